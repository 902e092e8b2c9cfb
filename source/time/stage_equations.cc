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
    work.resize(system.bodies().size());
    position_moments.resize(system.bodies().size());
    velocity_moments.resize(system.bodies().size());
    increment_moments.resize(system.bodies().size());
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
    run_tasks(system.bodies().size(), [&](const unsigned int b) {
      const BodyOperators &body = system.bodies()[b].operators();
      const std::vector<NodalMoments> moments =
        nodal_moments(body,
                      std::vector<const NodalVector *>{&state->positions[b],
                                                       &state->velocities[b]});
      position_moments[b] = moments[0];
      velocity_moments[b] = moments[1];
    });
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



  void
  StageEquations::increments_have_changed()
  {
    for (auto &moments : increment_moments)
      moments.clear();
  }



  const std::vector<NodalMoments> &
  StageEquations::moments_of_increments(const unsigned int b)
  {
    const auto evaluate = [&]() {
      std::vector<const NodalVector *> stages;
      for (const SystemVector &stage : increments)
        stages.push_back(&stage[b]);
      return nodal_moments(system.bodies()[b].operators(), stages);
    };
    if (increment_moments[b].empty())
      increment_moments[b] = evaluate();
    Assert(increment_moments[b][0].mean == evaluate()[0].mean,
           ExcMessage("increments_have_changed() was not called."));
    return increment_moments[b];
  }



  NodalMoments
  StageEquations::moments(const unsigned int stage, const unsigned int b)
  {
    return add(add(position_moments[b],
                   tableau.c(stage) * tau,
                   velocity_moments[b]),
               1,
               moments_of_increments(b)[stage]);
  }



  std::vector<Eigen::VectorXd>
  StageEquations::marker_increments() const
  {
    std::vector<Eigen::VectorXd> result;
    for (const SystemVector &stage : increments)
      result.push_back(system.marker_values(stage));
    return result;
  }



  Eigen::VectorXd
  StageEquations::marker_positions(const std::vector<Eigen::VectorXd> &Z,
                                   const unsigned int stage) const
  {
    return start_markers + tableau.c(stage) * tau * start_marker_rates +
           Z[stage];
  }



  Eigen::VectorXd
  StageEquations::marker_velocities(const std::vector<Eigen::VectorXd> &Z,
                                    const unsigned int stage) const
  {
    Eigen::VectorXd v = start_marker_rates;
    for (unsigned int j = 0; j < tableau.n_stages(); ++j)
      v += A_inverse(stage, j) / tau * Z[j];
    return v;
  }



  Eigen::VectorXd
  StageEquations::marker_accelerations(const std::vector<Eigen::VectorXd> &Z,
                                       const unsigned int stage) const
  {
    Eigen::VectorXd a = Eigen::VectorXd::Zero(start_markers.size());
    for (unsigned int j = 0; j < tableau.n_stages(); ++j)
      a += A_inverse_squared(stage, j) / (tau * tau) * Z[j];
    return a;
  }



  bool
  StageEquations::body_residual(const unsigned int b, StageVector &residual)
  {
    const Body &body = system.bodies()[b];
    if (body.strain_measure() == StrainMeasure::reduced)
      return reduced_residual(b, residual);
    return green_lagrange_residual(b, residual);
  }



  bool
  StageEquations::reduced_residual(const unsigned int b, StageVector &residual)
  {
    const Body &body            = system.bodies()[b];
    const unsigned int n_stages = tableau.n_stages();
    NodalMotion motion;
    motion.position     = &state->positions[b];
    motion.velocity     = &state->velocities[b];
    motion.second_rates = A_inverse_squared / (tau * tau);
    std::vector<NodalVector *> forces;
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        motion.times.push_back(tableau.c(i) * tau);
        motion.increments.push_back(&increments[i][b]);
        motion.moments.push_back(moments(i, b));
        motion.gravity.push_back(system.gravity(time(i)));
        forces.push_back(&residual[i][b]);
      }
    motion.mass_damping      = body.mass_damping();
    motion.stiffness_damping = body.stiffness_damping();
    if (motion.is_damped())
      {
        motion.first_rates = A_inverse / tau;
        for (unsigned int i = 0; i < n_stages; ++i)
          {
            NodalMoments velocity = velocity_moments[b];
            for (unsigned int j = 0; j < n_stages; ++j)
              velocity = add(velocity,
                             motion.first_rates(i, j),
                             moments_of_increments(b)[j]);
            motion.velocity_moments.push_back(velocity);
          }
      }
    if (!reduced_strain_residual(
          body.operators(), body.rotation_measure(), motion, forces))
      return false;
    if (system.has_surface_loads(b))
      for (unsigned int i = 0; i < n_stages; ++i)
        {
          set_position(i, b, work[b].position);
          system.add_surface_loads(b, time(i), work[b].position, *forces[i]);
        }
    return true;
  }



  bool
  StageEquations::green_lagrange_residual(const unsigned int b,
                                          StageVector &residual)
  {
    const Body &body            = system.bodies()[b];
    const unsigned int n_stages = tableau.n_stages();
    auto &[position, velocity, scratch, accelerations, inertia] = work[b];
    accelerations.resize(n_stages);
    inertia.resize(n_stages);
    if (scratch.size() == 0)
      scratch.reinit(body.operators().n_unknowns());
    std::vector<const NodalVector *> sources;
    std::vector<NodalVector *> products;
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        std::vector<ScaledVector> terms;
        for (unsigned int j = 0; j < n_stages; ++j)
          terms.push_back(
            {A_inverse_squared(i, j) / (tau * tau), &increments[j][b]});
        linear_combination(terms, accelerations[i]);
        if (inertia[i].size() == 0)
          inertia[i].reinit(body.operators().n_unknowns());
        sources.push_back(&accelerations[i]);
        products.push_back(&inertia[i]);
      }
    body.operators().mass_matrix.vmult(products, sources);
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        set_position(i, b, position);
        if (body.is_damped())
          set_velocity(i, b, velocity);
        NodalVector &force = residual[i][b];
        if (!internal_force(body, position, velocity, force, scratch))
          return false;
        linear_combination({{-1, &force}, {-1, &inertia[i]}}, force);
        system.add_loads(b, time(i), position, force);
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

    const std::vector<Eigen::VectorXd> Z = marker_increments();
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        const Eigen::VectorXd s = marker_positions(Z, i);
        Eigen::VectorXd v, a;
        if (system.needs_velocities())
          v = marker_velocities(Z, i);
        if (!system.masses().empty())
          a = marker_accelerations(Z, i);
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
    const std::vector<Eigen::VectorXd> Z = marker_increments();
    StageConstraints residual;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      residual.push_back(
        system.constraint_residual(time(i), marker_positions(Z, i)));
    return residual;
  }



  StageRotations
  StageEquations::rotations()
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
        const std::optional<Matrix3> at_start =
          rotation_of(position_moments[b].gradient);
        if (!at_start)
          throw SimulationError("Body '" + body.name() +
                                "' is turned inside out at time " +
                                format_number(state->time) +
                                " s: its mean deformation gradient has a "
                                "determinant that is not positive.");
        Matrix3 mean;
        for (unsigned int i = 0; i < n_stages; ++i)
          {
            const Matrix3 F     = moments(i, b).gradient;
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
          body_rotation(position_moments[b].gradient, body.rotation_measure());
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
    const std::vector<Eigen::VectorXd> Z = marker_increments();
    for (unsigned int i = 0; i < n; ++i)
      {
        s += marker_positions(Z, i) / n;
        lambda += multipliers[i] / n;
        if (system.needs_velocities())
          v += marker_velocities(Z, i) / n;
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
    const std::vector<Eigen::VectorXd> Z = marker_increments();
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
        const Eigen::VectorXd s = marker_positions(Z, i);
        Eigen::VectorXd v       = Eigen::VectorXd::Zero(s.size());
        if (system.needs_velocities())
          v = marker_velocities(Z, i);
        tangent.linearize_markers(
          i,
          system.linearize(time(i), s, v, multipliers[i], state->law_values));
      }
    return true;
  }
} // namespace ACF
