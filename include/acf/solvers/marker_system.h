// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_marker_system_h
#define acf_solvers_marker_system_h

#include <acf/mechanics/multibody_system.h>
#include <acf/solvers/marker_compliance.h>
#include <acf/solvers/repeated_pattern.h>

#include <Eigen/SparseLU>

namespace ACF
{
  /**
   * A change $U B U^T$ of a body's matrix K with columns U of length one. Its
   * unknowns are $\zeta / \kappa$ with the size $\kappa$ of B, so that their
   * rows are in m as those of the markers.
   */
  template <typename Number>
  struct MatrixChange
  {
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;

    /** Number of the first unknown in a MarkerSystem. */
    unsigned int first;

    Matrix columns;

    /** $Y_U = K^{-1} U$ */
    Matrix solutions;

    /** $\kappa (B^{-1} + U^T Y_U)$ */
    Matrix matrix;

    /** $R S Y_U$ */
    Matrix marker_values;

    double size;
  };



  /**
   * The equations of all bodies' marker values s, multipliers and changes
   * $\zeta$, with the compliances C of all bodies in world directions:
   * \f[ s + C (H s + D^T \mu) + R S Y_U \zeta = u, \qquad
   *     D s - \epsilon E \mu = g, \f]
   * and those of $\zeta$, see CoupledSystem. See theory (12.7), theory (16.3).
   */
  template <typename Number>
  class MarkerSystem
  {
  public:
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;
    using Matrix = Eigen::SparseMatrix<Number>;

    /**
     * @param first_values number of the first marker value of each body
     * @param H_transposed,D with the same entries each time
     * @param redundancy E
     * @param changes of all bodies or nothing
     * @return whether the matrix is regular
     */
    bool
    factorize(const std::vector<MarkerCompliance<Number>> &compliances,
              const std::vector<unsigned int> &first_values,
              const Matrix &H_transposed,
              const Eigen::SparseMatrix<double> &D,
              const MarkerLinearization::Triplets &redundancy,
              const std::vector<MatrixChange<Number>> &changes);

    /** @param rhs of the marker values, multipliers and changes */
    Vector
    solve(const Vector &rhs) const
    {
      return factor.solve(rhs);
    }

  private:
    /** I + C H and C D^T of a body. @return the largest compliance */
    double
    add_compliances(const MarkerCompliance<Number> &compliance,
                    const unsigned int first,
                    const Matrix &H_transposed,
                    const Eigen::SparseMatrix<double> &D);

    void
    add_change(const MatrixChange<Number> &change,
               const unsigned int first,
               const Matrix &H_transposed,
               const Eigen::SparseMatrix<double> &D);

    RepeatedPattern<Number> matrix;
    Eigen::SparseLU<Matrix> factor;

    /** Whether the factor is made for the entries without E and changes. */
    bool analyzed = false;

    /** Work space. */
    typename RepeatedPattern<Number>::Triplets triplets;
  };
} // namespace ACF

#endif
