// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_constraint_system_h
#define acf_solvers_constraint_system_h

#include <acf/mechanics/multibody_system.h>
#include <acf/solvers/marker_compliance.h>
#include <acf/solvers/repeated_pattern.h>

#include <Eigen/SparseLU>

namespace ACF
{
  /**
   * The Schur complement of constraints,
   * \f[ (D C D^T + \epsilon E)\, \mu = h \f]
   * with the compliances C of all bodies (paper Eq. (32)). Its rows are scaled
   * to a diagonal of ones, as they have different units. See theory (12.8).
   */
  template <typename Number>
  class ConstraintSystem
  {
  public:
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    /**
     * @param first_values number of the first marker value of each body
     * @param D constraints times marker values
     * @param redundancy E; D has the same entries each time, E perhaps not
     * @return whether the matrix is regular
     */
    bool
    factorize(const std::vector<MarkerCompliance<Number>> &compliances,
              const std::vector<unsigned int> &first_values,
              const Eigen::SparseMatrix<double> &D,
              const MarkerLinearization::Triplets &redundancy);

    Vector
    solve(const Vector &h) const;

  private:
    using Triplets = typename RepeatedPattern<Number>::Triplets;

    /** Numbers of the constraints on a body. */
    void
    find_rows(const std::vector<MarkerCompliance<Number>> &compliances,
              const std::vector<unsigned int> &first_values,
              const Eigen::SparseMatrix<double> &D);

    /** Adds $D_b C_b D_b^T$. */
    void
    add_body(const MarkerCompliance<Number> &compliance,
             const std::vector<int> &rows,
             const unsigned int first_value,
             const Eigen::SparseMatrix<double> &D);

    std::vector<std::vector<int>> body_rows;
    Eigen::VectorXd row_scales;
    RepeatedPattern<Number> matrix;
    Eigen::SparseLU<Eigen::SparseMatrix<Number>> factor;

    /** Whether the factor is made for the entries of D, without E. */
    bool analyzed = false;

    /** Work space. */
    Triplets triplets;
    std::vector<int> local_rows;
    Eigen::MatrixXd local_gradients;
    Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic> displacements;
  };
} // namespace ACF

#endif
