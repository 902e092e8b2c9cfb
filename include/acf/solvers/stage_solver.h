// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_stage_solver_h
#define acf_solvers_stage_solver_h

#include <acf/solvers/butcher_tableau.h>
#include <acf/solvers/coupled_system.h>

#include <memory>

namespace ACF
{
  /** Nodal vectors of all bodies for each stage: [stage][body]. */
  using StageVector = std::vector<SystemVector>;

  /** Constraint rows for each stage. */
  using StageConstraints = std::vector<Eigen::VectorXd>;

  /**
   * Rotations of the bodies, or of their material at the nodes, in a step. The
   * nodes of a marker turn alike.
   */
  struct StageRotations
  {
    /** [stage][body]. */
    std::vector<std::vector<NodeRotations>> stages;

    /** Between those of the stages, [body]. */
    std::vector<NodeRotations> mean;
  };

  /**
   * Solves the linear system of a simplified Newton iteration for the stage
   * increments,
   * \f[ (\tau^{-2} A_{RK}^{-2} \otimes M + \tau^{-1} A_{RK}^{-1} \otimes C
   *      + I \otimes K) \Delta Z + (I \otimes B^T) \Delta\Lambda = r, \qquad
   *     (I \otimes B) \Delta Z = g, \f]
   * or an approximation of it, with factorisations that depend on the step size
   * only. K is the stiffness R A R^T of the bodies, with changes of low rank
   * R (A + U B U^T) R^T where they are given, and that of the markers, C the
   * Rayleigh damping and that of the markers, M includes lumped masses.
   *
   * One factorisation serves bodies that turn in the step because
   * $\Delta Z_i = R_i w_i$ is solved for in frames that turn with them: with
   * the rotation R_i of stage i the stiffness of the body is exact, and what
   * the equations for w neglect, $R_i^T R_j - 1$, meets only the masses and the
   * markers. (With one rotation for all stages the error would meet the
   * stiffness, whose higher modes then decide the contraction.) For the strain
   * of Green and Lagrange R_i may turn each node with its material; then R A
   * R^T is no more than close to the tangent. Rotations and markers are frozen
   * by prepare().
   * See theory (12.1).
   */
  class StageSolver
  {
  public:
    virtual ~StageSolver() = default;

    /**
     * Chooses the step size and freezes the rotations of the bodies. Factorises
     * what the cache does not have.
     * @param changes of A of each body, or nothing; take one solve per column
     * and factor
     */
    virtual void
    prepare(const double step_size,
            const StageRotations &rotations,
            const MarkerLinearization &linearization,
            const std::vector<LowRankChange> &changes = {}) = 0;

    /**
     * @param[in,out] stages r, replaced by $\Delta Z$, in the world frame
     * @param[in,out] constraints g, replaced by $\Delta\Lambda$
     */
    virtual void
    solve(StageVector &stages, StageConstraints &constraints) = 0;

    /**
     * The same for r = 0, which needs no solves of the bodies, and with the
     * mean rotations in all stages, so that affine constraints hold afterwards.
     * @param[in,out] stages $\Delta Z$ is added to them
     * @param[in,out] constraints g, replaced by $\Delta\Lambda$
     */
    virtual void
    solve_constraints(StageVector &stages, StageConstraints &constraints) = 0;
  };



  /** The shifted matrix $\sigma m \otimes I_3 + A$ of a body that a stage
   * solver factorises. */
  struct StageMatrix
  {
    /** $\sigma$, 1/s^2 */
    std::complex<double> shift;

    /** Whether the factorisation is one of real numbers. */
    bool is_real;
  };

  /**
   * All of them for a step size, s.
   * @param one_step those of the OneStepStageSolver, otherwise of the
   * DiagonalizedStageSolver
   */
  std::vector<StageMatrix>
  stage_matrices(const Body &body,
                 const ButcherTableau &tableau,
                 const bool one_step,
                 const double step_size);



  /**
   * Exact solution by diagonalisation $A_{RK}^{-2} = T D T^{-1}$: one complex
   * factorisation $(d/\tau^2) M + A$ for a conjugate pair, one real one for a
   * real eigenvalue.
   * See theory (12.3), theory (12.5).
   */
  class DiagonalizedStageSolver : public StageSolver
  {
  public:
    DiagonalizedStageSolver(const MultibodySystem &system,
                            const ButcherTableau &tableau,
                            FactorizationCache &cache,
                            Statistics &statistics);

    void
    prepare(const double step_size,
            const StageRotations &rotations,
            const MarkerLinearization &linearization,
            const std::vector<LowRankChange> &changes = {}) override;

    void
    solve(StageVector &stages, StageConstraints &constraints) override;

    void
    solve_constraints(StageVector &stages,
                      StageConstraints &constraints) override;

  private:
    /**
     * Adds what a component gives.
     * @param is_first increments are replaced, those of the stages after the
     * right-hand sides have been read, if there are any
     */
    template <typename Number>
    void
    solve_component(const StageDiagonalization::Component &component,
                    CoupledSystem<Number> &coupled_system,
                    const bool is_first,
                    const StageVector *stages,
                    const StageConstraints &constraints,
                    StageVector &stage_increments,
                    StageConstraints &constraint_increments);

    void
    solve_all(const StageVector *stages,
              const StageConstraints &constraints,
              StageVector &stage_increments,
              StageConstraints &constraint_increments);

    const MultibodySystem &system;
    const StageDiagonalization diagonalization;
    FactorizationCache &cache;
    Statistics &statistics;
    StageRotations rotations;

    /** One of the two for each component, depending on its eigenvalue. */
    std::vector<std::unique_ptr<CoupledSystem<double>>> real_systems;
    std::vector<std::unique_ptr<CoupledSystem<std::complex<double>>>>
      complex_systems;

    /** Right-hand sides that several components read. */
    StageVector work;
  };



  /**
   * Approximate solution with real one-step matrices, stage by stage, in the
   * manner of the paper (Sec. 7.1): $A_{RK}^2 \approx L D$, so that with
   * $\Delta Z = \tau^2 L D\, \Delta Y$
   * \f[ (M + \tau^2 D_i K) \Delta Y_i + B^T \Delta\Lambda_i = r_i -
   *     \tau^2 K \sum_{j<i} L_{ij} D_j \Delta Y_j. \f]
   * Damping enters each stage with the rate $1 / (\tau \sqrt{D_i})$ alone, and
   * K on the right is without changes of low rank.
   * See theory (12.9).
   */
  class OneStepStageSolver : public StageSolver
  {
  public:
    OneStepStageSolver(const MultibodySystem &system,
                       const ButcherTableau &tableau,
                       FactorizationCache &cache,
                       Statistics &statistics);

    void
    prepare(const double step_size,
            const StageRotations &rotations,
            const MarkerLinearization &linearization,
            const std::vector<LowRankChange> &changes = {}) override;

    void
    solve(StageVector &stages, StageConstraints &constraints) override;

    void
    solve_constraints(StageVector &stages,
                      StageConstraints &constraints) override;

  private:
    const MultibodySystem &system;
    const StageTriangularization triangularization;
    FactorizationCache &cache;
    Statistics &statistics;
    StageRotations rotations;

    void
    solve_all(const StageVector *stages,
              const StageConstraints &constraints,
              StageVector &stage_increments,
              StageConstraints &constraint_increments);

    /** The product of K with vectors in the bodies' frames. */
    void
    multiply_stiffness(const SystemVector &w, SystemVector &product) const;

    std::vector<std::unique_ptr<CoupledSystem<double>>> systems;

    /** Of the markers, at the last prepare(). */
    Eigen::SparseMatrix<double> marker_stiffness;
  };
} // namespace ACF

#endif
