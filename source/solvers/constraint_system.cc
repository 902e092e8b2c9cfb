// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/constraint_system.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  template <typename Number>
  void
  ConstraintSystem<Number>::find_rows(
    const std::vector<MarkerCompliance<Number>> &compliances,
    const std::vector<unsigned int> &first_values,
    const Eigen::SparseMatrix<double> &D)
  {
    using Iterator = Eigen::SparseMatrix<double>::InnerIterator;

    body_rows.assign(compliances.size(), {});
    for (unsigned int b = 0; b < compliances.size(); ++b)
      {
        std::vector<int> &rows = body_rows[b];
        for (unsigned int k = 0; k < compliances[b].n_values(); ++k)
          for (Iterator entry(D, first_values[b] + k); entry; ++entry)
            rows.push_back(entry.row());
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      }
  }



  template <typename Number>
  void
  ConstraintSystem<Number>::add_body(const MarkerCompliance<Number> &compliance,
                                     const std::vector<int> &rows,
                                     const unsigned int first_value,
                                     const Eigen::SparseMatrix<double> &D)
  {
    using Iterator = Eigen::SparseMatrix<double>::InnerIterator;

    // D_b R_b, transposed
    const unsigned int n = compliance.functionals->rows();
    local_gradients.setZero(n, rows.size());
    for (unsigned int k = 0; k < rows.size(); ++k)
      local_rows[rows[k]] = k;
    for (unsigned int p = 0; p < compliance.markers->size(); ++p)
      for (unsigned int j = 0; j < dim; ++j)
        for (Iterator entry(D, first_value + dim * p + j); entry; ++entry)
          for (unsigned int i = 0; i < dim; ++i)
            local_gradients(dim * (*compliance.markers)[p] + i,
                            local_rows[entry.row()]) +=
              compliance.rotations[p](j, i) * entry.value();

    // C is symmetric: its columns are rows
    displacements.setZero(n, rows.size());
    for (unsigned int k = 0; k < rows.size(); ++k)
      for (unsigned int i = 0; i < n; ++i)
        if (local_gradients(i, k) != 0)
          displacements.col(k) +=
            local_gradients(i, k) * compliance.functionals->col(i);
    for (unsigned int l = 0; l < rows.size(); ++l)
      for (unsigned int k = 0; k <= l; ++k)
        {
          Number sum = 0;
          for (unsigned int i = 0; i < n; ++i)
            sum += local_gradients(i, k) * displacements(i, l);
          sum *= compliance.inverse_scale;
          triplets.emplace_back(rows[k], rows[l], sum);
          if (k < l)
            triplets.emplace_back(rows[l], rows[k], sum);
        }
  }



  template <typename Number>
  bool
  ConstraintSystem<Number>::factorize(
    const std::vector<MarkerCompliance<Number>> &compliances,
    const std::vector<unsigned int> &first_values,
    const Eigen::SparseMatrix<double> &D,
    const MarkerLinearization::Triplets &redundancy)
  {
    const bool is_new = !analyzed || !redundancy.empty();
    if (is_new)
      find_rows(compliances, first_values, D);
    local_rows.resize(D.rows());
    triplets.clear();
    for (unsigned int b = 0; b < compliances.size(); ++b)
      if (!body_rows[b].empty())
        add_body(compliances[b], body_rows[b], first_values[b], D);
    if (!redundancy.empty())
      {
        double size = 0;
        for (const auto &compliance : compliances)
          size = std::max(size, compliance.largest());
        for (const auto &entry : redundancy)
          triplets.emplace_back(entry.row(), entry.col(), size * entry.value());
      }

    Vector diagonal = Vector::Zero(D.rows());
    for (const auto &entry : triplets)
      if (entry.row() == entry.col())
        diagonal(entry.row()) += entry.value();
    row_scales.resize(D.rows());
    for (unsigned int r = 0; r < D.rows(); ++r)
      row_scales(r) = 1 / std::sqrt(std::abs(diagonal(r)));
    if (!row_scales.allFinite())
      return false;
    for (auto &entry : triplets)
      entry = {entry.row(),
               entry.col(),
               row_scales(entry.row()) * row_scales(entry.col()) *
                 entry.value()};

    matrix.assemble(D.rows(), D.rows(), triplets, is_new);
    if (is_new)
      factor.analyzePattern(matrix.matrix());
    analyzed = redundancy.empty();
    factor.factorize(matrix.matrix());
    return factor.info() == Eigen::Success;
  }



  template <typename Number>
  typename ConstraintSystem<Number>::Vector
  ConstraintSystem<Number>::solve(const Vector &h) const
  {
    const Vector scaled   = row_scales.cwiseProduct(h);
    const Vector solution = factor.solve(scaled);
    return row_scales.cwiseProduct(solution);
  }



  template class ConstraintSystem<double>;
  template class ConstraintSystem<std::complex<double>>;
} // namespace ACF
