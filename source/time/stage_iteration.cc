// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/base/linear_combination.h>
#include <acf/base/parallel.h>
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



    // A cache that knows the bodies.
    struct ExchangedCache
    {
      FactorizationCache &cache;
      const std::vector<Body> &bodies;

      void
      exchange(Archive &archive)
      {
        cache.exchange(archive, bodies);
      }
    };



    // " (worst for body 'a', joint 'b')": where increments are not finite or
    // largest, and the joint that is violated most.
    std::string
    worst_objects(const MultibodySystem &system,
                  const StageVector &increment,
                  const StageConstraints &residual)
    {
      unsigned int body = 0, row = 0;
      double largest = -1, violation = 0;
      // not-a-number is the worst of all, and stays
      const auto is_worse = [](const double value, const double than) {
        return !std::isnan(than) && !(value <= than);
      };
      for (const SystemVector &stage : increment)
        for (unsigned int b = 0; b < stage.size(); ++b)
          if (const double norm = relative_norm(system.bodies()[b], stage[b]);
              is_worse(norm, largest))
            {
              largest = norm;
              body    = b;
            }
      for (const Eigen::VectorXd &g : residual)
        for (unsigned int r = 0; r < g.size(); ++r)
          if (is_worse(std::abs(g(r)), violation))
            {
              violation = std::abs(g(r));
              row       = r;
            }
      const std::string name =
        " (worst for body '" + system.bodies()[body].name() + "'";
      // what is left of constraints in any iteration is no reason
      if (violation <= 1e-6 * system.bodies()[body].operators().length)
        return name + ")";
      return name + ", joint '" +
             system.joints()[system.joint_of_row(row)].name + "')";
    }
  } // namespace



  StageIteration::StageIteration(const MultibodySystem &system,
                                 const ButcherTableau &tableau,
                                 const TimeParameters &parameters,
                                 Statistics &statistics)
    : system(system)
    , tableau(tableau)
    , parameters(parameters)
    , statistics(statistics)
    , cache(statistics,
            parameters.factor_precision,
            static_cast<std::size_t>(1e6 * parameters.factor_memory))
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
  StageIteration::prepare(StageEquations &equations, StepReport &report)
  {
    rotations = equations.rotations();
    std::vector<LowRankChange> changes;
    if (linearization != Linearization::simplified)
      changes = equations.reduced_strain_changes(marked);
    try
      {
        cache.use(equations.step_size());
        stage_solver->prepare(equations.step_size(),
                              rotations,
                              equations.mean_linearization(),
                              changes);
        return true;
      }
    catch (const SimulationError &error)
      {
        report.failure = error.what();
        // a sentence becomes a part of one
        if (!report.failure.empty() && report.failure.back() == '.')
          report.failure.pop_back();
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
    length = std::max(1., length);

    double before = std::numeric_limits<double>::infinity();
    for (unsigned int k = 0; k <= max_corrections; ++k)
      {
        StageConstraints constraints = equations.constraint_residual();
        double largest               = 0;
        for (Eigen::VectorXd &rows : constraints)
          {
            rows *= -1;
            largest = std::max(largest, rows.lpNorm<Eigen::Infinity>());
          }
        // What a correction does not make smaller is round-off, and will be
        // the same in later steps.
        if (largest > 0.5 * before && largest < 5e-13 * length)
          constraint_round_off = std::max(constraint_round_off, largest);
        if (k == max_corrections ||
            !(largest > std::max(1e-14 * length, 2 * constraint_round_off)))
          return;
        before = largest;
        stage_solver->solve_constraints(equations.increments, constraints);
        ++statistics.constraint_corrections;
        for (unsigned int i = 0; i < tableau.n_stages(); ++i)
          equations.multipliers[i] += constraints[i];
        equations.increments_have_changed();
      }
  }



  double
  StageIteration::increment_norm(const StageVector &increment) const
  {
    std::vector<double> norms(system.bodies().size() * tableau.n_stages());
    run_tasks(system.bodies().size(), [&](const unsigned int b) {
      for (unsigned int i = 0; i < tableau.n_stages(); ++i)
        norms[b * tableau.n_stages() + i] =
          relative_norm(system.bodies()[b], increment[i][b]);
    });
    double largest = 0;
    for (const double norm : norms)
      {
        if (!std::isfinite(norm))
          return norm;
        largest = std::max(largest, norm);
      }
    return largest;
  }



  void
  StageIteration::add(const StageVector &increment,
                      const StageConstraints &constraint_increment,
                      StageEquations &equations) const
  {
    run_tasks(system.bodies().size(), [&](const unsigned int b) {
      for (unsigned int i = 0; i < tableau.n_stages(); ++i)
        {
          NodalVector &Z = equations.increments[i][b];
          linear_combination({{1, &Z}, {1, &increment[i][b]}}, Z);
        }
    });
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      equations.multipliers[i] += constraint_increment[i];
    equations.increments_have_changed();
  }



  void
  StageIteration::iterate(const LinearSolver &solve,
                          const unsigned int patience,
                          const bool accelerate,
                          StageEquations &equations,
                          StepReport &report)
  {
    acceleration.reset();
    first_iteration.start_step(equations.step_size(),
                               static_cast<int>(linearization));
    if (newton_increment.empty())
      newton_increment = equations.increments;
    StageVector &increment = newton_increment;
    StageConstraints constraint_increment(equations.multipliers);
    std::vector<double> norms;
    report.failure.clear();
    while (norms.size() < parameters.max_newton_iterations)
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
            if (!norms.empty())
              std::fill(marked.begin(), marked.end(), true);
            return;
          }
        norms.push_back(increment_norm(increment));
        ++report.iterations;
        ++statistics.newton_iterations;
        if (!judge(norms, patience, report))
          {
            report.failure +=
              worst_objects(system, increment, equations.constraint_residual());
            if (!std::isfinite(norms.back()))
              std::fill(marked.begin(), marked.end(), true);
            else if (norms.size() > 1)
              mark_bodies(increment);
            return;
          }

        // the last increment is small enough as it is
        if (accelerate && !report.converged)
          acceleration.accelerate(increment, constraint_increment);
        add(increment, constraint_increment, equations);
        if (report.converged)
          {
            first_iteration.end_step(norms);
            return;
          }
      }
    report.failure =
      "the iteration did not reach its tolerance" +
      worst_objects(system, increment, equations.constraint_residual());
    mark_bodies(increment);
  }



  bool
  StageIteration::judge(const std::vector<double> &norms,
                        const unsigned int patience,
                        StepReport &report) const
  {
    const unsigned int n = norms.size();
    const double norm    = norms.back();
    if (!std::isfinite(norm))
      {
        report.failure = "the iteration produced numbers that are not finite";
        return false;
      }
    if (n == 1)
      {
        if (linearization != Linearization::simplified &&
            norm > largest_correction)
          {
            report.failure = "the solution is too far from its prediction";
            return false;
          }
        report.error_estimate = first_iteration.error(norm);
        report.converged      = report.error_estimate <= tolerances.error;
        return true;
      }

    // the mean of two iterations, as single ones may be misleading
    report.contraction =
      (n == 2 ? norm / norms[0] : std::sqrt(norm / norms[n - 3]));
    const double factor   = report.contraction < 1
                              ? report.contraction / (1 - report.contraction)
                              : std::numeric_limits<double>::infinity();
    report.error_estimate = factor * norm;
    report.converged =
      report.error_estimate <= tolerances.error ||
      (report.contraction > 0.5 && 10 * norm <= tolerances.round_off);
    const double predicted =
      report.error_estimate *
      std::pow(report.contraction, parameters.max_newton_iterations - n);
    if (report.converged || n <= patience)
      return true;
    if (report.contraction >= 0.99)
      report.failure = "the iteration diverges";
    else if (predicted > tolerances.error)
      report.failure = "the iteration contracts too slowly";
    // What does not get shorter may be round-off, and is then the error.
    if (!report.failure.empty() && norm <= tolerances.round_off)
      {
        report.failure.clear();
        report.converged = true;
      }
    return report.failure.empty();
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
        if (relative_norm(system.bodies()[b], stage[b]) > 0.01 * largest)
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
      if (!equations.linearize(marked, rotations, *tangent, failure))
        return false;
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
  StageIteration::refresh_factors(StageEquations &equations, StepReport &report)
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
  StageIteration::run(StageEquations &equations,
                      const NewtonTolerances &step_tolerances,
                      StepReport &report)
  {
    tolerances = step_tolerances;
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



  void
  StageIteration::exchange(Archive &archive)
  {
    archive("linearisation", linearization);
    archive("marked bodies", marked);
    archive("waiting steps", waiting_steps);
    archive("next wait", next_wait);
    archive("failures", n_failures);
    archive("round-off of constraints", constraint_round_off);
    archive("first iteration", first_iteration);
    ExchangedCache exchanged{cache, system.bodies()};
    archive("factorisations", exchanged);
  }
} // namespace ACF
