// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/marker_system.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  namespace
  {
    // Calls function(column, value) for the entries of a column of a matrix:
    // those of a row of its transpose.
    template <typename Matrix, typename Function>
    void
    for_entries(const Matrix &columns,
                const unsigned int k,
                const Function &function)
    {
      for (typename Matrix::InnerIterator entry(columns, k); entry; ++entry)
        function(entry.row(), entry.value());
    }
  } // namespace



  template <typename Number>
  double
  MarkerSystem<Number>::add_compliances(
    const MarkerCompliance<Number> &compliance,
    const unsigned int first,
    const Matrix &H_transposed,
    const Eigen::SparseMatrix<double> &D)
  {
    const unsigned int n         = H_transposed.rows();
    const unsigned int n_markers = compliance.markers->size();
    double squared_size          = 0;
    for (unsigned int q = 0; q < n_markers; ++q)
      for (unsigned int p = 0; p < n_markers; ++p)
        {
          const Eigen::Matrix<Number, dim, dim> C = compliance.block(p, q);
          for (unsigned int j = 0; j < dim; ++j)
            {
              const auto add = [&](const unsigned int column,
                                   const Number value) {
                for (unsigned int i = 0; i < dim; ++i)
                  triplets.emplace_back(first + dim * p + i,
                                        column,
                                        C(i, j) * value);
              };
              const unsigned int k = first + dim * q + j;
              for_entries(H_transposed, k, add);
              for_entries(D, k, [&](const unsigned int r, const double value) {
                add(n + r, value);
              });
              for (unsigned int i = 0; i < dim; ++i)
                squared_size = std::max(squared_size, std::norm(C(i, j)));
            }
        }
    return std::sqrt(squared_size);
  }



  template <typename Number>
  void
  MarkerSystem<Number>::add_change(const MatrixChange<Number> &change,
                                   const unsigned int first,
                                   const Matrix &H_transposed,
                                   const Eigen::SparseMatrix<double> &D)
  {
    const unsigned int n = H_transposed.rows();
    for (unsigned int j = 0; j < change.columns.cols(); ++j)
      {
        const unsigned int row = change.first + j;
        for (unsigned int i = 0; i < change.columns.cols(); ++i)
          triplets.emplace_back(row, change.first + i, change.matrix(j, i));
        for (unsigned int k = 0; k < change.marker_values.rows(); ++k)
          {
            const Number s = change.marker_values(k, j);
            triplets.emplace_back(first + k, row, change.size * s);
            for_entries(H_transposed,
                        first + k,
                        [&](const unsigned int column, const Number value) {
                          triplets.emplace_back(row, column, s * value);
                        });
            for_entries(D,
                        first + k,
                        [&](const unsigned int r, const double value) {
                          triplets.emplace_back(row, n + r, s * value);
                        });
          }
      }
  }



  template <typename Number>
  bool
  MarkerSystem<Number>::factorize(
    const std::vector<MarkerCompliance<Number>> &compliances,
    const std::vector<unsigned int> &first_values,
    const Matrix &H_transposed,
    const Eigen::SparseMatrix<double> &D,
    const MarkerLinearization::Triplets &redundancy,
    const std::vector<MatrixChange<Number>> &changes)
  {
    const unsigned int n = H_transposed.rows();
    triplets.clear();
    for (unsigned int k = 0; k < n; ++k)
      {
        triplets.emplace_back(k, k, Number(1));
        for_entries(D, k, [&](const unsigned int r, const double value) {
          triplets.emplace_back(n + r, k, value);
        });
      }
    double size = 0;
    for (unsigned int b = 0; b < compliances.size(); ++b)
      size = std::max(
        size,
        add_compliances(compliances[b], first_values[b], H_transposed, D));
    for (const auto &entry : redundancy)
      triplets.emplace_back(n + entry.row(),
                            n + entry.col(),
                            -size * entry.value());
    unsigned int n_unknowns = n + D.rows();
    for (unsigned int b = 0; b < changes.size(); ++b)
      {
        add_change(changes[b], first_values[b], H_transposed, D);
        n_unknowns += changes[b].columns.cols();
      }

    // the pattern is that of the mechanism but for these two
    const bool pattern_varies = !changes.empty() || !redundancy.empty();
    const bool is_new         = !analyzed || pattern_varies;
    matrix.assemble(n_unknowns, n_unknowns, triplets, is_new);
    if (is_new)
      factor.analyzePattern(matrix.matrix());
    analyzed = !pattern_varies;
    factor.factorize(matrix.matrix());
    return factor.info() == Eigen::Success;
  }



  template class MarkerSystem<double>;
  template class MarkerSystem<std::complex<double>>;
} // namespace ACF
