// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/repeated_constraints.h>

#include <Eigen/SparseCholesky>

namespace ACF
{
  RepeatedConstraints
  find_repeated_constraints(const Eigen::SparseMatrix<double> &gram)
  {
    constexpr double tolerance = 1e-10;
    RepeatedConstraints result;
    const unsigned int n = gram.rows();
    result.row_scales    = Eigen::VectorXd::Ones(n);
    result.null_space.resize(n, 0);
    if (n == 0)
      return result;
    for (unsigned int r = 0; r < n; ++r)
      if (gram.coeff(r, r) > 0)
        result.row_scales(r) = 1 / std::sqrt(gram.coeff(r, r));
    const Eigen::SparseMatrix<double> scaled =
      result.row_scales.asDiagonal() * gram * result.row_scales.asDiagonal();

    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky(scaled);
    if (cholesky.info() == Eigen::Success &&
        cholesky.vectorD().minCoeff() > 10 * tolerance)
      return result;

    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{
      Eigen::MatrixXd(scaled)};
    unsigned int n_repeated = 0;
    while (n_repeated < n && solver.eigenvalues()(n_repeated) <= tolerance)
      ++n_repeated;
    result.null_space = solver.eigenvectors().leftCols(n_repeated);
    return result;
  }
} // namespace ACF
