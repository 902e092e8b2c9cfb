// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Steps, spins, ratios of stiffness and mass, slenderness.

#include <array>
#include <cmath>

#include "stress.h"

namespace Stress
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

    /**
     * A vibration in a mode of frequency omega, released from a deflection at
     * rest: after n steps Re R(i omega tau)^n and, for the velocity divided by
     * -omega, its imaginary part. The first probe is the position, the second
     * the velocity, of which one component is meant.
     */
    void
    check_mode(Row &row,
               const std::string &model_file,
               const double rest,
               const double amplitude,
               const double omega,
               const double tolerance,
               const unsigned int stages = 2,
               const double growth       = 1e-9)
    {
      Simulation simulation(model_file);
      const std::complex<double> factor =
        stability_function(stages,
                           {0, omega * simulation.model.time.step_size});
      std::complex<double> expected = 1;
      double error = 0, change = 0, n = 0;
      EnergyWatch energy(simulation);
      const bool done = simulation.run([&](const SystemState &state) {
        const auto values = simulation.probes(state);
        const std::complex<double> found((values[0] - rest) / amplitude,
                                         -values[1] / (amplitude * omega));
        if (state.time < simulation.model.time.end_time * (1 - 1e-9))
          {
            if (n > 0)
              expected *= factor;
            error  = std::max(error, std::abs(found - expected));
            change = std::max(change, std::abs(expected - 1.));
          }
        n += 1;
        energy(state);
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      row.below("error against powers of R(i w tau), relative to the change " +
                  shown(change),
                error / change,
                tolerance,
                "analytic mode, stability function");
      row.below("growth of energy / energy",
                energy.growth / energy.first,
                growth,
                "dissipative scheme; round-off");
      simulation.finish(row);
    }

    /** Free bar in its first longitudinal mode. */
    void
    step_to_period(Row &row,
                   const double ratio,
                   const double n_steps,
                   const unsigned int stages)
    {
      const double E = 1e6, rho = 1000, a = 1e-2;
      const double omega = pi * std::sqrt(E / rho);
      const double step  = ratio * 2 * pi / omega;
      check_mode(
        row,
        section("Bodies",
                {{"bar",
                  box({0, 0, 0}, {1, 0.1, 0.1}, "8, 1, 1", E, 0, rho) +
                    "Displacement field = " + exact(a) + "*cos(pi*x); 0; 0"}}) +
          section("Probes",
                  {{"x", "Of = bar: x min\nComponents = x"},
                   {"v",
                    "Type = mean velocity\nOf = bar: x min\nComponents = x"}}) +
          // one step more, as the last one may end elsewhere
          time_section((n_steps + 1) * step, step, stages),
        0,
        a,
        omega,
        2e-3,
        stages);
    }

    /** Cantilever under sudden gravity at steps of its longest period and
     * above: what vibrates is damped by |R|, the static state is left. */
    void
    quasi_static(Row &row, const std::string &strain, const double ratio)
    {
      const double E = 2e9, rho = 1000, h = 0.05, g = 1;
      const double inertia = h * h / 12;
      const double omega =
        std::pow(1.87510407, 2) * std::sqrt(E / rho * inertia);
      const double step    = ratio * 2 * pi / omega;
      const double n_steps = 40;
      const double shear   = 5. / 6 * E / 2; // of E's section, nu = 0
      const double expected =
        rho * g * (1 / (8 * E * inertia) + 1 / (2 * shear));
      Simulation simulation(
        section("Bodies",
                {{"beam",
                  box({0, 0, 0}, {1, h, h}, "8, 1, 1", E, 0, rho) +
                    "Strain = " + strain}}) +
        section("Joints",
                {{"clamp", "Type = fixed\nBetween = beam: x min, ground"}}) +
        section("Loads", {}, "set Gravity = 0, 0, " + exact(-g) + "\n") +
        section("Probes", {{"tip", "Of = beam: x max\nComponents = z"}}) +
        time_section(n_steps * step, step));
      double last = 0;
      EnergyWatch energy(simulation);
      const bool done = simulation.run([&](const SystemState &state) {
        last = simulation.probes(state)[0] - h / 2;
        energy(state);
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      row.near("tip [m]", last, -expected, 5e-3 * expected, "Timoshenko beam");
      row.below("growth of energy / work of gravity",
                energy.growth / (rho * g * h * h * expected),
                1e-6,
                "dissipative scheme");
      simulation.finish(row);
    }

    /**
     * A rigid body that spins in a plane, by Radau IIA with 2 stages: its nodes
     * are X exp(i theta), the stress has no moment. Angle, and velocity divided
     * by X in the complex plane.
     */
    class RigidSpin
    {
    public:
      explicit RigidSpin(const double rate)
        : velocity(0, rate)
      {}

      void
      step(const double tau)
      {
        using namespace std::complex_literals;
        // A^-2 and A^-1 of the method
        const double V[2][2] = {{1.5, 0.5}, {-4.5, 2.5}};
        const double W[2][2] = {{0, 2}, {-18, 4}};
        const double c[2]    = {1. / 3, 1};
        const auto now       = std::polar(1., angle);
        const double rate    = (velocity / (1i * now)).real();
        double t[2]          = {angle + c[0] * tau * rate, angle + tau * rate};
        std::complex<double> Z[2];
        for (unsigned int k = 0; k < 100; ++k)
          {
            for (unsigned int j = 0; j < 2; ++j)
              Z[j] = std::polar(1., t[j]) - now - c[j] * tau * velocity;
            double r[2], J[2][2];
            for (unsigned int i = 0; i < 2; ++i)
              {
                const auto back = std::polar(1., -t[i]);
                const auto sum  = W[i][0] * Z[0] + W[i][1] * Z[1];
                r[i]            = (back * sum).imag();
                for (unsigned int j = 0; j < 2; ++j)
                  J[i][j] = (W[i][j] * back * 1i * std::polar(1., t[j]) -
                             (i == j ? 1i * back * sum : 0.))
                              .imag();
              }
            const double det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
            t[0] -= (J[1][1] * r[0] - J[0][1] * r[1]) / det;
            t[1] -= (J[0][0] * r[1] - J[1][0] * r[0]) / det;
          }
        velocity += (V[1][0] * Z[0] + V[1][1] * Z[1]) / tau;
        angle = t[1];
      }

      /** Relative to that of the rate 1. */
      double
      momentum() const
      {
        return (std::polar(1., -angle) * velocity).imag();
      }

      double angle = 0;

    private:
      std::complex<double> velocity;
    };

    /** Free box that turns by some angle per step. */
    void
    spin(Row &row, const std::string &strain, const double angle_per_step)
    {
      const double rate = 10, step = angle_per_step / rate, n_steps = 50;
      Simulation simulation(
        section("Bodies",
                {{"box",
                  box({-0.5, -0.1, -0.05},
                      {0.5, 0.1, 0.05},
                      "2, 1, 1",
                      2.1e11,
                      0.3,
                      7800) +
                    "Angular velocity = 0, 0, 10\nStrain = " + strain}}) +
        section("Probes",
                {{"chord",
                  "Type = chord\nFrom = box: x min\nTo = box: x max\n"
                  "Axis = z"}}) +
        time_section(n_steps * step, step));
      RigidSpin rigid(rate);
      double angle_error = 0, momentum_error = 0, first = 0, before = 0;
      EnergyWatch energy(simulation);
      const bool done = simulation.run([&](const SystemState &state) {
        const double momentum = simulation.system.angular_momentum(state)[2];
        if (state.time == 0)
          first = momentum;
        else
          rigid.step(state.time - before);
        before = state.time;
        angle_error =
          std::max(angle_error,
                   std::abs(simulation.probes(state)[0] - rigid.angle));
        momentum_error =
          std::max(momentum_error,
                   std::abs(momentum / first - rigid.momentum() / rate));
        energy(state);
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      row.below("angle, of " + shown(rigid.angle) + " rad (exact " +
                  shown(rate * n_steps * step) + "), error [rad]",
                angle_error,
                1e-4 * n_steps * angle_per_step,
                "rigid body by the same scheme, written for it");
      row.below("angular momentum / first " + shown(rigid.momentum() / rate) +
                  ", error",
                momentum_error,
                1e-4,
                "the same");
      row.below("growth of energy / energy",
                energy.growth / energy.first,
                1e-9,
                "dissipative scheme");
      simulation.finish(row);
    }

    /** Extension of a free rod by the centrifugal force. */
    void
    spin_extension(Row &row, const std::string &strain)
    {
      const double E = 1e6, rho = 1000, rate = 2, half = 0.5, step = 0.01;
      const std::string q = exact(rho * rate * rate / (2 * E));
      Simulation simulation(
        section(
          "Bodies",
          {{"rod",
            box(
              {-half, -0.02, -0.02}, {half, 0.02, 0.02}, "6, 1, 1", E, 0, rho) +
              "Angular velocity = 0, 0, 2\nStrain = " + strain +
              "\nDisplacement field = " + q + "*(0.25*x - x^3/3); 0; 0"}}) +
        section("Probes",
                {{"stretch",
                  "Type = chord frame\nFrom = rod: x min\nTo = rod: x max\n"
                  "Point = 0, 0, 0\nAxis = z"}}) +
        time_section(6, step));
      double sum = 0, n = 0;
      EnergyWatch energy(simulation);
      const bool done = simulation.run([&](const SystemState &state) {
        energy(state);
        if (state.time < 3)
          return;
        sum += simulation.probes(state)[0];
        n += 1;
      });
      const double expected =
        2 * rho * rate * rate * half * half * half / (3 * E);
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      row.near("mean extension [m]",
               sum / n,
               expected,
               3e-3 * expected,
               "2 rho w^2 l^3 / (3 E)");
      row.below("growth of energy / energy",
                energy.growth / energy.first,
                1e-9,
                "dissipative scheme");
      simulation.finish(row);
    }

    /** Two rods in series, the second one ratio times as stiff. */
    std::string
    series(const double E, const double ratio, const std::string &field)
    {
      return section(
               "Bodies",
               {{"root",
                 box({0, 0, 0}, {0.5, 0.1, 0.1}, "6, 1, 1", E, 0, 1000) +
                   "Displacement field = " + field},
                {"tip",
                 box(
                   {0, 0, 0}, {0.5, 0.1, 0.1}, "2, 1, 1", ratio * E, 0, 1000) +
                   "Position = 0.5, 0, 0\n"}}) +
             section("Joints",
                     {{"clamp", "Type = fixed\nBetween = root: x min, ground"},
                      {"weld",
                       "Type = fixed\nBetween = tip: x min, root: x max"}}) +
             section("Probes",
                     {{"x", "Of = tip: x max\nComponents = x"},
                      {"v",
                       "Type = mean velocity\nOf = tip: x max\nComponents = "
                       "x"}});
    }

    void
    stiffness_ratio_static(Row &row, const double E, const double ratio)
    {
      const double force = 100, A = 0.01;
      Simulation simulation(
        series(E, ratio, "0; 0; 0") +
        section("Loads",
                {{"pull",
                  "On = tip: x max\nValue = " + exact(force) + "; 0; 0"}}) +
        "subsection Start\nset Equilibrium = true\nend\n");
      const double tip      = simulation.probes(simulation.start())[0] - 1;
      const double expected = 0.5 * force / (E * A) * (1 + 1 / ratio);
      row.near("tip [m]", tip, expected, 1e-5 * expected, "F L / (E A)");
      simulation.finish(row);
    }

    void
    stiffness_ratio_mode(Row &row)
    {
      // k L tan(k L) = 1 for a mass as large as that of the rod
      const double E = 1e5, kL = 0.86033358901938, a = 1e-3;
      const double omega = 2 * kL * std::sqrt(E / 1000);
      const double step  = 2 * pi / omega / 40;
      std::string model =
        series(E,
               1e6,
               exact(a / std::sin(kL)) + "*sin(" + exact(2 * kL) + "*x); 0; 0");
      const std::string position = "Position = 0.5, 0, 0\n";
      model.replace(model.find(position),
                    position.size(),
                    position + "set Displacement field = " + exact(a) +
                      "; 0; 0\n");
      check_mode(
        row, model + time_section(120 * step, step), 1, a, omega, 5e-3);
    }

    /**
     * Period of a physical pendulum that swings about x from an angle at rest:
     * twice the time between two zeros of the angle, from the angle and the
     * rate of a hinge, the first two probes.
     */
    void
    check_period(Row &row,
                 const std::string &model_file,
                 const double amplitude,
                 const double squared_rate)
    {
      Simulation simulation(model_file);
      std::vector<double> zeros;
      double before[3] = {0, 0, 0};
      EnergyWatch energy(simulation);
      const bool done = simulation.run([&](const SystemState &state) {
        energy(state);
        const auto values  = simulation.probes(state);
        const double angle = values[0] + amplitude;
        if (state.time > 0 && angle * before[1] < 0)
          {
            // inverse Hermite interpolation: time as a cubic of the angle
            const double h = angle - before[1], x = -before[1] / h,
                         T  = state.time - before[0];
            const double d0 = h / before[2] / T, d1 = h / values[1] / T;
            zeros.push_back(
              before[0] +
              T * (x * (d0 + x * (3 - 2 * d0 - d1 + x * (d0 + d1 - 2)))));
          }
        before[0] = state.time;
        before[1] = angle;
        before[2] = values[1];
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      const double expected = 4 / std::sqrt(squared_rate) *
                              std::comp_ellint_1(std::sin(amplitude / 2));
      row.near("period [s]",
               zeros.size() < 2 ? 0 : 2 * (zeros[1] - zeros[0]),
               expected,
               5e-4 * expected,
               "rigid pendulum, elliptic integral");
      row.below("growth of energy / largest kinetic energy",
                energy.growth / energy.largest_kinetic,
                1e-6,
                "dissipative scheme; tolerance of the iteration");
      row.below("loss of energy / largest kinetic energy",
                (energy.first - energy.last) / energy.largest_kinetic,
                1e-3,
                "small steps");
      simulation.finish(row);
    }

    std::string
    swing(const double time)
    {
      return section("Loads", {}, "set Gravity = 0, 0, -9.81\n") +
             section("Probes", {{"hinge", "Type = joint angle\nOf = hinge"}}) +
             time_section(time, 0.01);
    }

    const std::string hinge =
      "Type = revolute\nBetween = rod: z max, ground\n"
      "Axis = 1, 0, 0";

    /** A light rod with a heavy box at its end. */
    void
    heavy_bob(Row &row, const std::string &strain)
    {
      const double amplitude = 0.5;
      const std::string turn = "Rotation = 0.5, 0, 0\nStrain = " + strain;
      const double m_rod = 4e-4, m = 400, d = 1.1;
      const double J =
        m * (d * d + 0.2 * 0.2 / 6) + m_rod * (1 / 3. + 0.04 * 0.04 / 12);
      const double stiffness = 9.81 * (m * d + m_rod * 0.5);
      check_period(
        row,
        section(
          "Bodies",
          {{"rod",
            box(
              {-0.02, -0.02, -1}, {0.02, 0.02, 0}, "1, 1, 4", 2e11, 0.3, 0.25) +
              turn},
           {"bob",
            box({-0.1, -0.1, -1.2},
                {0.1, 0.1, -1},
                "1, 1, 1",
                2e11,
                0.3,
                m / 0.008) +
              turn}}) +
          section("Joints",
                  {{"hinge", hinge},
                   {"weld",
                    "Type = fixed\nBetween = bob: z max, rod: z min"}}) +
          swing(2.2),
        amplitude,
        stiffness / J);
    }

    /** A heavy rod, and a light one that hangs on it and whips. */
    void
    light_tail(Row &row)
    {
      const double h = 0.04;
      check_period(
        row,
        section(
          "Bodies",
          {{"rod",
            box(
              {-0.02, -0.02, -1}, {0.02, 0.02, 0}, "1, 1, 4", 2e11, 0.3, 7800) +
              "Rotation = 0.5, 0, 0\n"},
           {"tail",
            box({-0.02, -0.02, -1.5},
                {0.02, 0.02, -1},
                "1, 1, 2",
                2e11,
                0.3,
                7800 * 2e-6) +
              "Rotation = 0.5, 0, 0\n"}}) +
          section("Joints",
                  {{"hinge", hinge},
                   {"knee",
                    "Type = revolute\nBetween = tail: z max, rod: z min\n"
                    "Axis = 1, 0, 0"}}) +
          swing(2.2),
        0.5,
        9.81 * 0.5 / (1 / 3. + h * h / 12));
    }

    const double thin = 1e-3, steel = 2.1e11;

    std::string
    thin_rod(const std::string &cells, const std::string &entries)
    {
      return section("Bodies",
                     {{"rod",
                       box({0, -thin / 2, -thin / 2},
                           {1, thin / 2, thin / 2},
                           cells + ", 1, 1",
                           steel,
                           0.3,
                           7800) +
                         entries}}) +
             section("Joints",
                     {{"clamp", "Type = fixed\nBetween = rod: x min, ground"}});
    }

    /** 1 m x 1 mm x 1 mm: static deflection by a millimetre. */
    void
    slender_static(Row &row,
                   const std::string &strain,
                   const std::string &cells,
                   const double tolerance)
    {
      const double EI = steel * std::pow(thin, 4) / 12, force = 3 * EI * 1e-3;
      Simulation simulation(
        thin_rod(cells, "Strain = " + strain) +
        section("Loads",
                {{"tip", "On = rod: x max\nValue = 0; 0; " + exact(force)}}) +
        section("Probes", {{"tip", "Of = rod: x max\nComponents = z"}}) +
        "subsection Start\nset Equilibrium = true\nend\n");
      row.near("tip [m], " + cells + " cells",
               simulation.probes(simulation.start())[0],
               1e-3,
               tolerance * 1e-3,
               "F L^3 / (3 E I)");
      simulation.finish(row);
    }

    /** The same in its first mode of vibration. */
    void
    slender_mode(Row &row, const std::string &strain)
    {
      const double a = 2e-4;
      const double omega =
        std::pow(1.8751040687, 2) * std::sqrt(steel / 7800 / 12) * thin;
      const double step   = 2 * pi / omega / 40;
      const std::string A = exact(a / 2);
      const std::string w = A +
                            "*(cosh(1.8751040687*x) - cos(1.8751040687*x)"
                            " - 0.7340955138*(sinh(1.8751040687*x)"
                            " - sin(1.8751040687*x)))";
      const std::string dw = A +
                             "*1.8751040687*(sinh(1.8751040687*x)"
                             " + sin(1.8751040687*x) - 0.7340955138*"
                             "(cosh(1.8751040687*x)"
                             " - cos(1.8751040687*x)))";
      check_mode(row,
                 thin_rod("16",
                          "Strain = " + strain + "\nDisplacement field = -z*" +
                            dw + "; 0; " + w) +
                   section("Probes",
                           {{"tip", "Of = rod: x max\nComponents = z"},
                            {"v",
                             "Type = mean velocity\nOf = rod: x max\n"
                             "Components = z"}}) +
                   time_section(80 * step, step),
                 0,
                 a,
                 omega,
                 2e-2,
                 2,
                 1e-4);
    }
  } // namespace



  std::vector<Case>
  scale_cases()
  {
    std::vector<Case> cases;
    const auto add = [&](const std::string &name,
                         const bool quick,
                         const std::function<void(Row &)> &run) {
      cases.push_back({name, quick, run});
    };
    for (const auto &[ratio, n_steps, quick] :
         {std::make_tuple(1e-5, 2000., true),
          std::make_tuple(1e-4, 2000., false),
          std::make_tuple(1e-3, 2000., false),
          std::make_tuple(1e-2, 400., true),
          std::make_tuple(0.1, 100., true),
          std::make_tuple(1., 20., true)})
      for (const unsigned int stages : {2U, 3U})
        add("1 free bar, step / period = " + shown(ratio) + ", " +
              std::to_string(stages) + " stages",
            quick && stages == 2,
            [ratio = ratio, n_steps = n_steps, stages](Row &row) {
              step_to_period(row, ratio, n_steps, stages);
            });
    for (const std::string strain : {"reduced", "Green-Lagrange"})
      {
        for (const double ratio : {1., 100.})
          add("1 cantilever, step / period = " + shown(ratio) + ", " + strain,
              ratio == 1,
              [=](Row &row) { quasi_static(row, strain, ratio); });
        for (const double angle : {0.01, 0.1, 0.3, 1.})
          add("2 spin of " + shown(angle) + " rad per step, " + strain,
              angle > 0.2 && (angle < 1 || strain == "reduced"),
              [=](Row &row) { spin(row, strain, angle); });
        add("2 spinning rod, extension, " + strain, true, [=](Row &row) {
          spin_extension(row, strain);
        });
      }
    add("3 soft rod, then 1e6 times as stiff, static", true, [](Row &row) {
      stiffness_ratio_static(row, 1e5, 1e6);
    });
    add("3 stiff rod, then 1e6 times as soft, static", true, [](Row &row) {
      stiffness_ratio_static(row, 1e11, 1e-6);
    });
    add("3 soft rod, then 1e6 times as stiff, mode",
        true,
        stiffness_ratio_mode);
    for (const std::string strain : {"reduced", "Green-Lagrange"})
      add("4 body on a rod 1e6 times as light, " + strain,
          strain == "reduced",
          [=](Row &row) { heavy_bob(row, strain); });
    add("4 rod with a rod 1e6 times as light", true, light_tail);
    for (const std::string strain : {"reduced", "Green-Lagrange"})
      {
        for (const auto &[cells, tolerance] : {std::make_pair("2", 0.1),
                                               std::make_pair("4", 0.02),
                                               std::make_pair("8", 0.01),
                                               std::make_pair("16", 0.005)})
          {
            const std::string n   = cells;
            const double accepted = tolerance;
            add("5 slenderness 1000, static, " + n + " cells, " + strain,
                n == "8" && strain != "reduced",
                [=](Row &row) { slender_static(row, strain, n, accepted); });
          }
        add("5 slenderness 1000, first mode, " + strain, true, [=](Row &row) {
          slender_mode(row, strain);
        });
      }
    return cases;
  }
} // namespace Stress
