// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/base/interruption.h>
#include <acf/time/time_loop.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ACF
{
  namespace
  {
    // Times closer than this part of a step are the same.
    constexpr double same_time = 1e-9;



    // Shows an observer all its times in the accepted step up to its end.
    void
    observe_step(Observer &observer,
                 const RadauStepper &stepper,
                 const SystemState &state,
                 const double step_size,
                 const double end_time)
    {
      const double end = std::min(state.time, end_time) + same_time * step_size;
      for (double time = observer.next_time(std::min(state.time, end_time));
           time <= end;
           time = observer.next_time(std::min(state.time, end_time)))
        {
          if (std::abs(time - state.time) <= same_time * step_size)
            observer.observe(state);
          else
            observer.observe(stepper.interpolate(time));
          observer.advance(time);
        }
    }
  } // namespace



  namespace
  {
    // Residuals of the constraints at the end of a step.
    void
    check_constraints(const MultibodySystem &system,
                      const SystemState &state,
                      Statistics &statistics)
    {
      if (system.n_constraints() == 0)
        return;
      const Eigen::VectorXd s        = system.marker_values(state.positions);
      const Eigen::VectorXd v        = system.marker_values(state.velocities);
      statistics.constraint_residual = std::max(
        statistics.constraint_residual,
        system.constraint_residual(state.time, s).lpNorm<Eigen::Infinity>());
      statistics.constraint_velocity_residual = std::max(
        statistics.constraint_velocity_residual,
        system.constraint_velocity(state.time, s, v).lpNorm<Eigen::Infinity>());

      double length = 0;
      for (const Body &body : system.bodies())
        length = std::max(length, body.operators().length);
      const double contradiction = system.contradiction(state.time, s);
      if (contradiction > 1e-8 * std::max(1., length))
        throw SimulationError("At time " + format_number(state.time) +
                              " s the joints " + system.repeating_joints() +
                              " contradict each other by " +
                              format_number(contradiction) + " m or rad.");
    }
  } // namespace



  namespace
  {
    void
    count_step(const double step_size,
               const double last_size,
               const StepReport &report,
               Statistics &statistics)
    {
      const bool is_first = statistics.steps == 0;
      ++statistics.steps;
      if (!is_first && step_size != last_size)
        ++statistics.step_size_changes;
      statistics.min_step_size =
        is_first ? step_size : std::min(statistics.min_step_size, step_size);
      statistics.max_step_size = std::max(statistics.max_step_size, step_size);
      statistics.max_newton_iterations =
        std::max(statistics.max_newton_iterations, report.iterations);
    }
  } // namespace



  Observer::Observer(const double interval)
    : observation_interval(interval)
  {}



  double
  Observer::next_time(const double after_step) const
  {
    if (n_observations == 0)
      return 0;
    if (observation_interval > 0)
      return n_observations * observation_interval;
    return after_step > last_time ? after_step
                                  : std::numeric_limits<double>::infinity();
  }



  void
  Observer::advance(const double time)
  {
    ++n_observations;
    last_time = time;
  }



  void
  Observer::start_at(const double time)
  {
    n_observations = 1;
    if (observation_interval > 0)
      n_observations =
        std::max(1., std::ceil(time / observation_interval * (1 - same_time)));
  }



  void
  Observer::exchange(Archive &archive)
  {
    double kept_interval = observation_interval;
    archive("interval", kept_interval);
    archive("observations", n_observations);
    archive("last time", last_time);
    if (kept_interval == observation_interval || n_observations == 0)
      return;
    // the first time of the new interval after the last one
    start_at(last_time);
    while (observation_interval > 0 &&
           n_observations * observation_interval <= last_time * (1 + same_time))
      ++n_observations;
  }



  TimeLoop::TimeLoop(const MultibodySystem &system,
                     const SystemState &start,
                     const TimeParameters &parameters,
                     const std::vector<Observer *> &observers,
                     Statistics &statistics)
    : system(system)
    , parameters(parameters)
    , observers(observers)
    , statistics(statistics)
    , stepper(system, this->parameters, statistics)
    , sizes(parameters)
    , present(start)
  {}



  bool
  TimeLoop::step()
  {
    const double step_size     = sizes.next();
    const unsigned long n_hard = statistics.exact_tangent_steps;
    const unsigned long n_solves =
      statistics.real_solves + statistics.complex_solves;
    StepReport report;
    {
      const PhaseTimer timer(statistics, "time steps");
      report = stepper.try_step(present, step_size);
    }
    const auto fail = [&](const std::string &what) {
      throw SimulationError("The step of " + format_number(step_size) +
                            " s at time " + format_number(present.time) +
                            " s " + what);
    };
    if (!report.converged)
      {
        ++statistics.rejected_steps;
        if (!sizes.fail())
          fail("failed after " + std::to_string(parameters.max_halvings) +
               (parameters.max_halvings == 1 ? " halving: " : " halvings: ") +
               report.failure + ".");
        ++statistics.halvings;
        return false;
      }
    if (!sizes.allows(report.local_error))
      {
        ++statistics.rejected_steps;
        ++statistics.rejected_by_error;
        if (!sizes.reject(report.local_error))
          fail("does not reach the Tolerance: its estimated error is " +
               format_number(report.local_error) + " of the length of a body.");
        return false;
      }

    {
      const PhaseTimer timer(statistics, "time steps");
      stepper.accept(present);
    }
    sizes.accept(report.local_error,
                 [&](const double size) { return stepper.has_factors(size); },
                 {1. * (statistics.real_solves + statistics.complex_solves -
                        n_solves),
                  statistics.exact_tangent_steps > n_hard});
    present.time = sizes.time();
    count_step(step_size, last_size, report, statistics);
    if (parameters.tolerance > 0)
      statistics.estimated_error += report.local_error;
    last_size       = step_size;
    last_iterations = report.iterations;
    return true;
  }



  void
  TimeLoop::show()
  {
    const PhaseTimer timer(statistics, "output");
    for (Observer *const observer : observers)
      observe_step(*observer, stepper, present, last_size, parameters.end_time);
  }



  bool
  TimeLoop::is_due(const Checkpoints &checkpoints, const double before) const
  {
    if (!checkpoints.save)
      return false;
    const double seconds =
      std::chrono::duration<double>(Clock::now() - last_checkpoint).count();
    if (checkpoints.wall_interval > 0 && seconds >= checkpoints.wall_interval)
      return true;
    const auto n_intervals = [&](const double time) {
      return std::floor(time / checkpoints.interval * (1 + same_time));
    };
    return checkpoints.interval > 0 &&
           n_intervals(present.time) > n_intervals(before);
  }



  void
  TimeLoop::advance(Progress &progress, const Checkpoints &checkpoints)
  {
    const InterruptionGuard interruption;
    last_checkpoint = Clock::now();
    // what a new end time or interval makes visible of the last step
    if (last_size > 0)
      show();
    while (present.time < parameters.end_time - same_time * sizes.next())
      {
        const double before = present.time;
        if (!interruption.signal().empty())
          throw SimulationError("The simulation was interrupted by " +
                                interruption.signal() + " at time " +
                                format_number(before) + " s.");
        if (!step())
          continue;
        check_constraints(system, present, statistics);
        show();
        progress.update(present.time,
                        last_size,
                        last_iterations,
                        statistics.steps);
        if (is_due(checkpoints, before))
          {
            checkpoints.save();
            last_checkpoint = Clock::now();
            saved_time      = present.time;
          }
      }
    const bool wants_last = saved_time >= 0 || checkpoints.interval > 0;
    if (checkpoints.save && wants_last && saved_time < present.time)
      checkpoints.save();
  }



  void
  TimeLoop::run(Progress &progress, const Checkpoints &checkpoints)
  {
    try
      {
        advance(progress, checkpoints);
      }
    catch (const SimulationError &error)
      {
        std::string end =
          " The results up to time " +
          format_number(std::min(present.time, parameters.end_time)) +
          " s are kept";
        if (checkpoints.save)
          try
            {
              checkpoints.save();
              end += ", --restart " + checkpoints.file + " continues";
            }
          catch (const SimulationError &) // the first error is the cause
            {
              end += saved_time < 0 ? ", but no checkpoint could be written"
                                    : ", --restart " + checkpoints.file +
                                        " continues from time " +
                                        format_number(saved_time) + " s";
            }
        throw SimulationError(error.what() + end + ".");
      }
  }



  void
  TimeLoop::exchange(Archive &archive)
  {
    archive("state", present);
    archive("last step size", last_size);
    archive("step sizes", sizes);
    archive("stepper", stepper);
    for (Observer *const observer : observers)
      {
        const std::string name = observer->name();
        if (!name.empty() && (!archive.is_loading() || archive.has(name)))
          archive(name, *observer);
        else if (archive.is_loading())
          observer->start_at(present.time);
      }
  }



  void
  run_time_loop(const MultibodySystem &system,
                const SystemState &start,
                const TimeParameters &parameters,
                const std::vector<Observer *> &observers,
                Progress &progress,
                Statistics &statistics)
  {
    TimeLoop(system, start, parameters, observers, statistics).run(progress);
  }
} // namespace ACF
