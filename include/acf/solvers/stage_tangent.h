// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_stage_tangent_h
#define acf_solvers_stage_tangent_h

#include <acf/mechanics/elastic_force.h>
#include <acf/solvers/stage_solver.h>

#include <optional>

namespace ACF
{
  /**
   * The exact derivative of the stage equations, as a product with vectors,
   * \f[ r_i = \sum_j \big( \tau^{-2} (A_{RK}^{-2})_{ij} M
   *         + \tau^{-1} (A_{RK}^{-1})_{ij} C_i \big)\, z_j + K_i z_i
   *         + B_i^T \lambda_i, \qquad g_i = B_i z_i, \f]
   * with the derivatives of elastic forces (ElasticTangent), joints, springs
   * and dampers at each stage. Bodies that are not linearised exactly have the
   * stiffness \f$R_i A R_i^T\f$ of a StageSolver. Rayleigh damping is
   * $C_i = \alpha M + \beta K_i$, without the derivative of the rotation in it.
   * See theory (13.7).
   */
  class StageTangent
  {
  public:
    StageTangent(const MultibodySystem &system, const ButcherTableau &tableau);

    /** Begins a new linearisation: no body is exact, no marker acts. */
    void
    reset(const double step_size, const StageRotations &rotations);

    /** @return false if the body is turned inside out */
    bool
    linearize_body(const unsigned int stage,
                   const unsigned int body,
                   const NodalVector &positions);

    void
    linearize_markers(const unsigned int stage,
                      const MarkerLinearization &linearization);

    /**
     * @param[out] r forces, N
     * @param[out] g constraints
     */
    void
    vmult(StageVector &r,
          StageConstraints &g,
          const StageVector &z,
          const StageConstraints &lambda) const;

    /**
     * Solves the equations by GMRES, preconditioned from the left by a
     * StageSolver. The increments of bodies are measured relative to their
     * lengths, those of multipliers so that they weigh as much as the
     * increments in the preconditioned right-hand side.
     *
     * @param[in,out] r replaced by the increments
     * @param[in,out] g replaced by the increments of the multipliers
     * @param tolerance reduction of the preconditioned residual
     * @param max_iterations each takes one solve with the cached factors
     * @param[out] n_iterations
     * @return the reduction that was reached
     */
    double
    solve(StageSolver &preconditioner,
          const double tolerance,
          const unsigned int max_iterations,
          StageVector &r,
          StageConstraints &g,
          unsigned int &n_iterations) const;

  private:
    void
    apply_stiffness(const unsigned int stage,
                    const unsigned int body,
                    const NodalVector &z,
                    NodalVector &y) const;

    struct Markers
    {
      Eigen::SparseMatrix<double> stiffness, damping, mass, constraints;
    };

    const MultibodySystem &system;
    const Eigen::MatrixXd A_inverse;
    const Eigen::MatrixXd A_inverse_squared;

    double tau = 0;
    StageRotations rotations;

    /** [stage][body] */
    std::vector<std::vector<std::optional<ElasticTangent>>> bodies;

    /** [stage] */
    std::vector<Markers> markers;
  };
} // namespace ACF

#endif
