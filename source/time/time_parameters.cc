// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/input_problems.h>
#include <acf/time/time_parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  namespace
  {
    // More would take a week with small bodies, and is rather a mistake.
    constexpr double max_steps = 1e8;

    // A petabyte, MB.
    constexpr double max_factor_memory = 1e9;
  } // namespace



  void
  TimeParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Stages",
                      n_stages,
                      "Stages s of the Radau IIA method; positions converge "
                      "with order 2s-1, velocities with s, reactions with s-1. "
                      "Units: none.",
                      Patterns::Integer(1, 3));
    prm.add_parameter("End time",
                      end_time,
                      "Time at which the simulation ends; it starts at zero; "
                      "required, but for a simulation that is over after the "
                      "static equilibrium or the modes at the start. Units: "
                      "s.",
                      Patterns::Double(0));
    prm.add_parameter("Step size",
                      step_size,
                      "Size of the time steps; required without a Tolerance, "
                      "with it that of the first step; zero: one that suits "
                      "the tolerance. Units: s.",
                      Patterns::Double(0));
    prm.add_parameter("Tolerance",
                      tolerance,
                      "Bound on the error of the positions that the time "
                      "integration has at the End time, relative to the length "
                      "of the largest body; chooses the step sizes; zero: "
                      "steps of the same size. Units: none.",
                      Patterns::Double(0, 0.1));
    prm.add_parameter("Maximal step size",
                      max_step_size,
                      "Largest step that a Tolerance may lead to; zero: a "
                      "tenth of the End time. Units: s.",
                      Patterns::Double(0));
    prm.add_parameter("Factor memory",
                      factor_memory,
                      "Memory for factorisations of different step sizes; "
                      "those that were not used for the longest time are "
                      "dropped. The present ones may need more. Units: MB.",
                      Patterns::Double(0, max_factor_memory));
    prm.add_parameter(
      "Newton tolerance",
      newton_tolerance,
      "Bound on the predicted error of the positions that the iteration of a "
      "step leaves, relative to the length of a body; zero: with a Tolerance "
      "what adds up to at most a tenth of it (three stages: a hundredth), else "
      "1 % of the estimated error of the step itself, within 1e-13 and 1e-10, "
      "or 1e-9 in short runs with large steps. Units: none.",
      Patterns::Double(0, 1e-2));
    prm.add_parameter("Maximal Newton iterations",
                      max_newton_iterations,
                      "Iterations after which a step is given up and halved. "
                      "Units: none.",
                      Patterns::Integer(2, 1000));
    prm.add_parameter("Maximal Krylov iterations",
                      max_krylov_iterations,
                      "Iterations of a linear system with the exact tangent, "
                      "which takes over where the iteration of a step fails, "
                      "after which the step is given up. Units: none.",
                      Patterns::Integer(1, 1000));
    prm.add_parameter("Maximal halvings",
                      max_halvings,
                      "How often a step that does not converge is halved "
                      "before the simulation fails. Units: none.",
                      Patterns::Integer(0, 30));
    prm.declare_entry(
      "Stage matrices",
      "diagonalized",
      Patterns::Selection("diagonalized|one-step"),
      "Matrices of the Newton iteration: the exact ones of the stages, "
      "diagonalised (one complex factorisation per conjugate pair), or for "
      "comparison real one-step matrices in the manner of the paper, which "
      "need more iterations. Units: none.");
    prm.declare_entry(
      "Starting values",
      "extrapolated",
      Patterns::Selection("extrapolated|zero"),
      "Where the Newton iteration of a step starts: at increments that are "
      "extrapolated from the steps before, or for comparison at zero, that is "
      "at motion without acceleration, which needs more iterations. Units: "
      "none.");
    prm.declare_entry(
      "Factor precision",
      "automatic",
      Patterns::Selection("automatic|single|double"),
      "Precision in which factorisations are kept: single precision has half "
      "the bytes, which is what a solve costs, and the iteration corrects its "
      "errors; automatic takes it where test solves show that it is accurate "
      "enough, and double precision elsewhere. Units: none.");
    prm.add_action("Factor precision", [this](const std::string &value) {
      factor_precision = value == "single"   ? FactorPrecision::single_precision
                         : value == "double" ? FactorPrecision::double_precision
                                             : FactorPrecision::automatic;
    });
    prm.add_action("Stage matrices", [this](const std::string &value) {
      one_step_matrices = (value == "one-step");
    });
    prm.add_action("Starting values", [this](const std::string &value) {
      extrapolates = (value == "extrapolated");
    });
  }



  void
  TimeParameters::check() const
  {
    InputProblems problems;
    const auto refuse = [&](const std::string &entry,
                            const std::string &found,
                            const std::string &allowed) {
      problems.add(InputError("Time integration", entry, found, allowed));
    };
    const auto require_positive = [&](const std::string &entry,
                                      const double value) {
      if (!(value > 0))
        refuse(entry, "nothing or zero", "a positive number");
    };
    require_positive("End time", end_time);
    if (tolerance == 0)
      require_positive("Step size", step_size);
    if (newton_tolerance > 0 && newton_tolerance < 1e-14)
      refuse("Newton tolerance",
             "a tolerance below round-off",
             "0 or a number in [1e-14, 0.01]");
    if (end_time > 0 && step_size > end_time)
      refuse("Step size",
             "a step larger than the End time",
             "a positive number not larger than the End time");
    if (tolerance == 0 && step_size > 0 && end_time / step_size > max_steps)
      refuse("Step size",
             "'" + format_number(step_size) + "', which makes " +
               format_number(end_time / step_size) + " steps to the End time",
             "steps of which at most " + format_number(max_steps) +
               " make a simulation");
    if (tolerance > 0 && tolerance < 1e-12)
      refuse("Tolerance",
             "a tolerance below round-off",
             "0 or a number in [1e-12, 0.1]");
    if (tolerance == 0 && max_step_size > 0)
      refuse("Maximal step size",
             "a limit of steps of the same size",
             "0, or a Tolerance that chooses the steps");
    if (max_step_size > 0 && step_size > max_step_size)
      refuse("Step size",
             "a step larger than the Maximal step size",
             "a number not larger than the Maximal step size");
    if (max_step_size > 0 && end_time / max_step_size > max_steps)
      refuse("Maximal step size",
             "'" + format_number(max_step_size) + "', which makes more than " +
               format_number(end_time / max_step_size) +
               " steps to the End time",
             "steps of which at most " + format_number(max_steps) +
               " make a simulation");
    problems.throw_all();
  }



  double
  TimeParameters::largest_step() const
  {
    return max_step_size > 0 ? max_step_size : end_time / 10;
  }



  double
  TimeParameters::first_step() const
  {
    if (step_size > 0 || tolerance == 0)
      return step_size;
    // for a motion that turns its direction some ten times
    return std::min(largest_step(),
                    0.01 * end_time *
                      std::pow(tolerance, 1. / (2 * n_stages - 1)));
  }
} // namespace ACF
