// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/multibody_system.h>

#include <cmath>

#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const std::string tetrahedra = "set Element = tetrahedron\n";
  const std::string hexahedra  = "set Element = hexahedron\n";

  const std::string box =
    "set Mesh = box\n set Box from = -1, -0.5, 0\n"
    "set Box to = 1, 0.5, 3\n set Cells = 2, 1, 2\n";

  std::string
  cylinder(const unsigned int n_cells_across)
  {
    return "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
           "set Cylinder to = 0, 0, 1.2\n set Cylinder radius = 0.5\n"
           "set Cells = " +
           std::to_string(n_cells_across) + ", 2\n";
  }

  std::set<types::boundary_id>
  surface(const BodyDiscretization &body, const std::string &name)
  {
    return body.mesh().surface(name, "", "");
  }

  /** A body turned and placed somewhere. */
  BodyParameters
  placed_body(const std::string &name, const std::string &entries)
  {
    BodyParameters parameters = body_parameters(name, entries);
    parameters.position       = Point<dim>(0.7, -2, 0.3);
    parameters.rotation       = Vector3({0.4, -1.1, 2});
    return parameters;
  }

  std::string
  text(const Vector3 &v)
  {
    std::ostringstream out;
    out.precision(17);
    out << v[0] << ',' << v[1] << ',' << v[2];
    return out.str();
  }

  /** A system of one placed body with one joint, and the joint's centre. */
  struct JointedBody
  {
    MultibodySystem system;
    NodalVector start;
    Vector3 centre;

    JointedBody(const JointParameters &joint, const std::string &entries)
      : system({placed_body("b", entries)}, {joint}, LoadParameters(), ".")
      , start(system.placement()[0])
    {
      // either side may be the ground
      const std::size_t first = joint.between.find(": ") + 2;
      const std::string name  = joint.between.substr(
        first,
        std::min(joint.between.find(", ground"), joint.between.size()) - first);
      const BodyDiscretization &body = system.bodies()[0].discretization();
      centre = surface_mean(body, surface(body, name))(start);
    }

    /** Residual after turning about the centre, then moving. */
    Eigen::VectorXd
    residual(const Vector3 &rotation, const Vector3 &translation) const
    {
      const Matrix3 Q = rotation_matrix(rotation);
      return system.constraint_residual(
        {transformed(start, [&](const Vector3 &x) {
          return centre + translation + Q * (x - centre);
        })});
    }

    /** Derivative of the residual, rows x 3, by central differences. */
    Eigen::MatrixXd
    derivative(const bool of_rotation) const
    {
      const double h = 1e-5;
      Eigen::MatrixXd result(system.n_constraints(), dim);
      for (unsigned int i = 0; i < dim; ++i)
        {
          Vector3 step;
          step[i]         = h;
          const Vector3 r = of_rotation ? step : Vector3();
          const Vector3 t = of_rotation ? Vector3() : step;
          result.col(i)   = (residual(r, t) - residual(-r, -t)) / (2 * h);
        }
      return result;
    }
  };
} // namespace

TEST(Joints, RowsAndStart)
{
  const Vector3 axis = placed_body("b", box).rotation; // any vector
  struct Case
  {
    std::string type, directions;
    Vector3 axis;
    unsigned int n_rows;
  };
  const std::vector<Case> cases = {
    {"spherical", "", Vector3(), 3},
    {"mean position", "", Vector3(), 3},
    {"mean position", "y", Vector3(), 1},
    {"mean position", "1,0,0; 0,1,1", Vector3(), 2},
    {"mean rotation", "", Vector3(), 3},
    {"mean rotation", "z", Vector3(), 1},
    {"mean rotation", "1,2,3", Vector3(), 1},
    {"mean rotation", "x, y, z", Vector3(), 3},
    {"fixed", "", Vector3(), 6},
    {"revolute", "", axis, 5}};
  for (const Case &c : cases)
    {
      // the lateral surface resolves all directions
      const JointedBody body(
        joint_parameters(c.type, "b: side, ground", c.directions, c.axis),
        cylinder(3) + tetrahedra);
      EXPECT_EQ(body.system.n_constraints(), c.n_rows) << c.type;
      EXPECT_EQ(body.system.joints()[0].n_constraints(), c.n_rows) << c.type;
      EXPECT_LT(largest(body.residual(Vector3(), Vector3())), 1e-14) << c.type;
    }
}

TEST(Joints, PositionsAndGuides)
{
  const Vector3 across = unit(Vector3({1, 1, 0}));
  const Vector3 along({0.1, -0.1, 0.7}), turn({0.3, 2, -1});
  const JointedBody guide(joint_parameters("mean position",
                                           "b: x max, ground",
                                           "1,1,0"),
                          box + hexahedra);
  EXPECT_LT(largest(guide.residual(turn, along)), 1e-14);
  EXPECT_NEAR(guide.residual(turn, along + 0.3 * across)(0), 0.3, 1e-14);
  EXPECT_NEAR(guide.residual(turn, Vector3({1, 0, 0}))(0),
              1 / std::sqrt(2.),
              1e-14);

  const JointedBody rail(joint_parameters("mean position",
                                          "b: x max, ground",
                                          "1,2,2; 0,3,-3"),
                         box + hexahedra);
  const Vector3 free =
    cross_product_3d(Vector3({1, 2, 2}), Vector3({0, 1, -1}));
  EXPECT_LT(largest(rail.residual(turn, 0.4 * free)), 1e-14);
  EXPECT_NEAR(rail.residual(turn, Vector3({3, 0, 0}))(0), 1, 1e-14);
  EXPECT_NEAR(rail.residual(turn, Vector3({3, 1, 0}))(1),
              std::sqrt(0.5),
              1e-14);

  // directions turn with the second side
  const JointedBody groove(joint_parameters("mean position",
                                            "ground, b: x max",
                                            "1,1,0"),
                           box + hexahedra);
  const Vector3 turned = rotation_matrix(turn) * across;
  EXPECT_LT(largest(groove.residual(turn, along - (along * turned) * turned)),
            1e-14);
  EXPECT_NEAR(groove.residual(turn, 0.3 * turned)(0), -0.3, 1e-14);

  for (const std::string &entries : {box + hexahedra, box + tetrahedra})
    {
      const JointedBody ball(joint_parameters("spherical", "b: z min, ground"),
                             entries);
      EXPECT_LT(largest(ball.residual(turn, Vector3())), 1e-14);
      const Eigen::VectorXd moved = ball.residual(turn, along);
      EXPECT_LT((moved - to_eigen(along)).norm(), 1e-14);
    }
}

TEST(Joints, HingesTurnAboutTheirAxisOnly)
{
  Random random;
  double free_error = 0, angle_error = 0;
  const Matrix3 R0 = rotation_matrix(placed_body("b", box).rotation);
  // axes in the body: normal to a plane surface, in it and oblique to it, and
  // anything on a curved one
  const std::vector<std::tuple<std::string, std::string, Vector3>> cases = {
    {box, "x max", Vector3({1, 0, 0})},
    {box, "x max", Vector3({0, 0.6, 0.8})},
    {box, "y min", Vector3({0, -1, 0})},
    {box, "x max", unit(Vector3({1, 0, 0.5}))},
    {box, "x max", unit(Vector3({-2, 3, 1}))},
    {cylinder(3), "end", unit(Vector3({0, 1e-2, 1}))},
    {cylinder(3), "start", Vector3({0, 0, 1})},
    {cylinder(3), "side", Vector3({0, 0, 1})},
    {cylinder(3), "side", unit(Vector3({1, 2, -2}))}};
  for (const std::string &element : {tetrahedra, hexahedra})
    for (const auto &[mesh, name, axis_in_body] : cases)
      for (const bool revolute : {true, false})
        {
          const Vector3 axis = R0 * axis_in_body;
          const Vector3 t1 =
            unit(cross_product_3d(axis, Vector3({0.3, 0.2, std::sqrt(0.87)})));
          const Vector3 t2          = cross_product_3d(axis, t1);
          const std::string between = "b: " + name + ", ground";
          const JointedBody hinge(
            revolute ? joint_parameters("revolute", between, "", 2.5 * axis)
                     : joint_parameters("mean rotation",
                                        between,
                                        text(t1 + 0.5 * t2) + "; " + text(t2)),
            mesh + element);
          const unsigned int n_rows = hinge.system.n_constraints();
          ASSERT_EQ(n_rows, revolute ? 5 : 2);

          for (unsigned int n = 0; n < 5; ++n)
            free_error =
              std::max(free_error,
                       largest(hinge.residual(random.number(6) * axis,
                                              revolute ? Vector3()
                                                       : random.vector(1))));

          // to first order: positions see translations only, and the two rows
          // of the hinge together the angle across the axis
          const Eigen::MatrixXd of_rotation    = hinge.derivative(true);
          const Eigen::MatrixXd of_translation = hinge.derivative(false);
          if (revolute)
            {
              EXPECT_LT(largest(of_rotation.topRows(3)), 1e-9);
              EXPECT_LT(largest(of_translation.topRows(3) -
                                Eigen::Matrix3d::Identity()),
                        1e-9);
            }
          EXPECT_LT(largest(of_translation.bottomRows(2)), 1e-9);
          const Eigen::Vector3d e = to_eigen(axis);
          const Eigen::MatrixXd expected =
            Eigen::Matrix3d::Identity() - e * e.transpose();
          angle_error = std::max(angle_error,
                                 largest(of_rotation.bottomRows(2).transpose() *
                                           of_rotation.bottomRows(2) -
                                         expected));

          // and the angle itself, not only its derivative
          const double angle = 1e-3;
          const Eigen::VectorXd r =
            hinge.residual(angle * unit(t1 - 0.7 * t2), Vector3());
          EXPECT_NEAR(r.tail(2).norm(), std::sin(angle), 1e-13);
        }
  EXPECT_LT(free_error, 1e-14);
  EXPECT_LT(angle_error, 1e-9);
  report("hinges: residual of free rotations", free_error);
  report("hinges: derivative by the angle", angle_error);
}

TEST(Joints, MeanRotationIsTheAngle)
{
  double error = 0;
  for (const std::string &element : {tetrahedra, hexahedra})
    for (const auto &[mesh, name] :
         std::vector<std::pair<std::string, std::string>>{
           {box, "x min"}, {box, "z max"}, {cylinder(3), "side"}})
      {
        const std::string between = "b: " + name + ", ground";
        const JointedBody all(joint_parameters("mean rotation", between),
                              mesh + element);
        error =
          std::max(error,
                   largest(all.derivative(true) - Eigen::Matrix3d::Identity()));
        error = std::max(error, largest(all.derivative(false)));

        const Vector3 axis = unit(Vector3({1, -2, 3}));
        const JointedBody one(joint_parameters("mean rotation",
                                               between,
                                               text(3. * axis)),
                              mesh + element);
        error =
          std::max(error,
                   largest(one.derivative(true) - to_eigen(axis).transpose()));

        const JointedBody clamp(joint_parameters("fixed", between),
                                mesh + element);
        Eigen::MatrixXd rotation(6, 3), translation(6, 3);
        rotation << Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
        translation << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
        error = std::max(error, largest(clamp.derivative(true) - rotation));
        error = std::max(error, largest(clamp.derivative(false) - translation));
      }
  EXPECT_LT(error, 1e-9);
  report("mean rotation rows: derivative by the angle", error);
}

TEST(Joints, Errors)
{
  const auto make = [](const JointParameters &joint) {
    return [joint]() {
      MultibodySystem({body_parameters("arm", box + hexahedra),
                       body_parameters("leg", box + hexahedra)},
                      {joint},
                      LoadParameters(),
                      ".");
    };
  };
  const auto check = [](const std::string &type,
                        const std::string &directions,
                        const Vector3 &axis) {
    return
      [=]() { joint_parameters(type, "arm: x max, ground", directions, axis); };
  };
  const std::string spherical = "spherical";

  expect_input_error(make(joint_parameters(spherical, "foot: x max, ground")),
                     {"Joints/joint", "'Between'", "'foot'", "arm, leg"});
  expect_input_error(
    make(joint_parameters(spherical, "arm: top, ground")),
    {"Joints/joint", "'Between'", "'top'", "'x max', 'x min'"});
  for (const std::string between :
       {"ground, ground", "ground", "", "arm: x max"})
    expect_input_error(make(joint_parameters(spherical, between)),
                       {"Joints/joint",
                        "'Between'",
                        between.empty() ? "nothing" : "'" + between + "'",
                        "BODY: SURFACE, ground"});
  expect_input_error(make(joint_parameters(spherical, "arm x max, ground")),
                     {"'Between'", "'arm x max'", "BODY: SURFACE"});

  for (const std::string directions :
       {"x, x", "1,0,0; 2,0,0", "1,0,0; 0,1,0; 1,1,0", "0,0,0", "1,2", "x, w"})
    for (const std::string type : {"mean position", "mean rotation"})
      expect_input_error(check(type, directions, Vector3()),
                         {"Joints/joint",
                          "'Directions'",
                          "'" + directions + "'",
                          "linearly independent"});
  expect_input_error(check("fixed", "x", Vector3()),
                     {"'Directions'", "'fixed'"});
  expect_input_error(check("revolute", "", Vector3()),
                     {"'Axis'", "zero vector"});
  expect_input_error(check("fixed", "", Vector3({1, 0, 0})),
                     {"'Axis'", "'revolute'"});
}

TEST(Joints, RepeatedConstraints)
{
  const auto make = [](const std::string &first, const std::string &second) {
    std::vector<JointParameters> joints = {
      joint_parameters("spherical", "arm: x min, ground"),
      joint_parameters("mean position", first, "y, z"),
      joint_parameters("mean position", second, "z"),
      joint_parameters("mean rotation", "arm: z max, ground", "z")};
    joints[0].name = "ball";
    joints[1].name = "guide";
    joints[2].name = "stop";
    joints[3].name = "turn";
    return std::make_unique<MultibodySystem>(
      std::vector<BodyParameters>{body_parameters("arm", box + hexahedra)},
      joints,
      LoadParameters(),
      ".");
  };
  const auto independent = make("arm: x max, ground", "arm: y max, ground");
  EXPECT_EQ(independent->n_repeated_constraints(), 0);
  EXPECT_EQ(independent->repeating_joints(), "");
  const auto once = make("arm: x max, ground", "arm: x max, ground");
  EXPECT_EQ(once->n_repeated_constraints(), 1);
  EXPECT_EQ(once->repeating_joints(), "'guide', 'stop'");
  const auto twice = make("arm: x min, ground", "arm: y max, ground");
  EXPECT_EQ(twice->n_repeated_constraints(), 2);
  EXPECT_EQ(twice->repeating_joints(), "'ball', 'guide'");
  const auto thrice = make("arm: x min, ground", "arm: x min, ground");
  EXPECT_EQ(thrice->n_repeated_constraints(), 3);
  EXPECT_EQ(thrice->repeating_joints(), "'ball', 'guide', 'stop'");

  // a contradiction is the part of the residual that no position removes
  Eigen::VectorXd s = once->marker_values(once->placement());
  EXPECT_LT(once->contradiction(0, s), 1e-15);
  s += Eigen::VectorXd::Random(s.size());
  EXPECT_LT(once->contradiction(0, s), 1e-14);
}

TEST(Joints, ContradictionOfDrives)
{
  // two drives of the same surface: half of their difference remains
  std::vector<JointParameters> joints = {
    joint_parameters("mean position", "arm: x max, ground", "x, y, z"),
    joint_parameters("mean position", "arm: x max, ground", "x")};
  joints[0].displacement = "0.1*t; 0; t";
  joints[1].displacement = "0.4*t; 0; t";
  const MultibodySystem system({body_parameters("arm", box + hexahedra)},
                               joints,
                               LoadParameters(),
                               ".");
  EXPECT_EQ(system.n_repeated_constraints(), 1);
  Eigen::VectorXd s = system.marker_values(system.placement());
  EXPECT_LT(system.contradiction(0, s), 1e-14);
  EXPECT_NEAR(system.contradiction(2, s), 0.3, 1e-13);
  s += Eigen::VectorXd::Random(s.size());
  EXPECT_NEAR(system.contradiction(2, s), 0.3, 1e-13);
}

TEST(Joints, AForkHoldsAnEyeByTheDistanceOfItsCheeks)
{
  // The cheeks are moved against each other across the axis, without a twist of
  // their own: the fork has turned by the angle, whichever side is the first.
  const BodyParameters eye =
    body_parameters("eye",
                    "set Mesh = cylinder\n set Cylinder from = -0.15, 0, 0\n"
                    "set Cylinder to = 0.15, 0, 0\n"
                    "set Cylinder radius = 0.1\n set Cells = 3, 2\n" +
                      hexahedra);
  const BodyParameters fork =
    body_parameters("fork",
                    std::string("set Mesh = ") + ACF_TEST_DATA + "/fork.geo\n" +
                      tetrahedra);
  constexpr double angle = 1e-3;
  for (const std::string between :
       {"eye: side, fork: cheeks", "fork: cheeks, eye: side"})
    {
      const JointParameters joint =
        joint_parameters("revolute", between, "", Vector3({1, 0, 0}));
      const MultibodySystem system({eye, fork}, {joint}, LoadParameters(), ".");
      SystemVector positions = system.placement();
      for (unsigned int i = 0; i < positions[1].size(); i += dim)
        positions[1][i + 1] += angle * positions[1][i];
      const Eigen::VectorXd residual = system.constraint_residual(positions);
      ASSERT_EQ(residual.size(), 5);
      EXPECT_LT(residual.head(3).norm(), 1e-12);
      EXPECT_NEAR(residual.tail(2).norm(), angle, 1e-8);
    }
}
