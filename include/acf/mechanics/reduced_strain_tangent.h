// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_reduced_strain_tangent_h
#define acf_mechanics_reduced_strain_tangent_h

#include <acf/mechanics/reduced_strain.h>

#include <Eigen/Dense>

#include <optional>

namespace ACF
{
  /**
   * The derivative of the reduced-strain force, the second derivative of its
   * energy W: the constant stiffness A in the axes of the body and a change of
   * low rank,
   * \f[ \delta f = R\, (A + U B U^T)\, R^T \delta x, \f]
   * where $R$ and $R^T$ act on each node.
   */
  struct ReducedStrainTangent
  {
    /** R, the rotation of the body. */
    Matrix3 rotation;

    /** U, unknowns of the body times r; r is 6, or 0 where U B U^T vanishes. */
    Eigen::MatrixXd columns;

    /** B, r times r, symmetric and, if r > 0, invertible but indefinite. */
    Eigen::MatrixXd coefficients;
  };



  /**
   * The exact tangent of reduced_strain_force().
   *
   * For the displacement $R \delta_a$ the rotation has the spin
   * $\varphi = \Phi^T \delta$ with the three columns
   * $\Phi_{j,ak} = \Lambda_{jkl} g_{a,l}$ (1/m), and q varies by $\delta$ less
   * a translation and $\varphi \times y$, $y_a = R^T (x_a - \bar x)$. With the
   * force in the axes of the body $\hat f = R^T f$
   * \f[ \delta^2 W = \delta^T A\, \delta - 2 \varphi^T T^T \delta
   *                + \varphi^T G\, \varphi, \f]
   * \f[ T_{j,a} = (A\, [e_j \times q])_a + \hat f_a \times e_j, \f]
   * \f[ G_{ij} = [e_i \times q]^T A\, [e_j \times q]
   *            + \sum_a \big(y_{a,i} \hat f_{a,j}
   *            - (y_a \cdot \hat f_a)\, \delta_{ij}\big). \f]
   * The second derivative of the rotation (see BodyRotation) turns what would
   * be $k = A q$ into $\hat f$. So $U = (\Phi, T)$ and
   * \f[ B = \begin{pmatrix} G & -I \\ -I & 0 \end{pmatrix}, \quad
   *     B^{-1} = - \begin{pmatrix} 0 & I \\ I & G \end{pmatrix}. \f]
   * U has no columns if the body is not deformed, that is if q is no more than
   * round-off of the positions.
   *
   * Four products with A, without a loop over elements.
   * See theory (13.6).
   *
   * @param positions $x_a$, m
   * @param measure how the rotation is found
   * @return nothing if the mean deformation gradient has no rotation
   */
  std::optional<ReducedStrainTangent>
  reduced_strain_tangent(const BodyOperators &body,
                         const RotationMeasure measure,
                         const NodalVector &positions);
} // namespace ACF

#endif
