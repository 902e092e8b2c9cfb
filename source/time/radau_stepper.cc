// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/reduced_strain.h>
#include <acf/time/radau_stepper.h>

namespace ACF
{
  namespace
  {
    // Angle per step, rad, from which on the prediction follows the rotation:
    // the error of the method in the earlier step, of its third power with two
    // stages, is then larger than what the prediction leaves out.
    constexpr double fast_turn = 0.15;
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
  {}



  void
  RadauStepper::predict(const SystemState &state)
  {
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const Vector3 spin = body_spin(system.bodies()[b].operators(),
                                       system.bodies()[b].rotation_measure(),
                                       state.positions[b],
                                       state.velocities[b])
                               .value_or(Vector3());
        predict_straight(b);
        if (spin.norm() * equations.step_size() > fast_turn)
          predict_turning(b, state, spin);
      }
    for (Eigen::VectorXd &lambda : equations.multipliers)
      lambda = state.multipliers;
  }



  void
  RadauStepper::predict_straight(const unsigned int b)
  {
    // minus u_n + c_i tau v_n
    const double ratio =
      accepted_step_size > 0 ? equations.step_size() / accepted_step_size : 0;
    const unsigned int last = tableau.n_stages() - 1;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        const std::vector<double> shape =
          stage_shape(tableau, 1 + tableau.c(i) * ratio);
        NodalVector &Z = equations.increments[i][b];
        Z              = 0;
        if (accepted_step_size > 0)
          for (unsigned int j = 0; j <= last; ++j)
            Z.add(shape[j] - (j == last ? 1. : 0.) -
                    tableau.c(i) * ratio * A_inverse(last, j),
                  accepted_stages[j][b]);
      }
  }



  void
  RadauStepper::predict_turning(const unsigned int b,
                                const SystemState &state,
                                const Vector3 &spin)
  {
    const BodyOperators &body     = system.bodies()[b].operators();
    const Vector3 centre          = mass_mean(body, state.positions[b]);
    const Vector3 centre_velocity = mass_mean(body, state.velocities[b]);
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        const double time    = tableau.c(i) * equations.step_size();
        const Matrix3 turned = rotation_matrix(time * spin);
        NodalVector &Z       = equations.increments[i][b];
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



  StepReport
  RadauStepper::try_step(const SystemState &state, const double step_size)
  {
    equations.start_step(state, step_size);
    iteration.start_step();
    StepReport report;
    do
      {
        predict(state);
        iteration.run(equations, report);
    } while (!report.converged && iteration.linearize_better());
    iteration.end_step(equations, report);
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
    iteration.accept();

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
