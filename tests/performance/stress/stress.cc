// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Cases at and beyond the ends of the range of use, each with a figure that can
// fail and a bound on its steps; README.md explains them. Prints a table in
// Markdown; fails if a bound is passed.
//
// Usage: stress [--quick | --case NAME | --list]

#include "stress.h"

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>

#include <mpi.h>

#include <chrono>
#include <iostream>

extern "C" void
openblas_set_num_threads(int n_threads);

int
main(int argc, char **argv)
{
  using namespace Stress;
  const std::string option = argc > 1 ? argv[1] : "";
  const std::string name   = argc > 2 ? argv[2] : "";
  if (!(argc == 1 ||
        (argc == 2 && (option == "--quick" || option == "--list")) ||
        (argc == 3 && option == "--case")))
    {
      std::cerr << "Usage: stress [--quick | --case NAME | --list]\n";
      return 2;
    }
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  dealii::deal_II_exceptions::disable_abort_on_exception();
  // most models are too small for more threads
  dealii::MultithreadInfo::set_thread_limit(1);
  openblas_set_num_threads(1);

  unsigned int n_run = 0, n_failed = 0;
  if (option != "--list")
    std::cout << "| case | expected (source) | got | steps | rejected | "
                 "iterations | corrected steps | exact-tangent steps | "
                 "of GMRES | corrections | halvings | refreshes | verdict |\n"
                 "|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n";
  for (const auto &cases : {step_cases(),
                            scale_cases(),
                            mechanism_cases(),
                            motion_cases(),
                            deflection_cases(),
                            model_cases()})
    for (const Case &one : cases)
      {
        if (option == "--list")
          {
            std::cout << one.name << (one.quick ? " (quick)" : "") << "\n";
            continue;
          }
        if ((option == "--quick" && !one.quick) ||
            (option == "--case" && one.name.rfind(name, 0) != 0))
          continue;
        ++n_run;
        Row row;
        const auto start = std::chrono::steady_clock::now();
        try
          {
            one.run(row);
          }
        catch (const std::exception &error)
          {
            row.fail(error.what());
          }
        const std::chrono::duration<double> time =
          std::chrono::steady_clock::now() - start;
        std::cout << row.line(one.name) << std::endl;
        std::cerr << one.name << ": " << time.count() << " s" << std::endl;
        n_failed += !row.passed();
      }
  if (option == "--case" && n_run == 0)
    {
      std::cerr << "No case begins with '" << name << "', see --list\n";
      n_failed = 1;
    }
  MPI_Finalize();
  return n_failed > 0 ? 1 : 0;
}
