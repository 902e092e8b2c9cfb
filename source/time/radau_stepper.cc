// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/time/radau_stepper.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ACF
{
  void
  TimeParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Stages",
                      n_stages,
                      "Stages s of the Radau IIA method; positions converge "
                      "with order 2s-1, velocities with s, reactions with s-1. "
                      "Units: none.",
                      Patterns::Integer(2, 3));
    prm.add_parameter("End time",
                      end_time,
                      "Time at which the simulation ends; it starts at zero; "
                      "required, but for a simulation that is over after the "
                      "static equilibrium or the modes at the start. Units: "
                      "s.",
                      Patterns::Double(0));
    prm.add_parameter("Step size",
                      step_size,
                      "Size of the time steps; required. Units: s.",
                      Patterns::Double(0));
    prm.add_parameter(
      "Newton tolerance",
      newton_tolerance,
      "Bound on the predicted error of the positions that the iteration of a "
      "step leaves, relative to the length of a body. Units: none.",
      Patterns::Double(1e-14, 1e-2));
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
    prm.add_action("Stage matrices", [this](const std::string &value) {
      one_step_matrices = (value == "one-step");
    });
  }



  void
  TimeParameters::check() const
  {
    const auto require_positive = [](const std::string &entry,
                                     const double value) {
      if (!(value > 0))
        throw InputError("Time integration",
                         entry,
                         "nothing or zero",
                         "a positive number");
    };
    require_positive("End time", end_time);
    require_positive("Step size", step_size);
    if (step_size > end_time)
      throw InputError("Time integration",
                       "Step size",
                       "a step larger than the End time",
                       "a positive number not larger than the End time");
  }



  RadauStepper::RadauStepper(const MultibodySystem &system,
                             const TimeParameters &parameters,
                             Statistics &statistics)
    : system(system)
    , parameters(parameters)
    , statistics(statistics)
    , tableau(radau_iia(parameters.n_stages))
    , A_inverse(tableau.A.inverse())
    , cache(statistics)
    , equations(system, tableau, statistics)
    , acceleration(system, 5)
    , marked(system.bodies().size())
  {
    if (parameters.one_step_matrices)
      stage_solver = std::make_unique<OneStepStageSolver>(system,
                                                          tableau,
                                                          cache,
                                                          statistics);
    else
      stage_solver = std::make_unique<DiagonalizedStageSolver>(system,
                                                               tableau,
                                                               cache,
                                                               statistics);
  }



  void
  RadauStepper::predict(const SystemState &state)
  {
    // The collocation polynomial of the accepted step beyond its end, minus
    // u_n + c_i tau v_n; before the first step a motion without acceleration.
    const double ratio =
      accepted_step_size > 0 ? equations.step_size() / accepted_step_size : 0;
    const unsigned int last = tableau.n_stages() - 1;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        const std::vector<double> shape =
          stage_shape(tableau, 1 + tableau.c(i) * ratio);
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          {
            NodalVector &Z = equations.increments[i][b];
            Z              = 0;
            if (accepted_step_size > 0)
              for (unsigned int j = 0; j <= last; ++j)
                Z.add(shape[j] - (j == last ? 1. : 0.) -
                        tableau.c(i) * ratio * A_inverse(last, j),
                      accepted_stages[j][b]);
          }
        equations.multipliers[i] = state.multipliers;
      }
  }



  bool
  RadauStepper::prepare(StepReport &report)
  {
    rotations = equations.rotations();
    std::vector<LowRankChange> changes;
    if (linearization != Linearization::simplified)
      changes = equations.reduced_strain_changes(marked);
    try
      {
        stage_solver->prepare(equations.step_size(),
                              rotations,
                              equations.mean_linearization(),
                              changes);
        return true;
      }
    catch (const SimulationError &error)
      {
        report.failure = error.what();
        return false;
      }
  }



  void
  RadauStepper::correct_constraints()
  {
    // three corrections reach round-off from any tolerance of the iteration
    constexpr unsigned int max_corrections = 3;
    double length                          = 0;
    for (const Body &body : system.bodies())
      length = std::max(length, body.operators().length);
    const double tolerance = 1e-14 * std::max(1., length);

    StageVector increment(equations.increments);
    for (unsigned int k = 0; k < max_corrections; ++k)
      {
        StageConstraints constraints = equations.constraint_residual();
        double largest               = 0;
        for (Eigen::VectorXd &rows : constraints)
          {
            rows *= -1;
            largest = std::max(largest, rows.lpNorm<Eigen::Infinity>());
          }
        if (!(largest > tolerance))
          return;
        stage_solver->solve_constraints(increment, constraints);
        ++statistics.constraint_corrections;
        for (unsigned int i = 0; i < tableau.n_stages(); ++i)
          {
            for (unsigned int b = 0; b < system.bodies().size(); ++b)
              equations.increments[i][b] += increment[i][b];
            equations.multipliers[i] += constraints[i];
          }
      }
  }



  double
  RadauStepper::increment_norm(const SystemVector &increment,
                               const unsigned int b) const
  {
    const BodyOperators &operators = system.bodies()[b].operators();
    return increment[b].l2_norm() / std::sqrt(1. * operators.n_nodes) /
           operators.length;
  }



  double
  RadauStepper::increment_norm(const StageVector &increment) const
  {
    double norm = 0;
    for (const SystemVector &stage : increment)
      for (unsigned int b = 0; b < stage.size(); ++b)
        {
          const double relative = increment_norm(stage, b);
          if (!std::isfinite(relative))
            return relative;
          norm = std::max(norm, relative);
        }
    return norm;
  }



  void
  RadauStepper::iterate(const LinearSolver &solve,
                        const unsigned int patience,
                        const bool accelerate,
                        StepReport &report)
  {
    acceleration.reset();
    StageVector increment(equations.increments);
    StageConstraints constraint_increment(equations.multipliers);
    double factor        = std::pow(convergence_factor, 0.8);
    double previous_norm = 0, previous_ratio = 0;
    unsigned int n_iterations = 0;
    report.failure.clear();
    while (n_iterations < parameters.max_newton_iterations)
      {
        if (!equations.residual(increment,
                                constraint_increment,
                                report.failure) ||
            !solve(increment, constraint_increment, report.failure))
          {
            // the prediction may be at fault, or the iterations since
            if (n_iterations > 0)
              std::fill(marked.begin(), marked.end(), true);
            return;
          }
        ++n_iterations;
        ++report.iterations;
        ++statistics.newton_iterations;

        const double norm = increment_norm(increment);
        if (!std::isfinite(norm))
          {
            report.failure =
              "the iteration produced numbers that are not "
              "finite";
            std::fill(marked.begin(), marked.end(), true);
            return;
          }
        if (n_iterations > 1)
          {
            // the mean of two iterations, as single ones may be misleading
            const double ratio = norm / previous_norm;
            report.contraction =
              (n_iterations == 2 ? ratio : std::sqrt(ratio * previous_ratio));
            previous_ratio = ratio;
            factor         = report.contraction < 1
                               ? report.contraction / (1 - report.contraction)
                               : std::numeric_limits<double>::infinity();
            const double predicted =
              factor * norm *
              std::pow(report.contraction,
                       parameters.max_newton_iterations - n_iterations);
            if (n_iterations > patience)
              {
                if (report.contraction >= 0.99)
                  report.failure = "the iteration diverges";
                else if (predicted > parameters.newton_tolerance)
                  report.failure = "the iteration contracts too slowly";
                if (!report.failure.empty())
                  {
                    mark_bodies(increment);
                    return;
                  }
              }
          }
        previous_norm         = norm;
        report.error_estimate = factor * norm;
        report.converged = report.error_estimate <= parameters.newton_tolerance;
        // the contraction that was measured is that of accelerated iterations
        if (accelerate && (!report.converged || !acceleration.empty()))
          acceleration.accelerate(increment, constraint_increment);
        for (unsigned int i = 0; i < tableau.n_stages(); ++i)
          {
            for (unsigned int b = 0; b < system.bodies().size(); ++b)
              equations.increments[i][b] += increment[i][b];
            equations.multipliers[i] += constraint_increment[i];
          }
        if (report.converged)
          {
            convergence_factor =
              std::max(factor, std::numeric_limits<double>::epsilon());
            return;
          }
      }
    report.failure = "the iteration did not reach its tolerance";
    mark_bodies(increment);
  }



  void
  RadauStepper::mark_bodies(const StageVector &increment)
  {
    const double largest = increment_norm(increment);
    for (unsigned int b = 0; b < marked.size(); ++b)
      for (const SystemVector &stage : increment)
        if (increment_norm(stage, b) > 0.01 * largest)
          marked[b] = true;
  }



  void
  RadauStepper::iterate_exactly(StepReport &report)
  {
    if (!tangent)
      tangent = std::make_unique<StageTangent>(system, tableau);
    const auto solve = [&](StageVector &r,
                           StageConstraints &g,
                           std::string &failure) {
      if (!equations.linearize(marked, rotations, *tangent))
        {
          failure = "a body is turned inside out";
          return false;
        }
      unsigned int n_iterations;
      const double reduction = tangent->solve(*stage_solver,
                                              1e-3,
                                              parameters.max_krylov_iterations,
                                              r,
                                              g,
                                              n_iterations);
      statistics.krylov_iterations += n_iterations;
      if (reduction < 0.3)
        return true;
      failure = "the linear systems with the exact tangent are not solved by " +
                std::to_string(parameters.max_krylov_iterations) +
                " iterations";
      return false;
    };
    iterate(solve, 2, false, report);
  }



  void
  RadauStepper::refresh_factors(StepReport &report)
  {
    std::vector<const Body *> refreshed;
    for (unsigned int b = 0; b < marked.size(); ++b)
      if (marked[b])
        {
          const Body &body = system.bodies()[b];
          const auto elastic =
            ElasticTangent::at(body, equations.position(0, b));
          auto matrix =
            elastic ? elastic->matrix(rotations.stages[0][b]) : nullptr;
          if (!matrix)
            continue;
          cache.replace_stiffness(body, std::move(matrix));
          refreshed.push_back(&body);
        }
    if (refreshed.empty() || prepare(report))
      {
        statistics.factor_refreshes += refreshed.size();
        return;
      }
    for (const Body *const body : refreshed)
      cache.restore_stiffness(*body);
    prepare(report);
  }



  void
  RadauStepper::try_linearization(const SystemState &state, StepReport &report)
  {
    predict(state);
    if (!prepare(report))
      return;
    if (linearization == Linearization::exact)
      {
        if (n_failures >= 2)
          refresh_factors(report);
        iterate_exactly(report);
        if (report.converged)
          statistics.exact_tangent_steps +=
            std::count(marked.begin(), marked.end(), true);
        return;
      }
    // Acceleration takes some iterations to find the modes that are slow. The
    // one-step matrices belong to a non-normal iteration, whose increments may
    // grow at first.
    iterate(
      [&](StageVector &r, StageConstraints &g, std::string &) {
        stage_solver->solve(r, g);
        return true;
      },
      parameters.one_step_matrices ? 6 : 5,
      !parameters.one_step_matrices,
      report);
    if (report.converged && linearization == Linearization::corrected)
      for (unsigned int b = 0; b < marked.size(); ++b)
        if (marked[b] &&
            system.bodies()[b].strain_measure() == StrainMeasure::reduced)
          ++statistics.corrected_tangent_steps;
  }



  bool
  RadauStepper::linearize_better()
  {
    if (linearization == Linearization::exact ||
        std::find(marked.begin(), marked.end(), true) == marked.end())
      return false;
    bool reduced = false;
    for (unsigned int b = 0; b < marked.size(); ++b)
      reduced = reduced || (marked[b] && system.bodies()[b].strain_measure() ==
                                           StrainMeasure::reduced);
    if (linearization == Linearization::simplified)
      {
        waiting_steps = next_wait;
        next_wait     = std::min(2 * next_wait, longest_wait);
        if (reduced)
          {
            linearization = Linearization::corrected;
            return true;
          }
      }
    linearization = Linearization::exact;
    return true;
  }



  StepReport
  RadauStepper::try_step(const SystemState &state, const double step_size)
  {
    equations.start_step(state, step_size);
    if (waiting_steps == 0)
      {
        linearization = Linearization::simplified;
        std::fill(marked.begin(), marked.end(), false);
      }
    StepReport report;
    do
      try_linearization(state, report);
    while (!report.converged && linearize_better());

    if (!report.converged)
      {
        ++n_failures;
        waiting_steps = 0;
        return report;
      }
    if (linearization == Linearization::simplified)
      next_wait = first_wait;
    if (system.n_constraints() > 0)
      correct_constraints();
    return report;
  }



  void
  RadauStepper::update_laws(SystemState &state, const SystemState &before) const
  {
    if (!system.force_elements().empty())
      state.law_values =
        system.law_values(system.marker_values(state.positions),
                          before.law_values);
  }



  void
  RadauStepper::accept(SystemState &state)
  {
    step_start           = state;
    accepted_step_size   = equations.step_size();
    accepted_stages      = equations.increments;
    accepted_multipliers = equations.multipliers;
    n_failures           = 0;
    waiting_steps -= std::min(waiting_steps, 1U);

    const unsigned int last = tableau.n_stages() - 1;
    state.time += accepted_step_size;
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const NodalVector x = equations.position(last, b);
        state.velocities[b] = equations.velocity(last, b);
        state.positions[b]  = x;
      }
    state.multipliers = accepted_multipliers[last];
    update_laws(state, step_start);
  }



  SystemState
  RadauStepper::interpolate(const double time) const
  {
    const double tau                = accepted_step_size;
    const double c                  = (time - step_start.time) / tau;
    const std::vector<double> shape = stage_shape(tableau, c);
    const unsigned int s            = tableau.n_stages();

    // Lagrange polynomials of the stages, for the multipliers, and of the
    // stages and the start, for the velocities
    Eigen::VectorXd multiplier_shape(s), velocity_shape(s);
    for (unsigned int i = 0; i < s; ++i)
      {
        multiplier_shape(i) = 1;
        for (unsigned int j = 0; j < s; ++j)
          if (j != i)
            multiplier_shape(i) *=
              (c - tableau.c(j)) / (tableau.c(i) - tableau.c(j));
        velocity_shape(i) = multiplier_shape(i) * c / tableau.c(i);
      }
    const Eigen::VectorXd velocity_of_stages =
      A_inverse.transpose() * velocity_shape / tau;

    SystemState state(step_start);
    state.time = time;
    state.multipliers.setZero();
    for (unsigned int i = 0; i < s; ++i)
      state.multipliers += multiplier_shape(i) * accepted_multipliers[i];
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        state.positions[b].add(c * tau, step_start.velocities[b]);
        for (unsigned int i = 0; i < s; ++i)
          {
            state.positions[b].add(shape[i], accepted_stages[i][b]);
            state.velocities[b].add(velocity_of_stages(i),
                                    accepted_stages[i][b]);
          }
      }
    update_laws(state, step_start);
    return state;
  }
} // namespace ACF
