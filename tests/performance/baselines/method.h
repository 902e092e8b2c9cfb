// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_baselines_method_h
#define acf_tests_baselines_method_h

#include <acf/base/statistics.h>
#include <acf/model.h>

namespace Baselines
{
  using namespace ACF;

  /** A method of time integration with steps of one size. */
  class Method
  {
  public:
    virtual ~Method() = default;

    /** Finds what the method needs beside a consistent state at t = 0. */
    virtual void
    start(SystemState &state) = 0;

    /**
     * Replaces the state by that after a step.
     * @throws SimulationError
     */
    virtual void
    step(SystemState &state, const double step_size) = 0;
  };

  /**
   * Runs a method up to the end time, by the smallest number of equal steps
   * which are not longer than the step size. Observers see the first end of a
   * step that is not before their time. The phases "start" and "time steps" of
   * the statistics contain the method only, not the observers.
   */
  void
  run(Method &method,
      const MultibodySystem &system,
      SystemState state,
      const double end_time,
      const double step_size,
      const std::vector<Observer *> &observers,
      Statistics &statistics);

  /**
   * The baselines know bodies without damping, joints, gravity and loads on
   * surfaces.
   * @throws SimulationError if the system has anything else, or joints that
   * repeat constraints
   */
  void
  check_supported(const MultibodySystem &system);

  /** $-\ddot\Phi$ without its term $D \ddot s$: what $D \ddot s$ must be. */
  Eigen::VectorXd
  constraint_acceleration(const MultibodySystem &system,
                          const SystemState &state);

  /** $f - p + S^T D^T \lambda$ of a state, N.
   * @throws SimulationError if a body is turned inside out */
  SystemVector
  unbalanced_forces(const MultibodySystem &system, const SystemState &state);
} // namespace Baselines

#endif
