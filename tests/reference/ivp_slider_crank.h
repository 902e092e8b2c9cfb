// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef tests_reference_ivp_slider_crank_h
#define tests_reference_ivp_slider_crank_h

#include <array>
#include <vector>

#include "reference/planar_beam.h"

namespace Reference
{
  /**
   * The problem "slider crank" of the Test Set for IVP Solvers (Mazzia and
   * Magherini, release 2.4, University of Bari, 2008) by B. Simeon: Modelling
   * a flexible slider crank mechanism by a mixed system of DAEs and PDEs,
   * Mathematical Modelling of Systems 2 (1996) 1-18.
   *
   * A rigid crank turns with constant speed about the origin of the x-y plane;
   * a flexible rod joins its end and a block that slides on the x axis. No
   * gravity, no friction, no damping. The inertia of the crank is not among the
   * parameters (J1 = 0.002727 kg m^2 about the origin, m1 = 0.36 kg): with
   * constant speed and without gravity it has no influence.
   */
  struct IvpSliderCrank
  {
    /** Units: m. */
    double crank_length = 0.15;

    /** Of the crank; its angle is zero at time zero. Units: rad/s. */
    double angular_velocity = 150;

    /** Units: kg. */
    double slider_mass = 0.075552;

    PlanarBeam rod{0.3, 0.008, 0.008, 2e11, 0.3, 7870, 0};

    /**
     * The elastic coordinates q1, ..., q4 at time zero, see rod_field(). The
     * values are those of the test set: the motion hardly vibrates. Units: m.
     */
    std::array<double, 4> displacements{{0, 0, 0.103339863e-4, 0.169327969e-4}};

    /** Derivatives of the elastic coordinates at time zero. Units: m/s. */
    std::array<double, 4> velocities{
      {0.444896105, 0.463434311e-2, -0.178591076e-5, -0.268938672e-5}};
  };

  /**
   * Model of the rod. The frame of reference is the chord, the strain is linear
   * (the "linear stiffness" of the test set, whose nonlinear stiffening terms
   * are an option there), and there is no damping.
   *
   * The greatest differences from the published model in 0 to 0.1 s, where
   * w(L/2) reaches 1.65e-3 m and the multipliers 212 N, 383 N and 69 N m:
   *
   *                       phi2 [rad]    x3 [m]   q1 [m]  w(L/2) [m]
   *     consistent_mass       3.1e-7    1.8e-7   6.1e-8      6.1e-8
   *     bernoulli_euler       3.0e-7    1.8e-7   5.9e-8      6.2e-6
   *     timoshenko            3.0e-7    1.9e-7   6.2e-6      6.1e-6
   *
   * and 3 N, 5 N and 1 N m in the multipliers of consistent_mass, up to 11 N,
   * 23 N and 4 N m in those of the models with polynomials: the initial
   * values are smooth for the published model only, E A u'(L) = 404 N differs
   * from the 382 N that accelerate the block, so that the rod vibrates along
   * its axis. A solid that starts with the same field does, too.
   */
  enum class RodModel
  {
    /**
     * The problem whose solution the test set publishes. The theory is that of
     * Bernoulli and Euler, with two sines for the deflection and a quadratic
     * polynomial for the extension. Two of its coefficients are not those of
     * the theory: the moment of inertia of the undeformed rod has the rotary
     * inertia m h^2 / 12, which the deformation has not, and the mass of the
     * extension is too large by the factor 15 (the integrals of the products of
     * the shape functions are L [8 1; 1 2] instead of L [8 1; 1 2] / 15).
     */
    published,
    /** The same with the right mass of the extension. */
    consistent_mass,
    /** Bernoulli and Euler; polynomials for deflection and extension. */
    bernoulli_euler,
    /** Shear with Cowper's coefficient, rotary inertia; polynomials. */
    timoshenko
  };

  struct IvpOptions
  {
    RodModel model = RodModel::published;

    /** Of the polynomials; at least 2. Read if the model has polynomials. */
    unsigned int n_shape_functions = 10;

    /** Upper bound of the time step. Units: s. */
    double step_size = 1e-5;
  };

  /** The mechanism at one time. */
  struct IvpSliderCrankState
  {
    /** Units: s. */
    double time;

    /**
     * phi2: angle from the x axis to the chord of the rod, from the crank to
     * the block. Units: rad.
     */
    double rod_angle;

    /** Units: rad/s. */
    double rod_angular_velocity;

    /** x3. Units: m. */
    double slider_position;

    /** Units: m/s. */
    double slider_velocity;

    /**
     * q1, ..., q4 of rod_field(); if the model has polynomials q1 and q2 are
     * the first two Fourier coefficients of the deflection in sines, q3 and q4
     * are the extensions u(L/2) and u(L). Units: m.
     */
    std::array<double, 4> displacements;

    /** Derivatives of the displacements. Units: m/s. */
    std::array<double, 4> velocities;

    /**
     * Displacement w(L/2) from the chord in the direction (-sin, cos) of
     * rod_angle; q1 in the models with two sines. Units: m.
     */
    double mid_span_deflection;

    /**
     * Lagrange multipliers lambda of the test set, of the constraints
     * l1 sin(phi1) + (L + u(L)) sin(phi2) = 0,
     * x3 - l1 cos(phi1) - (L + u(L)) cos(phi2) = 0 and phi1 - Omega t = 0.
     * The force of the guide on the block is (0, -lambda1); the force of the
     * rod on the block is (-lambda2, lambda1), where -lambda2 = m3 x3''; the
     * driving torque on the crank is -lambda3. Units: N, N, N m.
     */
    std::array<double, 3> multipliers;

    /** Of the rod and the block; the crank's is constant. Units: J. */
    double kinetic_energy;

    /** Units: J. */
    double elastic_energy;
  };

  /** Displacement or velocity of the axis of the rod in its frame. */
  struct RodField
  {
    /** Along the chord, from the crank to the block. */
    double axial;

    /** In the direction (-sin, cos) of the angle of the chord. */
    double lateral;
  };

  /**
   * The field with the coordinates q of the test set at the position x from
   * the crank on a rod of the given length, with s = x / length:
   *   axial   = 4 s (1 - s) q3 + s (2 s - 1) q4,
   *   lateral = q1 sin(pi s) + q2 sin(2 pi s).
   *
   * With the displacement (u, w) and the velocity (u', w') of the field a point
   * of the axis is at P + R(phi2) (x + u, w) and moves with
   * P' + R(phi2) (u' - phi2' w, w' + phi2' (x + u)). At time zero P = (l1, 0),
   * P' = (0, l1 Omega), phi2 = 0 and phi2' = -l1 Omega / (L + q4). The
   * cross-sections stay normal to the axis: a point at the height zeta has
   * u - zeta dw/dx instead of u, the same for u'.
   */
  RodField
  rod_field(const std::array<double, 4> &q,
            const double x,
            const double length);

  /**
   * The motion of the mechanism; ivp_slider_crank.cc derives the equations.
   * Integrated with the Gauss method of order 10 in minimal coordinates.
   *
   * The published model has the published solution at 0.1 s to 1e-12 rad, 2e-10
   * m in x3 (the rounding of its initial value in the test set), 4e-11 m in q1
   * (of 1.9e-4 m; the test set has pi = 3.1415927) and 1e-5 N. The step size
   * contributes less than 1e-12 of that, in the models with polynomials 1e-9
   * rad, 1e-10 m and 6 N to undamped axial vibrations of high frequency.
   *
   * @param mechanism geometry, material and initial values
   * @param options model and discretisation
   * @param times when the state is wanted. Units: s.
   * @return the states, one per time
   * @pre the times are not negative and do not decrease
   * @throws std::invalid_argument if a parameter or the times are wrong
   * @throws std::runtime_error if the integration fails
   */
  std::vector<IvpSliderCrankState>
  drive_slider_crank(const IvpSliderCrank &mechanism,
                     const IvpOptions &options,
                     const std::vector<double> &times);
} // namespace Reference

#endif
