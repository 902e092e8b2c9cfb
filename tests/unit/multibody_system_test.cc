// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/mechanics/multibody_system.h>

#include <cmath>

#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const Vector3 place({0.7, -2, 0.3}), turn_a({0.4, -1.1, 2}),
    turn_b({-1.3, 0.2, 0.9});

  /** "a: z min" and "b: start" have the same mean position. */
  std::vector<BodyParameters>
  two_bodies()
  {
    return {body_at("a", box_mesh, turn_a, Vector3(), place),
            body_at("b", cylinder_mesh, turn_b, Vector3(), place)};
  }

  /** Joints of bodies with the ground and with each other. */
  std::vector<JointParameters>
  joints_to_ground()
  {
    // the revolute joint once with one director and once with two
    const Vector3 axis = rotation_matrix(turn_a) * Vector3({0, 0, 1});
    return {joint_parameters("spherical", "a: x min, ground"),
            joint_parameters("mean position",
                             "a: x max, ground",
                             "1,1,0; 0,0,1"),
            joint_parameters("mean rotation", "a: z max, ground", "1,2,-1"),
            joint_parameters("fixed", "b: side, ground"),
            joint_parameters("revolute", "a: y max, ground", "", axis),
            joint_parameters("mean rotation", "b: start, ground", "x, y, z"),
            joint_parameters("revolute", "b: end, ground", "", axis)};
  }

  std::vector<JointParameters>
  joints_between_bodies()
  {
    const Vector3 axis                = unit(Vector3({1, 2, -0.7}));
    std::vector<JointParameters> list = {
      joint_parameters("spherical", "a: z min, b: start"),
      joint_parameters("fixed", "b: start, a: z min"),
      joint_parameters("distance", "a: x max, b: end"),
      joint_parameters("mean rotation", "a: z max, b: start", "z"),
      joint_parameters("point on line", "a: z min, b: start", "", axis),
      joint_parameters("prismatic", "b: start, a: z min", "", axis)};
    list.push_back(list[0]);
    list.back().between     = "a: x max, b: side"; // a distance is kept
    list.back().keep_offset = true;
    for (const std::string type : {"universal", "revolute"})
      {
        JointParameters joint;
        joint.name       = type;
        joint.type       = type;
        joint.between    = "a: z min, b: start";
        joint.axis       = axis;
        joint.cross_axis = perpendicular(axis)[0];
        if (type == "revolute")
          joint.angular_velocity = "1";
        list.push_back(joint);
      }
    return list;
  }

  /** One of everything. */
  SystemParameters
  everything()
  {
    SystemParameters parameters;
    parameters.bodies        = two_bodies();
    parameters.loads.gravity = Vector3({0, 0, -9.81});
    parameters.joints        = joints_between_bodies();
    parameters.joints.push_back(joints_to_ground()[0]);
    for (const std::string type : {"spring-damper", "torsional spring"})
      {
        ForceElementParameters element;
        element.name      = type;
        element.type      = type;
        element.between   = "a: x max, b: side";
        element.stiffness = {11};
        element.damping   = {3};
        element.actuation = "2*t";
        if (type == "torsional spring")
          element.axis = Vector3({0, 0, 1});
        parameters.force_elements.push_back(element);
      }
    LumpedMassParameters mass;
    mass.name    = "mass";
    mass.on      = "b: side";
    mass.mass    = 12;
    mass.inertia = {3, 4, 5, 0.1, -0.2, 0.3};
    parameters.masses.push_back(mass);
    return parameters;
  }

  /** Forces of the joints on the markers. */
  Eigen::VectorXd
  joint_forces(const MultibodySystem &system, const SystemState &state)
  {
    return system.marker_forces(state.time,
                                system.marker_values(state.positions),
                                Eigen::VectorXd(),
                                Eigen::VectorXd(),
                                state.multipliers,
                                Eigen::VectorXd());
  }

  /** Of the joints' forces on a body. */
  Resultant
  resultant(const MultibodySystem &system,
            const SystemState &state,
            const unsigned int body,
            const Vector3 &point)
  {
    NodalVector force(state.positions[body].size());
    system.add_marker_forces(body, joint_forces(system, state), force);
    Resultant result;
    result.add(state.positions[body], force, point);
    return result;
  }

  /** The mean position of the surface in "BODY: SURFACE, ...". */
  Vector3
  mean_position(const MultibodySystem &system,
                const std::string &between,
                const SystemState &state)
  {
    const unsigned int b = between[0] - 'a';
    const auto &body     = system.bodies()[b].discretization();
    return surface_mean(
      body,
      body.mesh().surface(between.substr(3, between.find(',') - 3), "", ""))(
      state.positions[b]);
  }

  void
  set_multipliers(const MultibodySystem &system,
                  const unsigned int joint,
                  SystemState &state,
                  Random &random)
  {
    state.multipliers.setZero();
    for (unsigned int r = 0; r < system.joints()[joint].n_constraints(); ++r)
      state.multipliers(system.first_constraint(joint) + r) =
        random.number(100);
  }
} // namespace

TEST(MultibodySystem, ReactionsAreResultantsOfTheNodalForces)
{
  Random random;
  double error = 0;
  for (const auto &joints : {joints_to_ground(), joints_between_bodies()})
    {
      const MultibodySystem system(two_bodies(), joints, LoadParameters(), ".");
      for (unsigned int j = 0; j < joints.size(); ++j)
        for (unsigned int n = 0; n < 5; ++n)
          {
            SystemState state = system.initial_state();
            if (n > 0)
              disturb(state.positions, random);
            set_multipliers(system, j, state, random);
            const Vector3 centre =
              mean_position(system, joints[j].between, state);
            const unsigned int b = joints[j].between[0] - 'a';
            const Resultant sum  = resultant(system, state, b, centre);
            EXPECT_GT(sum.force.norm() + sum.moment.norm(), 0.1);
            if (joints[j].between.find("ground") != std::string::npos)
              {
                const Resultant other =
                  resultant(system, state, 1 - b, Vector3());
                EXPECT_EQ(other.force.norm() + other.moment.norm(), 0);
              }
            const auto reaction = system.reaction(j, state);
            error               = std::max({error,
                                            (reaction.force - sum.force).norm() / 100,
                                            (reaction.moment - sum.moment).norm() / 100});
          }
    }
  EXPECT_LT(error, 1e-12);
  report("reactions against sums over the nodes, relative", error);
}

TEST(MultibodySystem, ActionIsReaction)
{
  Random random;
  const std::vector<JointParameters> joints = joints_between_bodies();
  const MultibodySystem system(two_bodies(), joints, LoadParameters(), ".");
  double error = 0;
  for (unsigned int j = 0; j < joints.size(); ++j)
    for (unsigned int n = 0; n < 3; ++n)
      {
        // deformed, but so that the mean positions still meet: affinely
        SystemState state        = system.initial_state();
        const RigidMotion motion = random_motion(random);
        Matrix3 F                = identity_matrix() + random.matrix(0.1);
        if (joints[j].keep_offset) // bound to the directors' length
          F = identity_matrix();
        for (NodalVector &x : state.positions)
          x = transformed(x, [&](const Vector3 &v) {
            return motion(place + F * (v - place));
          });
        set_multipliers(system, j, state, random);
        const Resultant a = resultant(system, state, 0, Vector3());
        const Resultant b = resultant(system, state, 1, Vector3());
        EXPECT_GT(a.force.norm() + a.moment.norm(), 0.1);
        error = std::max({error,
                          (a.force + b.force).norm() / 100,
                          (a.moment + b.moment).norm() / 100});
      }
  EXPECT_LT(error, 2e-12);
  report("joints, action and reaction, relative", error);
}

TEST(MultibodySystem, JointForcesAreTheAdjointOfTheConstraints)
{
  Random random;
  double error = 0;
  for (const auto &joints : {joints_to_ground(), joints_between_bodies()})
    {
      const MultibodySystem system(two_bodies(), joints, LoadParameters(), ".");
      SystemState state = system.initial_state();
      disturb(state.positions, random);
      state.multipliers = random_vector(system.n_constraints(), 1, random);
      const Eigen::VectorXd F = joint_forces(system, state);
      double power            = 0;
      for (unsigned int b = 0; b < 2; ++b)
        {
          const unsigned int n = system.bodies()[b].operators().n_unknowns();
          state.velocities[b]  = random.nodal_vector(n, 1);
          NodalVector force(n);
          system.add_marker_forces(b, F, force);
          power += force * state.velocities[b];
        }
      // against differences of the constraints themselves, drives at rest
      const double h = 1e-5;
      SystemVector before(state.positions), after(state.positions);
      for (unsigned int b = 0; b < 2; ++b)
        {
          before[b].add(-h, state.velocities[b]);
          after[b].add(h, state.velocities[b]);
        }
      const Eigen::VectorXd rate = (system.constraint_residual(after) -
                                    system.constraint_residual(before)) /
                                   (2 * h);
      error = std::max(error,
                       std::abs(power + state.multipliers.dot(rate)) /
                         std::abs(power));
      // and what is called the velocity of the constraints
      const Eigen::VectorXd s = system.marker_values(state.positions);
      const Eigen::VectorXd v = system.marker_values(state.velocities);
      Eigen::VectorXd drives(system.n_constraints());
      for (unsigned int j = 0; j < joints.size(); ++j)
        drives.segment(system.first_constraint(j),
                       system.joints()[j].n_constraints()) =
          system.joints()[j].drive_rates(0);
      error = std::max(error,
                       relative_difference(system.constraint_velocity(0, s, v),
                                           rate - drives));
    }
  EXPECT_LT(error, 1e-8); // of the differences
  report("power of joint forces against the constraints, relative", error);
}

TEST(MultibodySystem, LinearizationAgainstDifferences)
{
  Random random;
  const MultibodySystem system(everything(), ".");
  EXPECT_FALSE(system.has_affine_joints());
  EXPECT_TRUE(system.needs_velocities());
  SystemState state = system.initial_state();
  disturb(state.positions, random);
  const unsigned int n    = system.n_marker_values();
  const unsigned int m    = system.n_constraints();
  const double t          = 0.6;
  const Eigen::VectorXd s = system.marker_values(state.positions);
  const Eigen::VectorXd v = random_vector(n, 1, random);
  const Eigen::VectorXd a = random_vector(n, 1, random);
  const Eigen::VectorXd l = random_vector(m, 5, random);
  // a turn further than the angle of the markers
  Eigen::VectorXd reference = system.law_values(s, Eigen::VectorXd());
  reference(1) += 2 * numbers::PI;
  const MarkerLinearization linearization =
    system.linearize(t, s, v, l, reference);
  const auto compare = [&](const std::string &label,
                           const MarkerLinearization::Triplets &triplets,
                           const Eigen::MatrixXd &expected) {
    const double error =
      relative_difference(to_dense(triplets, expected.rows(), n), expected);
    EXPECT_LT(error, 1e-8) << label; // of the differences
    report("linearisation against differences, " + label, error);
  };
  compare("constraints",
          linearization.constraints,
          difference_quotients(
            [&](const Eigen::VectorXd &x) {
              return system.constraint_residual(t, x);
            },
            s));
  compare("stiffness",
          linearization.stiffness,
          -difference_quotients(
            [&](const Eigen::VectorXd &x) {
              return system.marker_forces(t, x, v, a, l, reference);
            },
            s));
  compare("damping",
          linearization.damping,
          -difference_quotients(
            [&](const Eigen::VectorXd &x) {
              return system.marker_forces(t, s, x, a, l, reference);
            },
            v));
  compare("mass",
          linearization.mass,
          -difference_quotients(
            [&](const Eigen::VectorXd &x) {
              return system.marker_forces(t, s, v, x, l, reference);
            },
            a));
}

TEST(MultibodySystem, EnergyAndMomentaOfRigidMotions)
{
  BodyParameters parameters   = two_bodies()[0];
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

TEST(MultibodySystem, FieldsAtTheStart)
{
  BodyParameters parameters     = two_bodies()[0];
  parameters.velocity           = Vector3({1, 2, -0.5});
  parameters.displacement_field = "0.1*y^2; 0; -0.2*x*z";
  parameters.velocity_field     = "z; x*y; 3";
  const MultibodySystem system({parameters}, {}, LoadParameters(), ".");
  const SystemState state = system.initial_state();
  const Matrix3 R0        = rotation_matrix(parameters.rotation);
  const NodalVector &X    = system.bodies()[0].operators().reference_positions;
  double error            = 0;
  for (unsigned int a = 0; a < X.size() / dim; ++a)
    {
      const Vector3 x = node_value(X, a);
      const Vector3 displacement({0.1 * x[1] * x[1], 0, -0.2 * x[0] * x[2]});
      const Vector3 velocity({x[2], x[0] * x[1], 3});
      error = std::max({error,
                        (node_value(state.positions[0], a) -
                         Vector3(parameters.position) - R0 * (x + displacement))
                          .norm(),
                        (node_value(state.velocities[0], a) -
                         parameters.velocity - R0 * velocity)
                          .norm()});
    }
  EXPECT_LT(error, 1e-14);
  parameters.velocity_field = "x; y";
  expect_input_error(
    [&]() { MultibodySystem({parameters}, {}, LoadParameters(), "."); },
    {"Bodies/a", "'Velocity field'", "'x; y'"});
}

TEST(MultibodySystem, IdenticalBodiesShareWhatDoesNotDependOnTheirPlace)
{
  // hinges in the same place of the bodies, which are turned differently
  std::vector<BodyParameters> bodies;
  std::vector<JointParameters> joints;
  Random random;
  for (const std::string name : {"a", "b", "c", "d"})
    {
      bodies.push_back(
        body_at(name, box_mesh, random.vector(2), Vector3(), random.vector(3)));
      const Matrix3 R = rotation_matrix(bodies.back().rotation);
      joints.push_back(joint_parameters("fixed", name + ": x max, ground"));
      joints.push_back(joint_parameters(
        "revolute", name + ": z min, ground", "", R * Vector3({0, 1, 0})));
    }
  bodies[1].stiffness_damping = 0.1; // belongs to the placed body
  bodies[1].velocity          = Vector3({1, 0, 0});
  bodies[3].material.density  = 1300;
  const MultibodySystem system(bodies, joints, LoadParameters(), ".");
  EXPECT_EQ(system.n_reference_bodies(), 2);
  EXPECT_EQ(&system.bodies()[0].reference(), &system.bodies()[1].reference());
  EXPECT_EQ(&system.bodies()[0].reference(), &system.bodies()[2].reference());
  EXPECT_NE(&system.bodies()[0].reference(), &system.bodies()[3].reference());
  const MultibodySystem single({bodies[0]},
                               {joints[0], joints[1]},
                               LoadParameters(),
                               ".");
  EXPECT_EQ(system.bodies()[0].reference().functionals().size(),
            single.bodies()[0].reference().functionals().size());

  // the marker values are those of each body alone
  SystemState state = system.initial_state();
  disturb(state.positions, random);
  const Eigen::VectorXd phi = system.constraint_residual(state.positions);
  for (unsigned int b = 0; b < bodies.size(); ++b)
    {
      const MultibodySystem alone({bodies[b]},
                                  {joints[2 * b], joints[2 * b + 1]},
                                  LoadParameters(),
                                  ".");
      EXPECT_LT(largest(alone.constraint_residual({state.positions[b]}) -
                        phi.segment(11 * b, 11)),
                1e-13);
    }
}
