// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_repeated_pattern_h
#define acf_solvers_repeated_pattern_h

#include <deal.II/base/exceptions.h>

#include <Eigen/SparseCore>

#include <algorithm>
#include <vector>

namespace ACF
{
  /**
   * A small sparse matrix that is assembled again and again from triplets for
   * the same entries in the same order: what takes the time of
   * Eigen::SparseMatrix::setFromTriplets() is done once.
   */
  template <typename Number>
  class RepeatedPattern
  {
  public:
    using Matrix   = Eigen::SparseMatrix<Number>;
    using Triplets = std::vector<Eigen::Triplet<Number>>;

    /**
     * Sums of the triplets with the same row and column.
     * @param is_new the entries are not those of the last time
     */
    void
    assemble(const unsigned int n_rows,
             const unsigned int n_columns,
             const Triplets &triplets,
             const bool is_new)
    {
      if (is_new || places.size() != triplets.size())
        {
          sum.resize(n_rows, n_columns);
          sum.setFromTriplets(triplets.begin(), triplets.end());
          find_places(triplets);
          return;
        }
      Number *const values = sum.valuePtr();
      std::fill_n(values, sum.nonZeros(), Number(0));
      for (std::size_t k = 0; k < triplets.size(); ++k)
        {
          Assert(sum.innerIndexPtr()[places[k]] == triplets[k].row() &&
                   sum.outerIndexPtr()[triplets[k].col()] <= places[k] &&
                   places[k] < sum.outerIndexPtr()[triplets[k].col() + 1],
                 dealii::ExcMessage("The pattern has changed."));
          values[places[k]] += triplets[k].value();
        }
    }

    const Matrix &
    matrix() const
    {
      return sum;
    }

  private:
    void
    find_places(const Triplets &triplets)
    {
      places.clear();
      for (const auto &triplet : triplets)
        {
          const int *const rows  = sum.innerIndexPtr();
          const int *const start = sum.outerIndexPtr() + triplet.col();
          places.push_back(
            std::lower_bound(rows + start[0], rows + start[1], triplet.row()) -
            rows);
        }
    }

    Matrix sum;

    /** Of the triplets among the values of the matrix. */
    std::vector<int> places;
  };
} // namespace ACF

#endif
