// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_radau_stepper_h
#define acf_time_radau_stepper_h

#include <acf/time/local_error.h>
#include <acf/time/stage_iteration.h>
#include <acf/time/stage_predictor.h>

namespace ACF
{
  /**
   * Radau IIA for the index-3 equations of a multibody system: a StageIteration
   * solves the StageEquations of each step, the last stage of which ends the
   * step.
   * See theory (14.2).
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

    /** Whether a step size needs no new factorisation. */
    bool
    has_factors(const double step_size) const
    {
      return iteration.has_factors(step_size);
    }

    /** Makes the end of the last tried step the new state. */
    void
    accept(SystemState &state);

    /**
     * The state at a time of the accepted step, from the collocation
     * polynomial.
     * See theory (18.1).
     * @pre @p time lies in the last accepted step
     */
    SystemState
    interpolate(const double time) const;

    /** Saves or loads what steps leave, so that the next one does not notice.
     */
    void
    exchange(Archive &archive);

  private:
    /** Whether there are steps, and parameters that let them predict. */
    bool
    extrapolates() const;

    /**
     * Predicts the stages of the step (StagePredictor); those of the first step
     * by a motion without acceleration.
     */
    void
    predict(const SystemState &state);

    /** Replaces the prediction of a body that turns fast if another one was
     * better in the last step. */
    void
    follow_turning(const unsigned int body, const SystemState &state);

    /**
     * A prediction for a body that turns fast: only its centre of mass follows
     * that of the StagePredictor, the rest moves without acceleration in a
     * frame that turns about the centre with the spin of the state, rad/s.
     */
    void
    predict_turning(const unsigned int body,
                    const SystemState &state,
                    const Vector3 &spin,
                    StageVector &increments) const;

    /** Where the iteration ends: as the parameters say, or a part of the
     * estimated local error of the earlier step. */
    NewtonTolerances
    tolerances() const;

    /** Largest distance of accepted stages of a body from a prediction, m. */
    double
    prediction_error(const unsigned int body,
                     const StageVector &prediction) const;

    /** Law values of force elements, continuous from an earlier state. */
    void
    update_laws(SystemState &state, const SystemState &before) const;

    const MultibodySystem &system;
    const TimeParameters parameters;
    const ButcherTableau tableau;
    const Eigen::MatrixXd A_inverse;

    /** The tried step. */
    StageEquations equations;
    StageIteration iteration;

    StageHistory history;
    StagePredictor predictor;
    LocalError local_error;

    /** Both predictions for bodies that turn fast, and which was the better one
     * in the last step. */
    StageVector straight;
    StageVector turning;
    std::vector<char> turns;
    std::vector<bool> turning_is_better;

    /** Estimated in the last steps, falls at most by half per step; negative:
     * there is none. */
    double expected_error = -1;

    /** Of the tried step. */
    double tried_error = 0;

    SystemState step_start;
  };
} // namespace ACF

#endif
