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
          if (observer.interval() == 0 && time > state.time - step_size / 2)
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
    StepController controller(parameters.step_size, parameters.max_halvings);

    while (state.time < parameters.end_time - same_time * parameters.step_size)
      {
        const double step_size = controller.step_size();
        StepReport report;
        {
          const PhaseTimer timer(statistics, "time steps");
          report = stepper.try_step(state, step_size);
        }
        if (!report.converged)
          {
            ++statistics.rejected_steps;
            if (!controller.halve())
              throw SimulationError(
                "The step of " + format_number(step_size) + " s at time " +
                format_number(state.time) + " s failed after " +
                std::to_string(parameters.max_halvings) +
                (parameters.max_halvings == 1 ? " halving: " : " halvings: ") +
                report.failure + ". The results up to this time are kept.");
            ++statistics.halvings;
            continue;
          }

        stepper.accept(state);
        controller.accept();
        state.time = controller.time();
        ++statistics.steps;
        check_constraints(system, state, statistics);
        statistics.max_newton_iterations =
          std::max(statistics.max_newton_iterations, report.iterations);

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
