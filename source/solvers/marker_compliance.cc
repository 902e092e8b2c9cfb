// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/marker_compliance.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace ACF
{
  template <typename Number>
  Eigen::Matrix<Number, dim, dim>
  MarkerCompliance<Number>::block(const unsigned int row,
                                  const unsigned int column) const
  {
    const Eigen::Matrix3d &R_p = rotations[row], &R_q = rotations[column];
    const unsigned int p = dim * (*markers)[row], q = dim * (*markers)[column];
    Eigen::Matrix<Number, dim, dim> half, result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        half(i, j) = inverse_scale * (R_p(i, 0) * (*functionals)(p, q + j) +
                                      R_p(i, 1) * (*functionals)(p + 1, q + j) +
                                      R_p(i, 2) * (*functionals)(p + 2, q + j));
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result(i, j) = half(i, 0) * R_q(j, 0) + half(i, 1) * R_q(j, 1) +
                       half(i, 2) * R_q(j, 2);
    return result;
  }



  template <typename Number>
  typename MarkerCompliance<Number>::Vector
  MarkerCompliance<Number>::functional_forces(
    const Eigen::Ref<const Vector> &phi) const
  {
    Vector F = Vector::Zero(functionals->rows());
    for (unsigned int p = 0; p < markers->size(); ++p)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          F(dim * (*markers)[p] + i) +=
            inverse_scale * rotations[p](j, i) * phi(dim * p + j);
    return F;
  }



  template <typename Number>
  typename MarkerCompliance<Number>::Vector
  MarkerCompliance<Number>::displacements(
    const Eigen::Ref<const Vector> &phi) const
  {
    const Vector local = *functionals * functional_forces(phi);
    Vector result      = Vector::Zero(n_values());
    for (unsigned int p = 0; p < markers->size(); ++p)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          result(dim * p + i) +=
            rotations[p](i, j) * local(dim * (*markers)[p] + j);
    return result;
  }



  template <typename Number>
  double
  MarkerCompliance<Number>::largest() const
  {
    double result = 0;
    for (const unsigned int q : *markers)
      for (const unsigned int p : *markers)
        result =
          std::max(result,
                   functionals->template block<dim, dim>(dim * p, dim * q)
                     .cwiseAbs()
                     .maxCoeff());
    return std::abs(inverse_scale) * result;
  }



  template <typename Number>
  void
  MarkerCompliance<Number>::append_sizes(std::vector<double> &sizes) const
  {
    for (const unsigned int functional : *markers)
      {
        Number trace = 0;
        for (unsigned int i = 0; i < dim; ++i)
          trace += (*functionals)(dim * functional + i, dim * functional + i);
        sizes.push_back(std::abs(inverse_scale * trace));
      }
  }



  template struct MarkerCompliance<double>;
  template struct MarkerCompliance<std::complex<double>>;
} // namespace ACF
