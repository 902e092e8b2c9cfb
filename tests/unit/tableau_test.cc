// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/butcher_tableau.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

using namespace ACF;

namespace
{
  /** Coefficients in closed form (Hairer and Wanner, Tables IV.5.5 and 5.6). */
  ButcherTableau
  literature(const unsigned int n_stages)
  {
    ButcherTableau tableau;
    tableau.A.resize(n_stages, n_stages);
    tableau.c.resize(n_stages);
    const double r = std::sqrt(6.);
    if (n_stages == 1)
      {
        tableau.A << 1;
        tableau.c << 1;
      }
    else if (n_stages == 2)
      {
        tableau.A << 5. / 12, -1. / 12, 3. / 4, 1. / 4;
        tableau.c << 1. / 3, 1;
      }
    else
      {
        tableau.A << (88 - 7 * r) / 360, (296 - 169 * r) / 1800,
          (-2 + 3 * r) / 225, (296 + 169 * r) / 1800, (88 + 7 * r) / 360,
          (-2 - 3 * r) / 225, (16 - r) / 36, (16 + r) / 36, 1. / 9;
        tableau.c << (4 - r) / 10, (4 + r) / 10, 1;
      }
    return tableau;
  }

  double
  largest(const Eigen::MatrixXd &matrix)
  {
    return matrix.cwiseAbs().maxCoeff();
  }

  Eigen::MatrixXd
  identity(const unsigned int n)
  {
    return Eigen::MatrixXd::Identity(n, n);
  }

  /** Spectral radius of I - (I + z L D)^-1 (I + z A^2), z = (omega tau)^2: the
   * contraction of a mode with the circular frequency omega. */
  double
  contraction(const ButcherTableau &tableau, const double z)
  {
    const unsigned int s                       = tableau.n_stages();
    const StageTriangularization approximation = triangularize_stages(tableau);
    const Eigen::MatrixXd exact = identity(s) + z * tableau.A * tableau.A;
    const Eigen::MatrixXd approximate =
      identity(s) +
      z * approximation.lower * approximation.diagonal.asDiagonal();
    return (identity(s) - approximate.inverse() * exact)
      .eigenvalues()
      .cwiseAbs()
      .maxCoeff();
  }
} // namespace

TEST(RadauIIA, CoefficientsOfTheLiterature)
{
  for (unsigned int s = 1; s <= 3; ++s)
    {
      const ButcherTableau tableau = radau_iia(s);
      ASSERT_EQ(tableau.n_stages(), s);
      EXPECT_LT(largest(tableau.A - literature(s).A), 1e-15);
      EXPECT_LT(largest(tableau.c - literature(s).c), 1e-15);
    }
}

TEST(RadauIIA, OrderConditions)
{
  for (unsigned int s = 1; s <= 3; ++s)
    {
      const ButcherTableau tableau = radau_iia(s);
      const Eigen::MatrixXd &A     = tableau.A;
      const Eigen::VectorXd b      = A.row(s - 1);
      const auto power             = [&](const unsigned int k) {
        return Eigen::VectorXd(
          tableau.c.array().pow(static_cast<double>(k)).matrix());
      };
      const Eigen::VectorXd ones = Eigen::VectorXd::Ones(s);

      // B(2 s - 1), and not B(2 s)
      for (unsigned int k = 1; k <= 2 * s - 1; ++k)
        EXPECT_NEAR(b.dot(power(k - 1)), 1. / k, 1e-15) << s << k;
      EXPECT_GT(std::abs(b.dot(power(2 * s - 1)) - 1. / (2 * s)), 1e-4);

      for (unsigned int k = 1; k <= s; ++k)
        EXPECT_LT(largest(A * power(k - 1) - power(k) / k), 1e-15);
      for (unsigned int k = 1; k < s; ++k)
        EXPECT_LT(largest(A.transpose() * b.cwiseProduct(power(k - 1)) -
                          b.cwiseProduct(ones - power(k)) / k),
                  1e-15);

      // the stability function is the Pade approximation (s - 1, s) of exp
      for (const double z : {-100., -3., -0.5, 0.3})
        {
          const double R =
            1 + z * b.dot((identity(s) - z * A).inverse() * ones);
          const double pade =
            s == 1   ? 1 / (1 - z)
            : s == 2 ? (1 + z / 3) / (1 - 2 * z / 3 + z * z / 6)
                     : (1 + 2 * z / 5 + z * z / 20) /
                         (1 - 3 * z / 5 + 3 * z * z / 20 - z * z * z / 60);
          EXPECT_NEAR(R, pade, 1e-13) << s << " " << z;
        }
    }
}

TEST(StageDiagonalization, ReconstructsTheMatrix)
{
  for (unsigned int s = 1; s <= 3; ++s)
    {
      const ButcherTableau tableau     = radau_iia(s);
      const StageDiagonalization parts = diagonalize_stages(tableau);
      Eigen::MatrixXd matrix           = Eigen::MatrixXd::Zero(s, s);
      Eigen::MatrixXd unit             = Eigen::MatrixXd::Zero(s, s);
      unsigned int n_eigenvalues       = 0;
      for (const auto &part : parts.components)
        {
          ASSERT_EQ(part.to_stages.size(), s);
          ASSERT_EQ(part.from_stages.size(), s);
          EXPECT_GE(part.eigenvalue.imag(), 0);
          const double weight = part.is_real() ? 1 : 2;
          n_eigenvalues += (part.is_real() ? 1 : 2);
          for (unsigned int i = 0; i < s; ++i)
            for (unsigned int j = 0; j < s; ++j)
              {
                const std::complex<double> product =
                  part.to_stages[i] * part.from_stages[j];
                unit(i, j) += weight * product.real();
                matrix(i, j) += weight * (part.eigenvalue * product).real();
              }
        }
      EXPECT_EQ(n_eigenvalues, s);
      EXPECT_LT(largest(unit - identity(s)), 1e-14);
      // A^-2 by another way than by the inverse of A: A^2 (A^-2) = I
      EXPECT_LT(largest(literature(s).A * literature(s).A * matrix -
                        identity(s)),
                1e-13);
    }
}

TEST(StageDiagonalization, Eigenvalues)
{
  const auto eigenvalues = [](const unsigned int s) {
    std::vector<std::complex<double>> values;
    for (const auto &part : diagonalize_stages(radau_iia(s)).components)
      values.push_back(part.eigenvalue);
    // real ones first
    std::sort(values.begin(), values.end(), [](const auto &x, const auto &y) {
      return x.imag() < y.imag();
    });
    return values;
  };
  ASSERT_EQ(eigenvalues(1).size(), 1);
  EXPECT_NEAR(std::abs(eigenvalues(1)[0] - 1.), 0, 1e-15);

  ASSERT_EQ(eigenvalues(2).size(), 1);
  const std::complex<double> two_stages(2, 4 * std::sqrt(2.));
  EXPECT_LT(std::abs(eigenvalues(2)[0] - two_stages), 1e-13);

  // 1/gamma and alpha +- i beta of RADAU5, squared
  ASSERT_EQ(eigenvalues(3).size(), 2);
  const std::complex<double> pair(2.6810828736277521, 3.0504301992474105);
  EXPECT_EQ(eigenvalues(3)[0].imag(), 0);
  EXPECT_NEAR(eigenvalues(3)[0].real(), std::pow(3.6378342527444957, 2), 1e-12);
  EXPECT_LT(std::abs(eigenvalues(3)[1] - pair * pair), 1e-12);
}

TEST(StageTriangularization, FactorsAndShifts)
{
  for (unsigned int s = 1; s <= 3; ++s)
    {
      const ButcherTableau tableau        = literature(s);
      const Eigen::MatrixXd square        = tableau.A * tableau.A;
      const StageTriangularization result = triangularize_stages(radau_iia(s));
      const Eigen::MatrixXd D             = result.diagonal.asDiagonal();
      for (unsigned int i = 0; i < s; ++i)
        for (unsigned int j = i; j < s; ++j)
          EXPECT_EQ(result.lower(i, j), i == j ? 1 : 0);

      // what is left, U = (L D)^-1 A^2, is unit upper triangular
      const Eigen::MatrixXd U = (result.lower * D).inverse() * square;
      for (unsigned int i = 0; i < s; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          EXPECT_NEAR(U(i, j), i == j ? 1 : 0, 1e-13);
      EXPECT_LT(largest(result.increments * D - square), 1e-15);
    }

  const Eigen::VectorXd two   = triangularize_stages(radau_iia(2)).diagonal;
  const Eigen::VectorXd three = triangularize_stages(radau_iia(3)).diagonal;
  EXPECT_NEAR(two(0), 1. / 9, 1e-15);
  EXPECT_NEAR(two(1), 1. / 4, 1e-15);
  EXPECT_NEAR(three(0), 0.021835, 5e-7);
  EXPECT_NEAR(three(1), 0.199306, 5e-7);
  EXPECT_NEAR(three(2), 0.063830, 5e-7);
  EXPECT_NEAR(three.prod(), 1. / 3600, 1e-15); // det(A)^2, det(A) = 1/60
}

TEST(StageTriangularization, WorstContraction)
{
  for (const auto &[s, expected] : std::vector<std::pair<unsigned int, double>>{
         {1, 0}, {2, 0.36}, {3, 0.52}})
    {
      double worst = 0, worst_z = 0;
      for (double exponent = -6; exponent <= 10; exponent += 0.002)
        {
          const double z    = std::pow(10., exponent);
          const double rate = contraction(radau_iia(s), z);
          if (rate > worst)
            {
              worst   = rate;
              worst_z = z;
            }
        }
      EXPECT_NEAR(worst, expected, 0.005);
      std::cout << "[ measured ] worst contraction of the one-step matrices, "
                << s << " stages: " << worst
                << " at omega tau = " << std::sqrt(worst_z) << std::endl;
    }
}

TEST(StageShape, ValuesAndPolynomials)
{
  for (unsigned int s = 1; s <= 3; ++s)
    {
      const ButcherTableau tableau    = radau_iia(s);
      const std::vector<double> start = stage_shape(tableau, 0);
      for (unsigned int i = 0; i < s; ++i)
        {
          EXPECT_EQ(start[i], 0);
          for (unsigned int j = 0; j < s; ++j)
            EXPECT_NEAR(stage_shape(tableau, tableau.c(j))[i],
                        i == j ? 1 : 0,
                        1e-14);
        }
      for (const double c : {-0.3, 0.1, 0.5, 0.9, 1., 1.7})
        {
          const std::vector<double> shape = stage_shape(tableau, c);
          // c^2 ... c^(s + 1) are reproduced
          for (unsigned int k = 2; k <= s + 1; ++k)
            {
              double sum = 0;
              for (unsigned int i = 0; i < s; ++i)
                sum += std::pow(tableau.c(i), k) * shape[i];
              EXPECT_NEAR(sum, std::pow(c, k), 1e-12);
            }
        }
    }
}
