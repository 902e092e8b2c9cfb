// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_reduced_strain_h
#define acf_mechanics_reduced_strain_h

#include <acf/base/types.h>
#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/rotation.h>

#include <optional>

namespace ACF
{
  /**
   * Mean deformation gradient $\bar F = \sum_a x_a \otimes g_a$ (paper
   * Eq. (15)).
   * See theory (2.1).
   */
  Matrix3
  mean_deformation_gradient(const BodyOperators &body,
                            const NodalVector &positions);

  /**
   * Mass-weighted mean of a nodal vector field,
   * $\frac1m \sum_a x_a \int \rho \phi_a\, dV$: of positions the centre of
   * mass, of velocities its velocity.
   */
  Vector3
  mass_mean(const BodyOperators &body, const NodalVector &field);

  /** Sums over the nodes of a field. */
  struct NodalMoments
  {
    /** Its mean gradient, see mean_deformation_gradient(). */
    Matrix3 gradient;

    /** See mass_mean(). */
    Vector3 mean;

    NodalMoments &
    operator+=(const NodalMoments &other);
  };

  /** Both, for which the field is read once. They are linear in it. */
  NodalMoments
  nodal_moments(const BodyOperators &body, const NodalVector &field);

  /** Those of several fields, for which the sums' weights are read once for up
   * to three. */
  std::vector<NodalMoments>
  nodal_moments(const BodyOperators &body,
                const std::vector<const NodalVector *> &fields);

  /** Those of x + factor y. */
  NodalMoments
  add(const NodalMoments &x, const double factor, const NodalMoments &y);

  /**
   * Spin $\dot\varphi_i = \Lambda_{ijk} H_{jk}$, $H = R^T \sum_a v_a \otimes
   * g_a$, of a frame in itself, rad/s.
   * @param velocity_gradient $\sum_a v_a \otimes g_a$, 1/s
   * See theory (7.1).
   */
  Vector3
  frame_spin(const BodyRotation &frame, const Matrix3 &velocity_gradient);

  /**
   * Angular velocity $R \dot\varphi$ of the frame of a body in the world,
   * rad/s, see frame_spin().
   * @param gradient $\sum_a x_a \otimes g_a$
   * @param velocity_gradient $\sum_a v_a \otimes g_a$, 1/s
   * @return nothing if the body is turned inside out
   */
  std::optional<Vector3>
  body_spin(const RotationMeasure measure,
            const Matrix3 &gradient,
            const Matrix3 &velocity_gradient);

  /**
   * Co-rotated displacement
   * $q_a = R^T (x_a - \bar x) - (X_a - \bar X)$ with the centres of mass
   * $\bar x$, $\bar X$, which removes the rigid translation.
   * See theory (3.1).
   *
   * @param[out] displacement q, m; must have the size of @p positions
   */
  void
  co_rotated_displacement(const BodyOperators &body,
                          const NodalVector &positions,
                          const Matrix3 &rotation,
                          NodalVector &displacement);

  /**
   * Rate of the co-rotated displacement,
   * $\dot q_a = R^T (v_a - \bar v) - \dot\varphi \times R^T (x_a - \bar x)$
   * with the velocity $\bar v$ of the centre of mass and the spin
   * $\dot\varphi_i = \Lambda_{ijk} H_{jk}$, $H = R^T \sum_a v_a \otimes g_a$.
   * It vanishes if the body moves rigidly, whatever its deformation.
   * See theory (7.1).
   *
   * @param frame the rotation of the body at @p positions
   * @param velocities $v_a$, m/s
   * @param[out] rate $\dot q$, m/s; must have the size of @p positions
   */
  void
  co_rotated_velocity(const BodyOperators &body,
                      const BodyRotation &frame,
                      const NodalVector &positions,
                      const NodalVector &velocities,
                      NodalVector &rate);

  /**
   * The elastic force of the reduced strain $\mathrm{Sym}(R^T \nabla \tilde u)$
   * (paper Eq. (12)), the exact gradient of $W = \frac12 q^T A q$:
   * \f[ f_a = R (k_a - P g_a), \quad k = A q, \quad
   *     c = \sum_a q_a \times k_a, \quad P_{jk} = c_i \Lambda_{ijk} \f]
   * where the second term is $f_{\delta R}$ of paper Eq. (28); for the polar
   * decomposition it is $-R\,(L c) \times g_a$ with
   * $L = (\mathrm{tr}(U) I - U)^{-1}$. Without a loop over elements.
   * See theory (3.2), theory (3.3).
   *
   * @param positions $x_a$, m
   * @param measure how the rotation is found
   * @param[out] force $f_a$, N; must have the size of @p positions
   * @param scratch work space; must have the size of @p positions
   * @return the energy W, J; nothing if the mean deformation gradient has no
   * rotation
   */
  std::optional<double>
  reduced_strain_force(const BodyOperators &body,
                       const RotationMeasure measure,
                       const NodalVector &positions,
                       NodalVector &force,
                       NodalVector &scratch);

  /** W of reduced_strain_force(), J, without the force. */
  std::optional<double>
  reduced_strain_energy(const BodyOperators &body,
                        const RotationMeasure measure,
                        const NodalVector &positions);

  /**
   * The force of reduced_strain_force() with Rayleigh damping in the rotating
   * frame, on the same side of the equations of motion:
   * \f[ f_a = R (k_a - P g_a), \quad
   *     k = A (q + \beta \dot q) + \alpha M \dot q, \quad
   *     c = \sum_a y_a \times k_a, \quad P_{jk} = c_i \Lambda_{ijk} \f]
   * with $y_a = R^T (x_a - \bar x)$. This is the adjoint of the linear map
   * $v \mapsto \dot q$, so that $f \cdot v = k \cdot \dot q$: besides the power
   * $\dot W$ of the elastic force it takes
   * $\alpha\, \dot q^T M \dot q + \beta\, \dot q^T A \dot q \ge 0$ from the
   * body. The damping has neither a resultant nor a moment and does not resist
   * rigid motions.
   *
   * One product with A, and one with M if $\alpha \ne 0$. They do not give the
   * energy W.
   * See theory (7.2).
   *
   * @param velocities $v_a$, m/s
   * @param mass_damping $\alpha$, 1/s
   * @param stiffness_damping $\beta$, s
   * @param[out] force $f_a$, N; must have the size of @p positions
   * @param scratch work space; must have the size of @p positions
   * @param with_elasticity whether k has the term $A q$
   * @return false, and no force, if the mean deformation gradient has no
   * rotation
   */
  bool
  damped_reduced_strain_force(const BodyOperators &body,
                              const RotationMeasure measure,
                              const NodalVector &positions,
                              const NodalVector &velocities,
                              const double mass_damping,
                              const double stiffness_damping,
                              NodalVector &force,
                              NodalVector &scratch,
                              const bool with_elasticity = true);
} // namespace ACF

#endif
