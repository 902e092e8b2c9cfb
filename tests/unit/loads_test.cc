// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/multibody_system.h>

#include <cmath>

#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const Vector3 place({0.4, -1.2, 2}), turn({0.4, -1.1, 2});

  SurfaceLoadParameters
  load(const std::string &type,
       const std::string &on,
       const std::string &value,
       const bool follows = false)
  {
    SurfaceLoadParameters parameters;
    parameters.name    = "l";
    parameters.type    = type;
    parameters.on      = on;
    parameters.value   = value;
    parameters.follows = follows;
    return parameters;
  }

  /** A box with "x max" around @p place, loaded. */
  SystemParameters
  loaded_box(const std::vector<SurfaceLoadParameters> &loads)
  {
    SystemParameters parameters;
    parameters.bodies = {
      body_at("b", box_mesh, turn, Vector3({1, 0, 1.5}), place),
      body_at("c", cylinder_mesh, Vector3(), Vector3(), Vector3())};
    parameters.surface_loads = loads;
    for (const SurfaceLoadParameters &load : loads)
      load.check();
    return parameters;
  }

  /** Resultant about a point that is fixed to the body. */
  Resultant
  resultant(const MultibodySystem &system,
            const double t,
            const RigidMotion &motion,
            const Vector3 &point,
            const unsigned int body = 0)
  {
    const NodalVector x = transformed(system.placement()[body], motion);
    NodalVector force(x.size());
    system.add_loads(body, t, x, force);
    Resultant result;
    result.add(x, force, motion(point));
    return result;
  }

  void
  expect_resultant(const Resultant &result,
                   const Vector3 &force,
                   const Vector3 &moment)
  {
    EXPECT_LT((result.force - force).norm(), 1e-13);
    EXPECT_LT((result.moment - moment).norm(), 1e-13);
  }
} // namespace

TEST(Loads, ForcesTorquesAndTractions)
{
  Random random;
  const double t = 0.5;
  const Vector3 value({1 + t, -2, t * t});
  const double area = 3; // of "x max"
  for (const bool follows : {false, true})
    for (unsigned int n = 0; n < 3; ++n)
      {
        const RigidMotion motion =
          n == 0 ? RigidMotion() : random_motion(random);
        const Vector3 m = follows ? motion.rotation * value : value;
        const auto of   = [&](const std::string &type) {
          const MultibodySystem system(
            loaded_box({load(type, "b: x max", "1+t; -2; t^2", follows)}), ".");
          // nothing on the other body
          expect_resultant(resultant(system, t, motion, place, 1),
                           Vector3(),
                           Vector3());
          return resultant(system, t, motion, place);
        };
        expect_resultant(of("force"), m, Vector3());
        expect_resultant(of("torque"), Vector3(), m);
        expect_resultant(of("traction"), area * m, Vector3());
      }
}

TEST(Loads, WorkOnFields)
{
  const auto work = [](const SurfaceLoadParameters &load, const auto &field) {
    const MultibodySystem system(loaded_box({load}), ".");
    const NodalVector x = system.placement()[0];
    NodalVector force(x.size());
    system.add_loads(0, 0, x, force);
    const NodalVector &X = system.bodies()[0].operators().reference_positions;
    return force * transformed(X, field);
  };
  // forces and tractions: means of 1/12 and 3/4 of squares on "x max"
  const auto squares = [](const Vector3 &X) {
    return Vector3({X[1] * X[1], (X[2] - 1.5) * (X[2] - 1.5), X[0]});
  };
  EXPECT_NEAR(work(load("force", "b: x max", "1;2;3"), squares),
              1. / 12 + 2 * 0.75 + 3,
              1e-13);
  EXPECT_NEAR(work(load("traction", "b: x max", "1;2;3"), squares),
              3 * (1. / 12 + 2 * 0.75 + 3),
              1e-13);

  // torques: rotations, but no stretch of the surface
  const Matrix3 R = rotation_matrix(turn);
  const Vector3 angle({0.1, -0.3, 0.2}), torque({4, 5, 6});
  EXPECT_NEAR(work(load("torque", "b: x max", "4;5;6"),
                   [&](const Vector3 &X) {
                     return cross_product_3d(angle, R * X);
                   }),
              angle * torque,
              1e-13);
  EXPECT_NEAR(work(load("torque", "b: x max", "4;5;6"),
                   [&](const Vector3 &X) {
                     return R * Vector3({3 * X[0], 2 * X[1], -X[2]});
                   }),
              0,
              1e-13);
}

TEST(Loads, Pressure)
{
  Random random;
  const double t = 0.25;
  for (unsigned int n = 0; n < 3; ++n)
    {
      const RigidMotion motion = n == 0 ? RigidMotion() : random_motion(random);
      const Matrix3 R          = motion.rotation * rotation_matrix(turn);
      const MultibodySystem face(
        loaded_box({load("pressure", "b: x max", "8*t")}), ".");
      expect_resultant(resultant(face, t, motion, place),
                       -2 * 3 * (R * Vector3({1, 0, 0})),
                       Vector3());

      std::vector<SurfaceLoadParameters> loads;
      for (const std::string name : {"b: x min",
                                     "b: x max",
                                     "b: y min",
                                     "b: y max",
                                     "b: z min",
                                     "b: z max",
                                     "c: side",
                                     "c: start",
                                     "c: end"})
        loads.push_back(load("pressure", name, "8*t"));
      const MultibodySystem closed(loaded_box(loads), ".");
      for (const unsigned int body : {0, 1})
        expect_resultant(resultant(closed, t, motion, place, body),
                         Vector3(),
                         Vector3());
    }

  // work on a growing box: p times the change of the volume
  std::vector<SurfaceLoadParameters> loads;
  for (const std::string name :
       {"x min", "x max", "y min", "y max", "z min", "z max"})
    loads.push_back(load("pressure", "b: " + name, "3"));
  const MultibodySystem system(loaded_box(loads), ".");
  const NodalVector x = system.placement()[0];
  NodalVector force(x.size());
  system.add_loads(0, 0, x, force);
  EXPECT_NEAR(force * x, -3 * 3 * 6, 1e-12); // div x = 3, volume 6
}

TEST(Loads, GravityFactor)
{
  SystemParameters parameters     = loaded_box({});
  parameters.loads.gravity        = Vector3({1, -3, -9.81});
  parameters.loads.gravity_factor = "1 + 2*t";
  const MultibodySystem system(parameters, ".");
  const Vector3 centre =
    place + rotation_matrix(turn) * Vector3({-1, 0, 0}); // of mass
  for (const double t : {0., 0.7})
    {
      const double mass = 1200 * 6;
      const Vector3 g   = (1 + 2 * t) * parameters.loads.gravity;
      EXPECT_LT((system.gravity(t) - g).norm(), 1e-14);
      const Resultant weight = resultant(system, t, RigidMotion(), centre);
      EXPECT_LT((weight.force - mass * g).norm(), 1e-12 * mass);
      EXPECT_LT(weight.moment.norm(), 1e-12 * mass);
      SystemState state       = system.initial_state();
      state.time              = t;
      SystemParameters single = parameters;
      single.bodies.pop_back();
      EXPECT_NEAR(MultibodySystem(single, ".").energy(state).potential,
                  -mass * (g * centre),
                  1e-11 * mass);
    }
  parameters.loads.gravity_factor = "x";
  expect_input_error([&]() { MultibodySystem(parameters, "."); },
                     {"Loads", "'Gravity factor'", "'x'"});
}

TEST(Loads, Errors)
{
  const auto refused = [](const SurfaceLoadParameters &parameters,
                          const std::string &entry,
                          const std::string &text) {
    expect_input_error(
      [&]() { MultibodySystem(loaded_box({parameters}), "."); },
      {"Loads/l", "'" + entry + "'", text});
  };
  refused(load("force", "b: x max", ""), "Value", "three");
  refused(load("force", "b: x max", "1"), "Value", "three");
  refused(load("torque", "b: x max", "1; 2; x"), "Value", "'x'");
  refused(load("pressure", "b: x max", ""), "Value", "expression");
  refused(load("pressure", "b: x max", "1; 2; 3"), "Value", "expression");
  refused(load("pressure", "b: x max", "1", true), "Direction", "pressure");
  refused(load("force", "b: top", "1; 2; 3"), "On", "'top'");
  refused(load("force", "d: top", "1; 2; 3"), "On", "'d'");
  refused(load("force", "ground", "1; 2; 3"), "On", "'ground'");
}
