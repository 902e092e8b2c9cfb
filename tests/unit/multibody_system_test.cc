// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/mechanics/multibody_system.h>

#include <cmath>

#include <unit/mechanics_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const std::string box =
    "set Mesh = box\n set Box from = -1, -0.5, 0\n set Box to = 1, 0.5, 3\n"
    "set Cells = 2, 1, 2\n set Element = hexahedron\n";
  const std::string cylinder =
    "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
    "set Cylinder to = 0, 0, 1.2\n set Cylinder radius = 0.5\n"
    "set Cells = 3, 1\n set Element = tetrahedron\n";

  BodyParameters
  placed_body(const std::string &name, const std::string &mesh)
  {
    BodyParameters parameters = body_parameters(name, mesh);
    parameters.position       = Point<dim>(0.7, -2, 0.3);
    parameters.rotation       = Vector3({0.4, -1.1, 2});
    return parameters;
  }

  JointParameters
  joint(const std::string &type,
        const std::string &between,
        const std::string &directions = "",
        const Vector3 &axis           = Vector3())
  {
    JointParameters parameters;
    parameters.name       = type;
    parameters.type       = type;
    parameters.between    = between;
    parameters.directions = directions;
    parameters.axis       = axis;
    parameters.check();
    return parameters;
  }

  /** Turned, moved and deformed. */
  void
  disturb(SystemState &state, Random &random)
  {
    for (NodalVector &x : state.positions)
      {
        const Matrix3 Q = random.rotation();
        const Vector3 t = random.vector(1);
        x               = transformed(x, [&](const Vector3 &v) {
          return t + Q * v + 0.1 * v[0] * v[1] * Vector3({1, -1, 2});
        });
      }
  }
} // namespace

TEST(MultibodySystem, ReactionsAreResultantsOfTheNodalForces)
{
  // the revolute joint once with one director and once with two
  const Matrix3 R0   = rotation_matrix(placed_body("", box).rotation);
  const Vector3 axis = R0 * Vector3({0, 0, 1});
  const std::vector<JointParameters> joints = {
    joint("spherical", "a: x min, ground"),
    joint("mean position", "a: x max, ground", "1,1,0; 0,0,1"),
    joint("mean rotation", "a: z max, ground", "1,2,-1"),
    joint("fixed", "b: side, ground"),
    joint("revolute", "a: y max, ground", "", axis),
    joint("mean rotation", "b: start, ground", "x, y, z"),
    joint("revolute", "b: end, ground", "", axis)};
  const std::vector<BodyParameters> bodies = {placed_body("a", box),
                                              placed_body("b", cylinder)};
  const MultibodySystem system(bodies, joints, LoadParameters(), ".");

  Random random;
  double error = 0;
  for (unsigned int j = 0; j < joints.size(); ++j)
    for (unsigned int n = 0; n < 5; ++n)
      {
        SystemState state = system.initial_state();
        if (n > 0)
          disturb(state, random);
        const unsigned int n_rows = system.joints()[j].n_constraints();
        const unsigned int first  = system.first_constraint(j);
        for (unsigned int r = 0; r < n_rows; ++r)
          state.multipliers(first + r) = random.number(100);

        const unsigned int b = system.joints()[j].body;
        NodalVector force(state.positions[b].size());
        system.add_external_and_joint_forces(b, state.multipliers, force);
        NodalVector other(state.positions[1 - b].size());
        system.add_external_and_joint_forces(1 - b, state.multipliers, other);
        EXPECT_EQ(other.linfty_norm(), 0);

        const std::string between = joints[j].between;
        const auto &body          = system.bodies()[b].discretization();
        const Vector3 centre =
          surface_mean(body,
                       body.mesh().surface(
                         between.substr(3, between.find(',') - 3), "", ""))(
            state.positions[b]);
        Vector3 sum, moment;
        for (unsigned int a = 0; a < force.size() / dim; ++a)
          {
            sum += node_value(force, a);
            moment +=
              cross_product_3d(node_value(state.positions[b], a) - centre,
                               node_value(force, a));
          }
        EXPECT_GT(sum.norm() + moment.norm(), 0.1);
        const auto reaction = system.reaction(j, state);
        error               = std::max({error,
                                        (reaction.force - sum).norm() / 100,
                                        (reaction.moment - moment).norm() / 100});
      }
  EXPECT_LT(error, 1e-12);
  report("reactions against sums over the nodes, relative", error);
}

TEST(MultibodySystem, JointForcesAreTheAdjointOfTheConstraints)
{
  Random random;
  const MultibodySystem system({placed_body("a", box),
                                placed_body("b", cylinder)},
                               {joint("fixed", "b: side, ground"),
                                joint("spherical", "a: x min, ground"),
                                joint("mean rotation", "b: end, ground", "z")},
                               LoadParameters(),
                               ".");
  const Eigen::VectorXd lambda = Eigen::VectorXd::Random(10);
  SystemVector v;
  double power = 0;
  for (unsigned int b = 0; b < 2; ++b)
    {
      const unsigned int n = system.bodies()[b].operators().n_unknowns();
      v.push_back(random.nodal_vector(n, 1));
      NodalVector force(n);
      system.add_external_and_joint_forces(b, lambda, force);
      power += force * v[b];
    }
  ASSERT_EQ(system.n_constraints(), 10);
  EXPECT_NEAR(power, -lambda.dot(system.constraint_velocity(v)), 1e-13);
}

TEST(MultibodySystem, Gravity)
{
  LoadParameters loads;
  loads.gravity = Vector3({1, -3, -9.81});
  const MultibodySystem system({placed_body("a", box)}, {}, loads, ".");
  const BodyOperators &body = system.bodies()[0].operators();
  SystemState state         = system.initial_state();
  NodalVector force(body.n_unknowns());
  system.add_external_and_joint_forces(0, state.multipliers, force);
  Vector3 sum, moment;
  const Matrix3 R0     = rotation_matrix(Vector3({0.4, -1.1, 2}));
  const Vector3 centre = Vector3({0.7, -2, 0.3}) + R0 * Vector3({0, 0, 1.5});
  for (unsigned int a = 0; a < body.n_nodes; ++a)
    {
      sum += node_value(force, a);
      moment += cross_product_3d(node_value(state.positions[0], a) - centre,
                                 node_value(force, a));
    }
  const double mass = 1200 * 6;
  EXPECT_LT((sum - mass * loads.gravity).norm(), 1e-12 * mass);
  EXPECT_LT(moment.norm(), 1e-12 * mass);
  EXPECT_NEAR(system.energy(state).potential,
              -mass * (loads.gravity * centre),
              1e-11 * mass);
}

TEST(MultibodySystem, EnergyAndMomentaOfRigidMotions)
{
  BodyParameters parameters   = placed_body("a", box);
  parameters.velocity         = Vector3({1, 2, -0.5});
  parameters.angular_velocity = Vector3({3, -1, 2});
  const MultibodySystem system({parameters, parameters},
                               {},
                               LoadParameters(),
                               ".");
  const SystemState state = system.initial_state();

  const double mass    = 1200 * 6;
  const Vector3 &v     = parameters.velocity;
  const Vector3 &omega = parameters.angular_velocity;
  const Matrix3 R0     = rotation_matrix(parameters.rotation);
  const Vector3 centre =
    Vector3(parameters.position) + R0 * Vector3({0, 0, 1.5});
  const Vector3 edges = Vector3({2, 1, 3});
  Matrix3 principal;
  for (unsigned int i = 0; i < dim; ++i)
    principal[i][i] = mass / 12 * (edges.norm_square() - edges[i] * edges[i]);
  const Vector3 spin = R0 * (principal * (transpose(R0) * omega));

  const SystemEnergy energy = system.energy(state);
  EXPECT_NEAR(energy.kinetic / (mass * v.norm_square() + omega * spin),
              1,
              1e-13);
  EXPECT_LT(energy.elastic, 1e-25 * test_material().youngs_modulus);
  EXPECT_EQ(energy.potential, 0);
  EXPECT_LT((system.momentum(state) - 2 * mass * v).norm(), 1e-12 * mass);
  const Vector3 expected = 2. * (mass * cross_product_3d(centre, v) + spin);
  EXPECT_LT((system.angular_momentum(state) - expected).norm(),
            1e-12 * expected.norm());
}

TEST(MultibodySystem, InitialVelocities)
{
  const Matrix3 R0    = rotation_matrix(placed_body("", box).rotation);
  const Vector3 axis  = R0 * Vector3({0, 1, 0});
  const Vector3 arm   = R0 * Vector3({0, 0.5, 1.5}); // from the hinge
  const Vector3 omega = 2. * axis;
  const auto make     = [&](const Vector3 &velocity,
                        const Vector3 &angular_velocity) {
    return [=]() {
      BodyParameters parameters   = placed_body("a", box);
      parameters.velocity         = velocity;
      parameters.angular_velocity = angular_velocity;
      MultibodySystem({parameters},
                      {joint("revolute", "a: z min, ground", "", axis)},
                      LoadParameters(),
                      ".");
    };
  };
  const Vector3 turning = cross_product_3d(omega, arm);
  EXPECT_NO_THROW(make(Vector3(), Vector3())());
  EXPECT_NO_THROW(make(turning, omega)());

  const std::vector<std::string> parts = {"Joints/revolute", "'a'", "Velocity"};
  expect_input_error(make(Vector3(), omega), parts);
  expect_input_error(make(turning, Vector3()), parts);
  expect_input_error(make(-turning, omega), parts);
  expect_input_error(make(turning + 1e-4 * axis, omega), parts);
  const Vector3 tilted = omega + 1e-4 * R0 * Vector3({1, 0, 0});
  expect_input_error(make(cross_product_3d(tilted, arm), tilted), parts);
}
