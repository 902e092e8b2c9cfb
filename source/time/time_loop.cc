// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/time/time_loop.h>

#include <algorithm>
#include <cmath>

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
          observer.advance();
          // without an interval the next time would be the same again
          if (observer.interval() == 0 &&
              time > end - 2 * same_time * step_size)
            break;
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
                              format_number(contradiction) +
                              " m or rad. The results up to this time are "
                              "kept.");
    }
  } // namespace



  namespace
  {
    // Sizes of the steps: of a StepController, or with a tolerance of an
    // ErrorController.
    class StepSizes
    {
    public:
      explicit StepSizes(const TimeParameters &parameters)
        : is_controlled(parameters.tolerance > 0)
        , max_halvings(parameters.max_halvings)
        , least_step(1e-9 * parameters.end_time)
        , fixed(parameters.first_step(), parameters.max_halvings)
        , controlled(parameters.first_step(),
                     parameters.largest_step(),
                     parameters.tolerance / parameters.end_time,
                     2 * parameters.n_stages)
      {}

      double
      next() const
      {
        return is_controlled ? controlled.step_size() : fixed.step_size();
      }

      double
      time() const
      {
        return is_controlled ? controlled.time() : fixed.time();
      }

      // The three that follow: false if the step cannot be repeated.
      bool
      fail()
      {
        if (!is_controlled)
          return fixed.halve();
        controlled.fail();
        return ++n_failures <= max_halvings;
      }

      bool
      allows(const double error) const
      {
        return !is_controlled || controlled.allows(error);
      }

      bool
      reject(const double error)
      {
        controlled.reject(error);
        return controlled.step_size() > least_step;
      }

      void
      accept(const double error, const RadauStepper &stepper)
      {
        n_failures = 0;
        if (is_controlled)
          controlled.accept(error, [&](const double size) {
            return stepper.has_factors(size);
          });
        else
          fixed.accept();
      }

    private:
      const bool is_controlled;
      const unsigned int max_halvings;
      const double least_step;
      StepController fixed;
      ErrorController controlled;
      unsigned int n_failures = 0;
    };



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
    return observation_interval > 0 ? n_observations * observation_interval
                                    : after_step;
  }



  void
  Observer::advance()
  {
    ++n_observations;
  }



  void
  run_time_loop(const MultibodySystem &system,
                SystemState state,
                const TimeParameters &parameters,
                const std::vector<Observer *> &observers,
                Progress &progress,
                Statistics &statistics)
  {
    RadauStepper stepper(system, parameters, statistics);
    StepSizes sizes(parameters);
    double last_size = 0;
    while (state.time < parameters.end_time - same_time * sizes.next())
      {
        const double step_size = sizes.next();
        StepReport report;
        {
          const PhaseTimer timer(statistics, "time steps");
          report = stepper.try_step(state, step_size);
        }
        if (!report.converged)
          {
            ++statistics.rejected_steps;
            if (!sizes.fail())
              throw SimulationError(
                "The step of " + format_number(step_size) + " s at time " +
                format_number(state.time) + " s failed after " +
                std::to_string(parameters.max_halvings) +
                (parameters.max_halvings == 1 ? " halving: " : " halvings: ") +
                report.failure + ". The results up to this time are kept.");
            ++statistics.halvings;
            continue;
          }
        if (!sizes.allows(report.local_error))
          {
            ++statistics.rejected_steps;
            ++statistics.rejected_by_error;
            if (!sizes.reject(report.local_error))
              throw SimulationError(
                "The step of " + format_number(step_size) + " s at time " +
                format_number(state.time) +
                " s does not reach the Tolerance: its estimated error is " +
                format_number(report.local_error) +
                " of the length of a body. The results up to this time are "
                "kept.");
            continue;
          }

        stepper.accept(state);
        sizes.accept(report.local_error, stepper);
        state.time = sizes.time();
        count_step(step_size, last_size, report, statistics);
        if (parameters.tolerance > 0)
          statistics.estimated_error += report.local_error;
        last_size = step_size;
        check_constraints(system, state, statistics);
        {
          const PhaseTimer timer(statistics, "output");
          for (Observer *const observer : observers)
            observe_step(
              *observer, stepper, state, step_size, parameters.end_time);
        }
        progress.update(state.time,
                        step_size,
                        report.iterations,
                        statistics.steps);
      }
  }
} // namespace ACF
