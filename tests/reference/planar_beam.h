// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef tests_reference_planar_beam_h
#define tests_reference_planar_beam_h

#include <Eigen/Core>

#include <optional>
#include <string>

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

    /** Number of polynomials for the deflection. */
    unsigned int n_shape_functions = 12;

    /** Upper bound of the time step. Units: s. */
    double step_size = 1e-4;
  };

  /** Cowper's 10 (1 + nu) / (12 + 11 nu) for a rectangle. */
  double
  cowper_coefficient(const double poissons_ratio);

  /** @throws std::invalid_argument "name, but found ..." unless condition. */
  void
  require(const bool condition, const std::string &name, const double found);

  /** @throws std::invalid_argument if a parameter is wrong */
  void
  check(const PlanarBeam &beam, const BeamOptions &options);

  /** How the frame of reference is attached to the beam. */
  enum class Support
  {
    /** Chord between the ends: w(0) = w(L) = 0. */
    chord,
    /** Tangent at the start: w(0) = 0 and psi(0) = 0. */
    clamped
  };

  /**
   * The displacements u(x) along the beam and w(x) across it and the rotation
   * psi(x) of the cross-sections, linear in the coordinates (theta, q): one
   * column per coordinate, the first one, for the angle theta of the frame, is
   * zero. The integral of f g is f^T diag(weights) g, so that the rows are the
   * values at quadrature points, or coefficients of orthogonal polynomials.
   */
  struct BeamFields
  {
    Eigen::VectorXd weights;

    /** The functions 1 and x. */
    Eigen::VectorXd one, x;

    Eigen::MatrixXd u, w, psi;

    /** u', psi' and w' - psi. */
    Eigen::MatrixXd strain, curvature, shear;

    /** u(L) and w(L/2) as functions of (theta, q). */
    Eigen::VectorXd tip_extension, mid_span_deflection;
  };

  /** Fields of polynomials on [0, L]; their number as in the options. */
  BeamFields
  polynomial_fields(const double length,
                    const BeamOptions &options,
                    const Support support);

  /**
   * A beam whose frame of reference is at r0(t) and rotated by the angle theta
   * from the y axis to the z axis. The elastic deformation in the frame is that
   * of the linear theory (no geometric stiffening), the inertia forces are
   * complete. planar_beam.cc derives the equations.
   *
   * Coordinates Q = (theta, q), velocities V = Q', accelerations A = Q''.
   * Vectors of the plane have the components (y, z).
   */
  struct FloatingBeam
  {
    /** @pre shear of the fields is zero unless the theory is timoshenko */
    FloatingBeam(const PlanarBeam &beam,
                 const BeamOptions &options,
                 const BeamFields &fields);

    /**
     * Left-hand side of the equations of motion M(Q) A + f(Q, V) = 0 in Q.
     * @param base_acceleration r0'' minus the acceleration of gravity
     */
    Eigen::VectorXd
    residual(const Eigen::VectorXd &Q,
             const Eigen::VectorXd &V,
             const Eigen::VectorXd &A,
             const Eigen::Vector2d &base_acceleration) const;

    /**
     * The force that accelerates the beam: derivative of its momentum.
     * @param base_acceleration as for residual()
     */
    Eigen::Vector2d
    base_force(const Eigen::VectorXd &Q,
               const Eigen::VectorXd &V,
               const Eigen::VectorXd &A,
               const Eigen::Vector2d &base_acceleration) const;

    double
    kinetic_energy(const Eigen::VectorXd &Q,
                   const Eigen::VectorXd &V,
                   const Eigen::Vector2d &base_velocity) const;

    double
    elastic_energy(const Eigen::VectorXd &Q) const;

    /** Integral of rho (r - r0), and its derivative with respect to Q. */
    Eigen::Vector2d
    first_moment(const Eigen::VectorXd &Q) const;

    Eigen::Matrix2Xd
    first_moment_gradient(const Eigen::VectorXd &Q) const;

    /** Distance L + u(L) of the ends. */
    double
    chord(const Eigen::VectorXd &Q) const;

    /** Constants of the equations of motion, named as in planar_beam.cc. */
    Eigen::MatrixXd M, G, K;
    Eigen::VectorXd a, b;
    Eigen::Matrix2Xd P;
    double I0, S0, mass, length;
    Eigen::VectorXd tip_extension, mid_span_deflection;
  };
} // namespace Reference

#endif
