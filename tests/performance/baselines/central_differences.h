// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_baselines_central_differences_h
#define acf_tests_baselines_central_differences_h

#include "performance/baselines/method.h"

namespace Baselines
{
  /**
   * Explicit central differences with a lumped mass matrix
   * \f$\hat M = \mathrm{diag}(\hat m) \otimes I_3\f$ and the elastic force that
   * the program itself uses,
   * \f[ v_{n+1/2} = v_{n-1/2} + h \hat M^{-1} (p - f - S^T D_n^T \lambda_n),
   *     \quad x_{n+1} = x_n + h v_{n+1/2}, \quad
   *     \Phi(x_{n+1}, t_{n+1}) = 0 . \f]
   * The positions satisfy the joints at each step (SHAKE: Ryckaert, Ciccotti,
   * Berendsen, J. Comput. Phys. 23 (1977)); as the forces of joints act on the
   * markers s = S x, Newton's iteration for \f$\lambda_n\f$ knows these only,
   * with the constant \f$C = S \hat M^{-1} S^T\f$.
   *
   * The velocities of the state are those of the middle of the last step.
   */
  class CentralDifferences : public Method
  {
  public:
    explicit CentralDifferences(const MultibodySystem &system,
                                Statistics &statistics);

    /** \f$2 / \omega\f$ with the highest frequency of the uncoupled bodies,
     * s; see highest_frequency(). */
    double
    critical_step_size() const;

    void
    start(SystemState &state) override;

    void
    step(SystemState &state, const double step_size) override;

  private:
    /** Multipliers so that the markers \f$s - C D^T \lambda\f$ satisfy the
     * joints; D of the start of the step. */
    Eigen::VectorXd
    solve_constraints(const double t,
                      const Eigen::VectorXd &s,
                      const Eigen::MatrixXd &D,
                      Eigen::VectorXd multipliers) const;

    Eigen::MatrixXd
    jacobian(const double t, const Eigen::VectorXd &s) const;

    const MultibodySystem &system;
    Statistics &statistics;

    /** Per body and node, 1/kg. */
    std::vector<std::vector<double>> inverse_masses;

    /** C, times the identity for the three components, 1/kg. */
    Eigen::MatrixXd compliance;

    SystemVector forces;
    NodalVector scratch;
    double longest = 0;
    bool is_first_step;
  };

  /**
   * Lumped masses of a body, kg: the row sums of the mass matrix if all are
   * positive (quadratic hexahedra), else its diagonal, scaled so that the sum
   * is the mass (Hinton, Rock, Zienkiewicz, Earthq. Eng. Struct. Dyn. 4
   * (1976); quadratic tetrahedra, whose vertices have negative row sums).
   */
  std::vector<double>
  lumped_masses(const BodyOperators &body);

  /**
   * Square root of the largest eigenvalue of \f$\hat M^{-1} A\f$ by the power
   * method, which approaches it from below, until a step changes it by less
   * than 1e-6; 1/s.
   */
  double
  highest_frequency(const BodyOperators &body,
                    const std::vector<double> &masses);
} // namespace Baselines

#endif
