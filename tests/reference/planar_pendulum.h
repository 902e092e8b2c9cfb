// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef tests_reference_planar_pendulum_h
#define tests_reference_planar_pendulum_h

#include <vector>

#include "reference/planar_beam.h"

namespace Reference
{
  /** The pendulum at one time. */
  struct PendulumState
  {
    /** Units: s. */
    double time;

    /** atan2(z, y) of the tip, without jumps: falls from 0. Units: rad. */
    double chord_angle;

    /**
     * Displacement w(L/2) of the middle from the chord, in the direction
     * (-sin, cos) of the chord angle. Units: m.
     */
    double mid_span_deflection;

    /** Units: m. */
    double tip_y;

    /** Units: m. */
    double tip_z;

    /** Units: J. */
    double kinetic_energy;

    /** Units: J. */
    double elastic_energy;

    /** Zero at the start. Units: J. */
    double potential_energy;

    /** Sum of the three energies; zero at any time. Units: J. */
    double
    total_energy() const;
  };

  /**
   * Swing of a beam that is pinned to the ground at the origin and released
   * at time zero: from rest, undeformed, pointing into +y.
   *
   * The frame of reference rotates with the chord from the pin to the tip. The
   * elastic deformation in it is that of the linear theory (no geometric
   * stiffening), the inertia forces are complete; planar_beam.cc derives the
   * equations. Integrated with the Gauss method of order 10.
   *
   * The default PlanarBeam has the mid-span deflection of the first second to
   * 3e-6 m with 12 shape functions, to 1e-6 m with 20: the release excites also
   * the high frequencies. The default step size contributes less than 1e-9 m
   * with the default beam and number of shape functions.
   *
   * @param beam geometry and material
   * @param options model and discretisation
   * @param times when the state is wanted. Units: s.
   * @return the states, one per time
   * @pre the times are not negative and do not decrease
   * @throws std::invalid_argument if a parameter or the times are wrong
   * @throws std::runtime_error if the integration fails
   */
  std::vector<PendulumState>
  swing_pendulum(const PlanarBeam &beam,
                 const BeamOptions &options,
                 const std::vector<double> &times);

  /**
   * Circular natural frequencies of the bending vibrations of a beam that is
   * pinned at one end and free at the other, without its rigid rotation and
   * without gravity. BeamOptions::extensible and step_size have no influence.
   *
   * @return the n_shape_functions lowest ones, ascending (the upper half of
   *   them inaccurate). Units: rad/s.
   * @throws std::invalid_argument if a parameter is wrong
   */
  std::vector<double>
  pinned_free_frequencies(const PlanarBeam &beam, const BeamOptions &options);

  /** The same for a beam that is clamped at one end and free at the other. */
  std::vector<double>
  clamped_free_frequencies(const PlanarBeam &beam, const BeamOptions &options);

  /**
   * Static deflection w(L/2) under gravity if the beam lies horizontally on
   * two supports at its ends; negative, as it sags. Units: m.
   * @throws std::invalid_argument if a parameter is wrong
   */
  double
  supported_static_deflection(const PlanarBeam &beam,
                              const BeamOptions &options);
} // namespace Reference

#endif
