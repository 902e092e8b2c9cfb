// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_start_h
#define acf_time_start_h

#include <acf/mechanics/multibody_system.h>
#include <acf/solvers/factorization_cache.h>

#include <ostream>

namespace ACF
{
  /** What a model file says of the state at the start. */
  struct StartParameters
  {
    /** What is changed so that it fits the joints. */
    bool project_positions  = false;
    bool project_velocities = false;

    /** Whether the positions become those of the static equilibrium. */
    bool equilibrium = false;

    /** In which the loads grow; at least 1. */
    unsigned int n_load_steps = 1;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError */
    void
    check() const;
  };



  /**
   * Checks the start of a model file as far as that needs no factorisation:
   * initial_state() can still fail where it projects or looks for an
   * equilibrium. Parameters as there.
   */
  void
  check_start(const MultibodySystem &system,
              const StartParameters &parameters,
              const double step_size,
              std::ostream &log);

  /**
   * The state at t = 0: that of the model file, changed so that it satisfies
   * the constraints \f$\Phi = 0\f$ and \f$\dot\Phi = 0\f$ if the model asks for
   * it. The change is the smallest one in the norm of \f$M / h^2 + A\f$ with
   * the step size h, that is what an implicit step would do with the forces of
   * the joints alone. Between positions and velocities comes the static
   * equilibrium, if asked for (EquilibriumSolver).
   * See theory (10.2).
   *
   * @param step_size h, s; if zero, one that suits the bodies
   * @param log one line for each thing that was changed
   * @throws InputError if the state does not fit the joints and no projection
   * is asked for, or if constraints contradict each other
   * @throws SimulationError if the projection does not converge
   */
  SystemState
  initial_state(const MultibodySystem &system,
                const StartParameters &parameters,
                const double step_size,
                FactorizationCache &cache,
                Statistics &statistics,
                std::ostream &log);
} // namespace ACF

#endif
