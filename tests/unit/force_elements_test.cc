// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/multibody_system.h>

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

  ForceElementParameters
  element(const std::string &type,
          const std::string &between,
          const std::vector<double> &stiffness,
          const Vector3 &axis = Vector3())
  {
    ForceElementParameters parameters;
    parameters.name      = "element";
    parameters.type      = type;
    parameters.between   = between;
    parameters.stiffness = stiffness;
    parameters.axis      = axis;
    parameters.check();
    return parameters;
  }

  const std::vector<double> bushing_stiffness = {3, 5, 4, 2, 7, 6};

  SystemParameters
  system_parameters(const std::vector<ForceElementParameters> &elements)
  {
    SystemParameters parameters;
    parameters.bodies         = bodies();
    parameters.force_elements = elements;
    return parameters;
  }

  /** Elements of all types between bodies, then to the ground. */
  std::vector<ForceElementParameters>
  all_elements()
  {
    const Vector3 axis = unit(Vector3({1, 2, -0.7}));
    std::vector<ForceElementParameters> result;
    for (const std::string between : {"a: x max, b: side", "a: x max, ground"})
      {
        result.push_back(element("spring-damper", between, {11}));
        if (between == "a: x max, ground")
          result.back().ground_point = {1, 2, 3};
        result.push_back(element("torsional spring", between, {9}, axis));
        result.push_back(element("bushing", between, bushing_stiffness));
        result.push_back(element("bushing", between, bushing_stiffness, axis));
      }
    result.push_back(element("torsional spring", "ground, b: side", {9}, axis));
    result.push_back(
      element("bushing", "b: start, a: x max", bushing_stiffness));
    result.front().free_length = 0.2;
    return result;
  }

  SystemVector
  moved(const MultibodySystem &system,
        const unsigned int body,
        const RigidMotion &motion)
  {
    SystemVector x = system.placement();
    x[body]        = transformed(x[body], motion);
    return x;
  }

  /** Forces of all elements on the markers. */
  Eigen::VectorXd
  marker_forces(const MultibodySystem &system,
                const SystemVector &x,
                const SystemVector &v,
                const double t                   = 0,
                const Eigen::VectorXd &reference = Eigen::VectorXd())
  {
    return system.marker_forces(t,
                                system.marker_values(x),
                                system.marker_values(v),
                                Eigen::VectorXd(),
                                Eigen::VectorXd(),
                                reference);
  }
} // namespace

TEST(ForceElements, DerivativesOfTheEnergyAndOfTheForce)
{
  Random random;
  double gradient_error = 0, stiffness_error = 0, damping_error = 0,
         power_error                               = 0;
  std::vector<ForceElementParameters> conservative = all_elements();
  std::vector<ForceElementParameters> others       = all_elements();
  for (ForceElementParameters &parameters : others)
    {
      parameters.damping = {0.7};
      if (parameters.type == "bushing")
        parameters.damping = {1, 2, 0.5, 0, 3, 1};
      else
        parameters.actuation = "20*t";
    }
  const MultibodySystem springs(system_parameters(conservative), ".");
  const MultibodySystem damped(system_parameters(others), ".");
  EXPECT_TRUE(damped.needs_velocities());
  for (unsigned int e = 0; e < conservative.size(); ++e)
    {
      SystemVector x = springs.placement();
      for (unsigned int b = 0; b < x.size(); ++b)
        x[b] = transformed(x[b],
                           RigidMotion{random.vector(1),
                                       random.vector(0.3),
                                       rotation_matrix(random.vector(0.6))});
      const ForceElement &spring = springs.force_elements()[e];
      Eigen::VectorXd s          = spring.markers.values(x);
      s += random_vector(s.size(), 0.1, random);
      const Eigen::VectorXd v = random_vector(s.size(), 1, random);

      const auto energy = [&](const Eigen::VectorXd &values) {
        return Eigen::VectorXd::Constant(1,
                                         spring.energy(spring.values(values)))
          .eval();
      };
      const Eigen::VectorXd F =
        spring.force(0, s, Eigen::VectorXd::Zero(s.size()), spring.values(s));
      gradient_error =
        std::max(gradient_error,
                 largest(F + difference_quotients(energy, s).transpose()));

      // with damping and actuation, at a time
      const ForceElement &law = damped.force_elements()[e];
      const double t          = 0.5;
      const auto force        = [&](const Eigen::VectorXd &values,
                             const Eigen::VectorXd &velocities) {
        return law.force(t, values, velocities, law.values(values));
      };
      stiffness_error = std::max(stiffness_error,
                                 largest(law.stiffness(t, s, v, law.values(s)) +
                                         difference_quotients(
                                           [&](const Eigen::VectorXd &values) {
                                             return force(values, v);
                                           },
                                           s)));
      damping_error =
        std::max(damping_error,
                 largest(law.damping(s) +
                         difference_quotients(
                           [&](const Eigen::VectorXd &velocities) {
                             return force(s, velocities);
                           },
                           v)));

      // what a damper takes: d times the square of the rate
      double power = 0;
      for (const ForceElement::Law &part : law.laws)
        power += part.damping * std::pow(part.function.gradient(s).dot(v), 2);
      const double taken =
        (force(s, Eigen::VectorXd::Zero(s.size())) - force(s, v)).dot(v);
      power_error = std::max(power_error, std::abs(taken - power));
      EXPECT_GT(power, 0);
    }
  // forces of some 10, differences with steps of 1e-5
  EXPECT_LT(gradient_error, 1e-7);
  EXPECT_LT(stiffness_error, 1e-7);
  EXPECT_LT(damping_error, 1e-7);
  EXPECT_LT(power_error, 1e-11);
  report("force elements, force against the energy", gradient_error);
  report("force elements, stiffness", stiffness_error);
  report("force elements, damping", damping_error);
}

TEST(ForceElements, ActionIsReaction)
{
  Random random;
  double error = 0;
  for (ForceElementParameters parameters : all_elements())
    {
      if (parameters.between.find("ground") != std::string::npos)
        continue;
      parameters.damping = {0.7};
      if (parameters.type == "bushing")
        parameters.damping = {1, 2, 0.5, 0, 3, 1};
      else
        parameters.actuation = "20*t";
      const MultibodySystem system(system_parameters({parameters}), ".");
      for (unsigned int n = 0; n < 3; ++n)
        {
          SystemState state = system.initial_state();
          disturb(state.positions, random);
          disturb(state.velocities, random);
          const Eigen::VectorXd F =
            marker_forces(system, state.positions, state.velocities, 2);
          Resultant sum;
          double size = 0;
          for (unsigned int b = 0; b < 2; ++b)
            {
              Resultant own;
              own.add(state.positions[b], nodal_force(system, b, F));
              sum.force += own.force;
              sum.moment += own.moment;
              size = std::max(size, own.moment.norm());
            }
          EXPECT_GT(size, 1);
          error = std::max(
            {error, sum.force.norm() / size, sum.moment.norm() / size});
        }
    }
  EXPECT_LT(error, 1e-13);
  report("force elements, action and reaction", error);
}

TEST(ForceElements, Springs)
{
  ForceElementParameters parameters =
    element("spring-damper", "a: x max, b: side", {11});
  const MultibodySystem relaxed(system_parameters({parameters}), ".");
  const SystemVector none = {
    NodalVector(relaxed.bodies()[0].operators().n_unknowns()),
    NodalVector(relaxed.bodies()[1].operators().n_unknowns())};
  EXPECT_LT(largest(marker_forces(relaxed, relaxed.placement(), none)), 1e-13);

  // k (l - l0) pulls, an actuation pushes, a damper resists
  parameters.free_length = 0.5;
  parameters.damping     = {2};
  parameters.actuation   = "3*t";
  const MultibodySystem system(system_parameters({parameters}), ".");
  RigidMotion motion;
  motion.centre      = place + offset;
  motion.rotation    = rotation_matrix(Vector3({1, 2, 3}));
  motion.translation = 0.5 * offset;
  SystemVector x = moved(system, 0, motion), v = none;
  for (unsigned int a = 0; a < v[0].size() / dim; ++a)
    for (unsigned int i = 0; i < dim; ++i)
      v[0][dim * a + i] = 4 * offset[i];
  const double l        = offset.norm();
  const double expected = -11 * (1.5 * l - 0.5) - 2 * 4 * l + 3 * 0.7;
  Resultant first, second;
  const Eigen::VectorXd F = marker_forces(system, x, v, 0.7);
  first.add(x[0], nodal_force(system, 0, F), place + 1.5 * offset);
  second.add(x[1], nodal_force(system, 1, F), place);
  EXPECT_LT((first.force - expected * offset / l).norm(), 1e-12);
  EXPECT_LT((second.force + expected * offset / l).norm(), 1e-12);
  EXPECT_LT(first.moment.norm() + second.moment.norm(), 1e-12);
  SystemState state = system.initial_state();
  EXPECT_NEAR(system.energy(state).elastic, 5.5 * std::pow(l - 0.5, 2), 1e-12);
}

TEST(ForceElements, Bushings)
{
  Random random;
  // axes turn with the second side
  double error       = 0;
  const Vector3 axis = unit(Vector3({1, 2, -0.7}));
  for (const std::string between : {"a: x max, b: side", "a: x max, ground"})
    {
      const ForceElementParameters parameters =
        element("bushing", between, bushing_stiffness, axis);
      const bool to_ground = (between == "a: x max, ground");
      const MultibodySystem system(system_parameters({parameters}), ".");
      JointParameters frame;
      frame.axis      = axis;
      const auto axes = frame.joint_axes();
      const RigidMotion common =
        to_ground ? RigidMotion() : random_motion(random);
      const Vector3 translation = random.vector(1e-2);
      const Vector3 angle       = 1e-6 * random.vector(1);
      const RigidMotion relative{place + offset,
                                 translation,
                                 rotation_matrix(angle)};
      SystemVector x = moved(system, 0, relative);
      for (NodalVector &positions : x)
        positions = transformed(positions, common);
      Resultant resultant;
      resultant.add(x[0],
                    nodal_force(system, 0, marker_forces(system, x, x)),
                    common(place + offset + translation));
      for (unsigned int k = 0; k < dim; ++k)
        {
          const Vector3 e = common.rotation * axes[k];
          error =
            std::max({error,
                      std::abs(resultant.force * e +
                               bushing_stiffness[k] * (translation * axes[k])),
                      // quadratic in the angle
                      std::abs(resultant.moment * e +
                               bushing_stiffness[k + dim] * (angle * axes[k])) *
                        1e-1});
        }
    }
  EXPECT_LT(error, 1e-12);
  report("bushings, forces and moments", error);
}

TEST(ForceElements, AnglesBeyondAFullTurn)
{
  const Vector3 axis = unit(Vector3({1, 2, -0.7}));
  for (const std::string between :
       {"a: x max, b: side", "a: x max, ground", "ground, a: x max"})
    {
      ForceElementParameters parameters =
        element("torsional spring", between, {9}, axis);
      parameters.free_angle = 0.2;
      const MultibodySystem system(system_parameters({parameters}), ".");
      const double sign = between == "ground, a: x max" ? -1 : 1;
      SystemState state = system.initial_state();
      double error      = 0;
      for (double angle = 0; angle < 15; angle += 1.5)
        {
          state.positions =
            moved(system,
                  0,
                  {place + offset, Vector3(), rotation_matrix(angle * axis)});
          const Eigen::VectorXd F = marker_forces(
            system, state.positions, state.velocities, 0, state.law_values);
          state.law_values =
            system.law_values(system.marker_values(state.positions),
                              state.law_values);
          const double y = sign * angle;
          Resultant resultant;
          resultant.add(state.positions[0], nodal_force(system, 0, F));
          error = std::max(
            {error,
             std::abs(state.law_values(0) - y),
             std::abs(system.energy(state).elastic -
                      4.5 * (y - 0.2) * (y - 0.2)) /
               100,
             resultant.force.norm() / 100,
             (resultant.moment + sign * 9 * (y - 0.2) * axis).norm() / 100});
        }
      EXPECT_LT(error, 1e-12) << between;
      report("torsional spring over two turns, " + between, error);
    }
}

TEST(ForceElements, Errors)
{
  using Change       = std::function<void(ForceElementParameters &)>;
  const auto refused = [](const std::string &type,
                          const Change &change,
                          const std::string &entry,
                          const std::string &text = "") {
    ForceElementParameters parameters;
    parameters.name      = "e";
    parameters.type      = type;
    parameters.between   = "a: x max, ground";
    parameters.stiffness = {1};
    if (type == "bushing")
      parameters.stiffness = bushing_stiffness;
    if (type == "torsional spring")
      parameters.axis = Vector3({0, 0, 1});
    else if (type == "spring-damper")
      parameters.ground_point = {0, 0, 0};
    change(parameters);
    expect_input_error(
      [&]() {
        parameters.check();
        SystemParameters system;
        system.bodies         = bodies();
        system.force_elements = {parameters};
        MultibodySystem(system, ".");
      },
      {"Force elements/e", "'" + entry + "'", text});
  };
  using P = ForceElementParameters;
  for (const std::string type :
       {"spring-damper", "torsional spring", "bushing"})
    {
      refused(
        type,
        [](P &p) {
          p.stiffness = {1, 2};
        },
        "Stiffness",
        "2 numb");
      refused(
        type,
        [](P &p) {
          p.damping = {1, 2, 3};
        },
        "Damping",
        "3 numb");
      refused(
        type, [](P &p) { p.stiffness.clear(); }, "Stiffness", "nothing");
      refused(
        type, [](P &p) { p.between = "a: x max, c: top"; }, "Between", "'c'");
      refused(
        type, [](P &p) { p.between = "a: x max"; }, "Between");
    }
  refused(
    "torsional spring", [](P &p) { p.axis = Vector3(); }, "Axis");
  refused(
    "spring-damper", [](P &p) { p.axis[0] = 1; }, "Axis");
  refused(
    "bushing", [](P &p) { p.free_length = 1; }, "Free length");
  refused(
    "bushing", [](P &p) { p.free_angle = 1; }, "Free angle");
  refused(
    "spring-damper", [](P &p) { p.free_angle = 1; }, "Free angle");
  refused(
    "bushing",
    [](P &p) {
      p.ground_point = {1, 2, 3};
    },
    "Ground point");
  refused(
    "bushing", [](P &p) { p.actuation = "t"; }, "Actuation");
  refused(
    "spring-damper", [](P &p) { p.actuation = "q"; }, "Actuation", "'q'");
  refused(
    "spring-damper", [](P &p) { p.ground_point = {1}; }, "Ground point");
  refused(
    "spring-damper", [](P &p) { p.ground_point = {}; }, "Ground point");
  refused(
    "spring-damper",
    [](P &p) { p.between = "a: x max, b: side"; },
    "Ground point");
  const Vector3 start = place + offset;
  refused(
    "spring-damper",
    [&](P &p) {
      p.ground_point = {start[0], start[1], start[2]};
    },
    "Between",
    "without length");
}
