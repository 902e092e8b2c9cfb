// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Cost of a chain of identical links (prm/chain) against their number, as
// comma-separated values: assembly with factorisation (without reading the
// model file) relative to a single link, time per iteration and link, and
// memory of factors and states. Times are medians of three runs, or more of
// short chains. Fails if a longer chain assembles more bodies or makes more
// factors. Links of two sizes: with a factor that stays in the second-level
// cache, and with one that does not.
//
// Usage: chain_cost [--quick]

#include <acf/base/huge_pages.h>

#include <mpi.h>

#include <algorithm>
#include <iostream>

#include "recorded_run.h"

namespace
{
  using namespace Tests;

  const double step_size = 1e-3;

  std::string
  model_file(const std::string &cells, const unsigned int n_links)
  {
    std::string names, bodies, joint_names, joints;
    for (unsigned int k = 0; k < n_links; ++k)
      {
        const std::string separator = (k > 0 ? ", " : "");
        const std::string number    = std::to_string(k);
        names += separator + "link " + number;
        joint_names += separator + "joint " + number;
        bodies += "subsection link " + number + R"(
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = 0, -0.005, -0.005
    set Box to          = 0.1, 0.005, 0.005
    set Young's modulus = 2e8
    set Poisson's ratio = 0.3
    set Density         = 1000
    set Cells           = )" +
                  cells + "\n set Position = " + std::to_string(0.1 * k) +
                  ", 0, 0\n  end\n";
        joints +=
          "subsection joint " + number +
          "\n set Type = spherical\n set Between = link " + number +
          ": x min, " +
          (k == 0 ? "ground" : "link " + std::to_string(k - 1) + ": x max") +
          "\n end\n";
      }
    return "subsection Bodies\n set Names = " + names + "\n" + bodies +
           "end\nsubsection Joints\n set Names = " + joint_names + "\n" +
           joints +
           "end\nsubsection Loads\n set Gravity = 0, 0, -9.81\nend\n"
           "subsection Time integration\n set End time = 1\n set Step size = " +
           std::to_string(step_size) + "\nend\n";
  }

  struct Cost
  {
    Statistics statistics;
    unsigned int n_reference_bodies = 0;
    std::size_t state_bytes         = 0;
    double setup                    = 0; // s, assembly and factorisation
    double step                     = 0; // s per iteration
  };

  Cost
  measure(const std::string &cells,
          const unsigned int n_links,
          const unsigned int n_steps)
  {
    // those of small ones take milliseconds
    const unsigned int n_runs = n_steps < 10 ? 3 : 3 + 2 * (50 / n_links);
    std::vector<Cost> costs(n_runs);
    for (Cost &cost : costs)
      {
        RecordedRun run(model_file(cells, n_links),
                        1.,
                        {"Time integration/End time=" +
                         std::to_string(step_size * n_steps)});
        const auto start = std::chrono::steady_clock::now();
        const MultibodySystem system(run.model.system, run.model.directory);
        cost.setup = std::chrono::duration<double>(
                       std::chrono::steady_clock::now() - start)
                       .count();
        run.run();
        cost.n_reference_bodies = system.n_reference_bodies();
        for (const NodalVector &x : run.last().positions)
          cost.state_bytes += 2 * x.size() * sizeof(double);
        cost.statistics = run.statistics;
        auto &times     = cost.statistics.wall_times;
        cost.step       = (times["time steps"] - times["factorisation"]) /
                    cost.statistics.newton_iterations;
        cost.setup += times["factorisation"];
      }
    std::sort(costs.begin(), costs.end(), [](const Cost &a, const Cost &b) {
      return a.setup < b.setup;
    });
    Cost result = costs[n_runs / 2];
    std::sort(costs.begin(), costs.end(), [](const Cost &a, const Cost &b) {
      return a.step < b.step;
    });
    result.step = costs[n_runs / 2].step;
    return result;
  }
} // namespace



int
main(int argc, char **argv)
{
  const bool quick = (argc > 1 && std::string(argv[1]) == "--quick");
  ACF::keep_heap_in_huge_pages();
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);

  bool success = true;
  std::cout << "unknowns of a link,links,unknowns,constraints,assembled "
               "bodies,factorisations,"
               "factor memory [B],memory of positions and velocities [B],"
               "assembly and factorisation [s],relative to one link,"
               "iterations per step,per iteration and link [ms],"
               "per step and link [ms]"
            << std::endl;
  const auto run = [&](const std::string &cells,
                       const std::vector<unsigned int> &numbers,
                       const unsigned int n_steps) {
    double single_setup = 0;
    for (const unsigned int n : numbers)
      {
        const Cost cost                = measure(cells, n, n_steps);
        const Statistics &statistics   = cost.statistics;
        const unsigned long n_factored = statistics.complex_factorizations;
        if (n == 1)
          single_setup = cost.setup;
        success = success && cost.n_reference_bodies == 1 && n_factored == 1 &&
                  statistics.real_factorizations == 0;
        const std::size_t n_unknowns = cost.state_bytes / (2 * sizeof(double));
        std::cout << n_unknowns / n << ',' << n << ',' << n_unknowns << ','
                  << 3 * n << ',' << cost.n_reference_bodies << ','
                  << n_factored << ',' << statistics.factor_bytes << ','
                  << cost.state_bytes << ',' << cost.setup << ','
                  << cost.setup / single_setup << ','
                  << 1. * statistics.newton_iterations / statistics.steps << ','
                  << 1e3 * cost.step / n << ','
                  << 1e3 * cost.step / n * statistics.newton_iterations /
                       statistics.steps
                  << std::endl;
      }
  };
  if (quick)
    run("8, 2, 2", {1, 4}, 2);
  else
    {
      run("8, 2, 2", {1, 10, 50, 100, 200}, 50);
      run("24, 4, 4", {1, 10, 100}, 50);
    }
  MPI_Finalize();
  return success ? 0 : 1;
}
