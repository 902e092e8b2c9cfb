// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/parallel.h>
#include <acf/mechanics/reduced_strain.h>
#include <acf/time/radau_stepper.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  namespace
  {
    // Angle per step, rad, from which on a prediction that follows the rotation
    // may be better.
    constexpr double fast_turn = 0.15;

    // Part of the local error that the iteration may add, and bounds. More than
    // the largest one lets the energy rise, unless the sum of all that the
    // iterations of a run may do remains that part.
    constexpr double newton_share             = 0.01;
    constexpr double least_tolerance          = 1e-13;
    constexpr double largest_tolerance        = 1e-10;
    constexpr double largest_summed_tolerance = 1e-9;
  } // namespace



  RadauStepper::RadauStepper(const MultibodySystem &system,
                             const TimeParameters &parameters,
                             Statistics &statistics)
    : system(system)
    , parameters(parameters)
    , tableau(radau_iia(parameters.n_stages))
    , A_inverse(tableau.A.inverse())
    , equations(system, tableau, statistics)
    , iteration(system, tableau, this->parameters, statistics)
    , predictor(system, tableau)
    , local_error(system, tableau)
    , turns(system.bodies().size())
    , turning_is_better(system.bodies().size(), true)
  {}



  bool
  RadauStepper::extrapolates() const
  {
    return parameters.extrapolates && !history.steps.empty();
  }



  void
  RadauStepper::predict(const SystemState &state)
  {
    if (extrapolates())
      {
        predictor.start_step(history, equations.step_size());
        predictor.predict(history, equations.multipliers);
      }
    else
      for (Eigen::VectorXd &lambda : equations.multipliers)
        lambda = state.multipliers;
    straight.resize(tableau.n_stages(), SystemVector(turns.size()));
    turning.resize(tableau.n_stages(), SystemVector(turns.size()));
    equations.increments_have_changed();
    run_tasks(turns.size(), [&](const unsigned int b) {
      if (extrapolates())
        predictor.predict(history, b, equations.increments);
      else
        for (SystemVector &stage : equations.increments)
          stage[b] = 0;
      if (parameters.extrapolates)
        follow_turning(b, state);
      equations.evaluate_moments(b);
    });
  }



  void
  RadauStepper::follow_turning(const unsigned int b, const SystemState &state)
  {
    const Vector3 spin = body_spin(system.bodies()[b].rotation_measure(),
                                   equations.start_moments(b).gradient,
                                   equations.start_velocity_moments(b).gradient)
                           .value_or(Vector3());
    turns[b] = spin.norm() * equations.step_size() > fast_turn;
    if (!turns[b])
      return;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      straight[i][b] = turning[i][b] = equations.increments[i][b];
    predict_turning(b, state, spin, turning);
    if (turning_is_better[b])
      for (unsigned int i = 0; i < tableau.n_stages(); ++i)
        equations.increments[i][b] = turning[i][b];
  }



  void
  RadauStepper::predict_turning(const unsigned int b,
                                const SystemState &state,
                                const Vector3 &spin,
                                StageVector &increments) const
  {
    const BodyOperators &body     = system.bodies()[b].operators();
    const Vector3 centre          = mass_mean(body, state.positions[b]);
    const Vector3 centre_velocity = mass_mean(body, state.velocities[b]);
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        const double time    = tableau.c(i) * equations.step_size();
        const Matrix3 turned = rotation_matrix(time * spin);
        NodalVector &Z       = increments[i][b];
        const Vector3 mean   = mass_mean(body, Z);
        for (unsigned int a = 0; a < body.n_nodes; ++a)
          {
            Vector3 x, v;
            for (unsigned int k = 0; k < dim; ++k)
              {
                x[k] = state.positions[b][dim * a + k] - centre[k];
                v[k] = state.velocities[b][dim * a + k] - centre_velocity[k];
              }
            const Vector3 straight = x + time * v;
            const Vector3 z =
              mean + turned * (straight - time * cross_product_3d(spin, x)) -
              straight;
            for (unsigned int k = 0; k < dim; ++k)
              Z[dim * a + k] = z[k];
          }
      }
  }



  NewtonTolerances
  RadauStepper::tolerances() const
  {
    if (parameters.newton_tolerance > 0)
      return {parameters.newton_tolerance, 0};
    if (parameters.tolerance > 0)
      {
        // Errors of the iteration become errors of velocities when they are
        // divided by the step size, which act for the rest of the time: in the
        // worst case they add up to this share of the tolerance. (With more
        // three stages, which damp less, let the pendulum leave its plane,
        // where the reduced strain is unstable.)
        const double share = tableau.n_stages() < 3 ? 0.1 : 0.01;
        const double part  = equations.step_size() / parameters.end_time;
        const double error =
          std::max(least_tolerance,
                   std::min(largest_summed_tolerance,
                            share * parameters.tolerance * part * part));
        return {error, std::max(largest_tolerance, error)};
      }
    if (expected_error < 0)
      return {largest_tolerance, largest_tolerance};
    const double ratio = equations.step_size() / history.steps[0].size;
    const double error = newton_share * expected_error *
                         std::pow(ratio, local_error_order(tableau));
    // An error of positions, divided by the step size, is one of velocities,
    // which acts for the rest of the time.
    const double summed = error * equations.step_size() / parameters.end_time;
    const double largest =
      std::max(largest_tolerance, std::min(largest_summed_tolerance, summed));
    return {std::min(largest, std::max(least_tolerance, error)), largest};
  }



  StepReport
  RadauStepper::try_step(const SystemState &state, const double step_size)
  {
    equations.start_step(state, step_size);
    iteration.start_step();
    StepReport report;
    do
      {
        predict(state);
        iteration.run(equations, tolerances(), report);
    } while (!report.converged && iteration.linearize_better());
    iteration.end_step(equations, report);
    if (report.converged)
      report.local_error =
        local_error.estimate(equations.increments, step_size, history);
    tried_error = report.local_error;
    return report;
  }



  double
  RadauStepper::prediction_error(const unsigned int b,
                                 const StageVector &prediction) const
  {
    double error = 0;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        NodalVector difference(equations.increments[i][b]);
        difference -= prediction[i][b];
        error = std::max(error, difference.l2_norm());
      }
    return error;
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
    for (unsigned int b = 0; b < turns.size(); ++b)
      turning_is_better[b] = !turns[b] || prediction_error(b, turning) <=
                                            prediction_error(b, straight);
    const bool was_extrapolated = extrapolates();
    if (was_extrapolated)
      predictor.accept(history, equations.multipliers);
    if (!history.steps.empty())
      {
        const double ratio = equations.step_size() / history.steps[0].size;
        const double order = local_error_order(tableau);
        expected_error =
          std::max(tried_error, expected_error * std::pow(ratio, order) / 2);
      }
    step_start.time        = state.time;
    step_start.multipliers = state.multipliers;
    step_start.law_values  = state.law_values;
    step_start.positions.resize(turns.size());
    step_start.velocities.resize(turns.size());
    run_tasks(turns.size(), [&](const unsigned int b) {
      if (was_extrapolated)
        predictor.accept(history, b, equations.increments);
      // in the memory of the start of the last step
      equations.end_state(b, step_start.positions[b], step_start.velocities[b]);
      state.positions[b].swap(step_start.positions[b]);
      state.velocities[b].swap(step_start.velocities[b]);
    });
    state.time += equations.step_size();
    state.multipliers = equations.multipliers.back();
    history.push(equations.step_size(),
                 equations.increments,
                 equations.multipliers);
    iteration.accept();
    update_laws(state, step_start);
  }



  SystemState
  RadauStepper::interpolate(const double time) const
  {
    const StageVector &Z            = history.steps[0].increments;
    const double tau                = history.steps[0].size;
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
      state.multipliers +=
        multiplier_shape(i) * history.steps[0].multipliers[i];
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        state.positions[b].add(c * tau, step_start.velocities[b]);
        for (unsigned int i = 0; i < s; ++i)
          {
            state.positions[b].add(shape[i], Z[i][b]);
            state.velocities[b].add(velocity_of_stages(i), Z[i][b]);
          }
      }
    update_laws(state, step_start);
    return state;
  }



  void
  RadauStepper::exchange(Archive &archive)
  {
    archive("history", history);
    archive("start of the last step", step_start);
    archive("predictor", predictor);
    archive("iteration", iteration);
    archive("bodies whose turning is predicted", turning_is_better);
    archive("expected error", expected_error);
  }
} // namespace ACF
