// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Case 6: mechanisms at dead centres and change points.

#include <array>
#include <cmath>

#include "stress.h"

namespace Stress
{
  namespace
  {
    constexpr double pi = 3.14159265358979323846;

    std::string
    vector(const double x, const double y, const double z)
    {
      return exact(x) + ", " + exact(y) + ", " + exact(z);
    }

    /** A steel link along x that is placed and moves in the x-y plane. */
    std::string
    link(const double length,
         const std::array<double, 2> &position,
         const double angle,
         const std::array<double, 2> &velocity,
         const double rate)
    {
      return box({0, -0.01, -0.01},
                 {length, 0.01, 0.01},
                 "2, 1, 1",
                 2.1e11,
                 0.3,
                 7800) +
             "Position = " + vector(position[0], position[1], 0) +
             "\nRotation = " + vector(0, 0, angle) +
             "\nVelocity = " + vector(velocity[0], velocity[1], 0) +
             "\nAngular velocity = " + vector(0, 0, rate) + "\n";
    }

    std::string
    pin(const std::string &between, const std::string &more = "")
    {
      return "Type = revolute\nAxis = 0, 0, 1\nBetween = " + between + more;
    }

    const double rate = 2 * pi, two_turns = 2;

    /**
     * Slider-crank with crank = rod: the slider passes the crank's pin, where
     * the rod could also go on turning with the crank.
     */
    void
    equal_slider_crank(Row &row, const bool driven, const double step)
    {
      const double l = 0.5, phi = pi / 6, c = std::cos(phi), s = std::sin(phi);
      Simulation simulation(
        section(
          "Bodies",
          {{"crank",
            link(
              l, {{0, 0}}, phi, {{-rate * l / 2 * s, rate * l / 2 * c}}, rate)},
           {"rod",
            link(l,
                 {{l * c, l * s}},
                 -phi,
                 {{-1.5 * rate * l * s, 0.5 * rate * l * c}},
                 -rate)}}) +
        section("Joints",
                {{"main",
                  pin("crank: x min, ground",
                      driven ? "\nAngle = " + exact(rate) + "*t" : "")},
                 {"big end", pin("rod: x min, crank: x max")},
                 {"slider",
                  pin("rod: x max, ground",
                      "\nCross axis = 1, 0, 0\nFree = x")}}) +
        section("Probes",
                {{"slider", "Of = rod: x max\nComponents = x"},
                 {"crank",
                  "Type = chord\nAxis = z\nFrom = crank: x min\nTo = crank: x "
                  "max"},
                 {"rod",
                  "Type = chord\nAxis = z\nFrom = rod: x min\nTo = rod: x "
                  "max"}}) +
        time_section(two_turns, step));
      EnergyWatch energy(simulation);
      double kinematic = 0, fold = 0, last = 0;
      const bool done = simulation.run([&](const SystemState &state) {
        energy(state);
        const auto values = simulation.probes(state);
        kinematic         = std::max(kinematic,
                             std::abs(values[0] - 2 * l * std::cos(values[1])));
        fold              = std::max(fold, std::abs(values[1] + values[2]));
        last              = values[1];
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      row.below("slider - 2 l cos(crank) [m]",
                kinematic,
                3e-3,
                "rigid kinematics; elastic links");
      row.below("crank + rod angle [rad]",
                fold,
                5e-3,
                "rigid kinematics; elastic links");
      if (driven)
        row.near("crank at the end [rad]",
                 last,
                 phi + rate * two_turns,
                 1e-3,
                 "drive");
      else
        {
          row.below("growth of energy / energy",
                    energy.growth / energy.first,
                    1e-8,
                    "dissipative scheme");
          row.below("loss of energy / energy",
                    1 - energy.last / energy.first,
                    0.02,
                    "small steps");
        }
      simulation.finish(row);
    }

    /** Parallelogram that turns freely through its change points. */
    void
    parallelogram(Row &row, const double step)
    {
      const double l = 0.3, phi = pi / 3;
      const std::array<double, 2> end = {
        {l * std::cos(phi), l * std::sin(phi)}};
      const std::array<double, 2> velocity = {{-rate * end[1], rate * end[0]}};
      const std::array<double, 2> half = {{velocity[0] / 2, velocity[1] / 2}};
      Simulation simulation(
        section("Bodies",
                {{"left", link(l, {{0, 0}}, phi, half, rate)},
                 {"right", link(l, {{1, 0}}, phi, half, rate)},
                 {"coupler", link(1, end, 0, velocity, 0)}}) +
        section("Joints",
                {{"a", pin("left: x min, ground")},
                 {"b", pin("right: x min, ground")},
                 {"c", pin("coupler: x min, left: x max")},
                 {"d", pin("coupler: x max, right: x max")}}) +
        section("Probes",
                {{"left",
                  "Type = chord\nAxis = z\nFrom = left: x min\nTo = left: x "
                  "max"},
                 {"right",
                  "Type = chord\nAxis = z\nFrom = right: x min\nTo = right: x "
                  "max"}}) +
        time_section(two_turns, step));
      EnergyWatch energy(simulation);
      double fold = 0, drift = 0;
      const bool done = simulation.run([&](const SystemState &state) {
        energy(state);
        const auto values = simulation.probes(state);
        fold              = std::max(fold, std::abs(values[0] - values[1]));
        drift = std::max(drift, std::abs(values[0] - phi - rate * state.time));
      });
      row.require("end reached", done, done ? "yes" : simulation.failure, "");
      row.below("difference of the cranks [rad]",
                fold,
                1e-3,
                "parallelogram kinematics");
      row.below("angle - w t [rad]",
                drift,
                0.05,
                "the kinetic energy does not depend on the angle");
      row.below("growth of energy / energy",
                energy.growth / energy.first,
                1e-8,
                "dissipative scheme");
      row.below("loss of energy / energy",
                1 - energy.last / energy.first,
                0.01,
                "small steps");
      simulation.finish(row);
    }
  } // namespace



  std::vector<Case>
  mechanism_cases()
  {
    std::vector<Case> cases;
    const auto add = [&](const std::string &name,
                         const bool quick,
                         const std::function<void(Row &)> &run) {
      cases.push_back({name, quick, run});
    };
    for (const double step : {0.005, 0.02})
      {
        const std::string size = ", steps of " + shown(1e3 * step) + " ms";
        add("6 slider-crank with crank = rod, driven" + size,
            true,
            [=](Row &row) { equal_slider_crank(row, true, step); });
        add("6 slider-crank with crank = rod, free" + size,
            step < 0.01,
            [=](Row &row) { equal_slider_crank(row, false, step); });
        add("6 parallelogram through change points" + size,
            step < 0.01,
            [=](Row &row) { parallelogram(row, step); });
      }
    return cases;
  }
} // namespace Stress
