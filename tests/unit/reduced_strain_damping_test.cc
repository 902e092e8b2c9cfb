// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <cmath>

#include <unit/reduced_strain_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  struct Damping
  {
    double mass      = 0;
    double stiffness = 0;
  };

  // Both parts of the damping force are comparable with the elastic force of
  // the deformations and velocities below.
  constexpr double mass_damping = 2e4, stiffness_damping = 5e-3;

  Damping
  test_damping()
  {
    Damping damping;
    damping.mass      = mass_damping;
    damping.stiffness = stiffness_damping;
    return damping;
  }

  std::vector<Damping>
  dampings()
  {
    std::vector<Damping> all(3, test_damping());
    all[1].mass      = 0;
    all[2].stiffness = 0;
    return all;
  }

  BodyRotation
  frame_of(const Example &example,
           const RotationMeasure measure,
           const NodalVector &x)
  {
    return *body_rotation(mean_deformation_gradient(example.body, x), measure);
  }

  NodalVector
  force_of(const Example &example,
           const RotationMeasure measure,
           const Damping &damping,
           const NodalVector &x,
           const NodalVector &v)
  {
    NodalVector force(x.size());
    NodalVector scratch(x.size());
    EXPECT_TRUE(damped_reduced_strain_force(example.body,
                                            measure,
                                            x,
                                            v,
                                            damping.mass,
                                            damping.stiffness,
                                            force,
                                            scratch));
    return force;
  }

  NodalVector
  rate_of(const Example &example,
          const RotationMeasure measure,
          const NodalVector &x,
          const NodalVector &v)
  {
    NodalVector rate(x.size());
    co_rotated_velocity(
      example.body, frame_of(example, measure, x), x, v, rate);
    return rate;
  }

  /** (alpha M + beta A) q' */
  NodalVector
  resistance_to(const NodalVector &rate,
                const BodyOperators &body,
                const Damping &damping)
  {
    NodalVector resistance(rate.size()), product(rate.size());
    body.mass_matrix.vmult(product, rate);
    resistance.add(damping.mass, product);
    body.stiffness_matrix.vmult(product, rate);
    resistance.add(damping.stiffness, product);
    return resistance;
  }

  /** A rigid motion of some m/s, bending and small-scale noise. */
  NodalVector
  vibration(const NodalVector &x, Random &random)
  {
    const Matrix3 gradient = random.matrix(2);
    const Vector3 bend = random.vector(2), t = random.vector(3);
    NodalVector v = transformed(x, [&](const Vector3 &y) {
      return t + gradient * y + y[0] * y[0] * bend;
    });
    v += random.nodal_vector(x.size(), 0.1);
    return v;
  }

  /** v + t + omega x x */
  NodalVector
  with_rigid_motion(const NodalVector &v,
                    const NodalVector &x,
                    const Vector3 &t,
                    const Vector3 &omega)
  {
    NodalVector sum = transformed(x, [&](const Vector3 &y) {
      return t + cross_product_3d(omega, y);
    });
    sum += v;
    return sum;
  }
} // namespace

TEST(ReducedStrainDamping, RateIsTheDerivativeOfTheDisplacement)
{
  Random random;
  double error = 0;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      for (unsigned int n = 0; n < 5; ++n)
        {
          const NodalVector x = deformed(example, random);
          const NodalVector v = vibration(x, random);
          const double h      = 1e-6;
          NodalVector right(x), left(x), differences(x.size()), q(x.size());
          right.add(h, v);
          left.add(-h, v);
          co_rotated_displacement(example.body,
                                  right,
                                  frame_of(example, measure, right).rotation,
                                  differences);
          co_rotated_displacement(example.body,
                                  left,
                                  frame_of(example, measure, left).rotation,
                                  q);
          differences -= q;
          differences /= 2 * h;
          error = std::max(error,
                           relative_difference(rate_of(example, measure, x, v),
                                               differences));
        }
  EXPECT_LT(error, 1e-8); // round-off of positions over h times velocities
  report("rate of q against differences", error);
}

TEST(ReducedStrainDamping, VirtualPower)
{
  Random random;
  double error = 0, share = 1;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      for (const Damping &damping : dampings())
        for (unsigned int n = 0; n < 3; ++n)
          {
            const NodalVector x = deformed(example, random);
            const NodalVector v = vibration(x, random);
            const NodalVector f = force_of(example, measure, damping, x, v);
            const NodalVector elastic = force_of(example, measure, x).value;
            const NodalVector rate    = rate_of(example, measure, x, v);

            const NodalVector resistance =
              resistance_to(rate, example.body, damping);

            // the power of the forces in the motion itself, and in another
            for (const NodalVector &w : {v, vibration(x, random)})
              {
                const double power = elastic * w;
                const double dissipation =
                  resistance * rate_of(example, measure, x, w);
                error = std::max(error,
                                 std::abs(f * w - power - dissipation) /
                                   (f.l2_norm() * w.l2_norm()));
              }
            const double dissipation = resistance * rate;
            EXPECT_GT(dissipation, 0);
            share = std::min(share, dissipation / (f.l2_norm() * v.l2_norm()));
          }
  EXPECT_LT(error, 1e-13);
  EXPECT_GT(share, 1e-4); // the dissipation is far above the error
  report("virtual power of the damped force", error);
  report("smallest dissipation in the same unit", share);
}

TEST(ReducedStrainDamping, RigidMotionsAreFree)
{
  Random random;
  double error = 0, effect = 1;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      for (const Damping &damping : dampings())
        {
          // turning at hundreds of rad/s while it vibrates
          const NodalVector x = deformed(example, random);
          const NodalVector v = vibration(x, random);
          const Vector3 t = random.vector(100), omega = random.vector(500);
          const NodalVector turning = with_rigid_motion(v, x, t, omega);
          const NodalVector slow    = force_of(example, measure, damping, x, v);
          error =
            std::max(error,
                     relative_difference(
                       force_of(example, measure, damping, x, turning), slow));

          // a frozen deformation: only the elastic force is left
          const NodalVector frozen =
            with_rigid_motion(NodalVector(x.size()), x, t, omega);
          const NodalVector elastic = force_of(example, measure, x).value;
          error                     = std::max(
            error,
            relative_difference(force_of(example, measure, damping, x, frozen),
                                elastic));
          effect = std::min(effect, relative_difference(slow, elastic));
        }
  // the velocities of the rigid motions are hundreds of times those of the
  // vibrations, and q' inherits their round-off
  EXPECT_LT(error, 1e-11);
  EXPECT_GT(effect, 1e-2);
  report("change of the damped force by a rigid motion", error);
  report("smallest change of the force by the damping", effect);
}

TEST(ReducedStrainDamping, NoResultant)
{
  Random random;
  double force_sum = 0, moment_sum = 0, incomplete = 1;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      for (const Damping &damping : dampings())
        {
          const NodalVector x = deformed(example, random);
          const NodalVector v = vibration(x, random);
          const NodalVector f = force_of(example, measure, damping, x, v);
          const double scale  = f.l1_norm();
          force_sum  = std::max(force_sum, resultant(f).norm() / scale);
          moment_sum = std::max(moment_sum,
                                moment(f, x, random.vector(5)).norm() /
                                  (scale * example.body.length));

          // R (alpha M + beta A) q' alone has a moment
          const Matrix3 R = frame_of(example, measure, x).rotation;
          const NodalVector resistance =
            transformed(resistance_to(rate_of(example, measure, x, v),
                                      example.body,
                                      damping),
                        [&](const Vector3 &k) { return R * k; });
          incomplete = std::min(incomplete,
                                moment(resistance, x, Vector3()).norm() /
                                  (scale * example.body.length));
        }
  EXPECT_LT(force_sum, 1e-13);
  EXPECT_LT(moment_sum, 1e-13);
  EXPECT_GT(incomplete, 1e-5);
  report("resultant of the damped force, relative", force_sum);
  report("moment of the damped force, relative", moment_sum);
  report("moment of the damping without the term P g_a", incomplete);
}

TEST(ReducedStrainDamping, NoneGivesTheElasticForce)
{
  Random random;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      {
        const NodalVector x    = deformed(example, random);
        const NodalVector v    = vibration(x, random);
        NodalVector difference = force_of(example, measure, Damping(), x, v);
        difference -= force_of(example, measure, x).value;
        EXPECT_EQ(difference.linfty_norm(), 0);
      }
}

TEST(ReducedStrainDamping, NothingForInvertedBodies)
{
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      {
        const NodalVector &X = example.body.reference_positions;
        NodalVector x(X), force(X.size());
        x *= -1;
        NodalVector scratch(X.size());
        // clang 14 captures no structured bindings by reference
        const auto success = [&,
                              measure = measure](const NodalVector &positions) {
          return damped_reduced_strain_force(example.body,
                                             measure,
                                             positions,
                                             X,
                                             mass_damping,
                                             stiffness_damping,
                                             force,
                                             scratch);
        };
        EXPECT_FALSE(success(x));
        EXPECT_TRUE(success(X));
      }
}
