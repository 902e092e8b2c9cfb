// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_rotation_h
#define acf_mechanics_rotation_h

#include <acf/base/types.h>

#include <optional>
#include <vector>

namespace ACF
{
  /** How the rotation of a body follows from its mean deformation gradient. */
  enum class RotationMeasure
  {
    /** The rotation R of the polar decomposition F = R U. */
    polar,

    /** The rotation of two material directions (Gerstmayr, Schoeberl, Sec. 3).
     */
    three_points
  };

  /**
   * The rotation of a body and its first derivative.
   *
   * For a variation $\delta F$ of the deformation gradient the rotation varies
   * by $\delta R = R\, [\delta\omega]_\times$ with
   * $\delta\omega_i = \Lambda_{ijk} H_{jk}$, $H = R^T \delta F$.
   *
   * $\Lambda$ gives the second derivative, too. Both measures make linear
   * components of $R^T F$ vanish, and $\Lambda$ reads no others, so that for
   * $F + \varepsilon R H$ the rotation is
   * $R \exp([\varepsilon \varphi' + \frac12 \varepsilon^2 \varphi'']_\times)
   * + O(\varepsilon^3)$ with
   * \f[ \varphi'_i = \Lambda_{ijk} H_{jk}, \quad
   *     \varphi''_i = \Lambda_{ijk} S_{jk}, \quad
   *     S = [\varphi']_\times ([\varphi']_\times R^T F - 2 H). \f]
   * See theory (2.3).
   */
  struct BodyRotation
  {
    /** R, with determinant 1. */
    Matrix3 rotation;

    /** $\Lambda$, the derivative of the rotation in the rotated frame. */
    Tensor<3, dim> spin_gradient;

    /**
     * The matrix $P_{jk} = c_i \Lambda_{ijk}$, so that
     * $c \cdot \delta\omega = P : H$. Gerstmayr and Schoeberl's term
     * $f_{\delta R}$, Eq. (28), is $-R P g_a$ with $c = \sum_a q_a \times k_a$.
     */
    Matrix3
    contract(const Vector3 &c) const;
  };

  /**
   * Rotation R of the polar decomposition $F = R U$. Its derivative is
   * $\delta\omega = (\mathrm{tr}(U) I - U)^{-1} \mathrm{axial}(H - H^T)$.
   * See theory (2.4).
   *
   * @return nothing if $\det F \le 0$ (or not finite), where no proper rotation
   * exists
   */
  std::optional<BodyRotation>
  polar_rotation(const Matrix3 &deformation_gradient);

  /**
   * Rotation of an orthonormal frame that is attached to three material points:
   * its first axis follows the material direction $e_1$, its third axis stays
   * perpendicular to the material directions $e_1$ and $e_2$. With
   * $a = F e_1$, $b = F e_2$: $R = (a/|a|,\ n \times a/|a|,\ n)$,
   * $n = a \times b / |a \times b|$.
   * See theory (2.2).
   *
   * @return nothing if $\det F \le 0$ (or not finite)
   */
  std::optional<BodyRotation>
  three_point_rotation(const Matrix3 &deformation_gradient);

  /** One of the two functions above. */
  std::optional<BodyRotation>
  body_rotation(const Matrix3 &deformation_gradient,
                const RotationMeasure measure);

  /**
   * R of the polar decomposition alone, by Newton's iteration
   * $R \leftarrow (R + R^{-T}) / 2$ from F (Higham, Computing the polar
   * decomposition - with applications, 1986): quick for small strain.
   *
   * @return nothing if $\det F \le 0$ (or not finite)
   */
  std::optional<Matrix3>
  nearest_rotation(const Matrix3 &deformation_gradient);

  /**
   * nearest_rotation() of many matrices, eight at once.
   * @param fallback where there is none
   */
  std::vector<Matrix3>
  nearest_rotations(const std::vector<Matrix3> &deformation_gradients,
                    const Matrix3 &fallback);

  /**
   * Rotation by the angle $|v|$ about the axis $v/|v|$:
   * $R = \exp([v]_\times)$ (Rodrigues).
   *
   * @param v rotation vector, rad
   */
  Matrix3
  rotation_matrix(const Vector3 &v);

  /** The matrix $[v]_\times$ with $[v]_\times w = v \times w$. */
  Matrix3
  cross_product_matrix(const Vector3 &v);
} // namespace ACF

#endif
