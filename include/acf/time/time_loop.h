// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_time_loop_h
#define acf_time_time_loop_h

#include <acf/time/radau_stepper.h>
#include <acf/time/step_sizes.h>

#include <chrono>
#include <functional>

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

    /**
     * The next time to observe, s: a multiple of the interval, or the end of
     * the last step.
     */
    double
    next_time(const double after_step) const;

    /** Marks the observation of a time as done. */
    void
    advance(const double time);

    /** Leaves out the observations before a time, s. */
    void
    start_at(const double time);

    double
    interval() const
    {
      return observation_interval;
    }

    /** What it is called in a checkpoint; empty: it is not kept in one, and
     * begins at the time of the restart. */
    virtual std::string
    name() const
    {
      return "";
    }

    /** Saves or loads what has been observed, and when. */
    virtual void
    exchange(Archive &archive);

  private:
    double observation_interval;
    unsigned long n_observations = 0;
    double last_time             = 0;
  };



  /** When a simulation is saved, and how. */
  struct Checkpoints
  {
    /** Simulated time between two of them, s; 0: only if the simulation does
     * not reach its end. */
    double interval = 0;

    /** Wall time between two of them, s; 0: none. */
    double wall_interval = 0;

    /** Saves the simulation. Empty: never. */
    std::function<void()> save;

    /** What the user continues with, for messages. */
    std::string file;
  };



  /**
   * Steps through time: tries, halves or rejects, accepts, and shows the
   * observers the states at their times, which need not be ends of steps. The
   * last step may pass the end time; what is shown then ends at the end time.
   *
   * Multipliers are known for the stages of a step; those at the start of the
   * simulation are extrapolated from the first step.
   */
  class TimeLoop
  {
  public:
    /**
     * @param start see initial_state()
     * @param observers live longer than this object, as do the others
     */
    TimeLoop(const MultibodySystem &system,
             const SystemState &start,
             const TimeParameters &parameters,
             const std::vector<Observer *> &observers,
             Statistics &statistics);

    /**
     * Steps to the end time and saves checkpoints: at the interval and the end,
     * and where the simulation fails or is interrupted.
     *
     * @throws SimulationError if a step fails after all halvings, if the
     * tolerance is out of reach, if repeated constraints contradict each other,
     * if an observer fails, or if a signal interrupts the simulation (see
     * InterruptionGuard); the observers have then seen everything up to the
     * last accepted step
     */
    void
    run(Progress &progress, const Checkpoints &checkpoints = {});

    /** At the end of the last accepted step. */
    const SystemState &
    state() const
    {
      return present;
    }

    /** Saves or loads everything that the steps to come depend on. */
    void
    exchange(Archive &archive);

  private:
    /** The steps of run(), and their checkpoints. */
    void
    advance(Progress &progress, const Checkpoints &checkpoints);

    /** Whether a checkpoint is due after a step that began at a time. */
    bool
    is_due(const Checkpoints &checkpoints, const double before) const;

    /** Tries a step. @return whether it was accepted */
    bool
    step();

    /** Shows the observers their times in the last step. */
    void
    show();

    const MultibodySystem &system;
    const TimeParameters parameters;
    const std::vector<Observer *> observers;
    Statistics &statistics;

    RadauStepper stepper;
    StepSizes sizes;
    SystemState present;

    /** Of the last step: its size, 0 if there was none, and its iterations. */
    double last_size             = 0;
    unsigned int last_iterations = 0;

    using Clock = std::chrono::steady_clock;
    Clock::time_point last_checkpoint;

    /** s; negative: there was none. */
    double saved_time = -1;
  };

  /** A TimeLoop from beginning to end, without checkpoints. */
  void
  run_time_loop(const MultibodySystem &system,
                const SystemState &start,
                const TimeParameters &parameters,
                const std::vector<Observer *> &observers,
                Progress &progress,
                Statistics &statistics);
} // namespace ACF

#endif
