// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "performance/baselines/method.h"

#include <acf/base/exceptions.h>
#include <acf/mechanics/elastic_force.h>

#include <cmath>

namespace Baselines
{
  namespace
  {
    // Once for all its times that have passed.
    void
    observe(const std::vector<Observer *> &observers,
            const SystemState &state,
            const double step_size)
    {
      const double end = state.time + 1e-9 * step_size;
      for (Observer *const observer : observers)
        if (observer->next_time(state.time) <= end)
          {
            observer->observe(state);
            do
              observer->advance(state.time);
            while (observer->interval() > 0 &&
                   observer->next_time(state.time) <= end);
          }
    }
  } // namespace



  void
  run(Method &method,
      const MultibodySystem &system,
      SystemState state,
      const double end_time,
      const double step_size,
      const std::vector<Observer *> &observers,
      Statistics &statistics)
  {
    const unsigned long n_steps = std::ceil(end_time / step_size * (1 - 1e-9));
    const double h              = end_time / n_steps;
    {
      const PhaseTimer timer(statistics, "start");
      method.start(state);
    }
    observe(observers, state, h);
    while (statistics.steps < n_steps)
      {
        {
          const PhaseTimer timer(statistics, "time steps");
          method.step(state, h);
        }
        ++statistics.steps;
        state.time = statistics.steps * h;
        observe(observers, state, h);
      }
    if (system.n_constraints() > 0)
      statistics.constraint_residual =
        system.constraint_residual(state.positions, state.time)
          .lpNorm<Eigen::Infinity>();
  }



  void
  check_supported(const MultibodySystem &system)
  {
    bool damped = false;
    for (const Body &body : system.bodies())
      damped = damped || body.is_damped();
    if (damped || !system.force_elements().empty() ||
        !system.masses().empty() || system.n_repeated_constraints() > 0)
      throw SimulationError(
        "Baselines take bodies without damping, joints that do not repeat "
        "constraints, gravity and loads on surfaces.");
  }



  Eigen::VectorXd
  constraint_acceleration(const MultibodySystem &system,
                          const SystemState &state)
  {
    // Central difference of D v - u' along the motion with the velocities v:
    // the rows are polynomials or angles, so that this is accurate enough for
    // a start.
    const double dt         = 1e-6;
    const Eigen::VectorXd s = system.marker_values(state.positions);
    const Eigen::VectorXd v = system.marker_values(state.velocities);
    return -(system.constraint_velocity(state.time + dt, s + dt * v, v) -
             system.constraint_velocity(state.time - dt, s - dt * v, v)) /
           (2 * dt);
  }



  SystemVector
  unbalanced_forces(const MultibodySystem &system, const SystemState &state)
  {
    const Eigen::VectorXd forces =
      system.marker_forces(state.time,
                           system.marker_values(state.positions),
                           Eigen::VectorXd(),
                           Eigen::VectorXd(),
                           state.multipliers,
                           state.law_values);
    SystemVector result;
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const NodalVector &x = state.positions[b];
        NodalVector external(x.size()), internal(x.size()), scratch(x.size());
        if (!elastic_force(system.bodies()[b], x, internal, scratch))
          throw SimulationError("A body is turned inside out.");
        system.add_loads(b, state.time, x, external);
        system.add_marker_forces(b, forces, external);
        internal -= external;
        result.push_back(std::move(internal));
      }
    return result;
  }
} // namespace Baselines
