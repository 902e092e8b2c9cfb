// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/solvers/stage_frames.h>
#include <acf/solvers/stage_solver.h>

#include <cmath>
#include <limits>

#include <unit/dense_stage_system.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  using Complex = std::complex<double>;

  const MultibodySystem &
  hinged_and_free()
  {
    static const MultibodySystem system(
      {body("hinged", hexahedra), body("free", tetrahedra)},
      {joint("revolute", "hinged: x min, ground")},
      LoadParameters(),
      ".");
    return system;
  }

  const MultibodySystem &
  several_joints()
  {
    static const MultibodySystem system(
      {body("b", tetrahedra)},
      {joint("spherical", "b: x min, ground"),
       joint("mean position", "b: x max, ground", "0,1,1"),
       joint("mean rotation", "b: y max, ground", "1,0,0")},
      LoadParameters(),
      ".");
    return system;
  }

  const MultibodySystem &
  unconstrained()
  {
    static const MultibodySystem system({body("free", hexahedra)},
                                        {},
                                        LoadParameters(),
                                        ".");
    return system;
  }

  template <typename Number>
  using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;

  template <typename Number>
  void
  compare_factorization(const BodyOperators &body,
                        const Number shift,
                        const std::string &label)
  {
    const Matrix<Number> K = shift * to_dense(body.mass_matrix).cast<Number>() +
                             to_dense(body.stiffness_matrix).cast<Number>();
    const unsigned int n = body.n_unknowns(), n_vectors = 5;
    Random random;
    Matrix<Number> r(n, n_vectors);
    for (unsigned int j = 0; j < n_vectors; ++j)
      for (unsigned int i = 0; i < n; ++i)
        r(i, j) = random.number(1);
    if constexpr (std::is_same<Number, Complex>::value)
      r += Complex(0, 0.7) * r.rowwise().reverse();

    ShiftedFactorization<Number> factorization(body, shift);
    Matrix<Number> together(r), alone(r);
    factorization.solve(together.data(), n_vectors);
    for (unsigned int j = n_vectors; j-- > 0;)
      factorization.solve(alone.col(j).data());

    const Matrix<Number> exact = K.partialPivLu().solve(r);
    const double scale         = exact.cwiseAbs().maxCoeff();
    const double error = (together - exact).cwiseAbs().maxCoeff() / scale;
    // both solutions have relative errors of the condition number times eps
    EXPECT_LT(error, 1e-11) << label;
    EXPECT_LT((alone - exact).cwiseAbs().maxCoeff() / scale, 1e-11) << label;
    report(label + ", solutions against dense factorisation", error);

    const FactorizationStatistics &statistics = factorization.statistics();
    EXPECT_LT(statistics.backward_error, 1e-13);
    EXPECT_GE(statistics.n_entries, n);
    // vectors of eight rows are filled up with zeros
    EXPECT_GE(statistics.n_bytes, statistics.n_entries * sizeof(Number));
    EXPECT_LT(statistics.n_bytes, 1.3 * statistics.n_entries * sizeof(Number));
  }
} // namespace

namespace
{
  // Against the definitions; frames of all nodes or one.
  template <typename Number>
  double
  stage_frames_error(const unsigned int n_stages, const bool is_uniform)
  {
    const unsigned int n_nodes = 5;
    Random random;
    std::vector<NodeRotations> rotations;
    std::vector<NodalVector> r, z(n_stages, NodalVector(dim * n_nodes));
    std::vector<Number> factors;
    std::vector<const NodeRotations *> frames;
    std::vector<const NodalVector *> sources;
    std::vector<NodalVector *> targets;
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        std::vector<Matrix3> nodes;
        for (unsigned int a = 0; a < n_nodes; ++a)
          nodes.push_back(random.rotation());
        rotations.push_back(is_uniform ? NodeRotations(nodes[0])
                                       : NodeRotations(nodes));
        r.push_back(random.nodal_vector(dim * n_nodes, 1));
        Number factor(0.3 + i);
        if constexpr (!std::is_same<Number, double>::value)
          factor += Number(0, 1.7 - i);
        factors.push_back(factor);
      }
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        frames.push_back(&rotations[i]);
        sources.push_back(&r[i]);
        targets.push_back(&z[i]);
      }

    std::vector<Number> w(dim * n_nodes, Number(1e10));
    combine_in_body_frame(sources, factors, frames, w.data());
    double error = 0;
    for (unsigned int a = 0; a < n_nodes; ++a)
      for (unsigned int j = 0; j < dim; ++j)
        {
          Number expected(0);
          for (unsigned int i = 0; i < n_stages; ++i)
            expected += factors[i] * (node_value(r[i], a) * rotations[i][a])[j];
          error = std::max(error, std::abs(w[dim * a + j] - expected));
        }

    for (const bool replace : {true, false})
      {
        const std::vector<NodalVector> before = z;
        add_in_world_frame(w.data(), factors, frames, replace, targets);
        for (unsigned int i = 0; i < n_stages; ++i)
          for (unsigned int a = 0; a < n_nodes; ++a)
            {
              Vector3 real;
              for (unsigned int j = 0; j < dim; ++j)
                real[j] = std::real(factors[i] * w[dim * a + j]);
              Vector3 expected = rotations[i][a] * real;
              if (!replace)
                expected += node_value(before[i], a);
              error = std::max(error, (node_value(z[i], a) - expected).norm());
            }
      }
    return error;
  }
} // namespace

TEST(StageFrames, AgainstTheirDefinitions)
{
  for (const unsigned int n_stages : {1, 2, 3})
    for (const bool is_uniform : {true, false})
      {
        EXPECT_LT(stage_frames_error<double>(n_stages, is_uniform), 1e-13);
        EXPECT_LT(stage_frames_error<Complex>(n_stages, is_uniform), 1e-13);
      }
}

TEST(ShiftedFactorization, AgainstDenseFactorization)
{
  for (const auto &[name, system] :
       {std::make_pair("hexahedra", &unconstrained()),
        std::make_pair("tetrahedra", &several_joints())})
    {
      const BodyOperators &body = system->bodies()[0].operators();
      for (const double tau : {1e-4, 1e-2})
        {
          const std::string label =
            std::string(name) + ", step size " + std::to_string(tau);
          compare_factorization<double>(body,
                                        1 / (tau * tau),
                                        label + ", real");
          compare_factorization<Complex>(body,
                                         Complex(2, 4 * std::sqrt(2.)) /
                                           (tau * tau),
                                         label + ", complex");
        }
    }
}

TEST(ShiftedFactorization, NotANumberIsAnError)
{
  const BodyOperators &body = unconstrained().bodies()[0].operators();
  const double nan          = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ShiftedFactorization<double>(body, nan), SimulationError);
  EXPECT_THROW(ShiftedFactorization<Complex>(body, Complex(1e6, nan)),
               SimulationError);
}

TEST(JointedFactorization, ComplianceOfTheJoints)
{
  const Body &body          = several_joints().bodies()[0];
  const unsigned int n      = body.operators().n_unknowns();
  const auto &functionals   = body.reference().functionals();
  const unsigned int n_rows = dim * functionals.size();
  const Complex shift(3e6, 7e6);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n_rows, n);
  for (unsigned int p = 0; p < n_rows / dim; ++p)
    {
      const NodalFunctional &functional = functionals[p];
      for (unsigned int k = 0; k < functional.nodes.size(); ++k)
        for (unsigned int i = 0; i < dim; ++i)
          S(dim * p + i, dim * functional.nodes[k] + i) = functional.weights[k];
    }
  const Matrix<Complex> K =
    shift * to_dense(body.operators().mass_matrix).cast<Complex>() +
    to_dense(body.operators().stiffness_matrix).cast<Complex>();
  const Matrix<Complex> exact =
    S.cast<Complex>() *
    K.partialPivLu().solve(S.transpose().cast<Complex>().eval());

  Statistics statistics;
  FactorizationCache cache(statistics);
  const Matrix<Complex> compliance = cache.get(body, shift).compliance();
  const double error =
    (compliance - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
  EXPECT_LT(error, 1e-11);
  EXPECT_EQ(statistics.setup_solves, 1 + n_rows);
  report("compliance of the joint functionals", error);
}

TEST(DiagonalizedStageSolver, AgainstTheDenseSystem)
{
  Random random;
  for (const auto &[name, system] :
       {std::make_pair("two bodies, one joint", &hinged_and_free()),
        std::make_pair("several joints", &several_joints()),
        std::make_pair("no joint", &unconstrained())})
    for (unsigned int s = 1; s <= 3; ++s)
      {
        double error = 0;
        for (const double tau : {1e-4, 1e-2})
          {
            Statistics statistics;
            FactorizationCache cache(statistics);
            DiagonalizedStageSolver solver(*system,
                                           radau_iia(s),
                                           cache,
                                           statistics);
            const auto rotations     = random_rotations(*system, random, s);
            const auto linearization = linearization_of(*system);
            const DenseStageSystem dense(
              *system, radau_iia(s), tau, rotations, linearization);
            const Eigen::VectorXd r = dense.random_right_hand_side(random);
            Stages stages           = dense.unflatten(r);
            solver.prepare(tau, rotations, linearization);
            solver.solve(stages.bodies, stages.constraints);
            error =
              std::max(error,
                       dense.error(dense.flatten(stages), dense.solve(r)));
          }
        // condition numbers up to 1e5 between the stiffest and softest modes
        EXPECT_LT(error, 1e-9) << name << s;
        report(std::string(name) + ", " + std::to_string(s) +
                 " stages, diagonalised against dense",
               error);
      }
}

namespace
{
  /** Of the iteration x += solver(r - dense x), by a power iteration. */
  double
  contraction(StageSolver &solver,
              const DenseStageSystem &dense,
              const int size)
  {
    // without right-hand side x is the error
    const unsigned int n_iterations = 120;
    Eigen::VectorXd x               = Eigen::VectorXd::Random(size);
    double logarithm                = 0;
    for (unsigned int k = 0; k < n_iterations; ++k)
      {
        x /= dense.displacements(x).norm();
        Stages stages = dense.unflatten(-dense.vmult(x));
        solver.solve(stages.bodies, stages.constraints);
        x += dense.flatten(stages);
        if (k >= n_iterations / 2)
          logarithm += std::log(dense.displacements(x).norm());
      }
    return std::exp(logarithm / (n_iterations / 2));
  }
} // namespace

TEST(DiagonalizedStageSolver, BodiesThatTurnInTheStep)
{
  // Stages see the stiffness in their own frames: what contracts worst are the
  // masses, by about the angle between stages, and not the stiff modes.
  Random random;
  for (const auto &[name, system] :
       {std::make_pair("two bodies, one joint", &hinged_and_free()),
        std::make_pair("no joint", &unconstrained())})
    for (const double angle : {0.03, 0.3})
      {
        const double tau = 1e-2;
        Statistics statistics;
        FactorizationCache cache(statistics);
        DiagonalizedStageSolver solver(*system,
                                       radau_iia(2),
                                       cache,
                                       statistics);
        const auto linearization = linearization_of(*system);
        StageRotations rotations = random_rotations(*system, random, 2, angle);
        const DenseStageSystem dense(
          *system, radau_iia(2), tau, rotations, linearization);
        const int size = dense.random_right_hand_side(random).size();

        solver.prepare(tau, rotations, linearization);
        const double own = contraction(solver, dense, size);
        EXPECT_LT(own, 1.2 * angle) << name << angle;

        rotations.stages.assign(2, rotations.mean);
        solver.prepare(tau, rotations, linearization);
        const double mean = contraction(solver, dense, size);
        EXPECT_GT(mean, 3 * own) << name << angle;
        report(std::string(name) + ", turned by " + std::to_string(angle) +
                 ": contraction in frames of the stages",
               own);
        report(std::string(name) + ", turned by " + std::to_string(angle) +
                 ": contraction in one frame",
               mean);
      }
}

TEST(OneStepStageSolver, ConvergesToTheDenseSolution)
{
  Random random;
  const std::vector<double> worst_rates = {0, 0.36, 0.52};
  for (const auto &[name, system] :
       {std::make_pair("two bodies, one joint", &hinged_and_free()),
        std::make_pair("several joints", &several_joints())})
    for (unsigned int s = 1; s <= 3; ++s)
      {
        double worst_error = 0, worst_rate = 0;
        for (const double tau : {1e-4, 1e-3, 1e-2})
          {
            Statistics statistics;
            FactorizationCache cache(statistics);
            OneStepStageSolver solver(*system, radau_iia(s), cache, statistics);
            const auto rotations     = random_rotations(*system, random, s);
            const auto linearization = linearization_of(*system);
            const DenseStageSystem dense(
              *system, radau_iia(s), tau, rotations, linearization);
            const Eigen::VectorXd r     = dense.random_right_hand_side(random);
            const Eigen::VectorXd exact = dense.solve(r);
            solver.prepare(tau, rotations, linearization);

            Eigen::VectorXd x  = Eigen::VectorXd::Zero(r.size());
            const auto correct = [&](const Eigen::VectorXd &residual) {
              Stages stages = dense.unflatten(residual);
              solver.solve(stages.bodies, stages.constraints);
              x += dense.flatten(stages);
            };
            for (unsigned int k = 0; k < (s == 1 ? 1 : 60); ++k)
              correct(r - dense.vmult(x));
            worst_error = std::max(worst_error, dense.error(x, exact));
            if (s == 1)
              continue;

            worst_rate =
              std::max(worst_rate, contraction(solver, dense, r.size()));
          }
        EXPECT_LT(worst_error, 1e-9) << name << s;
        EXPECT_LT(worst_rate, worst_rates[s - 1] + 0.002) << name << s;
        report(std::string(name) + ", " + std::to_string(s) +
                 " stages, one-step matrices: error",
               worst_error);
        // the spectra of the bodies come close to the worst frequency
        EXPECT_GE(worst_rate, 0.95 * worst_rates[s - 1]) << name << s;
        if (s > 1)
          report(std::string(name) + ", " + std::to_string(s) +
                   " stages, one-step matrices: contraction",
                 worst_rate);
      }
}

TEST(FactorizationCache, FactorisesOncePerStepSize)
{
  Random random;
  const MultibodySystem &system = hinged_and_free();
  Statistics statistics;
  FactorizationCache cache(statistics);
  DiagonalizedStageSolver solver(system, radau_iia(3), cache, statistics);
  const auto prepare = [&](const double tau) {
    solver.prepare(tau,
                   random_rotations(system, random, 3),
                   linearization_of(system));
  };
  const auto expect = [&](const unsigned int n_factorizations,
                          const unsigned int n_marker_systems) {
    // for each body one real and one complex matrix per step size
    EXPECT_EQ(statistics.real_factorizations, 2 * n_factorizations);
    EXPECT_EQ(statistics.complex_factorizations, 2 * n_factorizations);
    EXPECT_EQ(statistics.constraint_factorizations, 2 * n_marker_systems);
    EXPECT_EQ(statistics.marker_factorizations, 0);
  };
  expect(0, 0);
  prepare(1e-3);
  expect(1, 1);
  prepare(1e-3);
  expect(1, 2);
  prepare(5e-4);
  expect(2, 3);
  prepare(1e-3);
  expect(2, 4);

  // another solver shares the factors that it has in common
  OneStepStageSolver one_step(system, radau_iia(2), cache, statistics);
  one_step.prepare(1e-3,
                   random_rotations(system, random, 2),
                   linearization_of(system));
  EXPECT_EQ(statistics.real_factorizations, 4 + 4);
  OneStepStageSolver same(system, radau_iia(2), cache, statistics);
  same.prepare(1e-3,
               random_rotations(system, random, 2),
               linearization_of(system));
  EXPECT_EQ(statistics.real_factorizations, 8);
  EXPECT_GT(statistics.joint_column_bytes, 0);
}

TEST(FactorizationCache, NoJointsNoMarkerSystem)
{
  Random random;
  const MultibodySystem &system = unconstrained();
  Statistics statistics;
  FactorizationCache cache(statistics);
  DiagonalizedStageSolver solver(system, radau_iia(2), cache, statistics);
  const auto rotations     = random_rotations(system, random, 2);
  const auto linearization = linearization_of(system);
  solver.prepare(1e-3, rotations, linearization);
  const DenseStageSystem dense(
    system, radau_iia(2), 1e-3, rotations, linearization);
  Stages stages = dense.unflatten(dense.random_right_hand_side(random));
  solver.solve(stages.bodies, stages.constraints);
  EXPECT_EQ(statistics.constraint_factorizations, 0);
  EXPECT_EQ(statistics.marker_factorizations, 0);
  EXPECT_EQ(statistics.joint_column_bytes, 0);
  EXPECT_EQ(statistics.complex_factorizations, 1);
  EXPECT_EQ(statistics.complex_solves, 1);
  EXPECT_EQ(statistics.real_solves, 0);
  EXPECT_EQ(statistics.setup_solves, 1); // the check of the factorisation
}

TEST(FactorizationCache, IdenticalBodiesShareFactors)
{
  Random random;
  std::vector<BodyParameters> bodies;
  std::vector<JointParameters> joints;
  for (const std::string name : {"a", "b", "c", "d"})
    {
      bodies.push_back(body(name, tetrahedra));
      bodies.back().position[1] = bodies.size();
      joints.push_back(joint("spherical", name + ": x min, ground"));
    }
  bodies[3].stiffness_damping = 1e-3; // its matrix has another shift
  const MultibodySystem system(bodies, joints, LoadParameters(), ".");
  EXPECT_EQ(system.n_reference_bodies(), 1);
  Statistics statistics;
  FactorizationCache cache(statistics);
  DiagonalizedStageSolver solver(system, radau_iia(2), cache, statistics);
  const auto rotations     = random_rotations(system, random, 2);
  const auto linearization = linearization_of(system);
  solver.prepare(1e-3, rotations, linearization);
  EXPECT_EQ(statistics.complex_factorizations, 2);
  EXPECT_EQ(statistics.real_factorizations, 0);

  const DenseStageSystem dense(
    system, radau_iia(2), 1e-3, rotations, linearization);
  const Eigen::VectorXd r = dense.random_right_hand_side(random);
  Stages stages           = dense.unflatten(r);
  solver.solve(stages.bodies, stages.constraints);
  EXPECT_EQ(statistics.complex_solves, 4);
  EXPECT_LT(dense.error(dense.flatten(stages), dense.solve(r)), 1e-9);
}
