// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_time_loop_h
#define acf_time_time_loop_h

#include <acf/time/error_controller.h>
#include <acf/time/radau_stepper.h>
#include <acf/time/step_controller.h>

namespace ACF
{
  class Progress;

  /** Something that looks at the state at times of its own. */
  class Observer
  {
  public:
    /** @param interval time between observations, s; zero: after every step */
    explicit Observer(const double interval);

    virtual ~Observer() = default;

    virtual void
    observe(const SystemState &state) = 0;

    /** The next time to observe, s: a multiple of the interval. */
    double
    next_time(const double after_step) const;

    /** Marks the observation of next_time() as done. */
    void
    advance();

    double
    interval() const
    {
      return observation_interval;
    }

  private:
    double observation_interval;
    unsigned long n_observations = 0;
  };



  /**
   * Steps through time: tries, halves or rejects, accepts, and shows the
   * observers the states at their times, which need not be ends of steps. The
   * last step may pass the end time; what is shown then ends at the end time.
   *
   * Multipliers are known for the stages of a step; those at the start of the
   * simulation are extrapolated from the first step.
   *
   * @param state at the start, see initial_state()
   * @throws SimulationError if a step fails after all halvings, if the
   * tolerance is out of reach, or if repeated
   * constraints contradict each other; the observers have then seen everything
   * up to the last accepted step
   */
  void
  run_time_loop(const MultibodySystem &system,
                SystemState state,
                const TimeParameters &parameters,
                const std::vector<Observer *> &observers,
                Progress &progress,
                Statistics &statistics);
} // namespace ACF

#endif
