// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/mechanics/reduced_strain.h>
#include <acf/time/stage_iteration.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ACF
{
  namespace
  {
    // Relative to the length of a body: far from the solution a tangent may be
    // so stiff against turning that short increments do not mean a small error.
    constexpr double largest_correction = 0.1;
  } // namespace



  StageIteration::StageIteration(const MultibodySystem &system,
                                 const ButcherTableau &tableau,
                                 const TimeParameters &parameters,
                                 Statistics &statistics)
    : system(system)
    , tableau(tableau)
    , parameters(parameters)
    , statistics(statistics)
    , cache(statistics, parameters.factor_precision)
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
  StageIteration::start_step()
  {
    if (waiting_steps == 0)
      {
        linearization = Linearization::simplified;
        std::fill(marked.begin(), marked.end(), false);
      }
  }



  void
  StageIteration::end_step(StageEquations &equations, const StepReport &report)
  {
    if (!report.converged)
      {
        ++n_failures;
        waiting_steps = 0;
        return;
      }
    if (linearization == Linearization::simplified)
      next_wait = first_wait;
    if (system.n_constraints() > 0)
      correct_constraints(equations);
  }



  void
  StageIteration::accept()
  {
    n_failures = 0;
    waiting_steps -= std::min(waiting_steps, 1U);
  }



  bool
  StageIteration::prepare(const StageEquations &equations, StepReport &report)
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
  StageIteration::correct_constraints(StageEquations &equations)
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
  StageIteration::increment_norm(const SystemVector &increment,
                                 const unsigned int b) const
  {
    const BodyOperators &operators = system.bodies()[b].operators();
    return increment[b].l2_norm() / std::sqrt(1. * operators.n_nodes) /
           operators.length;
  }



  double
  StageIteration::increment_norm(const StageVector &increment) const
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
  StageIteration::iterate(const LinearSolver &solve,
                          const unsigned int patience,
                          const bool accelerate,
                          StageEquations &equations,
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
        bool solved =
          equations.residual(increment, constraint_increment, report.failure);
        if (solved)
          {
            const auto means =
              free_translations(increment, equations.step_size());
            solved = solve(increment, constraint_increment, report.failure);
            translate(means, increment);
          }
        if (!solved)
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
        if (n_iterations == 1 && linearization != Linearization::simplified &&
            norm > largest_correction)
          {
            report.failure = "the solution is too far from its prediction";
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
        // the last increment is small enough as it is
        if (accelerate && !report.converged)
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



  std::vector<std::vector<Vector3>>
  StageIteration::free_translations(const StageVector &forces,
                                    const double step_size) const
  {
    const unsigned int n_stages = tableau.n_stages();
    std::vector<std::vector<Vector3>> means(marked.size());
    for (unsigned int b = 0; b < marked.size(); ++b)
      {
        const Body &body = system.bodies()[b];
        if (!system.body_markers(b).empty() ||
            (body.strain_measure() == StrainMeasure::reduced &&
             linearization != Linearization::exact &&
             parameters.factor_precision == FactorPrecision::double_precision))
          continue;
        Eigen::MatrixXd resultants = Eigen::MatrixXd::Zero(n_stages, dim);
        for (unsigned int i = 0; i < n_stages; ++i)
          for (unsigned int k = 0; k < forces[i][b].size(); ++k)
            resultants(i, k % dim) += forces[i][b][k];
        const Eigen::MatrixXd rates = tableau.A.inverse() / step_size;
        const Eigen::MatrixXd inertia =
          body.operators().mass * (rates * rates + body.mass_damping() * rates);
        const Eigen::MatrixXd solution = inertia.lu().solve(resultants);
        for (unsigned int i = 0; i < n_stages; ++i)
          means[b].emplace_back(
            Vector3({solution(i, 0), solution(i, 1), solution(i, 2)}));
      }
    return means;
  }



  void
  StageIteration::translate(const std::vector<std::vector<Vector3>> &means,
                            StageVector &increment) const
  {
    for (unsigned int b = 0; b < means.size(); ++b)
      for (unsigned int i = 0; i < means[b].size(); ++i)
        {
          NodalVector &z = increment[i][b];
          const Vector3 shift =
            means[b][i] - mass_mean(system.bodies()[b].operators(), z);
          for (unsigned int k = 0; k < z.size(); ++k)
            z[k] += shift[k % dim];
        }
  }



  void
  StageIteration::mark_bodies(const StageVector &increment)
  {
    const double largest = increment_norm(increment);
    for (unsigned int b = 0; b < marked.size(); ++b)
      for (const SystemVector &stage : increment)
        if (increment_norm(stage, b) > 0.01 * largest)
          marked[b] = true;
  }



  void
  StageIteration::iterate_exactly(StageEquations &equations, StepReport &report)
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
    iterate(solve, 2, false, equations, report);
  }



  void
  StageIteration::refresh_factors(const StageEquations &equations,
                                  StepReport &report)
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
    if (refreshed.empty() || prepare(equations, report))
      {
        statistics.factor_refreshes += refreshed.size();
        return;
      }
    for (const Body *const body : refreshed)
      cache.restore_stiffness(*body);
    prepare(equations, report);
  }



  void
  StageIteration::run(StageEquations &equations, StepReport &report)
  {
    if (!prepare(equations, report))
      return;
    if (linearization == Linearization::exact)
      {
        if (n_failures >= 2)
          refresh_factors(equations, report);
        iterate_exactly(equations, report);
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
      equations,
      report);
    if (report.converged && linearization == Linearization::corrected)
      for (unsigned int b = 0; b < marked.size(); ++b)
        if (marked[b] &&
            system.bodies()[b].strain_measure() == StrainMeasure::reduced)
          ++statistics.corrected_tangent_steps;
  }



  bool
  StageIteration::linearize_better()
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
} // namespace ACF
