// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef tests_reference_slider_crank_h
#define tests_reference_slider_crank_h

#include <vector>

#include "reference/planar_beam.h"

namespace Reference
{
  /**
   * A mechanism of two beams with the same material and cross-section in the
   * y-z plane: the crank is pinned to the ground at the origin, the rod to the
   * free end of the crank, and the other end of the rod, the slider, moves
   * without mass and friction on the line z = 0. The defaults are the
   * slider-crank of Gerstmayr and Schoeberl.
   */
  struct SliderCrank
  {
    /** Units: m. */
    double crank_length = 0.5;

    /** Longer than the crank. Units: m. */
    double rod_length = 1;

    /** Side of the cross-sections in the plane of motion. Units: m. */
    double height = 0.05;

    /** Side of the cross-sections normal to the plane. Units: m. */
    double width = 0.005;

    /** Units: Pa. */
    double youngs_modulus = 2.1e10;

    /** No units. */
    double poissons_ratio = 0.3;

    /** Units: kg/m^3. */
    double density = 7800;

    /** Points into -z; may be zero. Units: m/s^2. */
    double gravity = 9.81;
  };

  /** The mechanism at one time. */
  struct SliderCrankState
  {
    /** Units: s. */
    double time;

    /**
     * atan2(z, y) of the chord of the crank, from its pin at the ground to its
     * other end, without jumps: falls from 0. Units: rad.
     */
    double crank_angle;

    /** The same from the crank to the slider; in (-pi/2, pi/2). Units: rad. */
    double rod_angle;

    /**
     * Displacement w(L/2) of the middle of the crank from its chord, in the
     * direction (-sin, cos) of the angle of the chord. Units: m.
     */
    double crank_deflection;

    /** The same of the rod. Units: m. */
    double rod_deflection;

    /** Coordinate y of the slider. Units: m. */
    double slider_position;

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
   * Motion of the mechanism that is released at time zero: from rest,
   * undeformed, stretched along +y.
   *
   * The frame of reference of each beam is its chord. The elastic deformation
   * in it is that of the linear theory (no geometric stiffening), the inertia
   * forces are complete; planar_beam.cc derives the equations of a beam,
   * slider_crank.cc those of the mechanism. Integrated with the Gauss method of
   * order 10 in minimal coordinates.
   *
   * Accuracy of the default mechanism with the default options, 0 to 2 s,
   * against 20 shape functions and half the step size: angles 1e-7 rad (2e-7
   * rad if extensible), deflections 1e-7 m of at most 4e-4 m; 8 shape functions
   * 1e-6 rad, 1e-6 m. The vibrations after the release, undamped, make the
   * deflections sensitive to the model: frequencies that are 1e-3 higher change
   * the angle of the crank by 2e-5 rad until 1 s and 3e-5 rad until 2 s, the
   * deflection of the rod by 1.5e-5 m and 3e-5 m. Shear and rotary inertia
   * matter by 2.2e-3 rad and 7e-5 m until 1 s (3.9e-3 rad and 1e-4 m until
   * 2 s), extension by 4e-5 rad and 1.2e-5 m (8e-5 rad and 2.6e-5 m).
   *
   * @param mechanism geometry and material
   * @param options model and discretisation, the same for both beams
   * @param times when the state is wanted. Units: s.
   * @return the states, one per time
   * @pre the times are not negative and do not decrease
   * @throws std::invalid_argument if a parameter or the times are wrong
   * @throws std::runtime_error if the integration fails
   */
  std::vector<SliderCrankState>
  move_slider_crank(const SliderCrank &mechanism,
                    const BeamOptions &options,
                    const std::vector<double> &times);

  /**
   * Circular natural frequencies of the bending vibrations of the stretched
   * mechanism without gravity, without the motion of the rigid mechanism.
   * BeamOptions::extensible and step_size have no influence.
   *
   * @return the n_shape_functions lowest ones, ascending. Units: rad/s.
   * @throws std::invalid_argument if a parameter is wrong
   */
  std::vector<double>
  stretched_frequencies(const SliderCrank &mechanism,
                        const BeamOptions &options);
} // namespace Reference

#endif
