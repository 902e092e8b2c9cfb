// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The start of a simulation: static equilibrium, and natural modes.

#include <acf/base/exceptions.h>
#include <acf/model.h>
#include <acf/simulation.h>
#include <acf/time/equilibrium.h>
#include <acf/time/modes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "recorded_run.h"
#include "reference/planar_pendulum.h"

namespace
{
  using namespace ACF;

  void
  report(const std::string &label, const double value)
  {
    std::cout << "[ measured ] " << label << ": " << value << std::endl;
  }

  // A beam along y, 1 m long, 0.03 m wide in x and 0.05 m high in z.
  struct BeamText
  {
    std::string name    = "beam";
    std::string cells   = "1, 20, 2";
    std::string modulus = "2.1e11";
    std::string placement;

    std::string
    text() const
    {
      return "subsection " + name + R"(
        set Mesh            = box
        set Element         = hexahedron
        set Box from        = -0.015, 0, -0.025
        set Box to          =  0.015, 1,  0.025
        set Cells           = )" +
             cells + R"(
        set Young's modulus = )" +
             modulus + R"(
        set Poisson's ratio = 0.3
        set Density         = 7800
        )" + placement +
             "\nend\n";
    }
  };

  constexpr double length  = 1;
  constexpr double width   = 0.03;
  constexpr double height  = 0.05;
  constexpr double mass    = 7800 * length * width * height;
  constexpr double gravity = 9.81;

  Reference::PlanarBeam
  reference_beam(const double in_plane, const double across)
  {
    Reference::PlanarBeam beam;
    beam.length         = length;
    beam.height         = in_plane;
    beam.width          = across;
    beam.youngs_modulus = 2.1e11;
    beam.poissons_ratio = 0.3;
    beam.density        = 7800;
    return beam;
  }

  std::string
  section(const std::string &name, const std::string &entries)
  {
    return "subsection " + name + "\n" + entries + "\nend\n";
  }

  std::string
  one_beam(const BeamText &beam, const std::string &rest)
  {
    return section("Bodies", "set Names = " + beam.name + "\n" + beam.text()) +
           rest;
  }

  std::string
  joint(const std::string &entries)
  {
    return section("Joints", "set Names = joint\n" + section("joint", entries));
  }

  const std::string clamp =
    joint("set Type = fixed\nset Between = beam: y min, ground");
  const std::string hinge = joint(
    "set Type = revolute\nset Between = beam: y min, ground\nset Axis = 1,0,0");
  const std::string weight      = section("Loads", "set Gravity = 0, 0, -9.81");
  const std::string equilibrium = section("Start", "set Equilibrium = true");
  const std::string static_run =
    section("Time integration", "set End time = 0");

  // A model at its start.
  struct StartedModel
  {
    explicit StartedModel(const std::string &text)
      : model(read_model(
          ParameterFile::from_text(text + static_run, {"Modes/Number=1"})))
      , system(model.system, model.directory)
    {
      FactorizationCache cache(statistics);
      state = initial_state(
        system, model.start, model.time.step_size, cache, statistics, log);
    }

    NaturalModes
    modes(const unsigned int number)
    {
      return natural_modes(system, state, number, statistics);
    }

    // Mean position of a surface of the first body's end.
    Vector3
    position(const unsigned int body, const std::string &surface) const
    {
      ProbeParameters parameters;
      parameters.name   = "p";
      parameters.of     = system.bodies()[body].name() + ": " + surface;
      const auto values = make_probe(parameters, system)->evaluate(state);
      return Vector3({values[0], values[1], values[2]});
    }

    Model model;
    const MultibodySystem system;
    Statistics statistics;
    std::ostringstream log;
    SystemState state;
  };

  // p - f - S^T (D^T lambda - Q)
  SystemVector
  unbalanced_forces(const MultibodySystem &system, const SystemState &state)
  {
    const Eigen::VectorXd zero =
      Eigen::VectorXd::Zero(system.n_marker_values());
    const Eigen::VectorXd F =
      system.marker_forces(0,
                           system.marker_values(state.positions),
                           zero,
                           zero,
                           state.multipliers,
                           state.law_values);
    SystemVector result(state.positions);
    for (unsigned int b = 0; b < result.size(); ++b)
      {
        NodalVector scratch(result[b].size());
        reduced_strain_force(system.bodies()[b].operators(),
                             system.bodies()[b].rotation_measure(),
                             state.positions[b],
                             result[b],
                             scratch);
        result[b] *= -1;
        system.add_loads(b, 0, state.positions[b], result[b]);
        system.add_marker_forces(b, F, result[b]);
      }
    return result;
  }

  SystemVector
  random_vector(const SystemVector &like,
                const double size,
                std::mt19937 &generator)
  {
    SystemVector result(like);
    for (NodalVector &x : result)
      for (double &value : x)
        value = size * (generator() / double(std::mt19937::max()) - 0.5);
    return result;
  }

  double
  largest(const SystemVector &x)
  {
    double result = 0;
    for (const NodalVector &body : x)
      result = std::max(result, double(body.linfty_norm()));
    return result;
  }

  SystemVector
  sum(const double a,
      const SystemVector &x,
      const double b,
      const SystemVector &y)
  {
    SystemVector result(x);
    for (unsigned int k = 0; k < x.size(); ++k)
      {
        result[k] *= a;
        result[k].add(b, y[k]);
      }
    return result;
  }
} // namespace



// Two bodies, a nonlinear joint, a spring with a large angle and a lumped mass
// in an arbitrary deformed state.
static const std::string mechanism =
  section(
    "Bodies",
    "set Names = first, second\n" +
      BeamText{"first", "1, 3, 1", "2.1e8", ""}.text() +
      BeamText{"second", "1, 2, 1", "2.1e8", "set Position = 0, 1, 0"}.text()) +
  section("Joints",
          "set Names = pin, slider\n" +
            section("pin",
                    "set Type = revolute\nset Axis = 1,0,0\n"
                    "set Between = first: y min, ground") +
            section("slider",
                    "set Type = point on line\nset Axis = 0,1,0.2\n"
                    "set Between = second: y min, first: y max")) +
  section("Force elements",
          "set Names = spring, torsion\n" +
            section("spring",
                    "set Between = second: y max, ground\n"
                    "set Ground point = 0.3, 2.5, 1\nset Stiffness = 3000\n"
                    "set Damping = 5\nset Actuation = 20") +
            section("torsion",
                    "set Type = torsional spring\nset Axis = 1,0,0\n"
                    "set Between = second: y max, first: y max\n"
                    "set Stiffness = 100\nset Free angle = 0.4")) +
  section("Masses",
          "set Names = lump\n" +
            section("lump", "set On = second: y max\nset Mass = 3")) +
  weight;



TEST(TangentSystem, IsTheDerivativeOfTheForces)
{
  StartedModel start(mechanism);
  std::mt19937 generator;
  SystemState state = start.state;
  state.positions =
    sum(1, state.positions, 1, random_vector(state.positions, 0.01, generator));
  for (double &lambda : state.multipliers)
    lambda = 1e3 * (generator() / double(std::mt19937::max()) - 0.5);

  TangentSystem tangent(start.system, start.statistics);
  ASSERT_TRUE(tangent.linearize(state));
  double error = 0;
  for (unsigned int k = 0; k < 5; ++k)
    {
      const SystemVector direction =
        random_vector(state.positions, 1, generator);
      const double h     = 1e-4;
      const auto central = [&](const double size) {
        SystemState right = state, left = state;
        right.positions = sum(1, state.positions, size, direction);
        left.positions  = sum(1, state.positions, -size, direction);
        return sum(-1 / (2 * size),
                   unbalanced_forces(start.system, right),
                   1 / (2 * size),
                   unbalanced_forces(start.system, left));
      };
      const SystemVector exact =
        sum(4. / 3, central(h), -1. / 3, central(2 * h));
      SystemVector product(exact);
      tangent.apply_stiffness(product, direction);
      error =
        std::max(error, largest(sum(1, product, -1, exact)) / largest(exact));
    }
  report("K_T against differences", error);
  EXPECT_LT(error, 1e-9); // differences of fourth order: round-off
}



TEST(TangentSystem, SolvesTheSaddlePointSystem)
{
  StartedModel start(mechanism);
  std::mt19937 generator;
  SystemState state = start.state;
  state.positions =
    sum(1, state.positions, 1, random_vector(state.positions, 0.01, generator));
  for (double &lambda : state.multipliers)
    lambda = 1e3 * (generator() / double(std::mt19937::max()) - 0.5);

  TangentSystem tangent(start.system, start.statistics);
  ASSERT_TRUE(tangent.linearize(state));
  const double shift = slow_squared_rate(start.system);
  tangent.factorize(shift);
  const SystemVector r = random_vector(state.positions, 10, generator);
  Eigen::VectorXd g(start.system.n_constraints());
  for (double &value : g)
    value = 1e-3 * (generator() / double(std::mt19937::max()) - 0.5);
  SystemVector w     = r;
  Eigen::VectorXd mu = g;
  tangent.solve(w, mu);

  // K w + S^T D^T mu - r, where the forces of joints are linear in mu
  SystemVector residual(r), inertia(r);
  tangent.apply_stiffness(residual, w);
  tangent.apply_mass(inertia, w);
  residual          = sum(1, residual, shift, inertia);
  residual          = sum(1, residual, -1, r);
  SystemState other = state;
  other.multipliers += mu;
  residual = sum(1, residual, -1, unbalanced_forces(start.system, other));
  residual = sum(1, residual, 1, unbalanced_forces(start.system, state));
  const Eigen::VectorXd gap =
    start.system.constraint_velocity(0,
                                     start.system.marker_values(
                                       state.positions),
                                     start.system.marker_values(w)) -
    g;

  // Backward errors. Without joints the bodies would move by 1e5 times as much,
  // which costs the solution as many digits.
  SystemVector stiff(r);
  tangent.apply_stiffness(stiff, r);
  const double size = largest(stiff) / largest(r) * largest(w);
  report("backward error of the forces", largest(residual) / size);
  report("backward error of the constraints",
         gap.lpNorm<Eigen::Infinity>() / largest(w));
  EXPECT_LT(largest(residual), 1e-9 * size);
  EXPECT_LT(gap.lpNorm<Eigen::Infinity>(), 1e-8 * largest(w));
}



TEST(Equilibrium, CantileverUnderGravity)
{
  StartedModel start(one_beam({}, clamp + weight + equilibrium));
  const double I          = width * std::pow(height, 3) / 12;
  const double A          = width * height;
  const double q          = mass / length * gravity;
  const double E          = 2.1e11;
  const double kappa      = Reference::cowper_coefficient(0.3);
  const double deflection = q * std::pow(length, 4) / (8 * E * I) +
                            q * length * length / (2 * kappa * E / 2.6 * A);
  const double found = -start.position(0, "y max")[2];
  report("deflection against Timoshenko", found / deflection - 1);
  // the clamp holds the mean rotation of the section only
  EXPECT_NEAR(found / deflection, 1, 2e-3);

  // weight and moment at the clamp
  const auto reaction = start.system.reaction(0, start.state);
  EXPECT_NEAR(reaction.force[2] / (mass * gravity), 1, 1e-9);
  EXPECT_NEAR(reaction.moment[0] / (mass * gravity * length / 2), 1, 1e-6);
  EXPECT_NE(start.log.str().find("Static equilibrium found with"),
            std::string::npos);
  EXPECT_LE(start.statistics.equilibrium_iterations, 8U);
  report("iterations", start.statistics.equilibrium_iterations);
}



// 1 m x 1 mm x 1 mm: rounding errors of the forces move it by more than the
// tolerance.
TEST(Equilibrium, SlendernessThousand)
{
  BeamText rod;
  rod.cells          = "1, 8, 1";
  const double side  = 1e-3;
  const double E     = 2.1e11;
  const double exact = 1e-3;
  const double I     = std::pow(side, 4) / 12;
  const double force = 3 * E * I * exact;
  std::string text   = one_beam(
    rod,
    clamp +
      "subsection Loads\n set Names = tip\n subsection tip\n"
        "  set Type = force\n  set On = beam: y max\n  set Value = 0; 0; " +
      std::to_string(-1e6 * force) + "e-6\n end\nend\n" + equilibrium);
  const auto replace = [&text](const std::string &from, const std::string &to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("-0.015, 0, -0.025", "-0.0005, 0, -0.0005");
  replace("0.015, 1,  0.025", "0.0005, 1, 0.0005");
  StartedModel start(text);
  const double found = -start.position(0, "y max")[2];
  // eight cells: 0.5 %
  EXPECT_NEAR(found / exact, 1, 7e-3);
  EXPECT_LE(start.statistics.equilibrium_iterations, 30U);
  report("deflection", found / exact);
  report("iterations", start.statistics.equilibrium_iterations);
}



TEST(Equilibrium, PendulumsFindTheHangingPosition)
{
  // angles to the horizontal; the second is above the hinge
  for (const std::string modulus : {"2.1e11", "2.1e8"})
    for (const std::string angle : {"-1.0472", "1.0472", "1.5"})
      {
        BeamText beam;
        beam.cells     = "1, 6, 1";
        beam.modulus   = modulus;
        beam.placement = "set Rotation = " + angle + ", 0, 0";
        StartedModel start(one_beam(beam, hinge + weight + equilibrium));
        const Vector3 tip = start.position(0, "y max");
        report("E = " + modulus + ", angle " + angle + ", iterations",
               start.statistics.equilibrium_iterations);
        // a longer beam hangs lower: rho g L^2 / (2 E)
        EXPECT_NEAR(tip[2],
                    -length - 7800 * gravity / (2 * std::stod(modulus)),
                    1e-6);
        EXPECT_NEAR(tip[1], 0, 1e-8);
        EXPECT_NEAR(start.system.reaction(0, start.state).force[2] /
                      (mass * gravity),
                    1,
                    1e-9);
        EXPECT_LT(start.statistics.equilibrium_iterations, 150U);
      }
}



TEST(Equilibrium, SpringsCarryAMechanism)
{
  // k angle = m g L/2 cos(angle), the angle downwards
  const double k = 30;
  BeamText beam;
  beam.cells   = "1, 4, 1";
  double angle = 0.5;
  for (unsigned int i = 0; i < 50; ++i)
    angle -= (k * angle - mass * gravity * length / 2 * std::cos(angle)) /
             (k + mass * gravity * length / 2 * std::sin(angle));
  const std::string spring =
    section("Force elements",
            "set Names = spring\n" +
              section("spring",
                      "set Type = torsional spring\nset Axis = 1,0,0\n"
                      "set Between = beam: y min, ground\nset Stiffness = 30"));
  for (const std::string load_steps : {"1", "4"})
    {
      StartedModel start(one_beam(
        beam,
        hinge + weight + spring +
          section("Start",
                  "set Equilibrium = true\nset Load steps = " + load_steps)));
      const Vector3 tip  = start.position(0, "y max");
      const double found = std::atan2(-tip[2], tip[1]);
      report("angle of the rigid bar, error", found - angle);
      report("iterations", start.statistics.equilibrium_iterations);
      EXPECT_NEAR(found, angle, 1e-4); // the steel bar bends by 2e-5 m
    }
}



TEST(Equilibrium, OverdeterminedDoor)
{
  // three hinges about the vertical axis of the beam, two of them the same; a
  // spring with an actuation turns it
  BeamText beam;
  beam.cells          = "1, 4, 1";
  beam.placement      = "set Rotation = 1.5707963267948966, 0, 0";
  const auto hinge_at = [](const std::string &name,
                           const std::string &surface) {
    return section(
      name,
      "set Type = revolute\nset Axis = 0,0,1\nset Between = beam: " + surface +
        ", ground");
  };
  StartedModel start(one_beam(
    beam,
    section("Joints",
            "set Names = a, b, c\n" + hinge_at("a", "y min") +
              hinge_at("b", "y min") + hinge_at("c", "y max")) +
      section("Force elements",
              "set Names = spring\n" +
                section("spring",
                        "set Type = torsional spring\nset Axis = 0,0,1\n"
                        "set Between = beam: y min, ground\n"
                        "set Stiffness = 10\nset Actuation = 5")) +
      weight + equilibrium));
  EXPECT_EQ(start.system.n_repeated_constraints(), 5U);
  EXPECT_NEAR(start.state.law_values(0), 0.5, 1e-8);
  Vector3 force;
  for (unsigned int j = 0; j < 3; ++j)
    force += start.system.reaction(j, start.state).force;
  EXPECT_NEAR(force[2] / (mass * gravity), 1, 1e-8);
  EXPECT_NEAR(start.system.reaction(0, start.state).force[2],
              start.system.reaction(1, start.state).force[2],
              1e-6 * mass * gravity);
}



TEST(Equilibrium, StaysAtRest)
{
  StartedModel start(mechanism + equilibrium);
  Model model          = start.model;
  model.time.end_time  = 0.02;
  model.time.step_size = 1e-3;
  std::ostringstream nowhere;
  Progress progress(nowhere, false, model.time.end_time);
  Tests::Recorder recorder(start.system, {}, 0);
  run_time_loop(start.system,
                start.state,
                model.time,
                {&recorder},
                progress,
                start.statistics);
  const SystemVector change =
    sum(1, recorder.states.back().positions, -1, start.state.positions);
  report("displacement in 20 ms", largest(change));
  report("iterations", start.statistics.equilibrium_iterations);
  // without equilibrium g t^2 / 2 = 2e-3 m
  EXPECT_LT(largest(change), 1e-8);
  EXPECT_GT(largest(sum(1,
                        start.state.positions,
                        -1,
                        start.system.initial_state().positions)),
            1e-2);
}



TEST(Equilibrium, ErrorsNameTheBody)
{
  BeamText beam;
  beam.cells = "1, 2, 1";
  try
    {
      StartedModel start(one_beam(beam, weight + equilibrium));
      FAIL() << "a falling body has no equilibrium";
    }
  catch (const SimulationError &error)
    {
      EXPECT_NE(std::string(error.what()).find("'beam'"), std::string::npos);
      std::cout << error.what() << std::endl;
    }
  // a motor without a spring
  try
    {
      StartedModel start(one_beam(
        beam,
        hinge + equilibrium +
          section("Force elements",
                  "set Names = motor\n" +
                    section("motor",
                            "set Type = torsional spring\nset Axis = 1,0,0\n"
                            "set Between = beam: y min, ground\n"
                            "set Actuation = 5"))));
      FAIL() << "a motor has no equilibrium";
    }
  catch (const SimulationError &error)
    {
      EXPECT_NE(std::string(error.what()).find("'beam'"), std::string::npos);
      std::cout << error.what() << std::endl;
    }
  EXPECT_THROW(StartedModel(
                 one_beam(beam, section("Start", "set Load steps = 2"))),
               InputError);
}



TEST(Modes, CantileverAgainstTimoshenko)
{
  StartedModel start(one_beam({}, clamp));
  const NaturalModes found = start.modes(8);
  Reference::BeamOptions options;
  std::vector<double> expected;
  for (const auto &beam :
       {reference_beam(height, width), reference_beam(width, height)})
    {
      const auto omega = Reference::clamped_free_frequencies(beam, options);
      expected.insert(expected.end(), omega.begin(), omega.begin() + 3);
    }
  std::sort(expected.begin(), expected.end());
  for (unsigned int k = 0; k < expected.size(); ++k)
    {
      // between them, torsion and tension
      double error = 1;
      for (const Mode &mode : found.modes)
        error =
          std::min(error, std::abs(mode.angular_frequency() / expected[k] - 1));
      report("frequency " + std::to_string(expected[k]) + " rad/s, error",
             error);
      EXPECT_LT(error, 5e-3);
    }
  for (const Mode &mode : found.modes)
    EXPECT_LT(mode.error, 1e-7);
}



TEST(Modes, AreOrthonormal)
{
  StartedModel start(mechanism + equilibrium);
  const NaturalModes found = start.modes(5);
  TangentSystem tangent(start.system, start.statistics);
  tangent.linearize(start.state);
  for (unsigned int i = 0; i < 5; ++i)
    {
      SystemVector M(found.modes[i].shape), K(M);
      tangent.apply_mass(M, found.modes[i].shape);
      tangent.apply_stiffness(K, found.modes[i].shape);
      for (unsigned int j = 0; j < 5; ++j)
        {
          double m = 0, k = 0;
          for (unsigned int b = 0; b < M.size(); ++b)
            {
              m += found.modes[j].shape[b] * M[b];
              k += found.modes[j].shape[b] * K[b];
            }
          EXPECT_NEAR(m, i == j, 1e-9);
          EXPECT_NEAR(k,
                      i == j ? found.modes[i].eigenvalue : 0,
                      1e-8 * found.modes.back().eigenvalue);
        }
      const Eigen::VectorXd gap = start.system.constraint_velocity(
        0,
        start.system.marker_values(start.state.positions),
        start.system.marker_values(found.modes[i].shape));
      EXPECT_LT(gap.lpNorm<Eigen::Infinity>(),
                1e-9 * largest(found.modes[i].shape));
    }
}



TEST(Modes, FreeBodyHasSixZeroFrequencies)
{
  // a square section: bending modes in pairs
  const std::string body =
    section("Bodies",
            "set Names = beam\n" +
              section("beam",
                      "set Mesh = box\nset Element = hexahedron\n"
                      "set Box from = 0,0,0\nset Box to = 0.05,1,0.05\n"
                      "set Cells = 1,10,1\nset Young's modulus = 2.1e11\n"
                      "set Poisson's ratio = 0.3\nset Density = 7800\n"
                      "set Rotation = 0.3,0.2,0.1"));
  StartedModel start(body);
  const NaturalModes found = start.modes(10);
  for (unsigned int k = 0; k < 6; ++k)
    {
      report("zero eigenvalue", found.modes[k].eigenvalue);
      EXPECT_LT(std::abs(found.modes[k].eigenvalue), found.round_off);
    }
  report("round-off", found.round_off);
  // 22.373 sqrt(E I / rho A) / L^2 of Bernoulli-Euler, less with shear
  const double bernoulli = 22.3733 * std::sqrt(2.1e11 / 7800 / 12) * 0.05;
  const double ratio     = found.modes[6].angular_frequency() / bernoulli;
  report("first bending over Bernoulli-Euler", ratio);
  EXPECT_LT(ratio, 1);
  EXPECT_GT(ratio, 0.98);
  for (const unsigned int k : {6, 8})
    EXPECT_NEAR(found.modes[k + 1].eigenvalue / found.modes[k].eigenvalue,
                1,
                1e-8);
}



// Rigid motions are so much slower than vibrations that what is left of other
// vectors after a solve may be round-off: vectors that are not orthogonal
// before bring copies of the rigid motions in place of vibrations.
TEST(Modes, FreeBodiesAgainstDenseMatrices)
{
  constexpr unsigned int number = 14;
  for (const std::string modulus : {"1e5", "1e8", "2.1e11"})
    for (const std::string cells : {"1, 2, 1", "1, 6, 1"})
      {
        StartedModel start(
          section("Bodies",
                  "set Names = bar\n" +
                    section("bar",
                            "set Mesh = box\nset Element = hexahedron\n"
                            "set Box from = -0.1, -0.5, -0.1\n"
                            "set Box to = 0.1, 0.5, 0.1\n"
                            "set Density = 1000\n"
                            "set Young's modulus = " +
                              modulus + "\nset Cells = " + cells)));
        const NaturalModes found = start.modes(number);

        const BodyOperators &body = start.system.bodies()[0].operators();
        const unsigned int n      = body.n_unknowns();
        Eigen::MatrixXd K(n, n), M(n, n);
        NodalVector unit(n), column(n);
        for (unsigned int j = 0; j < n; ++j)
          {
            unit    = 0;
            unit[j] = 1;
            body.stiffness_matrix.vmult(column, unit);
            for (unsigned int i = 0; i < n; ++i)
              K(i, j) = column[i];
            body.mass_matrix.vmult(column, unit);
            for (unsigned int i = 0; i < n; ++i)
              M(i, j) = column[i];
          }
        const Eigen::VectorXd exact =
          Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
            K, M, Eigen::EigenvaluesOnly)
            .eigenvalues();
        double error = 0;
        for (unsigned int k = 0; k < number; ++k)
          error = std::max(error,
                           std::abs(found.modes[k].eigenvalue - exact[k]) /
                             std::max(exact[k], exact[6]));
        report(modulus + " Pa, cells " + cells + ": error of eigenvalues",
               error);
        EXPECT_LT(error, 1e-8);
      }
}



TEST(Modes, PendulumSwingsAndFalls)
{
  const double J        = mass * (length * length / 3 + height * height / 12);
  const double expected = mass * gravity * length / 2 / J;
  for (const bool upright : {false, true})
    {
      BeamText beam;
      beam.cells = "1, 6, 1";
      beam.placement =
        std::string("set Rotation = ") +
        (upright ? "1.5707963267948966" : "-1.5707963267948966") + ", 0, 0";
      StartedModel start(one_beam(beam, hinge + weight + equilibrium));
      const NaturalModes found = start.modes(3);
      const double eigenvalue  = found.modes[0].eigenvalue;
      report("squared rate over that of a rigid body, less one",
             std::abs(eigenvalue) / expected - 1);
      EXPECT_NEAR(eigenvalue, upright ? -expected : expected, 1e-4 * expected);
      EXPECT_GT(std::abs(eigenvalue), found.round_off);
      EXPECT_GT(found.modes[1].eigenvalue, 1e3);
    }
}



TEST(Modes, MassOnASpring)
{
  // a heavy mass on a guided body, whose flexibility counts for 1e-5
  BeamText beam;
  beam.cells = "1, 2, 1";
  StartedModel start(one_beam(
    beam,
    joint("set Type = prismatic\nset Between = beam: y min, ground\n"
          "set Axis = 0,1,0") +
      section("Masses",
              "set Names = lump\n" +
                section("lump", "set On = beam: y min\nset Mass = 1e4")) +
      section("Force elements",
              "set Names = spring\n" +
                section("spring",
                        "set Between = beam: y min, ground\n"
                        "set Ground point = 0, -1, 0\n"
                        "set Stiffness = 1e4"))));
  const double eigenvalue = start.modes(1).modes[0].eigenvalue;
  report("k / m, error", eigenvalue * (1e4 + mass) / 1e4 - 1);
  EXPECT_NEAR(eigenvalue, 1e4 / (1e4 + mass), 1e-6);
  EXPECT_THROW(start.modes(1000), InputError);
}



TEST(Modes, FilesOfAStaticRun)
{
  const std::string text =
    one_beam({"beam", "1, 4, 1", "2.1e11", ""},
             clamp + weight + equilibrium +
               section("Probes",
                       "set Names = tip\n" +
                         section("tip", "set Of = beam: y max")) +
               section("Output", "set VTU interval = 1") +
               section("Modes", "set Number = 2\nset At = end"));
  const Model model =
    read_model(ParameterFile::from_text(text + static_run, {}));
  const std::filesystem::path directory = "start_test-results";
  std::filesystem::remove_all(directory);
  std::ostringstream stream;
  run_model(model, {directory}, stream, stream);

  const auto lines = [&](const std::string &name) {
    std::ifstream file(directory / name);
    std::vector<std::string> result;
    for (std::string line; std::getline(file, line);)
      result.push_back(line);
    return result;
  };
  ASSERT_EQ(lines("probes.csv").size(), 2U);
  EXPECT_EQ(lines("probes.csv")[1].substr(0, 2), "0,");
  ASSERT_EQ(lines("modes.csv").size(), 3U);
  EXPECT_EQ(lines("modes.csv")[0],
            "number,eigenvalue [rad^2/s^2],angular frequency [rad/s],"
            "frequency [Hz]");
  for (const std::string name : {"mode-0001.vtu",
                                 "mode-0002.vtu",
                                 "modes.pvd",
                                 "solution-000000.vtu",
                                 "solution.pvd",
                                 "statistics.json"})
    EXPECT_TRUE(std::filesystem::exists(directory / name)) << name;
  EXPECT_FALSE(std::filesystem::exists(directory / "mode-0003.vtu"));
  EXPECT_NE(stream.str().find("mode 2: "), std::string::npos) << stream.str();
  std::cout << stream.str();

  // nothing to do without an end time
  EXPECT_THROW(read_model(ParameterFile::from_text(
                 one_beam({}, clamp + weight) + static_run, {})),
               InputError);
}
