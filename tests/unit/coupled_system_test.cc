// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>

#include <cmath>
#include <limits>

#include <unit/dense_stage_system.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** Three bodies, two of them identical, with everything between them. */
  SystemParameters
  coupled_parameters()
  {
    SystemParameters parameters;
    for (const std::string name : {"a", "b", "c"})
      {
        parameters.bodies.push_back(
          body(name, name == "c" ? hexahedra : tetrahedra));
        parameters.bodies.back().position =
          Point<dim>(0, name == "b" ? 0.5 : 0, name == "c" ? 0.7 : 0);
      }
    parameters.bodies[0].mass_damping      = 20;
    parameters.bodies[0].stiffness_damping = 1e-3;
    parameters.bodies[2].stiffness_damping = 2e-4;

    parameters.joints = {joint("revolute", "a: x min, ground"),
                         joint("fixed", "a: x max, b: x min"),
                         joint("distance", "b: x max, c: y max")};
    parameters.joints[0].angular_velocity = "1";
    parameters.joints[1].keep_offset      = true;

    ForceElementParameters spring;
    spring.name      = "spring";
    spring.between   = "a: x max, c: x max";
    spring.stiffness = {3e4};
    spring.damping   = {50};
    ForceElementParameters bushing;
    bushing.name              = "bushing";
    bushing.type              = "bushing";
    bushing.between           = "c: z min, ground";
    bushing.stiffness         = {1e4, 2e4, 3e4, 10, 20, 30};
    bushing.damping           = {10, 20, 30, 1, 2, 3};
    parameters.force_elements = {spring, bushing};

    LumpedMassParameters mass;
    mass.name         = "mass";
    mass.on           = "b: z max";
    mass.mass         = 30;
    parameters.masses = {mass};
    return parameters;
  }

  /** In a deformed state in motion, with forces up to a size in the joints. */
  MarkerLinearization
  random_linearization(const MultibodySystem &system,
                       Random &random,
                       const double joint_force = 1e4)
  {
    SystemVector x = system.placement();
    for (NodalVector &positions : x)
      positions += random.nodal_vector(positions.size(), 0.02);
    const Eigen::VectorXd s = system.marker_values(x);
    Eigen::VectorXd v(s.size()), lambda(system.n_constraints());
    for (double &value : v)
      value = random.number(1);
    for (double &value : lambda)
      value = random.number(joint_force);
    return system.linearize(
      0, s, v, lambda, system.law_values(s, Eigen::VectorXd()));
  }
} // namespace

TEST(RepeatedPattern, IsWhatEigenMakesOfTriplets)
{
  using Triplet = Eigen::Triplet<std::complex<double>>;
  RepeatedPattern<std::complex<double>> pattern;
  std::vector<Triplet> triplets;
  std::complex<double> value(1, 2);
  const auto check = [&](const bool is_new) {
    pattern.assemble(7, 5, triplets, is_new);
    Eigen::SparseMatrix<std::complex<double>> expected(7, 5);
    expected.setFromTriplets(triplets.begin(), triplets.end());
    EXPECT_EQ(pattern.matrix().nonZeros(), expected.nonZeros());
    EXPECT_EQ((pattern.matrix() - expected).norm(), 0);
  };
  // entries that come twice, in no order
  for (const auto &[row, column] :
       {std::pair(3, 4), {0, 1}, {6, 0}, {3, 4}, {2, 2}, {5, 4}, {0, 1}})
    triplets.emplace_back(row, column, value *= 1.5);
  check(true);
  for (Triplet &triplet : triplets)
    triplet = Triplet(triplet.row(), triplet.col(), value *= -0.7);
  check(false);
  // other entries: as many, said to be new; more
  for (Triplet &triplet : triplets)
    triplet = Triplet(6 - triplet.row(), triplet.col(), triplet.value());
  check(true);
  triplets.emplace_back(1, 1, value);
  check(false);
}

TEST(CoupledSystem, EverythingAgainstTheDenseSystem)
{
  Random random;
  const MultibodySystem system(coupled_parameters(), ".");
  EXPECT_EQ(system.n_repeated_constraints(), 0);
  for (unsigned int s = 1; s <= 3; ++s)
    {
      double error = 0, constraint_error = 0;
      for (const double tau : {1e-4, 1e-2})
        {
          Statistics statistics;
          FactorizationCache cache(statistics);
          DiagonalizedStageSolver solver(system,
                                         radau_iia(s),
                                         cache,
                                         statistics);
          for (unsigned int n = 0; n < 2; ++n) // the pattern is kept
            {
              const auto rotations     = random_rotations(system, random, s);
              const auto linearization = random_linearization(system, random);
              const DenseStageSystem dense(
                system, radau_iia(s), tau, rotations, linearization);
              Eigen::VectorXd r = dense.random_right_hand_side(random);
              Stages stages     = dense.unflatten(r);
              solver.prepare(tau, rotations, linearization);
              solver.solve(stages.bodies, stages.constraints);
              error =
                std::max(error,
                         dense.error(dense.flatten(stages), dense.solve(r)));

              // without forces on the bodies
              r.head(dense.displacements(r).size()).setZero();
              stages = dense.unflatten(r);
              solver.solve_constraints(stages.bodies, stages.constraints);
              constraint_error =
                std::max(constraint_error,
                         dense.error(dense.flatten(stages), dense.solve(r)));
            }
        }
      EXPECT_LT(error, 1e-8) << s;
      EXPECT_LT(constraint_error, 1e-8) << s;
      report(std::to_string(s) + " stages, coupled bodies against dense",
             std::max(error, constraint_error));
    }
}

TEST(CoupledSystem, MarkersAreEliminatedWhereTheirStiffnessIsSmall)
{
  // Forces of joints from none to ones larger than those of inertia, and a
  // spring in their place.
  enum class Stiffness
  {
    small,
    between,
    large
  };
  struct Case
  {
    double joint_force;
    double spring;
    Stiffness stiffness;
  };

  Random random;
  unsigned int n_between = 0, n_factorized = 0;
  for (const Case &each : {Case{0, 0, Stiffness::small},
                           Case{1e2, 0, Stiffness::small},
                           Case{1e5, 0, Stiffness::small},
                           Case{1e6, 0, Stiffness::between},
                           Case{2e6, 0, Stiffness::between},
                           Case{3e6, 0, Stiffness::between},
                           Case{1e10, 0, Stiffness::large},
                           Case{0, 1e3, Stiffness::small},
                           Case{0, 1e10, Stiffness::large}})
    for (const bool constrained : {true, false})
      {
        if (!constrained && each.joint_force > 0)
          continue;
        SystemParameters parameters = coupled_parameters();
        parameters.masses.clear();
        parameters.force_elements.resize(each.spring > 0 ? 1 : 0);
        for (ForceElementParameters &element : parameters.force_elements)
          element.stiffness = {each.spring};
        if (!constrained)
          parameters.joints.clear();
        const MultibodySystem system(parameters, ".");

        const double tau = 1e-4;
        double error     = 0;
        Statistics statistics;
        FactorizationCache cache(statistics);
        DiagonalizedStageSolver solver(system, radau_iia(2), cache, statistics);
        const unsigned int n_prepared = 2;
        for (unsigned int n = 0; n < n_prepared; ++n)
          {
            const auto rotations = random_rotations(system, random, 2);
            const auto linearization =
              random_linearization(system, random, each.joint_force);
            const DenseStageSystem dense(
              system, radau_iia(2), tau, rotations, linearization);
            solver.prepare(tau, rotations, linearization);
            // the second one with what the first one has factorised
            for (unsigned int k = 0; k < 2; ++k)
              {
                const Eigen::VectorXd r = dense.random_right_hand_side(random);
                Stages stages           = dense.unflatten(r);
                solver.solve(stages.bodies, stages.constraints);
                error =
                  std::max(error,
                           dense.error(dense.flatten(stages), dense.solve(r)));
              }
          }
        const std::string label =
          "joints with " + std::to_string(each.joint_force) + " N, spring of " +
          std::to_string(each.spring) + " N/m" +
          (constrained ? "" : ", no joints");
        EXPECT_LT(error, 1e-8) << label;
        if (each.stiffness == Stiffness::between)
          {
            n_between += n_prepared;
            n_factorized += statistics.constraint_factorizations +
                            statistics.marker_factorizations;
          }
        else
          {
            const bool is_small = (each.stiffness == Stiffness::small);
            EXPECT_EQ(statistics.constraint_factorizations,
                      is_small && constrained ? n_prepared : 0)
              << label;
            EXPECT_EQ(statistics.marker_factorizations,
                      is_small ? 0 : n_prepared)
              << label;
          }
        report(label + ", against dense", error);
      }
  // some iterations were given up
  EXPECT_GT(n_factorized, n_between);
}

TEST(CoupledSystem, NodeFramesAndChangesOfLowRank)
{
  Random random;
  const MultibodySystem system(coupled_parameters(), ".");
  for (const bool with_changes : {false, true})
    {
      std::vector<LowRankChange> changes;
      if (with_changes)
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          {
            // as large as the stiffness; the second body has none
            const BodyOperators &body = system.bodies()[b].operators();
            const unsigned int rank   = (b == 1 ? 0 : 4);
            const double size         = to_dense(body.stiffness_matrix).norm();
            LowRankChange change;
            change.columns.resize(body.n_unknowns(), rank);
            for (unsigned int j = 0; j < rank; ++j)
              for (unsigned int k = 0; k < body.n_unknowns(); ++k)
                change.columns(k, j) = random.number(j + 1);
            change.coefficients = Eigen::MatrixXd::Identity(rank, rank) *
                                  (size / body.n_unknowns());
            if (rank > 0)
              change.coefficients(0, 0) *= -1;
            changes.push_back(change);
          }
      for (unsigned int s = 1; s <= 3; ++s)
        {
          double error = 0;
          for (const double tau : {1e-4, 1e-2})
            {
              Statistics statistics;
              FactorizationCache cache(statistics);
              DiagonalizedStageSolver solver(system,
                                             radau_iia(s),
                                             cache,
                                             statistics);
              const auto rotations = random_node_rotations(system, random, s);
              const auto linearization = random_linearization(system, random);
              const DenseStageSystem dense(
                system, radau_iia(s), tau, rotations, linearization, changes);
              Eigen::VectorXd r = dense.random_right_hand_side(random);
              Stages stages     = dense.unflatten(r);
              solver.prepare(tau, rotations, linearization, changes);
              solver.solve(stages.bodies, stages.constraints);
              error =
                std::max(error,
                         dense.error(dense.flatten(stages), dense.solve(r)));

              r.head(dense.displacements(r).size()).setZero();
              stages = dense.unflatten(r);
              solver.solve_constraints(stages.bodies, stages.constraints);
              error =
                std::max(error,
                         dense.error(dense.flatten(stages), dense.solve(r)));

              // the same solver without changes from now on
              const DenseStageSystem unchanged(
                system, radau_iia(s), tau, rotations, linearization);
              r      = unchanged.random_right_hand_side(random);
              stages = unchanged.unflatten(r);
              solver.prepare(tau, rotations, linearization);
              solver.solve(stages.bodies, stages.constraints);
              error = std::max(error,
                               unchanged.error(unchanged.flatten(stages),
                                               unchanged.solve(r)));
            }
          EXPECT_LT(error, 1e-8) << with_changes << s;
          report(std::to_string(s) + " stages, frames of nodes" +
                   (with_changes ? ", changes of low rank" : "") +
                   " against dense",
                 error);
        }
    }
}

TEST(CoupledSystem, OneStepMatricesConverge)
{
  // Springs contract like bodies, however stiff. Dampers are approximated
  // worse: an oscillator with them contracts with up to 0.5 and 0.85.
  Random random;
  for (const bool damped : {false, true})
    {
      SystemParameters parameters = coupled_parameters();
      if (!damped)
        {
          for (BodyParameters &body : parameters.bodies)
            body.mass_damping = body.stiffness_damping = 0;
          for (ForceElementParameters &element : parameters.force_elements)
            element.damping.clear();
          parameters.force_elements[1].stiffness.assign(6, 1e9);
        }
      const MultibodySystem system(parameters, ".");
      EXPECT_EQ(system.needs_velocities(), damped);
      for (unsigned int s = 1; s <= 3; ++s)
        for (const double tau : {1e-4, 1e-3})
          {
            Statistics statistics;
            FactorizationCache cache(statistics);
            OneStepStageSolver solver(system, radau_iia(s), cache, statistics);
            const auto rotations     = random_rotations(system, random, s);
            const auto linearization = random_linearization(system, random);
            const DenseStageSystem dense(
              system, radau_iia(s), tau, rotations, linearization);
            const Eigen::VectorXd r     = dense.random_right_hand_side(random);
            const Eigen::VectorXd exact = dense.solve(r);
            solver.prepare(tau, rotations, linearization);
            const unsigned int n_iterations = (s == 1 ? 1 : 60);
            Eigen::VectorXd x               = Eigen::VectorXd::Zero(r.size());
            double middle                   = 0;
            for (unsigned int k = 0; k < n_iterations; ++k)
              {
                Stages stages = dense.unflatten(r - dense.vmult(x));
                solver.solve(stages.bodies, stages.constraints);
                x += dense.flatten(stages);
                if (k + 1 == n_iterations / 2)
                  middle = dense.error(x, exact);
              }
            const double error      = dense.error(x, exact);
            const std::string label = std::to_string(s) + " stages, step " +
                                      std::to_string(tau) +
                                      (damped ? ", damped" : ", undamped");
            EXPECT_LT(error, damped && s == 3 ? 1e-6 : 1e-8) << label;
            report(label + ", one-step matrices of coupled bodies: error",
                   error);
            if (s > 1 && error > 1e-12)
              report(label + ", contraction",
                     std::pow(error / middle, 2. / n_iterations));
          }
    }
}

TEST(CoupledSystem, RepeatedConstraintsShareTheLoad)
{
  Random random;
  SystemParameters parameters;
  parameters.bodies       = {body("a", tetrahedra), body("b", hexahedra)};
  parameters.joints       = {joint("revolute", "a: x min, b: x min"),
                             joint("spherical", "b: x max, ground")};
  const unsigned int once = 8;
  const MultibodySystem single(parameters, ".");
  ASSERT_EQ(single.n_constraints(), once);
  parameters.joints.push_back(parameters.joints[0]);
  parameters.joints.back().name = "double";
  const MultibodySystem repeated(parameters, ".");
  EXPECT_EQ(repeated.n_repeated_constraints(), 5);
  EXPECT_EQ(repeated.repeating_joints(), "'a: x min, b: x min', 'double'");

  double position_error = 0, multiplier_error = 0;
  for (const double tau : {1e-4, 1e-2})
    {
      Statistics statistics;
      FactorizationCache cache(statistics);
      DiagonalizedStageSolver solver(repeated, radau_iia(3), cache, statistics);
      for (unsigned int n = 0; n < 2; ++n)
        {
          // then in a deformed state, where directions have turned
          SystemVector x = single.placement();
          for (NodalVector &positions : x)
            positions += random.nodal_vector(positions.size(), 0.02 * n);
          const auto linearize = [&](const MultibodySystem &system) {
            const Eigen::VectorXd s = system.marker_values(x);
            return system.linearize(
              0, s, s, Eigen::VectorXd::Zero(system.n_constraints()), {});
          };
          const auto rotations = random_rotations(single, random, 3);
          const DenseStageSystem dense(
            single, radau_iia(3), tau, rotations, linearize(single));
          const Stages rhs =
            dense.unflatten(dense.random_right_hand_side(random));
          const Stages exact = dense.unflatten(dense.solve(dense.flatten(rhs)));
          solver.prepare(tau, rotations, linearize(repeated));
          Stages stages = rhs;
          for (Eigen::VectorXd &g : stages.constraints)
            {
              g.conservativeResize(once + 5);
              g.tail(5) = g.head(5);
            }
          solver.solve(stages.bodies, stages.constraints);
          for (unsigned int i = 0; i < 3; ++i)
            {
              for (unsigned int b = 0; b < 2; ++b)
                position_error =
                  std::max(position_error,
                           relative_difference(stages.bodies[i][b],
                                               exact.bodies[i][b]));
              Eigen::VectorXd expected(once + 5);
              expected << 0.5 * exact.constraints[i].head(5),
                exact.constraints[i].tail(3),
                0.5 * exact.constraints[i].head(5);
              multiplier_error =
                std::max(multiplier_error,
                         relative_difference(stages.constraints[i], expected));
            }
        }
    }
  EXPECT_LT(position_error, 1e-9);
  EXPECT_LT(multiplier_error, 1e-9);
  report("repeated joints, positions against one joint", position_error);
  report("repeated joints, forces against half of one joint's",
         multiplier_error);
}

TEST(CoupledSystem, SingularEquationsNameTheJoints)
{
  Random random;
  SystemParameters parameters;
  parameters.bodies = {body("a", tetrahedra), body("b", hexahedra)};
  parameters.joints = {joint("revolute", "a: x min, b: x min"),
                       joint("spherical", "b: x max, ground")};
  const MultibodySystem system(parameters, ".");
  Statistics statistics;
  FactorizationCache cache(statistics);
  DiagonalizedStageSolver solver(system, radau_iia(2), cache, statistics);
  const auto rotations = random_rotations(system, random, 2);
  // a constraint of the second joint without a gradient, and with a wrong one
  for (const double gradient : {0., std::numeric_limits<double>::quiet_NaN()})
    {
      MarkerLinearization linearization = random_linearization(system, random);
      for (auto &entry : linearization.constraints)
        if (entry.row() == 6)
          entry = {entry.row(), entry.col(), gradient};
      try
        {
          solver.prepare(1e-3, rotations, linearization);
          ADD_FAILURE() << "no error with the gradient " << gradient;
        }
      catch (const SimulationError &error)
        {
          const std::string message = error.what();
          EXPECT_NE(message.find("'b: x max, ground'"), std::string::npos)
            << message;
          EXPECT_EQ(message.find("'a: x min, b: x min'"), std::string::npos)
            << message;
        }
    }
}
