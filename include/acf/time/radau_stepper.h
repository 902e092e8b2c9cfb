// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_radau_stepper_h
#define acf_time_radau_stepper_h

#include <acf/time/stage_iteration.h>


namespace ACF
{
  /**
   * Radau IIA for the index-3 equations of a multibody system: a StageIteration
   * solves the StageEquations of each step, the last stage of which ends the
   * step.
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
    /**
     * Predicts the stages of the step by the collocation polynomial of the
     * accepted step beyond its end, before the first step by a motion without
     * acceleration.
     */
    void
    predict(const SystemState &state);

    void
    predict_straight(const unsigned int body);

    /**
     * Changes the prediction for a body that turns fast: only its centre of
     * mass follows the polynomial, the rest moves without acceleration in a
     * frame that turns about the centre with the spin of the state, rad/s.
     */
    void
    predict_turning(const unsigned int body,
                    const SystemState &state,
                    const Vector3 &spin);

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

    StageVector accepted_stages;
    StageConstraints accepted_multipliers;
    SystemState step_start;
    double accepted_step_size = 0;
  };
} // namespace ACF

#endif
