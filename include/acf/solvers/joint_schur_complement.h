// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_joint_schur_complement_h
#define acf_solvers_joint_schur_complement_h

#include <acf/mechanics/multibody_system.h>
#include <acf/solvers/factorization_cache.h>

namespace ACF
{
  /**
   * Solves the equations of all bodies coupled by their joints, in the bodies'
   * frames,
   * \f[ K_b w_b + B_b^T \mu = r_b, \qquad \sum_b B_b w_b = g, \qquad
   *     B_b = D_b (I \otimes R_b) S_b, \f]
   * with the functional values $S_b$ and the constraint coefficients $D_b$, by
   * the Schur complement $\sum_b D'_b C_b D_b'^T$, $D'_b = D_b (I \otimes R_b)$
   * (paper Eq. (32)). Only $D'_b$ depends on the rotations; the compliances
   * $C_b$ belong to the cached factorisations. Without joints there is no Schur
   * complement and nothing is done for it.
   */
  template <typename Number>
  class JointSchurComplement
  {
  public:
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    /**
     * @param system the bodies and their constraints
     * @param rotations $R_b$ of each body
     * @param factors factorisation of each body; must outlive this object
     */
    JointSchurComplement(const MultibodySystem &system,
                         const std::vector<Matrix3> &rotations,
                         std::vector<JointedFactorization<Number> *> factors,
                         Statistics &statistics);

    /**
     * @param[in,out] bodies right-hand sides $r_b$ in the bodies' frames,
     * replaced by $w_b$
     * @param g right-hand side of the constraints
     * @return $\mu$
     */
    Vector
    solve(std::vector<std::vector<Number>> &bodies, const Vector &g);

  private:
    const MultibodySystem &system;
    std::vector<JointedFactorization<Number> *> factors;
    Statistics &statistics;

    /** $D'_b$ */
    std::vector<Eigen::MatrixXd> rotated_constraints;

    Eigen::PartialPivLU<Matrix> schur_complement;
  };
} // namespace ACF

#endif
