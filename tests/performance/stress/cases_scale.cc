// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Cases 3 to 5: ratios of stiffness and mass, slenderness.

#include <cmath>

#include "stress.h"
#include "vibration.h"

namespace Stress
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

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
                strain == "reduced" || n == "8",
                [=](Row &row) { slender_static(row, strain, n, accepted); });
          }
        add("5 slenderness 1000, first mode, " + strain, true, [=](Row &row) {
          slender_mode(row, strain);
        });
      }
    return cases;
  }
} // namespace Stress
