// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_stage_iteration_h
#define acf_time_stage_iteration_h

#include <acf/solvers/anderson_acceleration.h>
#include <acf/time/first_iteration.h>
#include <acf/time/stage_equations.h>
#include <acf/time/stage_history.h>
#include <acf/time/time_parameters.h>

#include <functional>

namespace ACF
{
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

    /** Estimated error that the step adds if it is solved exactly, relative to
     * the bodies' length, see LocalError. */
    double local_error = 0;

    /** Why the step did not converge. */
    std::string failure;
  };



  /** Where an iteration ends. */
  struct NewtonTolerances
  {
    /** Bound on the predicted error. */
    double error = 1e-10;

    /** A bound that is good enough where round-off keeps the error above the
     * other one. */
    double round_off = 0;
  };



  /**
   * Solves StageEquations by a simplified Newton iteration with the linear
   * systems of a StageSolver, whose factorisations depend on the step size
   * only.
   *
   * Convergence control follows RADAU5 (Hairer and Wanner, Sec. IV.8): with the
   * increments $|\Delta Z^k|$ and $\theta_k = |\Delta Z^k| / |\Delta Z^{k-1}|$
   * the iteration ends when the predicted remaining error
   * $\theta / (1 - \theta)\, |\Delta Z^k|$ is below the tolerance. After the
   * first iteration the $\theta$ of an earlier step serves (FirstIteration).
   * The norm of a body is the root mean square of the increments of its nodes
   * divided by its length, that of the system the largest over bodies and
   * stages. Errors of velocities and multipliers are those of Z divided by
   * $\tau$ and $\tau^2$, which is the usual weighting of index-2 and index-3
   * components. AndersonAcceleration makes it faster where it contracts slowly.
   *
   * Where that is not enough because the stiffness of the undeformed bodies is
   * no good tangent any more, bodies with the reduced strain get its change of
   * low rank (ReducedStrainTangent). If that is not enough either, or the
   * strain is that of Green and Lagrange, Newton's method with the exact
   * tangent of those bodies takes the place of the iteration (StageTangent);
   * the StageSolver is then the preconditioner. From time to time the step goes
   * back to the simplified iteration. If the step has failed twice, bodies with
   * the strain of Green and Lagrange get factorisations with their present
   * tangent.
   *
   * A step is tried like this:
   * See theory (13.1).
   * @code
   * iteration.start_step();
   * do
   *   {
   *     // predict the stages
   *     iteration.run(equations, report);
   *   }
   * while (!report.converged && iteration.linearize_better());
   * iteration.end_step(equations, report);
   * @endcode
   */
  class StageIteration
  {
  public:
    /** @param tableau lives longer than this object, as do the others */
    StageIteration(const MultibodySystem &system,
                   const ButcherTableau &tableau,
                   const TimeParameters &parameters,
                   Statistics &statistics);

    /** Chooses the linearisation to begin with. */
    void
    start_step();

    /**
     * Iterates from the prediction to the tolerance, or to a failure.
     * @param[in,out] equations stages: predicted ones, replaced by the solution
     * @param tolerances of the predicted error, relative to the length of the
     * bodies
     * @param[in,out] report adds the iterations
     */
    void
    run(StageEquations &equations,
        const NewtonTolerances &tolerances,
        StepReport &report);

    /** Chooses the next linearisation to try. @return false if there is none
     */
    bool
    linearize_better();

    /**
     * Takes note of success or failure. Corrects the stages if they have
     * converged until constraints hold up to round-off.
     */
    void
    end_step(StageEquations &equations, const StepReport &report);

    /** The step has been accepted. */
    void
    accept();

    /** Whether a step size needs no new factorisation. */
    bool
    has_factors(const double step_size) const
    {
      return cache.holds(step_size);
    }

    /** Saves or loads what steps leave. */
    void
    exchange(Archive &archive);

  private:
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
    prepare(StageEquations &equations, StepReport &report);

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
            StageEquations &equations,
            StepReport &report);

    /**
     * Sets the outcome of an iteration in the report.
     * @param norms of the increments of this iteration and those before it
     * @return false, and why, if the iteration has failed
     */
    bool
    judge(const std::vector<double> &norms,
          const unsigned int patience,
          StepReport &report) const;

    /** Newton's method with the exact tangent of the bodies that need it. */
    void
    iterate_exactly(StageEquations &equations, StepReport &report);

    /**
     * Mean increments that the resultants of the forces ask for, for free
     * bodies whose linear system does not conserve momentum: internal forces
     * have no resultant, but those of frames that differ between nodes do, and
     * those of inexact solutions and of factors in single precision.
     * [body][stage], empty for other bodies.
     */
    std::vector<std::vector<Vector3>>
    free_translations(const StageVector &forces, const double step_size) const;

    /** Gives increments these means. */
    void
    translate(const std::vector<std::vector<Vector3>> &means,
              StageVector &increment) const;

    /** Marks bodies whose last increments were not small beside the largest. */
    void
    mark_bodies(const StageVector &increment);

    /** Makes the tangents of the prediction the matrices of marked bodies, or
     * restores the old ones if these cannot be factorised. */
    void
    refresh_factors(StageEquations &equations, StepReport &report);

    /** Corrects the positions of converged stages until constraints hold up to
     * round-off, without solves of bodies. */
    void
    correct_constraints(StageEquations &equations);

    /** The largest one of the bodies and stages, see relative_norm(). */
    double
    increment_norm(const StageVector &increment) const;

    /** Adds increments to those of the step. */
    void
    add(const StageVector &increment,
        const StageConstraints &constraint_increment,
        StageEquations &equations) const;

    const MultibodySystem &system;
    const ButcherTableau &tableau;
    const TimeParameters &parameters;
    Statistics &statistics;

    FactorizationCache cache;
    std::unique_ptr<StageSolver> stage_solver;
    std::unique_ptr<StageTangent> tangent;
    AndersonAcceleration acceleration;

    /** Work space; has no values between calls. */
    StageVector newton_increment;

    /** Of the present prediction. */
    StageRotations rotations;

    /** Residual of the constraints that corrections do not reduce. */
    double constraint_round_off = 0;

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

    /** Of the present step. */
    NewtonTolerances tolerances;

    FirstIteration first_iteration;
  };
} // namespace ACF

#endif
