// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_repeated_constraints_h
#define acf_mechanics_repeated_constraints_h

#include <Eigen/Dense>
#include <Eigen/SparseCore>

namespace ACF
{
  /** Combinations of constraints that vanish identically. */
  struct RepeatedConstraints
  {
    /** Factors that give the gradients of the constraints unit length. */
    Eigen::VectorXd row_scales;

    /** Orthonormal columns N with $N^T \mathrm{diag}(\text{scales}) B = 0$;
     * constraints x repeated constraints. */
    Eigen::MatrixXd null_space;
  };

  /**
   * Finds repeated constraints, those with which $B K^{-1} B^T$ has no full
   * rank for any body matrix K: eigenvalues of the Gram matrix $B B^T$ of the
   * scaled gradients that are smaller than 1e-10. A sparse Cholesky
   * factorisation decides at first; eigenvalues are only computed if there are
   * any.
   * See theory (8.8).
   *
   * @param gram $B B^T$ of the unscaled gradients
   */
  RepeatedConstraints
  find_repeated_constraints(const Eigen::SparseMatrix<double> &gram);
} // namespace ACF

#endif
