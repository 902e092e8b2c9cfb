// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/reduced_strain_tangent.h>

#include <cmath>
#include <limits>

#include <unit/reduced_strain_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** R (A + U B U^T) R^T v */
  NodalVector
  apply(const BodyOperators &body,
        const ReducedStrainTangent &tangent,
        const NodalVector &v)
  {
    const NodalVector source = transformed(v, [&](const Vector3 &v_a) {
      return transpose(tangent.rotation) * v_a;
    });
    NodalVector result(v.size());
    body.stiffness_matrix.vmult(result, source);

    const Eigen::Map<const Eigen::VectorXd> delta(source.begin(), v.size());
    Eigen::Map<Eigen::VectorXd>(result.begin(), v.size()) +=
      tangent.columns *
      (tangent.coefficients * (tangent.columns.transpose() * delta));
    return transformed(result,
                       [&](const Vector3 &k) { return tangent.rotation * k; });
  }

  /** The same without U B U^T. */
  NodalVector
  apply_stiffness(const BodyOperators &body,
                  ReducedStrainTangent tangent,
                  const NodalVector &v)
  {
    tangent.columns.resize(v.size(), 0);
    tangent.coefficients.resize(0, 0);
    return apply(body, tangent, v);
  }

  /** Derivative of the force in a direction, by central differences of fourth
   * order. */
  NodalVector
  differences(const Example &example,
              const RotationMeasure measure,
              const NodalVector &x,
              const NodalVector &direction)
  {
    const double h     = 5e-4 * example.body.length / direction.linfty_norm();
    const auto central = [&](const double size) {
      NodalVector right(x), left(x);
      right.add(size, direction);
      left.add(-size, direction);
      NodalVector change = force_of(example, measure, right).value;
      change -= force_of(example, measure, left).value;
      change /= 2 * size;
      return change;
    };
    NodalVector derivative = central(h);
    derivative.sadd(4. / 3, -1. / 3, central(2 * h));
    return derivative;
  }
} // namespace

TEST(ReducedStrainTangent, AgainstDifferencesOfTheForce)
{
  Random random;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      {
        const NodalVector x = deformed(example, random);
        const ReducedStrainTangent tangent =
          *reduced_strain_tangent(example.body, measure, x);
        EXPECT_EQ((tangent.coefficients - tangent.coefficients.transpose())
                    .cwiseAbs()
                    .maxCoeff(),
                  0);

        // every column of the matrix, in the unit of the largest entry
        double error = 0, correction = 0, largest = 0;
        NodalVector unit(x.size());
        for (unsigned int k = 0; k < x.size(); ++k)
          {
            unit[k]                 = 1;
            const NodalVector exact = differences(example, measure, x, unit);
            NodalVector with        = apply(example.body, tangent, unit);
            NodalVector without = apply_stiffness(example.body, tangent, unit);
            unit[k]             = 0;
            with -= exact;
            without -= exact;
            error      = std::max(error, with.linfty_norm());
            correction = std::max(correction, without.linfty_norm());
            largest    = std::max(largest, exact.linfty_norm());
          }
        const std::string label = example.name + ", " + name;
        EXPECT_LT(error / largest, 1e-11) << label;
        EXPECT_GT(correction / largest, 1e-3) << label;
        report(label + ", tangent against differences", error / largest);
        report(label + ", the same without U B U^T", correction / largest);
      }
}

TEST(ReducedStrainTangent, SmoothDirections)
{
  // Long waves, for which A is small and the rotation matters.
  Random random;
  double error = 0, without = 1;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      for (unsigned int n = 0; n < 5; ++n)
        {
          const NodalVector x = deformed(example, random);
          const ReducedStrainTangent tangent =
            *reduced_strain_tangent(example.body, measure, x);
          const Matrix3 gradient  = random.matrix(1);
          const Vector3 bend      = random.vector(0.3);
          const NodalVector v     = transformed(x, [&](const Vector3 &y) {
            return gradient * y + y[0] * y[0] * bend;
          });
          const NodalVector exact = differences(example, measure, x, v);
          error                   = std::max(error,
                           relative_difference(apply(example.body, tangent, v),
                                               exact));
          without =
            std::min(without,
                     relative_difference(
                       apply_stiffness(example.body, tangent, v), exact));
        }
  // the differences lose more digits to round-off the longer the waves
  EXPECT_LT(error, 5e-9);
  EXPECT_GT(without, 1e-2);
  report("tangent in smooth directions", error);
  report("the same without U B U^T, smallest", without);
}

TEST(ReducedStrainTangent, RigidMotionsTurnTheForce)
{
  Random random;
  double error = 0;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      for (unsigned int n = 0; n < 5; ++n)
        {
          const NodalVector x     = deformed(example, random);
          const NodalVector force = force_of(example, measure, x).value;
          const Vector3 omega = random.vector(1), t = random.vector(1);
          const NodalVector motion = transformed(x, [&](const Vector3 &y) {
            return t + cross_product_3d(omega, y);
          });
          const NodalVector turned =
            transformed(force, [&](const Vector3 &f_a) {
              return cross_product_3d(omega, f_a);
            });
          const ReducedStrainTangent tangent =
            *reduced_strain_tangent(example.body, measure, x);
          error =
            std::max(error,
                     relative_difference(apply(example.body, tangent, motion),
                                         turned));
        }
  EXPECT_LT(error, 1e-11);
  report("tangent of rigid motions against omega x f", error);
}

TEST(ReducedStrainTangent, IndependentOfTheObserver)
{
  Random random;
  double error = 0;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      {
        const NodalVector x = deformed(example, random);
        const NodalVector v = random.nodal_vector(x.size(), 1);
        const Matrix3 Q     = random.rotation();
        const Vector3 t     = random.vector(1);
        const auto rotate   = [&](const Vector3 &y) { return Q * y; };
        const NodalVector here =
          apply(example.body,
                *reduced_strain_tangent(example.body, measure, x),
                v);
        const NodalVector there =
          apply(example.body,
                *reduced_strain_tangent(
                  example.body,
                  measure,
                  transformed(x, [&](const Vector3 &y) { return t + Q * y; })),
                transformed(v, rotate));
        error = std::max(error,
                         relative_difference(there, transformed(here, rotate)));
      }
  EXPECT_LT(error, 1e-12);
  report("change of the tangent by a superposed motion", error);
}

TEST(ReducedStrainTangent, NoColumnsWithoutDeformation)
{
  Random random;
  double error = 0, round_off = 0;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      for (const double distance : {0., 1., 1e3})
        {
          const BodyOperators &body = example.body;
          const Matrix3 Q           = random.rotation();
          const Vector3 t           = random.vector(distance);
          NodalVector x =
            transformed(body.reference_positions,
                        [&](const Vector3 &X) { return t + Q * X; });
          const ReducedStrainTangent tangent =
            *reduced_strain_tangent(body, measure, x);
          EXPECT_EQ(tangent.columns.rows(), x.size());
          EXPECT_EQ(tangent.columns.cols(), 0);
          EXPECT_EQ(tangent.coefficients.size(), 0);

          NodalVector q(x.size());
          co_rotated_displacement(body, x, tangent.rotation, q);
          round_off = std::max(round_off,
                               q.linfty_norm() /
                                 (std::sqrt(body.n_nodes) *
                                  std::numeric_limits<double>::epsilon() *
                                  std::max(x.linfty_norm(), body.length)));

          if (distance < 10)
            {
              const NodalVector v = random.nodal_vector(x.size(), 1);
              error               = std::max(
                error,
                relative_difference(apply(body, tangent, v),
                                    differences(example, measure, x, v)));
            }

          // the smallest deformations have them
          x += random.nodal_vector(x.size(), 1e-11 * (body.length + distance));
          EXPECT_EQ(reduced_strain_tangent(body, measure, x)->columns.cols(),
                    6);
        }
  EXPECT_LT(error, 1e-9);
  report("tangent without deformation against differences", error);
  report("round-off of q over eps sqrt(n) max(|x|, l)", round_off);
}

TEST(ReducedStrainTangent, NothingForInvertedBodies)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      {
        NodalVector x(example.body.reference_positions);
        x *= -1;
        EXPECT_FALSE(reduced_strain_tangent(example.body, measure, x));
        x *= -1;
        EXPECT_TRUE(reduced_strain_tangent(example.body, measure, x));
        x[7] = nan;
        EXPECT_FALSE(reduced_strain_tangent(example.body, measure, x));
      }
}
