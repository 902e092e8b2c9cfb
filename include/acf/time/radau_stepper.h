// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_radau_stepper_h
#define acf_time_radau_stepper_h

#include <acf/solvers/anderson_acceleration.h>
#include <acf/time/stage_equations.h>

#include <functional>
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
    unsigned int max_krylov_iterations = 40;
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
   * Radau IIA for the index-3 equations of a multibody system: solves the
   * StageEquations of each step, the last stage of which ends the step, by a
   * simplified Newton iteration with the linear systems of a StageSolver, whose
   * factorisations depend on the step size only.
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
   *
   * Where the iteration does not contract enough because the stiffness of the
   * undeformed bodies is no good tangent any more, bodies with the reduced
   * strain get its change of low rank (ReducedStrainTangent). If that is not
   * enough, or the strain is that of Green and Lagrange, Newton's method with
   * the exact tangent of those bodies takes the place of the iteration
   * (StageTangent); the StageSolver is then the preconditioner. From time to
   * time the step goes back to the simplified iteration. If the step has been
   * halved twice without success, bodies with the strain of Green and Lagrange
   * get factorisations with their present tangent.
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
    predict(const SystemState &state);

    /** How exactly the iteration linearises the elastic forces. */
    enum class Linearization
    {
      /** R A R^T for all bodies. */
      simplified,

      /** With changes of low rank where bodies need it. */
      corrected,

      /** The exact tangent where bodies need it. */
      exact
    };

    /**
     * Gives the stage solver the rotations and markers of the prediction, and
     * unless simplified the changes of low rank.
     * @return false, and why, if a matrix is singular
     */
    bool
    prepare(StepReport &report);

    /** Predicts and iterates with the present linearisation. */
    void
    try_linearization(const SystemState &state, StepReport &report);

    /** The next linearisation to try. @return false if there is none */
    bool
    linearize_better();

    /**
     * Solves the linear system of an iteration.
     * @param[in,out] r forces, replaced by increments
     * @param[in,out] g constraints, replaced by increments of the multipliers
     * @return false, and why, if a body is turned inside out
     */
    using LinearSolver =
      std::function<bool(StageVector &, StageConstraints &, std::string &)>;

    /** Iterates from the prediction to the tolerance, or to a failure.
     * @param patience iterations before a failure to contract counts
     * @param accelerate whether by Anderson's method */
    void
    iterate(const LinearSolver &solve,
            const unsigned int patience,
            const bool accelerate,
            StepReport &report);

    /** Newton's method with the exact tangent of the bodies that need it. */
    void
    iterate_exactly(StepReport &report);

    /** Marks bodies whose last increments were not small beside the largest. */
    void
    mark_bodies(const StageVector &increment);

    /** Makes the tangents of the prediction the matrices of marked bodies, or
     * restores the old ones if these cannot be factorised. */
    void
    refresh_factors(StepReport &report);

    /** Corrects the positions of converged stages until constraints hold up to
     * round-off, without solves of bodies. */
    void
    correct_constraints();

    /** Law values of force elements, continuous from an earlier state. */
    void
    update_laws(SystemState &state, const SystemState &before) const;

    double
    increment_norm(const SystemVector &increment, const unsigned int b) const;

    double
    increment_norm(const StageVector &increment) const;

    const MultibodySystem &system;
    const TimeParameters parameters;
    Statistics &statistics;

    const ButcherTableau tableau;
    const Eigen::MatrixXd A_inverse;
    FactorizationCache cache;
    std::unique_ptr<StageSolver> stage_solver;

    /** The tried step. */
    StageEquations equations;

    StageRotations rotations;
    std::unique_ptr<StageTangent> tangent;

    AndersonAcceleration acceleration;

    Linearization linearization = Linearization::simplified;

    /** Bodies for which the simplified linearisation is not enough. */
    std::vector<bool> marked;

    /** Steps until the simplified iteration is tried again; the next such wait.
     */
    unsigned int waiting_steps = 0;
    unsigned int next_wait     = first_wait;

    /** Failed tries since the last accepted step. */
    unsigned int n_failures = 0;

    static constexpr unsigned int first_wait   = 4;
    static constexpr unsigned int longest_wait = 64;

    StageVector accepted_stages;
    StageConstraints accepted_multipliers;
    SystemState step_start;
    double accepted_step_size = 0;

    /** $\theta / (1 - \theta)$ of the last measurement. */
    double convergence_factor = 1;
  };
} // namespace ACF

#endif
