// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Cases 11 and 13: buckling, snap-through, loads and releases far from
// equilibrium.

#include <acf/time/modes.h>

#include <cmath>

#include "reference/cantilever.h"
#include "stress.h"

namespace Stress
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

    // Column: clamped at x = 0, slenderness 80, bends along z.
    const double column_E = 1e9, column_h = 0.0125, column_b = 0.05;
    const std::string column_cells = "24, 1, 1";
    const double euler_load =
      pi * pi / 4 * column_E * column_b * std::pow(column_h, 3) / 12;

    std::string
    column(const double load, const std::string &entries)
    {
      return section("Bodies",
                     {{"column",
                       box({0, -column_b / 2, -column_h / 2},
                           {1, column_b / 2, column_h / 2},
                           column_cells,
                           column_E,
                           0,
                           1000) +
                         "Strain = Green-Lagrange\n" + entries}}) +
             section("Joints",
                     {{"clamp",
                       "Type = fixed\nBetween = column: x min, ground"}}) +
             section("Loads",
                     {{"tip",
                       "On = column: x max\nValue = " + exact(-load) +
                         "; 0; 0"}}) +
             section("Probes", {{"tip", "Of = column: x max"}}) +
             "subsection Start\nset Equilibrium = true\nend\n";
    }

    /** The squared frequency of a straight column falls linearly with the load,
     * to zero at that of Euler. */
    void
    euler_buckling(Row &row)
    {
      double value[2];
      const double factor[2] = {0.95, 1.05};
      for (unsigned int k = 0; k < 2; ++k)
        {
          Simulation simulation(column(factor[k] * euler_load, ""));
          const SystemState state = simulation.start();
          value[k] =
            natural_modes(simulation.system, state, 2, simulation.statistics)
              .modes[0]
              .eigenvalue;
          simulation.finish(row);
        }
      row.near("buckling load / Euler's",
               factor[0] +
                 (factor[1] - factor[0]) * value[0] / (value[0] - value[1]),
               1,
               5e-3,
               "pi^2 E I / (4 L^2)");
    }

    /** Buckled state of the elastica. */
    void
    elastica(Row &row)
    {
      const double factor = 1.2;
      double low = 0, high = 0.999;
      for (unsigned int i = 0; i < 60; ++i)
        {
          const double k = (low + high) / 2;
          (std::pow(2 / pi * std::comp_ellint_1(k), 2) < factor ? low : high) =
            k;
        }
      const double K = std::comp_ellint_1(low), E = std::comp_ellint_2(low);
      Simulation simulation(
        column(factor * euler_load,
               "Displacement field = 0; 0; 0.1*(1 - cos(pi/2*x))"));
      const auto tip = simulation.probes(simulation.start());
      row.near("deflection [m]", tip[2], 2 * low / K, 5e-3, "elastica");
      row.near("tip [m]", tip[0], 2 * E / K - 1, 5e-3, "elastica");
      simulation.finish(row);
    }

    // Arch of arch.geo
    const double arch_E = 1e9, arch_h = 0.01,
                 arch_rise = 4 * 0.01 / std::sqrt(12.);

    /** Weight per length whose first harmonic holds the amplitude a of the
     * arch: bending, and the thrust of the shortened axis. */
    double
    arch_load(const double a)
    {
      // per width
      const double EA = arch_E * arch_h, EI = EA * arch_h * arch_h / 12;
      const double thrust = EA * pi * pi / 4 * (arch_rise * arch_rise - a * a);
      return pi / 4 *
             (EI * std::pow(pi, 4) * (arch_rise - a) + thrust * pi * pi * a);
    }

    std::string
    arch(const double load, const std::string &more)
    {
      const double rho = 1000;
      return section("Bodies",
                     {{"arch",
                       std::string("Mesh = ") + ACF_STRESS +
                         "/arch.geo\nElement = hexahedron\n"
                         "Strain = Green-Lagrange\nPoisson's ratio = 0\n"
                         "Young's modulus = " +
                         exact(arch_E) + "\nDensity = " + exact(rho)}}) +
             section("Joints",
                     {{"left",
                       "Type = revolute\nAxis = 0, 0, 1\nBetween = arch: "
                       "left, ground"},
                      {"right",
                       "Type = revolute\nAxis = 0, 0, 1\nBetween = arch: "
                       "right, ground"}}) +
             section("Loads",
                     {},
                     "set Gravity = 0, " + exact(-load / (rho * arch_h)) +
                       ", 0\n") +
             section("Probes",
                     {{"middle",
                       "Type = point position\nOf = arch\nPoint = 0.5, " +
                         exact(arch_rise) + ", 0.01\nComponents = y"}}) +
             more;
    }

    /** The load of snap-through is the largest one of arch_load(); the second
     * mode does not come first, as rise^2 < 16 radii of gyration^2 + a^2. */
    void
    snap_load(Row &row)
    {
      double largest = 0, at_largest = 0;
      for (double a = arch_rise; a > 0; a -= 1e-4 * arch_rise)
        if (arch_load(a) > largest)
          {
            largest    = arch_load(a);
            at_largest = a;
          }
      double high = arch_rise, low = at_largest;
      for (unsigned int i = 0; i < 60; ++i)
        {
          const double a                              = (low + high) / 2;
          (arch_load(a) > 0.8 * largest ? low : high) = a;
        }
      const std::string start =
        "subsection Start\nset Equilibrium = true\nend\n";
      const auto middle = [&](const double factor) {
        Simulation simulation(arch(factor * largest, start));
        const double y = simulation.probes(simulation.start())[0];
        simulation.finish(row);
        return y / arch_rise;
      };
      const std::string source = "pinned sine arch, one harmonic";
      row.near("height / rise at 0.8 snap load",
               middle(0.8),
               low / arch_rise,
               0.02,
               source);
      const double before = middle(0.97), after = middle(1.03);
      row.require("upright at 0.97 snap load",
                  before > 0,
                  shown(before),
                  source);
      row.require("snapped at 1.03 snap load",
                  after < -0.9,
                  shown(after),
                  source);
    }

    void
    dynamic_snap(Row &row)
    {
      double largest = 0;
      for (double a = arch_rise; a > 0; a -= 1e-3 * arch_rise)
        largest = std::max(largest, arch_load(a));
      Simulation simulation(arch(1.2 * largest, time_section(0.5, 1e-3)));
      EnergyWatch energy(simulation);
      double lowest   = 1;
      const bool done = simulation.run([&](const SystemState &state) {
        energy(state);
        lowest = std::min(lowest, simulation.probes(state)[0] / arch_rise);
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      row.below("lowest height / rise", lowest, -1, "snapped");
      row.below("growth of energy / largest kinetic",
                energy.growth / energy.largest_kinetic,
                1e-5,
                "dissipative scheme; tolerance of the iteration");
      row.below("loss of energy / largest kinetic",
                (energy.first - energy.last) / energy.largest_kinetic,
                0.1,
                "small steps");
      simulation.finish(row);
    }

    /** Cantilever, 2 m x 50 mm x 100 mm, in one descent from the straight
     * state. */
    void
    large_load(Row &row, const double force)
    {
      Reference::PlanarBeam beam;
      beam.length         = 2;
      beam.height         = 0.05;
      beam.width          = 0.1;
      beam.youngs_modulus = 2.07e11;
      beam.poissons_ratio = 0.3;
      const auto tip      = Reference::cantilever_tip(beam, force);
      Simulation simulation(
        section("Bodies",
                {{"beam",
                  box({0, -0.05, -0.025},
                      {2, 0.05, 0.025},
                      "24, 1, 1",
                      2.07e11,
                      0.3,
                      7850) +
                    "Strain = Green-Lagrange"}}) +
        section("Joints",
                {{"clamp", "Type = fixed\nBetween = beam: x min, ground"}}) +
        section("Loads",
                {{"tip", "On = beam: x max\nValue = 0; 0; " + exact(-force)}}) +
        section("Probes", {{"tip", "Of = beam: x max"}}) +
        "subsection Start\nset Equilibrium = true\nend\n");
      const auto found         = simulation.probes(simulation.start());
      const std::string source = "geometrically exact beam";
      row.near("deflection [m]", -found[2], tip.deflection, 0.01, source);
      row.near("shortening [m]", 2 - found[0], tip.shortening, 0.01, source);
      simulation.finish(row);
    }

    /** A beam that is bent to a part of a circle and let go. */
    void
    release(Row &row,
            const std::string &strain,
            const double angle,
            const double h,
            const unsigned int n_cells,
            const double end)
    {
      const double E = 1e5 / (h * h), step = 0.01;
      const std::string k = exact(angle);
      Simulation simulation(
        section("Bodies",
                {{"beam",
                  box({0, -0.02, -h / 2},
                      {1, 0.02, h / 2},
                      std::to_string(n_cells) + ", 1, 1",
                      E,
                      0,
                      1000) +
                    "Strain = " + strain + "\nDisplacement field = sin(" + k +
                    "*x)/" + k + " - x - z*sin(" + k + "*x); 0; (1 - cos(" + k +
                    "*x))/" + k + " + z*(cos(" + k + "*x) - 1)"}}) +
        section("Joints",
                {{"clamp", "Type = fixed\nBetween = beam: x min, ground"}}) +
        section("Probes", {{"tip", "Of = beam: x max\nComponents = z"}}) +
        time_section(end, step));
      EnergyWatch energy(simulation);
      double lowest   = 1;
      const bool done = simulation.run([&](const SystemState &state) {
        energy(state);
        lowest = std::min(lowest, simulation.probes(state)[0]);
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      if (strain != "reduced")
        {
          const double expected = E * 0.04 * h * h * h / 12 * angle * angle / 2;
          row.near("energy at the start [J]",
                   energy.first,
                   expected,
                   0.05 * expected,
                   "E I k^2 L / 2");
        }
      row.below("lowest tip [m]", lowest, -0.3, "swings through");
      row.below("growth of energy / energy",
                energy.growth / energy.first,
                1e-6,
                "dissipative scheme");
      if (strain != "reduced")
        row.below("loss of energy / energy",
                  1 - energy.last / energy.first,
                  0.3,
                  "vibrations faster than the steps are damped");
      simulation.finish(row);
    }
  } // namespace



  std::vector<Case>
  deflection_cases()
  {
    std::vector<Case> cases = {
      {"11 column, buckling load", true, euler_buckling},
      {"11 column, buckled", true, elastica},
      {"11 arch, load of snap-through", false, snap_load},
      {"11 arch, dynamic snap-through", false, dynamic_snap}};
    for (const double force : {3.125e5, 1e6})
      cases.push_back({"13 cantilever under " + shown(force) + " N",
                       force < 5e5,
                       [=](Row &row) { large_load(row, force); }});
    for (const std::string strain : {"reduced", "Green-Lagrange"})
      {
        cases.push_back(
          {"13 release from an arc of 1 rad, length / height 20, " + strain,
           true,
           [=](Row &row) { release(row, strain, 1, 0.05, 4, 0.4); }});
        cases.push_back(
          {"13 release from a quarter of a circle, length / height 20, " +
             strain,
           false,
           [=](Row &row) { release(row, strain, pi / 2, 0.05, 8, 1.5); }});
      }
    cases.push_back(
      {"13 release from a quarter of a circle, length / height "
       "50, Green-Lagrange",
       false,
       [](Row &row) {
         release(row, "Green-Lagrange", pi / 2, 0.02, 16, 1.5);
       }});
    return cases;
  }
} // namespace Stress
