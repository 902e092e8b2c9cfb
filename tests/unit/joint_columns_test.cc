// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/joint_columns.h>

#include <gtest/gtest.h>

#include <limits>

#include <unit/all_instructions.h>

using namespace ACF;

namespace
{
  template <typename Number>
  class JointColumnsTest : public testing::Test
  {
  protected:
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;

    // Largest error of x - Y F against a product by Eigen.
    void
    check(const unsigned int n_rows,
          const unsigned int n_columns,
          const bool single,
          const double tolerance)
    {
      const Matrix Y   = Matrix::Random(n_rows, n_columns);
      Vector F         = Vector::Random(n_columns);
      F(n_columns / 2) = 0;
      const Vector x   = Vector::Random(n_rows);
      const JointColumns<Number> columns(
        std::vector<Number>(Y.data(), Y.data() + Y.size()), n_rows, single);
      // the last rows are filled up to sixteen numbers
      const std::size_t n_bytes = Y.size() * sizeof(Number);
      EXPECT_GE(columns.n_bytes(), n_bytes / (single ? 2 : 1));
      EXPECT_LT(columns.n_bytes(),
                (n_bytes + n_columns * 16 * sizeof(double)) / (single ? 2 : 1));

      const Vector expected = x - Y * F;
      Vector result;
      Testing::with_all_instructions([&]() {
        result = x;
        columns.subtract_product(F, result.data(), false);
        EXPECT_LT((result - expected).template lpNorm<Eigen::Infinity>(),
                  tolerance)
          << n_rows << " rows, " << n_columns << " columns";
        Vector from_zero =
          Vector::Constant(n_rows,
                           Number(std::numeric_limits<double>::quiet_NaN()));
        columns.subtract_product(F, from_zero.data(), true);
        EXPECT_LT((x + from_zero - expected).template lpNorm<Eigen::Infinity>(),
                  tolerance)
          << n_rows << " rows, " << n_columns << " columns";
      });

      // the columns in use are the same as those that are multiplied
      Vector by_columns = x;
      for (unsigned int k = 0; k < n_columns; ++k)
        by_columns -=
          F(k) *
          Eigen::Map<const Vector>(columns.column(k).data(), n_rows).eval();
      EXPECT_LT((result - by_columns).template lpNorm<Eigen::Infinity>(),
                1e-14 * n_columns);
    }
  };

  using Numbers = testing::Types<double, std::complex<double>>;
  TYPED_TEST_SUITE(JointColumnsTest, Numbers);
} // namespace

TYPED_TEST(JointColumnsTest, ProductsAreThoseOfMatrices)
{
  // a part of a vector, blocks of vectors, parts for threads
  for (const unsigned int n_rows : {1U, 3U, 7U, 33U, 1029U, 30003U})
    for (const unsigned int n_columns : {1U, 6U, 7U, 18U})
      {
        this->check(n_rows, n_columns, false, 1e-13);
        this->check(n_rows, n_columns, true, 1e-6 * n_columns);
      }
}
