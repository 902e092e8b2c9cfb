// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/multibody_system.h>
#include <acf/mechanics/reduced_strain.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>

namespace ACF
{
  void
  LoadParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Gravity",
                      gravity,
                      "Acceleration of gravity. Units: m/s^2.");
  }



  MultibodySystem::MultibodySystem(const std::vector<BodyParameters> &bodies,
                                   const std::vector<JointParameters> &joints,
                                   const LoadParameters &loads,
                                   const std::filesystem::path &directory)
    : gravity_acceleration(loads.gravity)
  {
    for (const BodyParameters &parameters : bodies)
      system_bodies.emplace_back(parameters, directory);
    for (const JointParameters &parameters : joints)
      system_joints.push_back(make_joint(parameters, system_bodies));

    unsigned int n_rows = 0;
    body_constraints.resize(system_bodies.size());
    for (const Joint &joint : system_joints)
      {
        first_rows.push_back(n_rows);
        for (unsigned int r = 0; r < joint.n_constraints(); ++r)
          body_constraints[joint.body].rows.push_back(n_rows + r);
        n_rows += joint.n_constraints();
      }

    right_hand_side.resize(n_rows);
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      body_constraints[b].matrix =
        Eigen::MatrixXd::Zero(body_constraints[b].rows.size(),
                              dim *
                                system_bodies[b].joint_functionals().size());

    std::vector<unsigned int> next_row(system_bodies.size());
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      {
        const Joint &joint = system_joints[j];
        right_hand_side.segment(first_rows[j], joint.n_constraints()) =
          joint.right_hand_side;
        for (unsigned int p = 0; p < joint.functionals.size(); ++p)
          body_constraints[joint.body].matrix.block(next_row[joint.body],
                                                    dim * joint.functionals[p],
                                                    joint.n_constraints(),
                                                    dim) +=
            joint.matrix.middleCols(dim * p, dim);
        next_row[joint.body] += joint.n_constraints();
      }
    check_redundant_constraints(joints);
    check_initial_velocities(joints);
  }



  void
  MultibodySystem::check_redundant_constraints(
    const std::vector<JointParameters> &joints) const
  {
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      {
        // B B^T with B = D S, from the products of the functionals' weights
        const auto &functionals  = system_bodies[b].joint_functionals();
        const unsigned int n     = functionals.size();
        Eigen::MatrixXd products = Eigen::MatrixXd::Zero(dim * n, dim * n);
        for (unsigned int p = 0; p < n; ++p)
          for (unsigned int q = 0; q < n; ++q)
            products.block<dim, dim>(dim * p, dim * q) =
              scalar_product(functionals[p], functionals[q]) *
              Eigen::Matrix3d::Identity();
        const Eigen::MatrixXd &D = body_constraints[b].matrix;
        Eigen::MatrixXd gram     = D * products * D.transpose();
        const Eigen::VectorXd scale =
          gram.diagonal().cwiseSqrt().cwiseInverse();
        gram = scale.asDiagonal() * gram * scale.asDiagonal();

        // the first joint with which the rows become dependent
        unsigned int n_rows = 0;
        for (unsigned int j = 0; j < system_joints.size(); ++j)
          if (system_joints[j].body == b)
            {
              n_rows += system_joints[j].n_constraints();
              const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
                gram.topLeftCorner(n_rows, n_rows), Eigen::EigenvaluesOnly);
              if (!(solver.eigenvalues()(0) > 1e-10))
                throw InputError(
                  joints[j].section(),
                  "Between",
                  "a joint that repeats constraints which it or joints before "
                  "it impose on the body '" +
                    system_bodies[b].name() + "'",
                  "joints that constrain no motion of a surface twice");
            }
      }
  }



  void
  MultibodySystem::check_initial_velocities(
    const std::vector<JointParameters> &joints) const
  {
    const SystemState state        = initial_state();
    const Eigen::VectorXd velocity = constraint_velocity(state.velocities);
    for (unsigned int j = 0; j < system_joints.size(); ++j)
      {
        const Joint &joint = system_joints[j];
        const double largest =
          velocity.segment(first_rows[j], joint.n_constraints())
            .lpNorm<Eigen::Infinity>();
        const double scale =
          state.velocities[joint.body].linfty_norm() *
          std::max(1., 1 / system_bodies[joint.body].operators().length);
        if (largest > 1e-8 * scale)
          throw InputError(
            joints[j].section(),
            "Between",
            "an initial velocity of the body '" +
              system_bodies[joint.body].name() +
              "' that the joint does not allow (" + format_number(largest) +
              " m/s or rad/s in a blocked direction)",
            "a Velocity and an Angular velocity of the body that leave the "
            "joint where it is");
      }
  }



  SystemState
  MultibodySystem::initial_state() const
  {
    SystemState state;
    for (const Body &body : system_bodies)
      {
        state.positions.push_back(body.initial_positions());
        state.velocities.push_back(body.initial_velocities());
      }
    state.multipliers = Eigen::VectorXd::Zero(n_constraints());
    return state;
  }



  Eigen::VectorXd
  MultibodySystem::functional_values(const unsigned int body,
                                     const NodalVector &x) const
  {
    const auto &functionals = system_bodies[body].joint_functionals();
    Eigen::VectorXd values(dim * functionals.size());
    for (unsigned int p = 0; p < functionals.size(); ++p)
      {
        const Vector3 s = functionals[p](x);
        for (unsigned int i = 0; i < dim; ++i)
          values(dim * p + i) = s[i];
      }
    return values;
  }



  Eigen::VectorXd
  MultibodySystem::apply_constraints(const SystemVector &x) const
  {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(n_constraints());
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      if (!body_constraints[b].rows.empty())
        {
          const Eigen::VectorXd values =
            body_constraints[b].matrix * functional_values(b, x[b]);
          for (unsigned int r = 0; r < values.size(); ++r)
            result(body_constraints[b].rows[r]) += values(r);
        }
    return result;
  }



  Eigen::VectorXd
  MultibodySystem::constraint_residual(const SystemVector &positions) const
  {
    return apply_constraints(positions) - right_hand_side;
  }



  Eigen::VectorXd
  MultibodySystem::constraint_velocity(const SystemVector &velocities) const
  {
    return apply_constraints(velocities);
  }



  void
  MultibodySystem::add_external_and_joint_forces(
    const unsigned int body,
    const Eigen::VectorXd &multipliers,
    NodalVector &force) const
  {
    const BodyOperators &operators = system_bodies[body].operators();
    if (gravity_acceleration.norm_square() > 0)
      for (unsigned int a = 0; a < operators.n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          force[dim * a + i] +=
            operators.nodal_masses[a] * gravity_acceleration[i];

    const BodyConstraints &constraints = body_constraints[body];
    if (constraints.rows.empty())
      return;
    Eigen::VectorXd lambda(constraints.rows.size());
    for (unsigned int r = 0; r < constraints.rows.size(); ++r)
      lambda(r) = multipliers(constraints.rows[r]);
    const Eigen::VectorXd F = -constraints.matrix.transpose() * lambda;

    const auto &functionals = system_bodies[body].joint_functionals();
    for (unsigned int p = 0; p < functionals.size(); ++p)
      functionals[p].add_adjoint(
        Vector3({F(dim * p), F(dim * p + 1), F(dim * p + 2)}), force);
  }



  SystemEnergy
  MultibodySystem::energy(const SystemState &state) const
  {
    SystemEnergy energy;
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      {
        const BodyOperators &operators = system_bodies[b].operators();
        NodalVector product(operators.n_unknowns());
        NodalVector scratch(operators.n_unknowns());

        operators.mass_matrix.vmult(product, state.velocities[b]);
        energy.kinetic += 0.5 * (state.velocities[b] * product);
        energy.elastic +=
          reduced_strain_force(operators,
                               system_bodies[b].rotation_measure(),
                               state.positions[b],
                               product,
                               scratch)
            .value();
        energy.potential -=
          operators.mass *
          (gravity_acceleration * mass_mean(operators, state.positions[b]));
      }
    return energy;
  }



  Vector3
  MultibodySystem::momentum(const SystemState &state) const
  {
    Vector3 momentum;
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      momentum += system_bodies[b].operators().mass *
                  mass_mean(system_bodies[b].operators(), state.velocities[b]);
    return momentum;
  }



  Vector3
  MultibodySystem::angular_momentum(const SystemState &state) const
  {
    Vector3 result;
    for (unsigned int b = 0; b < system_bodies.size(); ++b)
      {
        const BodyOperators &operators = system_bodies[b].operators();
        NodalVector product(operators.n_unknowns());
        operators.mass_matrix.vmult(product, state.velocities[b]);
        for (unsigned int a = 0; a < operators.n_nodes; ++a)
          {
            Vector3 x, momentum;
            for (unsigned int i = 0; i < dim; ++i)
              {
                x[i]        = state.positions[b][dim * a + i];
                momentum[i] = product[dim * a + i];
              }
            result += cross_product_3d(x, momentum);
          }
      }
    return result;
  }



  MultibodySystem::Reaction
  MultibodySystem::reaction(const unsigned int index,
                            const SystemState &state) const
  {
    const Joint &joint = system_joints[index];
    const Eigen::VectorXd F =
      -joint.matrix.transpose() *
      state.multipliers.segment(first_rows[index], joint.n_constraints());

    Reaction reaction;
    for (unsigned int p = 0; p < joint.functionals.size(); ++p)
      {
        const Vector3 force({F(dim * p), F(dim * p + 1), F(dim * p + 2)});
        if (joint.is_mean_position[p])
          reaction.force += force;
        else
          reaction.moment += cross_product_3d(
            system_bodies[joint.body].joint_functionals()[joint.functionals[p]](
              state.positions[joint.body]),
            force);
      }
    return reaction;
  }
} // namespace ACF
