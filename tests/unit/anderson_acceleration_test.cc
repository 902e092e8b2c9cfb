// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/anderson_acceleration.h>

#include <unit/dense_stage_system.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /**
   * The error e of x <- x + f(x), f = -(I - J) e, in all stages of one body,
   * with J = 1e-4 but for four directions with larger eigenvalues.
   */
  class SlowModes
  {
  public:
    explicit SlowModes(const unsigned int n)
      : modes(
          Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::Random(n, 4))
            .householderQ() *
          Eigen::MatrixXd::Identity(n, 4))
    {}

    Eigen::VectorXd
    operator()(const Eigen::VectorXd &e) const
    {
      return modes * (eigenvalues.array() - 1e-4).matrix().asDiagonal() *
               (modes.transpose() * e) -
             (1 - 1e-4) * e;
    }

  private:
    const Eigen::MatrixXd modes;
    const Eigen::Vector4d eigenvalues = {0.5, -0.7, 0.9, 1.5};
  };
} // namespace

TEST(AndersonAcceleration, FewSlowModesTakeFewIterations)
{
  const MultibodySystem system({body_parameters("box", tetrahedra)},
                               {},
                               {},
                               ".");
  const unsigned int n = system.bodies()[0].operators().n_unknowns();
  const SlowModes f(2 * n);
  AndersonAcceleration acceleration(system, 5);
  for (unsigned int repetition = 0; repetition < 2; ++repetition)
    {
      // multipliers are linear in x, here the sum of its error
      Eigen::VectorXd e = Eigen::VectorXd::Random(2 * n);
      const double size = e.norm();
      double multiplier = e.sum();
      acceleration.reset();
      EXPECT_TRUE(acceleration.empty());
      std::vector<double> errors;
      for (unsigned int k = 0; k < 9; ++k)
        {
          const Eigen::VectorXd increment = f(e);
          StageVector stages(2, SystemVector(1, NodalVector(n)));
          for (unsigned int j = 0; j < 2 * n; ++j)
            stages[j / n][0][j % n] = increment(j);
          StageConstraints multipliers(2, Eigen::VectorXd(1));
          multipliers[0](0) = increment.head(n).sum();
          multipliers[1](0) = increment.tail(n).sum();
          acceleration.accelerate(stages, multipliers);
          for (unsigned int j = 0; j < 2 * n; ++j)
            e(j) += stages[j / n][0][j % n];
          multiplier += multipliers[0](0) + multipliers[1](0);
          errors.push_back(e.norm() / size);
          EXPECT_NEAR(multiplier, e.sum(), 1e-10 * n);
        }
      // the plain iteration diverges; five directions, one iteration more
      EXPECT_LT(errors[6], 1e-5);
      EXPECT_LT(errors[8], 1e-9);
      report("error after 7 iterations", errors[6]);
      report("error after 9 iterations", errors[8]);
    }
}
