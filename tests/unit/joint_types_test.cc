// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <cmath>

#include <unit/joint_pair.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** What a type blocks, in axes of the joint. */
  struct JointCase
  {
    std::string type;
    std::string free;
    bool has_axis;
    std::string translations;
    std::string rotations;

    /** Axis of any angle, "any" for any rotation, or nothing. */
    std::string turns_about;
  };

  const std::vector<JointCase> joint_cases = {
    {"spherical", "", false, "xyz", "", "any"},
    {"revolute", "", true, "xyz", "xy", "z"},
    {"cylindrical", "", true, "xy", "xy", "z"},
    {"prismatic", "", true, "xy", "xyz", ""},
    {"fixed", "", false, "xyz", "xyz", ""},
    {"universal", "", true, "xyz", "universal", "universal"},
    {"point on line", "", true, "xy", "", "any"},
    {"point on plane", "", true, "z", "", "any"},
    {"planar", "", true, "z", "xy", "z"},
    {"mean rotation", "", false, "", "xyz", ""},
    {"revolute", "z", true, "xy", "xy", "z"},
    {"prismatic", "y", true, "x", "xyz", ""},
    {"spherical", "y", false, "xz", "", "any"},
    {"fixed", "rotation x", false, "xyz", "yz", "x"},
    {"fixed", "rotation x, z", false, "xy", "yz", "x"},
    {"fixed", "rotation x, rotation z", false, "xyz", "y", ""}};

  /** Columns: the world directions of some of the joint's axes. */
  Eigen::MatrixXd
  select(const std::array<Vector3, dim> &axes, const std::string &letters)
  {
    Eigen::MatrixXd result(dim, letters.size());
    for (unsigned int k = 0; k < letters.size(); ++k)
      result.col(k) = to_eigen(axes[letters[k] - 'x']);
    return result;
  }

  /** A motion that the joint allows. */
  RigidMotion
  allowed_motion(const JointCase &c, const JointedPair &pair, Random &random)
  {
    RigidMotion motion;
    motion.centre = pair.centre;
    for (unsigned int i = 0; i < dim; ++i)
      if (c.translations.find("xyz"[i]) == std::string::npos)
        motion.translation += random.number(0.5) * pair.axes[i];
    if (c.turns_about == "any")
      motion.rotation = random.rotation();
    else if (c.turns_about == "universal")
      motion.rotation =
        rotation_matrix(random.number(3) * pair.axes[0]) *
        rotation_matrix(random.number(3) * pair.axes[2]); // z of the first side
    else if (!c.turns_about.empty())
      motion.rotation =
        rotation_matrix(random.number(3) * pair.axes[c.turns_about[0] - 'x']);
    return motion;
  }

  /** Projector on the blocked small motions of the first side, 6 x 6. */
  Eigen::MatrixXd
  blocked_motions(const JointCase &c,
                  const JointedPair &pair,
                  const RigidMotion &relative)
  {
    const Eigen::MatrixXd translations = select(pair.axes, c.translations);
    Eigen::MatrixXd rotations;
    if (c.rotations == "universal")
      rotations = to_eigen(
        cross_product_3d(relative.rotation * pair.axes[2], pair.axes[0]));
    else
      rotations = select(pair.axes, c.rotations);
    Eigen::MatrixXd result         = Eigen::MatrixXd::Zero(6, 6);
    result.topLeftCorner(3, 3)     = translations * translations.transpose();
    result.bottomRightCorner(3, 3) = rotations * rotations.transpose();
    return result;
  }

  /** Derivative of the residual by small motions, rows x 6. */
  Eigen::MatrixXd
  motion_derivative(const JointedPair &pair,
                    const RigidMotion &relative,
                    const RigidMotion &common)
  {
    const auto residual = [&](const Eigen::VectorXd &twist) {
      RigidMotion varied = relative;
      varied.translation += Vector3({twist(0), twist(1), twist(2)});
      varied.rotation =
        rotation_matrix(Vector3({twist(3), twist(4), twist(5)})) *
        varied.rotation;
      return pair.residual(varied, common);
    };
    return difference_quotients(residual, Eigen::VectorXd::Zero(6));
  }

  struct Errors
  {
    double allowed = 0, blocked = 0, jacobian = 0, hessian = 0;
  };

  void
  compare(const JointCase &c,
          const JointedPair &pair,
          Random &random,
          Errors &errors)
  {
    const Joint &joint = pair.joint;
    EXPECT_EQ(joint.n_constraints(),
              c.translations.size() +
                (c.rotations == "universal" ? 1 : c.rotations.size()));
    for (unsigned int n = 0; n < 2; ++n)
      {
        const RigidMotion common   = random_motion(random);
        const RigidMotion relative = allowed_motion(c, pair, random);
        errors.allowed =
          std::max(errors.allowed, largest(pair.residual(relative, common)));
        const Eigen::MatrixXd J = motion_derivative(pair, relative, common);
        errors.blocked          = std::max(errors.blocked,
                                  largest(J.transpose() * J -
                                          blocked_motions(c, pair, relative)));
      }

    // derivatives by marker values, also of deformed surfaces
    Eigen::VectorXd s = pair.values(RigidMotion(), random_motion(random));
    Eigen::VectorXd lambda(joint.n_constraints());
    for (double &value : s)
      value += random.number(0.2);
    for (double &value : lambda)
      value = random.number(1);
    const auto residual = [&](const Eigen::VectorXd &x) {
      return joint.residual(0, x);
    };
    const auto force = [&](const Eigen::VectorXd &x) {
      return (joint.jacobian(x).transpose() * lambda).eval();
    };
    errors.jacobian =
      std::max(errors.jacobian,
               largest(joint.jacobian(s) - difference_quotients(residual, s)));
    const Eigen::MatrixXd G = joint.geometric_stiffness(s, lambda);
    errors.hessian =
      std::max(errors.hessian, largest(G - difference_quotients(force, s)));
    EXPECT_EQ(joint.is_affine(), largest(G) == 0);
  }

  /** The case as a model file has it. */
  JointParameters
  parameters_of(const JointCase &c,
                const std::string &between,
                const Vector3 &axis)
  {
    JointParameters parameters;
    parameters.name    = "joint";
    parameters.type    = c.type;
    parameters.between = between;
    parameters.free    = c.free;
    if (c.has_axis)
      parameters.axis = 3. * axis;
    if (c.type == "universal")
      parameters.cross_axis = perpendicular(axis)[1];
    parameters.check();
    return parameters;
  }

  void
  report_errors(const std::string &label, const Errors &errors)
  {
    // positions are of the size 3, of some ten operations
    EXPECT_LT(errors.allowed, 2e-13);
    // differences with steps 1e-5
    EXPECT_LT(errors.blocked, 1e-8);
    EXPECT_LT(errors.jacobian, 1e-8);
    EXPECT_LT(errors.hessian, 1e-8);
    report(label + ": residual of allowed motions", errors.allowed);
    report(label + ": derivative by blocked motions", errors.blocked);
    report(label + ": jacobian", errors.jacobian);
    report(label + ": geometric stiffness", errors.hessian);
  }
} // namespace

TEST(JointTypes, AllowedAndBlockedMotions)
{
  Random random;
  Errors errors;
  const std::vector<Body> on_side  = make_bodies(Vector3({0, 0, 0.6}));
  const std::vector<Body> on_start = make_bodies(Vector3());
  const std::vector<std::pair<std::string, const std::vector<Body> *>> pairs = {
    {"a: x max, b: side", &on_side},
    {"b: side, a: x max", &on_side},
    {"a: x max, b: start", &on_start}, // plane and plane
    {"a: x max, ground", &on_side},
    {"ground, a: x max", &on_side},
    {"b: side, ground", &on_side}};

  // normal to the box's face, in it, and oblique to all faces
  const Matrix3 R = rotation_matrix(turn_a);
  for (const Vector3 &axis : {R * Vector3({1, 0, 0}),
                              R * Vector3({0, 0.6, 0.8}),
                              unit(Vector3({1, 2, -0.7}))})
    for (const JointCase &c : joint_cases)
      for (const auto &[between, bodies] : pairs)
        {
          SCOPED_TRACE(c.type + " " + c.free + " " + between);
          compare(c,
                  JointedPair(parameters_of(c, between, axis), *bodies),
                  random,
                  errors);
        }
  report_errors("joints", errors);
}

TEST(JointTypes, KeptOffsetTurnsWithTheSecondSide)
{
  Random random;
  Errors errors;
  const Vector3 offset({0.3, -0.5, 0.8});
  const std::vector<Body> bodies = make_bodies(Vector3({0, 0, 0.6}), -offset);
  const Vector3 axis             = unit(Vector3({1, 2, -0.7}));
  for (const JointCase &c : joint_cases)
    for (const std::string between : {"a: x max, b: side", "b: side, a: x max"})
      {
        SCOPED_TRACE(c.type + " " + c.free + " " + between);
        JointParameters parameters = parameters_of(c, between, axis);
        if (!c.translations.empty())
          expect_input_error([&]() { make_joint(parameters, bodies); },
                             {"Joints/joint",
                              "'Between'",
                              "0.98", // the distance
                              "'Offset = keep'"});
        parameters.keep_offset = true;
        compare(c, JointedPair(parameters, bodies), random, errors);
      }
  report_errors("joints with an offset", errors);

  // a distance that is not blocked is no error
  const std::vector<Body> along = make_bodies(Vector3({0, 0, 0.6}), 0.7 * axis);
  for (const std::string type : {"prismatic", "cylindrical", "point on line"})
    EXPECT_NO_THROW(
      make_joint(joint_parameters(type, "a: x max, b: side", "", axis), along));
  EXPECT_THROW(make_joint(joint_parameters(
                            "point on plane", "a: x max, b: side", "", axis),
                          along),
               InputError);
}

TEST(JointTypes, Distance)
{
  Random random;
  const Vector3 offset({0.3, -0.5, 0.8});
  const std::vector<Body> bodies = make_bodies(Vector3({0, 0, 0.6}), -offset);
  JointParameters parameters =
    joint_parameters("distance", "a: x max, b: side");
  const JointedPair rod(parameters, bodies);
  EXPECT_EQ(rod.joint.n_constraints(), 1);
  EXPECT_FALSE(rod.joint.is_affine());
  for (unsigned int n = 0; n < 5; ++n)
    {
      // anywhere on a sphere about the second side, turned
      RigidMotion motion{rod.centre,
                         random.rotation() * offset - offset,
                         random.rotation()};
      const RigidMotion common = random_motion(random);
      EXPECT_LT(largest(rod.residual(motion, common)), 1e-14);
      motion.translation = 0.25 * offset;
      EXPECT_NEAR(rod.residual(motion, common)(0), 0.25 * offset.norm(), 1e-14);
    }
  Eigen::VectorXd s   = rod.values(RigidMotion(), random_motion(random));
  const auto residual = [&](const Eigen::VectorXd &x) {
    return rod.joint.residual(0, x);
  };
  const auto force = [&](const Eigen::VectorXd &x) {
    return (3 * rod.joint.jacobian(x).transpose()).eval();
  };
  EXPECT_LT(largest(rod.joint.jacobian(s) - difference_quotients(residual, s)),
            1e-9);
  EXPECT_LT(
    largest(rod.joint.geometric_stiffness(s, Eigen::VectorXd::Constant(1, 3)) -
            difference_quotients(force, s)),
    1e-9);

  parameters.between = "a: x max, ground";
  expect_input_error([&]() { make_joint(parameters, bodies); },
                     {"Joints/joint", "'Between'", "distance"});
  parameters.between = "a: x max, b: side";
  const auto meeting = make_bodies(Vector3({0, 0, 0.6}));
  expect_input_error([&]() { make_joint(parameters, meeting); },
                     {"Joints/joint", "'Between'", "coincide"});
}
