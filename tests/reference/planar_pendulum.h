// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef tests_reference_planar_pendulum_h
#define tests_reference_planar_pendulum_h

#include <optional>
#include <vector>

/**
 * Solutions to compare the three-dimensional program with, computed by another
 * theory and without any code of the program.
 */
namespace Reference
{
  /**
   * A beam with rectangular cross-section that moves in the y-z plane. The
   * defaults are the pendulum of Gerstmayr and Schoeberl.
   */
  struct PlanarBeam
  {
    /** Units: m. */
    double length = 1;

    /** Side of the cross-section in the plane of motion. Units: m. */
    double height = 0.05;

    /** Side of the cross-section normal to the plane. Units: m. */
    double width = 0.0025;

    /** Units: Pa. */
    double youngs_modulus = 2.1e8;

    /** No units. */
    double poissons_ratio = 0.3;

    /** Units: kg/m^3. */
    double density = 7800;

    /** Points into -z; may be zero. Units: m/s^2. */
    double gravity = 9.81;
  };

  /** What a cross-section may do. */
  enum class BeamTheory
  {
    /** No shear, no rotary inertia: the beam is a line with mass. */
    bernoulli_euler,
    /** Shear flexibility and rotary inertia. */
    timoshenko
  };

  /** The model of the beam and its discretisation. */
  struct BeamOptions
  {
    BeamTheory theory = BeamTheory::timoshenko;

    /** Whether the beam may also become longer, elastically. */
    bool extensible = false;

    /**
     * The fraction kappa of the cross-section that carries shear; without a
     * value cowper_coefficient(). Read by the Timoshenko theory only.
     */
    std::optional<double> shear_coefficient;

    /**
     * Number of polynomials for the deflection. The default PlanarBeam has the
     * mid-span deflection of the first second to 3e-6 m with 12 of them, to
     * 1e-6 m with 20: the release excites also the high frequencies.
     */
    unsigned int n_shape_functions = 12;

    /**
     * Upper bound of the time step. The default contributes less than 1e-9 m
     * with the default beam and number of shape functions. Units: s.
     */
    double step_size = 1e-4;
  };

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

  /** Cowper's 10 (1 + nu) / (12 + 11 nu) for a rectangle. */
  double
  cowper_coefficient(const double poissons_ratio);

  /**
   * Swing of a beam that is pinned to the ground at the origin and released
   * at time zero: from rest, undeformed, pointing into +y.
   *
   * The frame of reference rotates with the chord from the pin to the tip. The
   * elastic deformation in it is that of the linear theory (no geometric
   * stiffening), the inertia forces are complete; planar_pendulum.cc derives
   * the equations. Integrated with the Gauss method of order 10.
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
