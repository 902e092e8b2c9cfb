// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_tangent_system_h
#define acf_solvers_tangent_system_h

#include <acf/mechanics/elastic_force.h>
#include <acf/solvers/coupled_system.h>

#include <memory>

namespace ACF
{
  /**
   * The equations of a system at rest, linearised about a state,
   * \f[ K_T = \sum_b R_b (A_b + U_b B_b U_b^T) R_b^T + S^T G S, \qquad
   *     M + S^T M_L S, \qquad D, \f]
   * with the exact derivative of the elastic forces (ElasticTangent; the strain
   * of Green and Lagrange has a matrix of its own for each state) and
   * the stiffness G of springs and of the multipliers of joints. Velocities
   * count as zero, and loads as constant: those that turn with a body have no
   * part in \f$K_T\f$.
   * See theory (16.2).
   */
  class TangentSystem
  {
  public:
    TangentSystem(const MultibodySystem &system, Statistics &statistics);

    /**
     * @param load_factor factor of the actuations of force elements
     * @return false if a body is turned inside out
     */
    bool
    linearize(const SystemState &state, const double load_factor = 1);

    /** The body because of which linearize() has returned false. */
    unsigned int
    inverted_body() const
    {
      return tangents.size();
    }

    /** $y = K_T x$ */
    void
    apply_stiffness(SystemVector &y, const SystemVector &x) const;

    /** $y = (M + S^T M_L S)\, x$ */
    void
    apply_mass(SystemVector &y, const SystemVector &x) const;

    /**
     * Makes solve() ready for the linearised state. Keeps the factorisations of
     * bodies with the reduced strain while the shift stays.
     * @param shift $\sigma > 0$, 1/s^2
     * @throws SimulationError see CoupledSystem
     */
    void
    factorize(const double shift);

    /**
     * Solves \f$(K_T + \sigma (M + S^T M_L S))\, w + S^T D^T \mu = r\f$,
     * \f$D S w = g\f$.
     * @param[in,out] r replaced by w
     * @param[in,out] g replaced by \f$\mu\f$
     */
    void
    solve(SystemVector &r, Eigen::VectorXd &g);

  private:
    /** Adds S^T N S x. */
    void
    add_marker_product(const Eigen::SparseMatrix<double> &N,
                       const SystemVector &x,
                       SystemVector &y) const;

    const MultibodySystem &system;
    Statistics &statistics;

    std::vector<ElasticTangent> tangents;
    MarkerLinearization linearization;
    Eigen::SparseMatrix<double> G;
    Eigen::SparseMatrix<double> lumped_mass;

    double factor_shift = 0;
    std::unique_ptr<FactorizationCache> cache;
    std::unique_ptr<CoupledSystem<double>> coupled_system;
  };

  /**
   * A rate of the slow motions of the bodies, $10^{-6} E / (\rho L^2)$ of the
   * body for which it is smallest, 1/s^2. As a shift it is small beside the
   * stiffness of the bodies, and large beside its round-off.
   */
  double
  slow_squared_rate(const MultibodySystem &system);
} // namespace ACF

#endif
