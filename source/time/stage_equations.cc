// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/base/linear_combination.h>
#include <acf/base/parallel.h>
#include <acf/time/stage_equations.h>

namespace ACF
{
  StageEquations::StageEquations(const MultibodySystem &system,
                                 const ButcherTableau &tableau,
                                 Statistics &statistics)
    : system(system)
    , tableau(tableau)
    , statistics(statistics)
    , A_inverse(tableau.A.inverse())
    , A_inverse_squared(A_inverse * A_inverse)
  {
    SystemVector zero;
    for (const Body &body : system.bodies())
      zero.emplace_back(body.operators().n_unknowns());
    increments.assign(tableau.n_stages(), zero);
    multipliers.assign(tableau.n_stages(),
                       Eigen::VectorXd::Zero(system.n_constraints()));
    stage_positions = stage_velocities = stage_accelerations =
      StageVector(tableau.n_stages(), SystemVector(system.bodies().size()));
    work.resize(system.bodies().size());
    marker_nodes.resize(system.bodies().size());
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      if (system.bodies()[b].strain_measure() == StrainMeasure::green_lagrange)
        {
          std::vector<const NodalFunctional *> functionals;
          for (const unsigned int p : system.body_markers(b))
            functionals.push_back(
              &system.bodies()[b].reference().functionals()[p]);
          marker_nodes[b] = connected_nodes(functionals);
        }
  }



  void
  StageEquations::start_step(const SystemState &new_state,
                             const double step_size)
  {
    state = &new_state;
    tau   = step_size;
    if (system.n_marker_values() == 0)
      return;
    start_markers      = system.marker_values(state->positions);
    start_marker_rates = system.marker_values(state->velocities);
  }



  void
  StageEquations::set_position(const unsigned int stage,
                               const unsigned int body,
                               NodalVector &x) const
  {
    linear_combination({{1, &state->positions[body]},
                        {tableau.c(stage) * tau, &state->velocities[body]},
                        {1, &increments[stage][body]}},
                       x);
  }



  void
  StageEquations::set_velocity(const unsigned int stage,
                               const unsigned int body,
                               NodalVector &v) const
  {
    std::vector<ScaledVector> terms{{1, &state->velocities[body]}};
    for (unsigned int j = 0; j < tableau.n_stages(); ++j)
      terms.push_back({A_inverse(stage, j) / tau, &increments[j][body]});
    linear_combination(terms, v);
  }



  NodalVector
  StageEquations::position(const unsigned int stage,
                           const unsigned int body) const
  {
    NodalVector x;
    set_position(stage, body, x);
    return x;
  }



  void
  StageEquations::end_state(const unsigned int body,
                            NodalVector &x,
                            NodalVector &v) const
  {
    const unsigned int last = tableau.n_stages() - 1;
    set_position(last, body, x);
    set_velocity(last, body, v);
  }



  double
  StageEquations::time(const unsigned int stage) const
  {
    return state->time + tableau.c(stage) * tau;
  }



  Eigen::VectorXd
  StageEquations::marker_positions(const unsigned int stage) const
  {
    return start_markers + tableau.c(stage) * tau * start_marker_rates +
           system.marker_values(increments[stage]);
  }



  Eigen::VectorXd
  StageEquations::marker_velocities(const unsigned int stage) const
  {
    Eigen::VectorXd v = start_marker_rates;
    for (unsigned int j = 0; j < tableau.n_stages(); ++j)
      v += A_inverse(stage, j) / tau * system.marker_values(increments[j]);
    return v;
  }



  bool
  StageEquations::body_residual(const unsigned int b, StageVector &residual)
  {
    const Body &body                  = system.bodies()[b];
    const unsigned int n_stages       = tableau.n_stages();
    const double inverse_square       = 1 / (tau * tau);
    std::vector<NodalVector> &inertia = work[b].inertia;
    inertia.resize(n_stages);
    std::vector<const NodalVector *> positions, velocities, accelerations;
    std::vector<NodalVector *> forces, inertial_forces;
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        set_position(i, b, stage_positions[i][b]);
        if (body.is_damped())
          set_velocity(i, b, stage_velocities[i][b]);
        std::vector<ScaledVector> terms;
        for (unsigned int j = 0; j < n_stages; ++j)
          terms.push_back(
            {inverse_square * A_inverse_squared(i, j), &increments[j][b]});
        linear_combination(terms, stage_accelerations[i][b]);
        if (inertia[i].size() == 0)
          inertia[i].reinit(body.operators().n_unknowns());
        positions.push_back(&stage_positions[i][b]);
        velocities.push_back(&stage_velocities[i][b]);
        accelerations.push_back(&stage_accelerations[i][b]);
        inertial_forces.push_back(&inertia[i]);
        forces.push_back(&residual[i][b]);
      }

    if (!internal_forces(body, positions, velocities, forces, work[b].forces))
      return false;
    body.operators().mass_matrix.vmult(inertial_forces, accelerations);
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        linear_combination({{-1, forces[i]}, {-1, inertial_forces[i]}},
                           *forces[i]);
        system.add_loads(b, time(i), *positions[i], *forces[i]);
      }
    return true;
  }



  bool
  StageEquations::residual(StageVector &forces,
                           StageConstraints &constraints,
                           std::string &failure)
  {
    const unsigned int n_stages = tableau.n_stages();
    const unsigned int n_bodies = system.bodies().size();
    std::vector<char> is_inverted(n_bodies, false);
    run_tasks(n_bodies, [&](const unsigned int b) {
      is_inverted[b] = !body_residual(b, forces);
    });
    statistics.force_evaluations += n_bodies * n_stages;
    for (unsigned int b = 0; b < n_bodies; ++b)
      if (is_inverted[b])
        {
          failure = "body '" + system.bodies()[b].name() +
                    "' is turned inside out (the determinant of a deformation "
                    "gradient is not positive)";
          return false;
        }
    if (system.n_marker_values() == 0)
      return true;

    for (unsigned int i = 0; i < n_stages; ++i)
      {
        const Eigen::VectorXd s = marker_positions(i);
        Eigen::VectorXd v, a;
        if (system.needs_velocities())
          v = marker_velocities(i);
        if (!system.masses().empty())
          a = system.marker_values(stage_accelerations[i]);
        const Eigen::VectorXd F = system.marker_forces(
          time(i), s, v, a, multipliers[i], state->law_values);
        for (unsigned int b = 0; b < n_bodies; ++b)
          system.add_marker_forces(b, F, forces[i][b]);
        constraints[i] = -system.constraint_residual(time(i), s);
      }
    return true;
  }



  StageConstraints
  StageEquations::constraint_residual() const
  {
    StageConstraints residual;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      residual.push_back(
        system.constraint_residual(time(i), marker_positions(i)));
    return residual;
  }



  StageRotations
  StageEquations::rotations() const
  {
    const unsigned int n_stages = tableau.n_stages();
    const unsigned int n_bodies = system.bodies().size();
    StageRotations result;
    result.mean.resize(n_bodies);
    result.stages.assign(n_stages, result.mean);
    for (unsigned int b = 0; b < n_bodies; ++b)
      {
        const Body &body = system.bodies()[b];
        const auto rotation_of =
          [&body](const Matrix3 &F) -> std::optional<Matrix3> {
          if (const auto frame = body_rotation(F, body.rotation_measure()))
            return frame->rotation;
          return {};
        };
        // linear in positions
        const Matrix3 start =
          mean_deformation_gradient(body.operators(), state->positions[b]);
        const Matrix3 rate =
          mean_deformation_gradient(body.operators(), state->velocities[b]);
        const std::optional<Matrix3> at_start = rotation_of(start);
        if (!at_start)
          throw SimulationError("Body '" + body.name() +
                                "' is turned inside out at time " +
                                format_number(state->time) +
                                " s: its mean deformation gradient has a "
                                "determinant that is not positive.");
        Matrix3 mean;
        for (unsigned int i = 0; i < n_stages; ++i)
          {
            const Matrix3 F =
              start + tableau.c(i) * tau * rate +
              mean_deformation_gradient(body.operators(), increments[i][b]);
            result.stages[i][b] = rotation_of(F).value_or(*at_start);
            mean += F / n_stages;
          }
        result.mean[b] = rotation_of(mean).value_or(*at_start);
        if (body.strain_measure() == StrainMeasure::green_lagrange)
          add_material_rotations(b, result);
      }
    return result;
  }



  void
  StageEquations::add_material_rotations(const unsigned int b,
                                         StageRotations &rotations) const
  {
    const auto &reference      = system.bodies()[b].reference();
    const unsigned int n       = tableau.n_stages();
    const unsigned int n_nodes = reference.operators().n_nodes;
    std::vector<Matrix3> mean(n_nodes);
    for (unsigned int i = 0; i < n; ++i)
      {
        const std::vector<Matrix3> gradients =
          reference.green_lagrange().node_gradients(position(i, b));
        NodeRotations &stage = rotations.stages[i][b];
        stage = material_rotations(gradients, marker_nodes[b], stage[0]);
        for (unsigned int a = 0; a < n_nodes; ++a)
          mean[a] += gradients[a] / n;
      }
    rotations.mean[b] =
      material_rotations(mean, marker_nodes[b], rotations.mean[b][0]);
  }



  std::vector<LowRankChange>
  StageEquations::reduced_strain_changes(
    const std::vector<bool> &corrected) const
  {
    std::vector<LowRankChange> changes(corrected.size());
    for (unsigned int b = 0; b < corrected.size(); ++b)
      {
        const Body &body               = system.bodies()[b];
        const BodyOperators &operators = body.operators();
        changes[b].columns.resize(operators.n_unknowns(), 0);
        if (!corrected[b] || body.strain_measure() != StrainMeasure::reduced)
          continue;
        // not at the prediction, which is stretched where the body turns: its
        // stress would make the matrix too stiff
        const NodalVector &x = state->positions[b];
        const auto frame =
          body_rotation(mean_deformation_gradient(operators, x),
                        body.rotation_measure());
        if (!frame)
          return {};
        NodalVector local(operators.n_unknowns());
        NodeRotations(frame->rotation).to_body(x, operators.n_nodes, local);
        auto tangent =
          reduced_strain_tangent(operators, body.rotation_measure(), local);
        if (!tangent)
          return {};
        changes[b] = {std::move(tangent->columns),
                      std::move(tangent->coefficients)};
      }
    return changes;
  }



  MarkerLinearization
  StageEquations::mean_linearization() const
  {
    if (system.n_marker_values() == 0)
      return {};
    const unsigned int n   = tableau.n_stages();
    Eigen::VectorXd s      = Eigen::VectorXd::Zero(system.n_marker_values());
    Eigen::VectorXd v      = s;
    Eigen::VectorXd lambda = Eigen::VectorXd::Zero(system.n_constraints());
    for (unsigned int i = 0; i < n; ++i)
      {
        s += marker_positions(i) / n;
        lambda += multipliers[i] / n;
        if (system.needs_velocities())
          v += marker_velocities(i) / n;
      }
    return system.linearize(
      state->time + 0.5 * tau, s, v, lambda, state->law_values);
  }



  bool
  StageEquations::linearize(const std::vector<bool> &exact,
                            const StageRotations &rotations,
                            StageTangent &tangent,
                            std::string &failure) const
  {
    tangent.reset(tau, rotations);
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          if (exact[b] && !tangent.linearize_body(i, b, position(i, b)))
            {
              failure =
                "body '" + system.bodies()[b].name() + "' is turned inside out";
              return false;
            }
        if (system.n_marker_values() == 0)
          continue;
        const Eigen::VectorXd s = marker_positions(i);
        Eigen::VectorXd v       = Eigen::VectorXd::Zero(s.size());
        if (system.needs_velocities())
          v = marker_velocities(i);
        tangent.linearize_markers(
          i,
          system.linearize(time(i), s, v, multipliers[i], state->law_values));
      }
    return true;
  }
} // namespace ACF
