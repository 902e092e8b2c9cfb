// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Cases 10 and 12: thin pendulum on unsymmetric meshes, spin-up beam.

#include <cmath>

#include "stress.h"

namespace Stress
{
  namespace
  {
    /** The thin pendulum on tetrahedra without a plane of symmetry. */
    void
    thin_pendulum(Row &row, const std::string &strain, const double mesh_size)
    {
      const bool reduced     = (strain == "reduced");
      const std::string time = time_section(reduced ? 1.3 : 1., 1e-3);
      Simulation simulation(
        section("Bodies",
                {{"pendulum",
                  std::string("Mesh = ") + ACF_STRESS +
                    "/thin_pendulum.geo\nMesh size = " + exact(mesh_size) +
                    "\nElement = tetrahedron\nYoung's modulus = 2.1e8\n"
                    "Poisson's ratio = 0.3\nDensity = 7800\nStrain = " +
                    strain}}) +
        section(
          "Joints",
          {{"right", "Type = spherical\nBetween = pendulum: right, ground"},
           {"left", "Type = spherical\nBetween = pendulum: left, ground"}}) +
        section("Loads", {}, "set Gravity = 0, 0, -9.81\n") +
        section("Probes", {{"tip", "Of = pendulum: tip\nComponents = x"}}) +
        time.substr(0, time.find("subsection Validity")));
      double at_half = 0, at_one = 0;
      EnergyWatch energy(simulation);
      const bool done = simulation.run([&](const SystemState &state) {
        energy(state);
        const double x = std::abs(simulation.probes(state)[0]);
        if (state.time < 0.5)
          at_half = std::max(at_half, x);
        if (state.time < 1.0005)
          at_one = std::max(at_one, x);
      });
      row.require(std::to_string(simulation.system.bodies()[0]
                                   .operators()
                                   .reference_positions.size()) +
                    " unknowns, end reached",
                  done,
                  done ? "yes" : simulation.failure,
                  "");
      if (reduced)
        {
          row.near("out of the plane at 1 s [m]",
                   at_one,
                   1e-2,
                   0.9e-2,
                   "measured before on another mesh");
          row.require("growing",
                      at_one > 3 * at_half,
                      shown(at_half) + " at 0.5 s",
                      "unstable without stiffening by tension");
          row.require("validity warning",
                      !simulation.warnings.str().empty(),
                      simulation.warnings.str().substr(0, 90),
                      "neglected energy");
        }
      else
        row.below("out of the plane up to 1 s [m]",
                  at_one,
                  1e-3,
                  "stable with stiffening by tension");
      row.below("halvings", simulation.statistics.halvings, 0, "1 ms suffices");
      row.below("growth of energy / largest kinetic",
                energy.growth / energy.largest_kinetic,
                1e-5,
                "dissipative scheme, tolerance");
      simulation.finish(row);
    }

    /** prm/spin-up: largest deflection of the tip and steady extension. */
    std::pair<double, double>
    spin_up(Row &row, const std::string &parts, const std::string &strain)
    {
      Simulation simulation(std::filesystem::path(ACF_PRM) /
                              "spin-up/spin-up.prm",
                            {"Bodies/beam/Cut=" + parts,
                             "Bodies/beam/Strain=" + strain});
      double deflection = 0, extension = 0, n = 0;
      const bool done = simulation.run([&](const SystemState &state) {
        const auto v   = simulation.probes(state);
        const double c = std::cos(v[2]), s = std::sin(v[2]);
        deflection = std::max(deflection, std::abs(c * v[1] - s * v[0]));
        if (state.time > 15)
          {
            extension += c * v[0] + s * v[1] - 10;
            n += 1;
          }
      });
      const std::string name =
        (parts.empty() ? "1 part" : parts) + ", " + strain;
      row.require(name, done, done ? "end" : simulation.failure, "");
      simulation.finish(row);
      row.near("extension [m]",
               extension / n,
               5.14e-4,
               0.01 * 5.14e-4,
               "rho w^2 L^3 / (3 E)");
      return {deflection, extension / n};
    }

    void
    spin_up_beam(Row &row)
    {
      const double exact_beam = spin_up(row, "", "Green-Lagrange").first;
      // the error falls with the square of the number of parts
      for (const auto &[parts, tolerance] : {std::make_pair("8 along x", 0.05),
                                             std::make_pair("4 along x", 0.05),
                                             std::make_pair("2 along x", 0.1),
                                             std::make_pair("", 0.25)})
        {
          const double deflection = spin_up(row, parts, "reduced").first;
          row.near("largest deflection [m]",
                   deflection,
                   exact_beam,
                   tolerance * exact_beam,
                   "strain of Green and Lagrange");
        }
    }
  } // namespace



  std::vector<Case>
  model_cases()
  {
    std::vector<Case> cases;
    for (const double size : {0.05, 0.025, 0.0125})
      for (const std::string strain : {"reduced", "Green-Lagrange"})
        cases.push_back(
          {"10 thin pendulum, mesh size " + shown(size) + ", " + strain,
           false,
           [=](Row &row) { thin_pendulum(row, strain, size); }});
    cases.push_back({"12 spin-up beam", false, spin_up_beam});
    return cases;
  }
} // namespace Stress
