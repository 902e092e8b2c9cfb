// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/rotation.h>

#include <cmath>
#include <limits>

#include <unit/mechanics_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  constexpr unsigned int n_samples = 200;

  const std::vector<RotationMeasure> measures = {RotationMeasure::polar,
                                                 RotationMeasure::three_points};

  /** Any rotation and a moderate stretch and shear. */
  Matrix3
  random_gradient(Random &random)
  {
    Matrix3 F;
    do
      F = identity_matrix() + random.matrix(0.3);
    while (determinant(F) < 0.3);
    return random.rotation() * F;
  }

  /** v with [v]x = W; W must be skew. */
  Vector3
  axial(const Matrix3 &W)
  {
    return Vector3({W[2][1], W[0][2], W[1][0]});
  }

  /** Cross product by its components. */
  Vector3
  cross(const Vector3 &a, const Vector3 &b)
  {
    return Vector3({a[1] * b[2] - a[2] * b[1],
                    a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]});
  }

  /** Orthogonal polar factor by Newton's iteration (Higham 1986). */
  Matrix3
  newton_polar_factor(Matrix3 F)
  {
    for (unsigned int i = 0; i < 20; ++i)
      F = 0.5 * (F + transpose(invert(F)));
    return F;
  }

  /** Spin of R for a variation of F, by central differences. */
  Vector3
  spin_by_differences(const Matrix3 &F,
                      const Matrix3 &direction,
                      const RotationMeasure measure)
  {
    const double h = 1e-5;
    const Matrix3 change =
      (body_rotation(F + h * direction, measure)->rotation -
       body_rotation(F - h * direction, measure)->rotation) /
      (2 * h);
    const Matrix3 W = transpose(body_rotation(F, measure)->rotation) * change;
    EXPECT_LT((W + transpose(W)).norm(), 1e-9 * (1 + W.norm()));
    return axial(0.5 * (W - transpose(W)));
  }

  /** delta omega_i = Lambda_ijk H_jk */
  Vector3
  apply(const Tensor<3, dim> &gradient, const Matrix3 &H)
  {
    Vector3 spin;
    for (unsigned int i = 0; i < dim; ++i)
      spin[i] = scalar_product(gradient[i], H);
    return spin;
  }
} // namespace

TEST(RotationMatrix, IsRodriguesFormulaAndTheExponentialSeries)
{
  Random random;
  double error = 0;
  for (const double size : {1e-9, 1e-4, 0.5, 3., 7.})
    for (unsigned int n = 0; n < 20; ++n)
      {
        const Vector3 v      = random.vector(size);
        const double angle   = v.norm();
        const Matrix3 R      = rotation_matrix(v);
        const Vector3 x      = random.vector(1);
        const Vector3 axis   = v / angle;
        const Vector3 turned = std::cos(angle) * x +
                               std::sin(angle) * cross(axis, x) +
                               (1 - std::cos(angle)) * (axis * x) * axis;
        error = std::max(error, (R * x - turned).norm());

        Vector3 sum = x, term = x;
        for (unsigned int k = 1; k < 60; ++k)
          {
            term = cross(v, term) / k;
            sum += term;
          }
        // the terms of the series grow up to exp(|v|)
        EXPECT_LT((R * x - sum).norm(), 1e-15 * (3 + std::exp(angle)));
      }
  EXPECT_LT(error, 5e-15);
  report("rotation matrix against Rodrigues' formula", error);

  EXPECT_EQ((rotation_matrix(Vector3()) - identity_matrix()).norm(), 0);
  const Matrix3 quarter = rotation_matrix(Vector3({0, 0, numbers::PI / 2}));
  EXPECT_NEAR(quarter[1][0], 1, 1e-15); // x to y, not to -y
  EXPECT_NEAR(quarter[0][1], -1, 1e-15);
}

TEST(RotationMatrix, CrossProductMatrix)
{
  Random random;
  for (unsigned int n = 0; n < 10; ++n)
    {
      const Vector3 v = random.vector(2), w = random.vector(2);
      EXPECT_EQ((cross_product_matrix(v) * w - cross(v, w)).norm(), 0);
    }
}

TEST(Rotation, PolarDecomposition)
{
  Random random;
  double difference = 0, defect = 0;
  for (unsigned int n = 0; n < n_samples; ++n)
    {
      const Matrix3 F = random_gradient(random);
      const Matrix3 R = polar_rotation(F)->rotation;
      const Matrix3 U = transpose(R) * F;
      defect = std::max(defect, (transpose(R) * R - identity_matrix()).norm());
      defect = std::max(defect, std::abs(determinant(R) - 1));
      defect = std::max(defect, (U - transpose(U)).norm());
      for (const double value : eigenvalues(symmetrize(U)))
        EXPECT_GT(value, 0);
      difference = std::max(difference, (R - newton_polar_factor(F)).norm());
    }
  EXPECT_LT(defect, 1e-14);
  EXPECT_LT(difference, 1e-13);
  report("polar decomposition: orthogonality, determinant, symmetry", defect);
  report("polar decomposition against Newton's iteration", difference);
}

TEST(Rotation, ThreePointFrame)
{
  Random random;
  double defect = 0;
  for (unsigned int n = 0; n < n_samples; ++n)
    {
      const Matrix3 F = random_gradient(random);
      const Matrix3 R = three_point_rotation(F)->rotation;
      defect = std::max(defect, (transpose(R) * R - identity_matrix()).norm());
      defect = std::max(defect, std::abs(determinant(R) - 1));
      // R^T F is upper triangular in its first two columns, both positive
      const Matrix3 U = transpose(R) * F;
      defect          = std::max(
        {defect, std::abs(U[1][0]), std::abs(U[2][0]), std::abs(U[2][1])});
      EXPECT_GT(U[0][0], 0);
      EXPECT_GT(U[1][1], 0);
    }
  EXPECT_LT(defect, 1e-14);
  report("three-point frame: orthogonality and directions", defect);
}

TEST(Rotation, ObjectivityAndRigidRotations)
{
  Random random;
  double difference = 0, isotropy = 0, rigid = 0;
  for (const RotationMeasure measure : measures)
    for (unsigned int n = 0; n < n_samples; ++n)
      {
        const Matrix3 F = random_gradient(random), Q = random.rotation();
        const BodyRotation plain   = *body_rotation(F, measure);
        const BodyRotation rotated = *body_rotation(Q * F, measure);
        difference =
          std::max(difference, (rotated.rotation - Q * plain.rotation).norm());
        // in the rotated frame the derivative does not see Q
        difference =
          std::max(difference,
                   (rotated.spin_gradient - plain.spin_gradient).norm());
        rigid =
          std::max(rigid, (body_rotation(Q, measure)->rotation - Q).norm());
        if (measure == RotationMeasure::polar)
          isotropy = std::max(
            isotropy,
            (polar_rotation(F * Q)->rotation - plain.rotation * Q).norm());
      }
  EXPECT_LT(difference, 1e-13);
  EXPECT_LT(isotropy, 1e-13);
  EXPECT_LT(rigid, 1e-14);
  report("rotation measures: objectivity", difference);
  report("polar decomposition: isotropy", isotropy);
}

TEST(Rotation, DerivativeAgainstCentralDifferences)
{
  Random random;
  for (const RotationMeasure measure : measures)
    {
      double error = 0;
      for (unsigned int n = 0; n < n_samples; ++n)
        {
          const Matrix3 F           = random_gradient(random);
          const BodyRotation result = *body_rotation(F, measure);
          for (unsigned int j = 0; j < dim; ++j)
            for (unsigned int k = 0; k < dim; ++k)
              {
                Matrix3 direction;
                direction[j][k] = 1;
                const Vector3 spin =
                  apply(result.spin_gradient,
                        transpose(result.rotation) * direction);
                error = std::max(
                  error,
                  (spin - spin_by_differences(F, direction, measure)).norm() /
                    result.spin_gradient.norm());
              }
        }
      EXPECT_LT(error, 1e-7);
      report(measure == RotationMeasure::polar
               ? "derivative of the polar rotation"
               : "derivative of the three-point rotation",
             error);
    }
}

TEST(Rotation, SecondDerivativeAgainstCentralDifferences)
{
  Random random;
  for (const RotationMeasure measure : measures)
    {
      double error = 0;
      for (unsigned int n = 0; n < n_samples; ++n)
        {
          const Matrix3 F = random_gradient(random), H = random.matrix(1);
          const BodyRotation result = *body_rotation(F, measure);
          const Matrix3 &R          = result.rotation;
          const Vector3 first       = apply(result.spin_gradient, H);
          const Matrix3 W           = cross_product_matrix(first);
          const Vector3 second =
            apply(result.spin_gradient, W * (W * transpose(R) * F - 2. * H));

          // the rate of the spin of R(eps) is the second derivative alone
          const double h  = 1e-5;
          const auto spin = [&](const double eps) {
            const BodyRotation moved = *body_rotation(F + eps * R * H, measure);
            return apply(moved.spin_gradient,
                         transpose(moved.rotation) * R * H);
          };
          const Vector3 exact = (spin(h) - spin(-h)) / (2 * h);
          error               = std::max(error,
                           (second - exact).norm() /
                             std::pow(result.spin_gradient.norm(), 2));
        }
      EXPECT_LT(error, 1e-7);
      report(measure == RotationMeasure::polar
               ? "second derivative of the polar rotation"
               : "second derivative of the three-point rotation",
             error);
    }
}

TEST(Rotation, Contraction)
{
  Random random;
  double difference = 0;
  for (unsigned int n = 0; n < n_samples; ++n)
    {
      const Matrix3 F = random_gradient(random), H = random.matrix(1);
      const Vector3 c = random.vector(1);
      for (const RotationMeasure measure : measures)
        {
          const BodyRotation result = *body_rotation(F, measure);
          EXPECT_NEAR(scalar_product(result.contract(c), H),
                      c * apply(result.spin_gradient, H),
                      1e-14);
        }

      // P = [L c]x, the form of the polar decomposition
      const BodyRotation result = *polar_rotation(F);
      const Matrix3 U           = transpose(result.rotation) * F;
      const Matrix3 L           = invert(trace(U) * identity_matrix() - U);
      difference =
        std::max(difference,
                 (result.contract(c) - cross_product_matrix(L * c)).norm());
    }
  EXPECT_LT(difference, 1e-13);
  report("contraction against [L c]x", difference);
}

TEST(Rotation, NothingWithoutProperRotation)
{
  Random random;
  const double nan      = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const RotationMeasure measure : measures)
    {
      EXPECT_FALSE(body_rotation(Matrix3(), measure));
      for (unsigned int i = 0; i < dim; ++i)
        {
          Matrix3 reflection = identity_matrix();
          reflection[i][i]   = -1;
          EXPECT_FALSE(body_rotation(reflection, measure));
          EXPECT_FALSE(body_rotation(random.rotation() * reflection, measure));

          Matrix3 flat = identity_matrix();
          flat[i][i]   = 0;
          EXPECT_FALSE(body_rotation(flat, measure));
          for (unsigned int j = 0; j < dim; ++j)
            for (const double bad : {nan, infinity, -infinity})
              {
                Matrix3 F = random.rotation();
                F[i][j]   = bad;
                EXPECT_FALSE(body_rotation(F, measure)) << i << j << bad;
              }
        }
      EXPECT_FALSE(body_rotation(-1. * random.rotation(), measure));
      EXPECT_TRUE(body_rotation(1e-3 * random.rotation(), measure));
      for (unsigned int n = 0; n < n_samples; ++n)
        {
          const Matrix3 F = random.matrix(1);
          EXPECT_EQ(body_rotation(F, measure).has_value(), determinant(F) > 0);
        }
    }
}
