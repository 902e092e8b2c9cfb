// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// What a user would take instead of the program, on the same models and with
// the same output:
//   conventional  implicit, nonlinear, a factorisation in each iteration
//   explicit      central differences with a lumped mass matrix
//   calculix      the program CalculiX, if it is installed
// See hilber_hughes_taylor.h, central_differences.h and calculix.h.
//
// Usage: baselines METHOD [--alpha A] [--least-iterations N] [OPTIONS] MODEL
//        baselines --quick
// with the options of acf-dealii. --alpha is that of the method of Hilber,
// Hughes and Taylor, -0.05 if not given, 0 for the trapezoidal rule. Newton's
// method takes at least N iterations per step, 2 if not given, as in CalculiX.
// The
// explicit method takes steps of 0.9 times the critical size, or shorter ones
// that divide the probe interval. --quick compares all methods with the program
// on a small pendulum, and fails if they disagree.

#include <acf/base/exceptions.h>
#include <acf/base/huge_pages.h>
#include <acf/run_report.h>
#include <acf/simulation.h>

#include <mpi.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

#include "performance/baselines/agreement.h"
#include "performance/baselines/calculix.h"
#include "performance/baselines/central_differences.h"
#include "performance/baselines/hilber_hughes_taylor.h"

namespace
{
  using namespace Baselines;

  // The longest step size below a limit that divides the probe interval.
  double
  dividing_step_size(const double limit, const double interval)
  {
    return interval > 0 ? interval / std::ceil(interval / limit) : limit;
  }



  void
  run_method(const std::string &name,
             const double alpha,
             const unsigned int least_iterations,
             const Model &model,
             const std::filesystem::path &directory)
  {
    Statistics statistics;
    std::unique_ptr<const MultibodySystem> system;
    {
      const PhaseTimer timer(statistics, "assembly");
      system =
        std::make_unique<const MultibodySystem>(model.system, model.directory);
    }
    std::filesystem::create_directories(directory);
    ProbeOutput probes(*system,
                       model.probes,
                       model.output.probe_interval,
                       directory,
                       statistics);
    const auto run_steps = [&](Method &method, const double step_size) {
      std::ostringstream nowhere;
      Statistics start;
      FactorizationCache cache(start);
      run(method,
          *system,
          initial_state(
            *system, model.start, model.time.step_size, cache, start, nowhere),
          model.time.end_time,
          step_size,
          {&probes},
          statistics);
    };

    if (name == "conventional")
      {
        HilberHughesTaylor method(
          *system, alpha, least_iterations, model.time, statistics);
        run_steps(method, model.time.step_size);
      }
    else if (name == "explicit")
      {
        CentralDifferences method(*system, statistics);
        run_steps(method,
                  dividing_step_size(0.9 * method.critical_step_size(),
                                     model.output.probe_interval));
      }
    else
      {
        write_calculix_model(model, *system, alpha, directory);
        run_calculix(directory, statistics);
        read_calculix_results(*system, directory, {&probes});
      }
    std::ofstream(directory / "statistics.json")
      << statistics_json(statistics, *system, nullptr, true);
    std::cout << name << ": " << statistics.steps << " steps, "
              << statistics.newton_iterations << " iterations, "
              << statistics.real_factorizations << " factorisations, "
              << statistics.wall_times["time steps"] << " s" << std::endl;
  }



  int
  run_command(std::vector<std::string> arguments)
  {
    if (arguments == std::vector<std::string>{"--quick"})
      return check_agreement() ? 0 : 1;
    const std::string method = arguments.empty() ? "" : arguments.front();
    if (method != "conventional" && method != "explicit" &&
        method != "calculix")
      throw InputError(
        "Usage: baselines conventional|explicit|calculix "
        "[--alpha A] [--least-iterations N] [OPTIONS] MODEL");
    arguments.erase(arguments.begin());
    double alpha                  = -0.05;
    unsigned int least_iterations = 2;
    while (arguments.size() > 1 &&
           (arguments[0] == "--alpha" || arguments[0] == "--least-iterations"))
      {
        if (arguments[0] == "--alpha")
          alpha = std::stod(arguments[1]);
        else
          least_iterations = std::stoul(arguments[1]);
        arguments.erase(arguments.begin(), arguments.begin() + 2);
      }
    const CommandLine command_line = parse_command_line(arguments);
    const Model model =
      read_model(ParameterFile(command_line.model, command_line.overrides));
    run_method(method,
               alpha,
               least_iterations,
               model,
               command_line.output_directory.value_or(
                 model.output.directory.empty()
                   ? command_line.model.stem().string() + "-" + method
                   : model.output.directory));
    return 0;
  }
} // namespace



int
main(int argc, char **argv)
{
  ACF::keep_heap_in_huge_pages();
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  int status = 1;
  try
    {
      status = run_command({argv + 1, argv + argc});
    }
  catch (const std::exception &error)
    {
      std::cerr << "baselines: " << error.what() << std::endl;
    }
  MPI_Finalize();
  return status;
}
