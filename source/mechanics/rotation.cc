// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/rotation.h>

#include <Eigen/Dense>

#include <cmath>

namespace ACF
{
  namespace
  {
    // The determinant of a matrix that is not finite may be infinite.
    bool
    preserves_orientation(const Matrix3 &F)
    {
      const double det = determinant(F);
      return det > 0 && std::isfinite(det);
    }
  } // namespace



  Matrix3
  BodyRotation::contract(const Vector3 &c) const
  {
    Matrix3 P;
    for (unsigned int i = 0; i < dim; ++i)
      P += c[i] * spin_gradient[i];
    return P;
  }



  Matrix3
  cross_product_matrix(const Vector3 &v)
  {
    Matrix3 result;
    result[0][1] = -v[2];
    result[0][2] = v[1];
    result[1][0] = v[2];
    result[1][2] = -v[0];
    result[2][0] = -v[1];
    result[2][1] = v[0];
    return result;
  }



  std::optional<BodyRotation>
  polar_rotation(const Matrix3 &deformation_gradient)
  {
    if (!preserves_orientation(deformation_gradient))
      return {};

    Eigen::Matrix3d F;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        F(i, j) = deformation_gradient[i][j];
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F,
                                                Eigen::ComputeFullU |
                                                  Eigen::ComputeFullV);

    const Eigen::Matrix3d &V = svd.matrixV();
    const Eigen::Matrix3d R  = svd.matrixU() * V.transpose();
    const Eigen::Matrix3d U =
      V * svd.singularValues().asDiagonal() * V.transpose();
    const Eigen::Matrix3d L =
      (U.trace() * Eigen::Matrix3d::Identity() - U).inverse();

    // axial(H - H^T)_l = eps_lkj H_jk, where eps_lkj = -eps_ljk
    BodyRotation result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        {
          result.rotation[i][j] = R(i, j);

          const unsigned int k          = (j + 1) % dim;
          const unsigned int l          = (j + 2) % dim;
          result.spin_gradient[i][k][j] = L(i, l);
          result.spin_gradient[i][j][k] = -L(i, l);
        }
    return result;
  }



  std::optional<BodyRotation>
  three_point_rotation(const Matrix3 &F)
  {
    if (!preserves_orientation(F))
      return {};

    Vector3 a, b;
    for (unsigned int i = 0; i < dim; ++i)
      {
        a[i] = F[i][0];
        b[i] = F[i][1];
      }
    const Vector3 axis_1 = a / a.norm();
    const Vector3 normal = cross_product_3d(a, b);
    const Vector3 axis_3 = normal / normal.norm();
    const Vector3 axis_2 = cross_product_3d(axis_3, axis_1);

    BodyRotation result;
    for (unsigned int i = 0; i < dim; ++i)
      {
        result.rotation[i][0] = axis_1[i];
        result.rotation[i][1] = axis_2[i];
        result.rotation[i][2] = axis_3[i];
      }

    // In the rotated frame a = (|a|, 0, 0) and b = (b_1, b_2, 0) with b_2 > 0.
    // The first axis stays parallel to a: omega_3 = H_21 / |a|,
    // omega_2 = -H_31 / |a|. The third stays perpendicular to b:
    // H_32 + b . (omega x e_3) = 0 gives omega_1 b_2 = H_32 + omega_2 b_1.
    const double length = a.norm();
    const double b_1    = b * axis_1;
    const double b_2    = b * axis_2;

    result.spin_gradient[2][1][0] = 1 / length;
    result.spin_gradient[1][2][0] = -1 / length;
    result.spin_gradient[0][2][1] = 1 / b_2;
    result.spin_gradient[0][2][0] = -b_1 / (length * b_2);
    return result;
  }



  std::optional<BodyRotation>
  body_rotation(const Matrix3 &deformation_gradient,
                const RotationMeasure measure)
  {
    return measure == RotationMeasure::polar
             ? polar_rotation(deformation_gradient)
             : three_point_rotation(deformation_gradient);
  }



  std::optional<Matrix3>
  nearest_rotation(const Matrix3 &deformation_gradient)
  {
    if (!preserves_orientation(deformation_gradient))
      return {};
    // a stretch of 2^k takes about k + 5 iterations
    constexpr unsigned int max_iterations = 40;
    Matrix3 R                             = deformation_gradient;
    for (unsigned int k = 0; k < max_iterations; ++k)
      {
        const Matrix3 next  = 0.5 * (R + transpose(invert(R)));
        const double change = (next - R).norm_square();
        R                   = next;
        // quadratic: the next change is of the order of this one squared
        if (change < 1e-16)
          return R;
      }
    return {};
  }



  Matrix3
  rotation_matrix(const Vector3 &v)
  {
    const double angle = v.norm();
    Eigen::Vector3d axis(1, 0, 0);
    if (angle > 0)
      axis = Eigen::Vector3d(v[0], v[1], v[2]) / angle;
    const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();

    Matrix3 result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result[i][j] = R(i, j);
    return result;
  }
} // namespace ACF
