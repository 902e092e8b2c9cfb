// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_joint_columns_h
#define acf_solvers_joint_columns_h

#include <deal.II/base/aligned_vector.h>

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
    JointColumns(const std::vector<Number> &columns,
                 const std::size_t n_rows,
                 const bool single);

    /** A column as it is kept, size n_rows. */
    std::vector<Number>
    column(const std::size_t index) const;

    /** $x \leftarrow x - Y F$
     * @param F size of the number of columns
     * @param[in,out] x size n_rows
     * @param x_is_zero whether x stands for zero, whatever its numbers are */
    void
    subtract_product(const Vector &F, Number *x, const bool x_is_zero) const;

    /** What is held. */
    std::size_t
    n_bytes() const
    {
      return n_bytes(n_rows, n_columns, double_values.empty());
    }

    /** What would be. */
    static std::size_t
    n_bytes(const std::size_t n_rows,
            const std::size_t n_columns,
            const bool single);

  private:
    std::size_t n_rows    = 0;
    std::size_t n_columns = 0;

    /**
     * One of both: some rows of all columns, one column after the other, then
     * the next rows, so that a product reads them in one direction. Real and
     * imaginary parts side by side; what is missing to the last rows is zero.
     */
    dealii::AlignedVector<double> double_values;
    dealii::AlignedVector<float> single_values;
  };
} // namespace ACF

#endif
