// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Cases 1 and 2: sizes of the steps, spins.

#include <cmath>

#include "stress.h"
#include "vibration.h"

namespace Stress
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

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
  } // namespace



  std::vector<Case>
  step_cases()
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
    return cases;
  }
} // namespace Stress
