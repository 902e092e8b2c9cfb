// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_radau_stepper_h
#define acf_time_radau_stepper_h

#include <acf/solvers/stage_solver.h>

#include <memory>
#include <string>

namespace ACF
{
  /** What a model file says of the time integration. */
  struct TimeParameters
  {
    unsigned int n_stages = 2;

    /** s */
    double end_time  = 0;
    double step_size = 0;

    /** Bound on the predicted error of the iteration, relative to the bodies.
     */
    double newton_tolerance = 1e-10;

    unsigned int max_newton_iterations = 20;
    unsigned int max_halvings          = 8;

    /** Real one-step matrices as in the paper instead of the exact ones. */
    bool one_step_matrices = false;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError for values that the patterns cannot exclude */
    void
    check() const;
  };



  /** Outcome of a trial step. */
  struct StepReport
  {
    bool converged = false;

    /** Newton iterations, that is linear stage systems solved. */
    unsigned int iterations = 0;

    /** Last measured contraction rate of the iteration. */
    double contraction = 0;

    /** Predicted remaining error, relative to the bodies' length. */
    double error_estimate = 0;

    /** Why the step did not converge. */
    std::string failure;
  };



  /**
   * Radau IIA for the index-3 equations of a multibody system. With
   * $Z_i = U_i - u_n - c_i \tau v_n$ the stages satisfy
   * \f[ \tau^{-2} (A_{RK}^{-2} \otimes M) Z + F(U, V) + B(U)^T \Lambda = P,
   *     \qquad \Phi(U_i, t_n + c_i \tau) = 0, \f]
   * the velocities are $V_i = v_n + \tau^{-1} \sum_j (A_{RK}^{-1})_{ij} Z_j$
   * and the last stage ends the step. The stage equations are solved by a
   * simplified Newton iteration whose linear systems are those of a
   * StageSolver.
   *
   * Convergence control follows RADAU5 (Hairer and Wanner, Sec. IV.8): with the
   * increments $|\Delta Z^k|$ and $\theta_k = |\Delta Z^k| / |\Delta Z^{k-1}|$
   * the iteration ends when the predicted remaining error
   * $\theta / (1 - \theta)\, |\Delta Z^k|$ is below the tolerance; before the
   * second iteration the $\theta$ of earlier steps serves, with growing doubt.
   * The norm of a body is the root mean square of the increments of its nodes
   * divided by its length, that of the system the largest over bodies and
   * stages. Errors of velocities and multipliers are those of Z divided by
   * $\tau$ and $\tau^2$, which is the usual weighting of index-2 and index-3
   * components.
   */
  class RadauStepper
  {
  public:
    RadauStepper(const MultibodySystem &system,
                 const TimeParameters &parameters,
                 Statistics &statistics);

    /**
     * Tries one step. The state stays as it is until accept() is called.
     */
    StepReport
    try_step(const SystemState &state, const double step_size);

    /** Makes the end of the last tried step the new state. */
    void
    accept(SystemState &state);

    /**
     * The state at a time of the accepted step, from the collocation
     * polynomial.
     * @pre @p time lies in the last accepted step
     */
    SystemState
    interpolate(const double time) const;

  private:
    void
    predict(const SystemState &state, const double step_size);

    /** Freezes the rotations of the predicted stages and the markers at their
     * mean. */
    void
    prepare(const SystemState &state);

    StageRotations
    predicted_rotations(const SystemState &state) const;

    bool
    assemble_residual(const SystemState &state,
                      StageVector &residual,
                      StageConstraints &constraint_residual,
                      std::string &failure);

    /** Residual of a body at a stage without the forces on markers. */
    bool
    assemble_body_residual(const SystemState &state,
                           const unsigned int stage,
                           const unsigned int body,
                           const NodalVector &position,
                           const NodalVector &velocity,
                           const NodalVector &acceleration,
                           NodalVector &residual) const;

    /**
     * Corrects the positions of converged stages until nonlinear constraints
     * hold up to round-off, without solves of bodies.
     */
    void
    correct_constraints(const SystemState &state);

    NodalVector
    stage_velocity(const SystemState &state,
                   const unsigned int stage,
                   const unsigned int body) const;

    /** Law values of force elements, continuous from an earlier state. */
    void
    update_laws(SystemState &state, const SystemState &before) const;

    double
    stage_time(const SystemState &state, const unsigned int stage) const;

    double
    increment_norm(const StageVector &increment) const;

    NodalVector
    stage_position(const SystemState &state,
                   const unsigned int stage,
                   const unsigned int body) const;

    const MultibodySystem &system;
    const TimeParameters parameters;
    Statistics &statistics;

    const ButcherTableau tableau;
    const Eigen::MatrixXd A_inverse;
    const Eigen::MatrixXd A_inverse_squared;
    FactorizationCache cache;
    std::unique_ptr<StageSolver> stage_solver;

    /** Stages of the tried step, and of the accepted one before it. */
    StageVector stages;
    StageConstraints stage_multipliers;
    double tried_step_size = 0;

    StageVector accepted_stages;
    StageConstraints accepted_multipliers;
    SystemState step_start;
    double accepted_step_size = 0;

    /** $\theta / (1 - \theta)$ of the last measurement. */
    double convergence_factor = 1;
  };
} // namespace ACF

#endif
