// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_joint_columns_h
#define acf_solvers_joint_columns_h

#include <Eigen/Dense>

#include <complex>
#include <cstddef>
#include <vector>

namespace ACF
{
  /**
   * The columns Y of JointedFactorization, which each solve reads. Beside a
   * factor in single precision they are kept in it, too: the iteration corrects
   * their errors like those of the factor.
   *
   * @tparam Number double or std::complex<double>, of vectors
   */
  template <typename Number>
  class JointColumns
  {
  public:
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    JointColumns() = default;

    /**
     * @param columns one after the other
     * @param n_rows of a column
     * @param single whether to keep them in single precision
     */
    JointColumns(std::vector<Number> columns,
                 const std::size_t n_rows,
                 const bool single);

    /** A column as it is kept, size n_rows. */
    std::vector<Number>
    column(const std::size_t index) const;

    /** $x \leftarrow x - Y F$
     * @param F size of the number of columns
     * @param[in,out] x size n_rows */
    void
    subtract_product(const Vector &F, Number *x) const;

    std::size_t
    n_bytes() const
    {
      return values.size() * sizeof(Number) +
             single_values.size() * sizeof(float);
    }

  private:
    std::size_t n_rows = 0;

    /** One of both. Real and imaginary parts side by side. */
    std::vector<Number> values;
    std::vector<float> single_values;
  };
} // namespace ACF

#endif
