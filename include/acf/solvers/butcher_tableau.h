// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_butcher_tableau_h
#define acf_solvers_butcher_tableau_h

#include <Eigen/Dense>

#include <complex>
#include <vector>

namespace ACF
{
  /** A collocation Runge-Kutta method whose last stage ends the step. */
  struct ButcherTableau
  {
    /** Coefficients $a_{ij}$. */
    Eigen::MatrixXd A;

    /** Abscissae $c_i$, the last one is 1. */
    Eigen::VectorXd c;

    unsigned int
    n_stages() const
    {
      return c.size();
    }
  };

  /**
   * Radau IIA with 1 (implicit Euler), 2 or 3 stages, order 2 s - 1 (Hairer and
   * Wanner, Solving Ordinary Differential Equations II, Sec. IV.5).
   * See theory (15.1).
   */
  ButcherTableau
  radau_iia(const unsigned int n_stages);

  /**
   * Diagonalisation $A^{-2} = T D T^{-1}$ of the stage equations of
   * second-order systems. Complex eigenvalues come in conjugate pairs, of which
   * one member is kept: a stage vector is
   * $z = \sum_k \omega_k \mathrm{Re}(T_k \hat z_k)$, $\hat z_k = T^{-1}_k z$,
   * with $\omega_k = 1$ for a real and 2 for a complex eigenvalue.
   */
  struct StageDiagonalization
  {
    struct Component
    {
      /** $d_k$; the shift of a body's factorisation is $d_k / \tau^2$. */
      std::complex<double> eigenvalue;

      /** Column of T, size n_stages. */
      std::vector<std::complex<double>> to_stages;

      /** Row of $T^{-1}$, size n_stages. */
      std::vector<std::complex<double>> from_stages;

      bool
      is_real() const
      {
        return eigenvalue.imag() == 0;
      }
    };

    std::vector<Component> components;
  };

  /** See theory (12.3). */
  StageDiagonalization
  diagonalize_stages(const ButcherTableau &tableau);

  /**
   * Block-triangular approximation $A^2 \approx L D$ from $A^2 = L D U$ with
   * unit triangular L and U: the iteration then solves one real one-step matrix
   * $M + \tau^2 D_i A$ per stage, stage by stage, as the paper does (Sec. 7.1),
   * and contracts with the spectral radius of an s x s matrix.
   */
  struct StageTriangularization
  {
    /** $D_i$. */
    Eigen::VectorXd diagonal;

    /** Unit lower triangular L. */
    Eigen::MatrixXd lower;

    /**
     * $A^2 D^{-1}$: the increments of the stages are
     * $\Delta Z = \tau^2 A^2 \Delta Y = A^2 D^{-1} W$ with
     * $W_i = \tau^2 D_i \Delta Y_i$.
     */
    Eigen::MatrixXd increments;
  };

  /** See theory (12.9). */
  StageTriangularization
  triangularize_stages(const ButcherTableau &tableau);

  /**
   * Values $\ell_i(c)$ of the polynomials of degree s + 1 with the double root
   * 0 and the value 1 at $c_i$, zero at the other abscissae. Positions over a
   * step are $x_n + c \tau v_n + \sum_i \ell_i(c) Z_i$.
   * See theory (18.1).
   */
  std::vector<double>
  stage_shape(const ButcherTableau &tableau, const double c);
} // namespace ACF

#endif
