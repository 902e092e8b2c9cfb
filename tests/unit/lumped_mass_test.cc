// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <cmath>

#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const Vector3 place({0.4, -1.2, 2}), offset({0.3, -0.5, 0.8}),
    turn_a({0.4, -1.1, 2}), turn_b({-1.3, 0.2, 0.9});

  /** The mean of "b: side" at the distance offset from that of "a: x max". */
  std::vector<BodyParameters>
  bodies()
  {
    return {
      body_at("a", box_mesh, turn_a, Vector3({1, 0, 1.5}), place + offset),
      body_at("b", cylinder_mesh, turn_b, Vector3({0, 0, 0.6}), place)};
  }

  LumpedMassParameters
  mass_parameters(const std::string &on,
                  const double mass,
                  const Matrix3 &inertia = Matrix3())
  {
    LumpedMassParameters parameters;
    parameters.name = "m";
    parameters.on   = on;
    parameters.mass = mass;
    if (inertia.norm() > 0)
      parameters.inertia = {inertia[0][0],
                            inertia[1][1],
                            inertia[2][2],
                            inertia[1][2],
                            inertia[2][0],
                            inertia[0][1]};
    parameters.check();
    return parameters;
  }

  Matrix3
  diagonal(const double x, const double y, const double z)
  {
    Matrix3 result;
    result[0][0] = x;
    result[1][1] = y;
    result[2][2] = z;
    return result;
  }
} // namespace

TEST(LumpedMass, MovesAsARigidBody)
{
  Random random;
  // any body on a curved surface, a plate on a plane one, and a point
  const Matrix3 Q = random.rotation(), R = rotation_matrix(turn_a);
  const std::vector<std::tuple<std::string, double, Matrix3, Vector3>> cases = {
    {"b: side", 30, Q * diagonal(4, 5, 7) * transpose(Q), place},
    {"a: x max", 20, R * diagonal(5, 2, 3) * transpose(R), place + offset},
    {"a: x max", 0, R * diagonal(5, 2, 3) * transpose(R), place + offset},
    {"a: x max", 20, Matrix3(), place + offset}};
  double error = 0;
  for (const auto &[on, mass, inertia, centre] : cases)
    {
      SystemParameters parameters;
      parameters.bodies        = bodies();
      parameters.loads.gravity = Vector3({1, -2, 3});
      const MultibodySystem empty(parameters, ".");
      parameters.masses = {mass_parameters(on, mass, inertia)};
      const MultibodySystem system(parameters, ".");

      // a rigid motion in a turned state
      const RigidMotion motion = random_motion(random);
      const Vector3 omega = random.vector(3), velocity = random.vector(2);
      const Vector3 x_bar = motion(centre);
      SystemState state   = system.initial_state();
      for (unsigned int b = 0; b < 2; ++b)
        {
          state.positions[b] = transformed(state.positions[b], motion);
          state.velocities[b] =
            transformed(state.positions[b], [&](const Vector3 &x) {
              return velocity + cross_product_3d(omega, x - x_bar);
            });
        }
      const Vector3 spin =
        motion.rotation * (inertia * (transpose(motion.rotation) * omega));
      const SystemEnergy with    = system.energy(state),
                         without = empty.energy(state);
      error                      = std::max(
        {error,
                              std::abs(with.kinetic - without.kinetic -
                  0.5 * mass * velocity.norm_square() - 0.5 * omega * spin) /
                                with.kinetic,
                              std::abs(with.potential - without.potential +
                  mass * (parameters.loads.gravity * x_bar)) /
                                std::abs(with.potential),
                              (system.momentum(state) - empty.momentum(state) - mass * velocity)
                                  .norm() /
                                system.momentum(state).norm(),
                              (system.angular_momentum(state) - empty.angular_momentum(state) -
          mass * cross_product_3d(x_bar, velocity) - spin)
                                  .norm() /
                                system.angular_momentum(state).norm()});

      // forces: the weight, and minus the gradient of the kinetic energy by
      // velocities where the accelerations are
      const Eigen::VectorXd s = system.marker_values(state.positions);
      const Eigen::VectorXd a = random_vector(s.size(), 1, random);
      const Eigen::MatrixXd M =
        to_dense(system.linearize(0, s, s, Eigen::VectorXd(), {}).mass,
                 s.size(),
                 s.size());
      const Eigen::VectorXd v = system.marker_values(state.velocities);
      EXPECT_NEAR(0.5 * v.dot(M * v) / with.kinetic,
                  1 - without.kinetic / with.kinetic,
                  1e-12);
      EXPECT_LT(largest(M - M.transpose()), 1e-14);
      const auto forces = [&](const Eigen::VectorXd &acceleration) {
        return system.marker_forces(
          0, s, s, acceleration, Eigen::VectorXd(), Eigen::VectorXd());
      };
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(s.size());
      EXPECT_LT(largest(forces(a) - forces(zero) + M * a), 1e-12);
      Resultant weight;
      for (unsigned int b = 0; b < 2; ++b)
        weight.add(state.positions[b],
                   nodal_force(system, b, forces(zero)),
                   x_bar);
      EXPECT_LT((weight.force - mass * parameters.loads.gravity).norm(), 1e-11);
      EXPECT_LT(weight.moment.norm(), 1e-11);
    }
  EXPECT_LT(error, 1e-13);
  report("lumped masses in rigid motion", error);
}

TEST(LumpedMass, Errors)
{
  const auto refused = [](const LumpedMassParameters &mass,
                          const std::vector<std::string> &parts) {
    SystemParameters parameters;
    parameters.bodies = bodies();
    parameters.masses = {mass};
    expect_input_error(
      [&]() {
        mass.check();
        MultibodySystem(parameters, ".");
      },
      parts);
  };
  // mass in front of the face, a little
  const Matrix3 R = rotation_matrix(turn_a);
  refused(mass_parameters("a: x max",
                          1,
                          R * diagonal(4.9, 2, 3) * transpose(R)),
          {"Masses/m", "'Inertia'", "a: x max", "plane"});
  refused(mass_parameters("b: side", 1, diagonal(1, 2, 3.1)),
          {"Masses/m", "'Inertia'", "no rigid body"});
  refused(mass_parameters("b: side", 1, diagonal(1, -1, 1)),
          {"Masses/m", "'Inertia'", "no rigid body"});
  refused(mass_parameters("ground", 1), {"Masses/m", "'On'"});
  refused(mass_parameters("b: top", 1), {"Masses/m", "'On'", "'top'"});
  refused(mass_parameters("c: top", 1), {"Masses/m", "'On'", "'c'"});

  LumpedMassParameters parameters = mass_parameters("b: side", 1);
  parameters.mass                 = 0;
  refused(parameters, {"Masses/m", "'Mass'", "zero"});
  parameters.inertia = {1, 2, 3};
  refused(parameters, {"Masses/m", "'Inertia'", "3 numbers"});
}
