// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_modes_h
#define acf_time_modes_h

#include <acf/solvers/tangent_system.h>

namespace dealii
{
  class ParameterHandler;
}

namespace ACF
{
  /** What a model file says of the natural modes. */
  struct ModeParameters
  {
    /** 0: none. */
    unsigned int number = 0;

    /** About the state at the end of the simulation, not at its start. */
    bool at_end = false;

    void
    add_parameters(ParameterHandler &prm);
  };



  /** A natural mode of the linearised system without damping. */
  struct Mode
  {
    /** $\omega^2$, 1/s^2; negative where the state is unstable. */
    double eigenvalue = 0;

    /** Normalised by the mass, \f$\phi^T (M + S^T M_L S)\, \phi = 1\f$;
     * 1/kg^(1/2). */
    SystemVector shape;

    /** Residual in the norm of the mass, see natural_modes(). */
    double error = 0;

    /** $\omega$, rad/s; for negative eigenvalues the negative growth rate. */
    double
    angular_frequency() const;

    /** Hz, with the same sign. */
    double
    frequency() const;
  };



  /** The modes of a state. */
  struct NaturalModes
  {
    /** Ascending eigenvalues. */
    std::vector<Mode> modes;

    /** Eigenvalues within are zero but for round-off, 1/s^2: ten times the
     * Rayleigh quotients of rotations of the undeformed bodies. */
    double round_off = 0;
  };

  /** @throws InputError if natural_modes() cannot compute that many. */
  void
  check_number_of_modes(const MultibodySystem &system,
                        const unsigned int number);

  /**
   * Modes of
   * \f[ K_T \phi + S^T D^T \mu = \omega^2 (M + S^T M_L S)\, \phi, \qquad
   *     D S \phi = 0 \f]
   * about a state (TangentSystem): those with the eigenvalues next to
   * \f$-\sigma\f$, \f$\sigma\f$ = slow_squared_rate(), which are the lowest
   * ones if the state is stable. Shift-invert Lanczos (ARPACK), then subspace
   * iteration with random vectors added, which finds repeated eigenvalues that
   * a single vector may miss.
   *
   * The error of a mode is the norm of
   * \f$(K_T + \sigma M)^{-1} (K_T - \omega^2 M)\, \phi\f$, with the inverse on
   * the motions that the constraints allow; \f$\omega^2 + \sigma\f$ has at most
   * this relative error, in practice its square.
   * See theory (17.1), theory (17.2).
   *
   * @throws InputError if the system has too few unknowns for the number
   * @throws SimulationError if modes are not found or not accurate
   */
  NaturalModes
  natural_modes(const MultibodySystem &system,
                const SystemState &state,
                const unsigned int number,
                Statistics &statistics);
} // namespace ACF

#endif
