// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Cost of a step of the pendulum (prm/pendulum) against the number of unknowns,
// as comma-separated values: memory and entries of the factor, times of
// assembly, factorisation and step, the share of the solves with the cached
// factor, and in the same run the ratios of the paper's real one-step matrices
// to the diagonalised ones and of the strain of Green and Lagrange to the
// reduced one, and of shorter vector instructions to those of the processor.
// Times are medians of three runs.
//
// Usage: step_cost [--quick]

#include <acf/base/huge_pages.h>
#include <acf/base/processor.h>

#include <mpi.h>

#include <algorithm>
#include <array>
#include <iostream>

#include "pendulum_model.h"
#include "recorded_run.h"

namespace
{
  using namespace Tests;

  std::string
  model_file(const std::array<unsigned int, 3> &cells)
  {
    return pendulum_model("tetrahedron",
                          std::to_string(cells[0]) + ", " +
                            std::to_string(cells[1]) + ", " +
                            std::to_string(cells[2]));
  }

  struct Cost
  {
    Statistics statistics;
    double assembly = 0; // s
    double step     = 0; // s, without factorisation
    double solves   = 0; // s per step
  };

  Cost
  measure(const std::array<unsigned int, 3> &cells,
          const unsigned int n_steps,
          const std::string &override)
  {
    std::vector<Cost> costs(3);
    for (Cost &cost : costs)
      {
        const auto start = std::chrono::steady_clock::now();
        RecordedRun run(model_file(cells),
                        1.,
                        {"Time integration/End time=" +
                           std::to_string(1e-3 * n_steps),
                         override});
        cost.assembly = std::chrono::duration<double>(
                          std::chrono::steady_clock::now() - start)
                          .count();
        run.run();
        cost.statistics = run.statistics;
        auto &times     = cost.statistics.wall_times;
        cost.step   = (times["time steps"] - times["factorisation"]) / n_steps;
        cost.solves = times["solves"] / n_steps;
      }
    std::sort(costs.begin(), costs.end(), [](const Cost &a, const Cost &b) {
      return a.step < b.step;
    });
    return costs[1];
  }
} // namespace



int
main(int argc, char **argv)
{
  const bool quick = (argc > 1 && std::string(argv[1]) == "--quick");
  ACF::keep_heap_in_huge_pages();
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);

  std::vector<std::array<unsigned int, 3>> meshes = {{{1, 8, 1}}};
  if (!quick)
    meshes = {{{1, 20, 1}}, {{1, 40, 2}}, {{1, 80, 4}}, {{1, 112, 5}}};
  const unsigned int n_steps = quick ? 3 : 20;

  std::cout << "unknowns,factor entries,factor memory [B],assembly [s],"
               "factorisation [s],step [s],iterations per step,share of solves,"
               "one-step: step relative to diagonalized,"
               "one-step: iterations per step,"
               "Green-Lagrange: step relative to reduced,"
               "Green-Lagrange: iterations per step,"
               "AVX2: step relative to best instructions,"
               "without AVX: step relative to best instructions,"
               "peak memory [B]"
            << std::endl;
  for (const auto &cells : meshes)
    {
      const Cost cost =
        measure(cells, n_steps, "Bodies/pendulum/Strain=reduced");
      const Cost paper =
        measure(cells, n_steps, "Time integration/Stage matrices=one-step");
      const Cost full =
        measure(cells, n_steps, "Bodies/pendulum/Strain=Green-Lagrange");
      const auto with_at_most = [&](const Processor processor) {
        limit_processor(processor);
        const Cost limited =
          measure(cells, n_steps, "Bodies/pendulum/Strain=reduced");
        limit_processor(Processor::avx512);
        return limited;
      };
      const Cost avx2       = with_at_most(Processor::avx2);
      const Cost any        = with_at_most(Processor::any);
      const auto iterations = [&](const Cost &c) {
        return 1. * c.statistics.newton_iterations / c.statistics.steps;
      };
      const RecordedRun size(model_file(cells),
                             1.,
                             {"Time integration/End time=1"});
      std::cout << size.system.bodies()[0].operators().n_unknowns() << ','
                << cost.statistics.factor_entries << ','
                << cost.statistics.factor_bytes << ',' << cost.assembly << ','
                << cost.statistics.wall_times.at("factorisation") << ','
                << cost.step << ',' << iterations(cost) << ','
                << cost.solves / cost.step << ',' << paper.step / cost.step
                << ',' << iterations(paper) << ',' << full.step / cost.step
                << ',' << iterations(full) << ',' << avx2.step / cost.step
                << ',' << any.step / cost.step << ',' << peak_memory()
                << std::endl;
    }
  MPI_Finalize();
  return 0;
}
