// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <cmath>

#include <unit/joint_pair.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** The residual, and its rate if the pair moves, are zero at some times. */
  double
  drive_error(const JointedPair &pair,
              const std::function<RigidMotion(double)> &relative)
  {
    const auto common = [](const double t) {
      return RigidMotion{Vector3({1, 2, 3}),
                         t * Vector3({1, -0.2, 0.5}),
                         rotation_matrix(t * Vector3({0.7, 1, -0.4}))};
    };
    const auto values = [&](const double t) {
      return pair.values(relative(t), common(t));
    };
    double error = 0;
    // away from the start, where there are no values for differences
    for (const double t : {0., 0.4, 1.7, 3.})
      {
        error = std::max(error, largest(pair.joint.residual(t, values(t))));
        if (t == 0)
          continue;
        const double h          = 1e-4; // differences of fourth order
        const Eigen::VectorXd v = (8 * (values(t + h) - values(t - h)) -
                                   values(t + 2 * h) + values(t - 2 * h)) /
                                  (12 * h);
        // far more round-off: a weight that makes the two comparable
        error = std::max(error,
                         1e-2 * largest(pair.joint.jacobian(values(t)) * v -
                                        pair.joint.drive_rates(t)));
      }
    return error;
  }

  std::string
  number(const double x)
  {
    std::ostringstream out;
    out.precision(17);
    out << x;
    return out.str();
  }
} // namespace

TEST(Drives, MotionsAboutAndAlongAxes)
{
  const std::vector<Body> bodies = make_bodies(Vector3({0, 0, 0.6}));
  double error                   = 0;
  const Matrix3 R                = rotation_matrix(turn_a);
  for (const Vector3 &axis :
       {R * Vector3({1, 0, 0}), unit(Vector3({1, 2, -0.7}))})
    for (const std::string between : {"a: x max, b: side",
                                      "b: side, a: x max",
                                      "a: x max, ground",
                                      "ground, a: x max"})
      {
        SCOPED_TRACE(between);
        const auto motion = [&](const double angle, const double distance) {
          return RigidMotion{place,
                             distance * axis,
                             rotation_matrix(angle * axis)};
        };
        // more than a half turn
        JointParameters parameters =
          joint_parameters("revolute", between, "", axis);
        parameters.angle = "2*sin(t) + 1.5*t";
        parameters.check();
        const JointedPair hinge(parameters, bodies);
        EXPECT_EQ(hinge.joint.n_constraints(), 6);
        error = std::max(error, drive_error(hinge, [&](const double t) {
                           return motion(2 * std::sin(t) + 1.5 * t, 0);
                         }));
        // the residual is the angle that is missing
        EXPECT_NEAR(hinge.residual(motion(0.3, 0), RigidMotion(), 0)(5),
                    0.3,
                    1e-13);

        parameters.angle            = "";
        parameters.angular_velocity = "3*t^2 + cos(t)";
        parameters.check();
        error =
          std::max(error,
                   drive_error(JointedPair(parameters, bodies),
                               [&](const double t) {
                                 return motion(t * t * t + std::sin(t), 0);
                               }));

        parameters.type         = "cylindrical";
        parameters.displacement = "0.4*sin(t)";
        parameters.check();
        error = std::max(error,
                         drive_error(JointedPair(parameters, bodies),
                                     [&](const double t) {
                                       return motion(t * t * t + std::sin(t),
                                                     0.4 * std::sin(t));
                                     }));

        parameters.type             = "prismatic";
        parameters.angular_velocity = "";
        parameters.check();
        error = std::max(error,
                         drive_error(JointedPair(parameters, bodies),
                                     [&](const double t) {
                                       return motion(0, 0.4 * std::sin(t));
                                     }));
      }
  EXPECT_LT(error, 1e-12);
  report("driven joints about and along axes", error);
}

TEST(Drives, MotionsOfTheGroundAndLengths)
{
  const std::vector<Body> bodies = make_bodies(Vector3({0, 0, 0.6}));
  const auto moved               = [](const double t) {
    return Vector3({std::sin(t), t * t, -0.3 * t});
  };
  double error = 0;
  for (const std::string type : {"spherical", "fixed", "mean position"})
    {
      JointParameters parameters = joint_parameters(type, "a: x max, ground");
      if (type == "mean position")
        parameters.directions = "1,0,0; 0,1,1";
      const auto relative = [&](const double t) {
        const Vector3 axis({1, 2, 3});
        return RigidMotion{place,
                           moved(t),
                           rotation_matrix(type == "fixed" ? Vector3()
                                                           : t * axis)};
      };
      parameters.displacement = "sin(t); t^2; -0.3*t";
      parameters.check();
      error =
        std::max(error, drive_error(JointedPair(parameters, bodies), relative));

      parameters.displacement = "";
      parameters.position = number(place[0]) + "+sin(t); " + number(place[1]) +
                            "+t^2; " + number(place[2]) + "-0.3*t";
      parameters.check();
      error =
        std::max(error, drive_error(JointedPair(parameters, bodies), relative));
    }

  const Vector3 offset({0.3, -0.5, 0.8});
  const std::vector<Body> apart = make_bodies(Vector3({0, 0, 0.6}), -offset);
  JointParameters rod = joint_parameters("distance", "a: x max, b: side");
  rod.length          = number(offset.norm()) + "*(1 + 0.2*t)";
  rod.check();
  error =
    std::max(error, drive_error(JointedPair(rod, apart), [&](const double t) {
               return RigidMotion{place, 0.2 * t * offset, identity_matrix()};
             }));
  EXPECT_LT(error, 1e-12);
  report("joints that follow positions and lengths", error);
}

TEST(Drives, JumpsAtTheStartAreErrors)
{
  const std::vector<Body> bodies = make_bodies(Vector3({0, 0, 0.6}));
  const std::vector<Body> apart =
    make_bodies(Vector3({0, 0, 0.6}), Vector3({0.3, 0, 0.4}));
  const Vector3 axis({0, 0, 1});
  const auto expect_error = [](const JointParameters &joint,
                               const std::vector<Body> &bodies,
                               const std::vector<std::string> &parts) {
    joint.check();
    expect_input_error([&]() { make_joint(joint, bodies); }, parts);
  };
  JointParameters hinge =
    joint_parameters("revolute", "a: x max, b: side", "", axis);
  hinge.angle = "0.1 + t";
  expect_error(hinge, bodies, {"Joints/joint", "'Angle'", "0.1 rad", "zero"});
  JointParameters slider =
    joint_parameters("prismatic", "a: x max, ground", "", axis);
  slider.displacement = "0.2*cos(t)";
  expect_error(slider,
               bodies,
               {"Joints/joint", "'Displacement'", "0.2 m", "zero"});
  JointParameters ball = joint_parameters("spherical", "a: x max, ground");
  ball.displacement    = "0; 0.3; 0.4";
  expect_error(ball,
               bodies,
               {"Joints/joint", "'Displacement'", "0, 0.3, 0.4", "0.5 m"});
  ball.displacement = "";
  ball.position     = "0.4; -1.2; 1.5";
  expect_error(ball,
               bodies,
               {"Joints/joint", "'Position'", "0.5 m", "0.4, -1.2, 2 m"});
  ball.between  = "a: x max, b: side";
  ball.position = "0.4; -1.2; 2";
  expect_error(ball, bodies, {"Joints/joint", "'Position'", "ground"});
  JointParameters rod = joint_parameters("distance", "a: x max, b: side");
  rod.length          = "0.6 + t";
  expect_error(rod, apart, {"Joints/joint", "'Length'", "0.6 m", "0.5 m"});
}

TEST(JointParameters, Errors)
{
  using Change       = std::function<void(JointParameters &)>;
  const auto refused = [](const std::string &type,
                          const Change &change,
                          const std::string &entry,
                          const std::string &text = "") {
    JointParameters joint;
    joint.name    = "j";
    joint.type    = type;
    joint.between = "a: x max, ground";
    if (type == "revolute" || type == "prismatic" || type == "universal" ||
        type == "planar")
      joint.axis = Vector3({0, 0, 2});
    change(joint);
    expect_input_error([&]() { joint.check(); },
                       {"Joints/j", "'" + entry + "'", text});
  };
  const auto axis = [](const Vector3 &v) {
    return [v](JointParameters &joint) { joint.axis = v; };
  };
  const auto cross = [](const Vector3 &v) {
    return [v](JointParameters &joint) { joint.cross_axis = v; };
  };
  const auto free = [](const std::string &text) {
    return [text](JointParameters &joint) { joint.free = text; };
  };
  for (const std::string type : {"prismatic", "universal", "planar"})
    refused(type, axis(Vector3()), "Axis", "zero vector");
  for (const std::string type : {"spherical", "distance", "mean rotation"})
    refused(type, axis(Vector3({1, 0, 0})), "Axis", "'" + type + "'");
  refused("fixed", cross(Vector3({1, 0, 0})), "Cross axis");
  refused("universal", cross(Vector3()), "Cross axis");
  refused("universal", cross(Vector3({1, 0, 1e-3})), "Cross axis");
  refused("revolute", cross(Vector3({0, 0, -1})), "Cross axis");
  refused("planar", free("x"), "Free", "'x'");
  for (const std::string text : {"rotation z", "w", "rotation", "x, x"})
    refused("revolute", free(text), "Free", "'revolute'");
  refused("distance", free("x"), "Free", "Directions");
  refused("mean rotation", free("rotation x"), "Free", "Directions");

  const auto angle = [](JointParameters &joint) { joint.angle = "t"; };
  const auto speed = [](JointParameters &joint) {
    joint.angular_velocity = "t";
  };
  const auto slide = [](JointParameters &joint) { joint.displacement = "t"; };
  const auto moved = [](JointParameters &joint) {
    joint.displacement = "t;0;0";
  };
  const auto place = [](JointParameters &joint) { joint.position = "t;0;0"; };
  for (const std::string type : {"spherical", "fixed", "prismatic"})
    {
      refused(type, angle, "Angle", "axis");
      refused(type, speed, "Angular velocity", "axis");
    }
  refused(
    "revolute",
    [&](JointParameters &joint) {
      angle(joint);
      speed(joint);
    },
    "Angular velocity",
    "beside an Angle");
  for (const std::string type : {"spherical", "revolute", "planar"})
    refused(type, slide, "Displacement", "axis");
  for (const std::string type : {"distance", "mean rotation"})
    {
      refused(type, moved, "Displacement", "blocked position");
      refused(type, place, "Position", "blocked position");
    }
  refused(
    "spherical",
    [&](JointParameters &joint) {
      moved(joint);
      place(joint);
    },
    "Position",
    "beside a Displacement");
  refused(
    "spherical",
    [](JointParameters &joint) { joint.length = "1"; },
    "Length",
    "'distance'");
}
