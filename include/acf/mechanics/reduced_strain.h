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

  /**
   * Co-rotated displacement
   * $q_a = R^T (x_a - \bar x) - (X_a - \bar X)$ with the centres of mass
   * $\bar x$, $\bar X$, which removes the rigid translation.
   *
   * @param[out] displacement q, m; must have the size of @p positions
   */
  void
  co_rotated_displacement(const BodyOperators &body,
                          const NodalVector &positions,
                          const Matrix3 &rotation,
                          NodalVector &displacement);

  /**
   * The elastic force of the reduced strain $\mathrm{Sym}(R^T \nabla \tilde u)$
   * (paper Eq. (12)), the exact gradient of $W = \frac12 q^T A q$:
   * \f[ f_a = R (k_a - P g_a), \quad k = A q, \quad
   *     c = \sum_a q_a \times k_a, \quad P_{jk} = c_i \Lambda_{ijk} \f]
   * where the second term is $f_{\delta R}$ of paper Eq. (28); for the polar
   * decomposition it is $-R\,(L c) \times g_a$ with
   * $L = (\mathrm{tr}(U) I - U)^{-1}$. Without a loop over elements.
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
} // namespace ACF

#endif
