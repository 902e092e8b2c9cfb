// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/mechanics/reduced_strain_residual.h>

#include <deal.II/fe/fe_values.h>

#include <cmath>
#include <limits>

#include <unit/all_instructions.h>
#include <unit/reduced_strain_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** W = q . A q / 2 */
  double
  energy_of(const BodyOperators &body,
            const RotationMeasure measure,
            const NodalVector &x)
  {
    const Matrix3 R =
      body_rotation(mean_deformation_gradient(body, x), measure)->rotation;
    NodalVector q(x.size()), Aq(x.size());
    co_rotated_displacement(body, x, R, q);
    body.stiffness_matrix.vmult(Aq, q);
    return q * Aq / 2;
  }

  /** The same as integral of the energy density of Sym(R^T grad x - I), with
   * the quadrature of the stiffness. */
  double
  energy_by_elements(const Example &example,
                     const RotationMeasure measure,
                     const NodalVector &x)
  {
    const BodyDiscretization &body = example.discretization;
    FEValues<dim> values(body.mesh().mapping(),
                         body.finite_element(),
                         body.mesh().cell_quadrature(
                           body.mesh().is_simplex() ? 2 : 4),
                         update_gradients | update_JxW_values);
    const FEValuesExtractors::Vector u(0);
    std::vector<Matrix3> gradients(values.n_quadrature_points);
    const Material material = test_material();

    Matrix3 mean;
    double volume = 0;
    for (const auto &cell : body.dof_handler().active_cell_iterators())
      {
        values.reinit(cell);
        values[u].get_function_gradients(x, gradients);
        for (const unsigned int q : values.quadrature_point_indices())
          {
            mean += values.JxW(q) * gradients[q];
            volume += values.JxW(q);
          }
      }
    mean /= volume;
    EXPECT_LT((mean - mean_deformation_gradient(example.body, x)).norm(),
              1e-12);
    const Matrix3 R = body_rotation(mean, measure)->rotation;

    double energy = 0;
    for (const auto &cell : body.dof_handler().active_cell_iterators())
      {
        values.reinit(cell);
        values[u].get_function_gradients(x, gradients);
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const SymmetricTensor<2, dim> strain =
              symmetrize(transpose(R) * gradients[q] - identity_matrix());
            energy += (material.lambda() / 2 * std::pow(trace(strain), 2) +
                       material.mu() * strain * strain) *
                      values.JxW(q);
          }
      }
    return energy;
  }

  // Random motion, with forces of inertia and damping as large as the elastic
  // ones.
  struct TestMotion
  {
    TestMotion(const Example &example,
               const unsigned int n,
               const double alpha,
               const double beta,
               Random &random)
      : x(deformed(example, random))
      , v(random.nodal_vector(x.size(), 1))
    {
      const BodyOperators &body = example.body;
      const double scale        = example.force_scale();
      motion.position           = &x;
      motion.velocity           = &v;
      motion.mass_damping       = alpha * scale / body.mass;
      motion.stiffness_damping  = beta;
      motion.first_rates        = 10 * Eigen::MatrixXd::Random(n, n);
      motion.second_rates = Eigen::MatrixXd::Random(n, n) * scale / body.mass;
      for (unsigned int i = 0; i < n; ++i)
        z.push_back(random.nodal_vector(x.size(), 1e-2));
      for (unsigned int i = 0; i < n; ++i)
        {
          motion.times.push_back(1e-2 * (i + 1));
          motion.increments.push_back(&z[i]);
          motion.gravity.push_back(random.vector(0.01 * scale / body.mass));
          motion.moments.push_back(nodal_moments(body, position(i)));
          motion.velocity_moments.push_back(nodal_moments(body, velocity(i)));
        }
    }

    TestMotion(const TestMotion &) = delete;

    NodalVector
    position(const unsigned int i) const
    {
      NodalVector result(x);
      result.add(motion.times[i], v, 1, z[i]);
      return result;
    }

    NodalVector
    velocity(const unsigned int i) const
    {
      NodalVector result(v);
      for (unsigned int j = 0; j < z.size(); ++j)
        result.add(motion.first_rates(i, j), z[j]);
      return result;
    }

    // Gravity and minus the acceleration.
    NodalVector
    missing_acceleration(const unsigned int i) const
    {
      NodalVector result(x.size());
      for (unsigned int j = 0; j < z.size(); ++j)
        result.add(-motion.second_rates(i, j), z[j]);
      for (unsigned int k = 0; k < x.size(); ++k)
        result[k] += motion.gravity[i][k % dim];
      return result;
    }

    NodalVector x, v;
    std::vector<NodalVector> z;
    NodalMotion motion;
  };

  // What is missing for equilibrium: by the force, the product with the mass
  // matrix and gravity, each alone. Also what of it is damping.
  std::pair<NodalVector, NodalVector>
  expected_residual(const Example &example,
                    const RotationMeasure measure,
                    const TestMotion &test,
                    const unsigned int i)
  {
    const BodyOperators &body   = example.body;
    const NodalVector positions = test.position(i);
    NodalVector expected(positions.size()), damping(positions.size()),
      scratch(positions.size());
    body.mass_matrix.vmult(expected, test.missing_acceleration(i));
    const NodalVector elastic = force_of(example, measure, positions).value;
    expected -= elastic;
    if (test.motion.is_damped())
      {
        EXPECT_TRUE(damped_reduced_strain_force(body,
                                                measure,
                                                positions,
                                                test.velocity(i),
                                                test.motion.mass_damping,
                                                test.motion.stiffness_damping,
                                                damping,
                                                scratch));
        damping -= elastic;
        expected -= damping;
      }
    return {expected, damping};
  }
} // namespace

TEST(ReducedStrain, MeansAndCoRotatedDisplacement)
{
  Random random;
  for (const Example &example : examples())
    for (unsigned int n = 0; n < 5; ++n)
      {
        const BodyOperators &body = example.body;
        const Matrix3 R           = random.rotation(),
                      F = R * (identity_matrix() + random.matrix(0.3));
        const Vector3 t = random.vector(2);
        const NodalVector x =
          transformed(body.reference_positions,
                      [&](const Vector3 &X) { return t + F * X; });
        EXPECT_LT((mean_deformation_gradient(body, x) - F).norm(), 1e-12);
        EXPECT_LT((mass_mean(body, x) - t - F * body.centre).norm(), 1e-13);

        NodalVector q(x.size());
        co_rotated_displacement(body, x, R, q);
        for (unsigned int a = 0; a < body.n_nodes; ++a)
          {
            const Vector3 arm =
              node_value(body.reference_positions, a) - body.centre;
            EXPECT_LT(
              (node_value(q, a) - transpose(R) * (F * arm) + arm).norm(),
              1e-13);
          }
      }
}

TEST_WITH_ALL_INSTRUCTIONS(ReducedStrain, NodalMomentsAreLinear)
{
  Random random;
  for (const Example &example : examples())
    {
      const BodyOperators &body = example.body;
      const NodalVector x       = deformed(example, random),
                        y       = random.nodal_vector(x.size(), 1);
      Matrix3 gradient;
      Vector3 sum;
      for (unsigned int a = 0; a < body.n_nodes; ++a)
        {
          gradient += outer_product(node_value(x, a),
                                    node_value(body.averaging_vectors, a));
          sum += body.nodal_masses[a] * node_value(x, a);
        }
      const NodalMoments moments = nodal_moments(body, x);
      EXPECT_LT((moments.gradient - gradient).norm(), 1e-12);
      EXPECT_LT((moments.mean - sum / body.mass).norm(), 1e-13);

      NodalVector both(x);
      both.add(0.3, y);
      const NodalMoments of_both = nodal_moments(body, both),
                         added   = add(moments, 0.3, nodal_moments(body, y));
      EXPECT_LT((of_both.gradient - added.gradient).norm(), 1e-12);
      EXPECT_LT((of_both.mean - added.mean).norm(), 1e-13);

      std::vector<const NodalVector *> fields;
      for (unsigned int n = 1; n <= 5; ++n)
        {
          fields.push_back(n % 2 == 0 ? &y : &x);
          const auto several = nodal_moments(body, fields);
          ASSERT_EQ(several.size(), n);
          EXPECT_LT((several[0].mean - moments.mean).norm(), 1e-13);
          const NodalMoments last = nodal_moments(body, *fields.back());
          EXPECT_LT((several.back().gradient - last.gradient).norm(), 1e-12);
          EXPECT_LT((several.back().mean - last.mean).norm(), 1e-13);
        }
    }
}

TEST_WITH_ALL_INSTRUCTIONS(ReducedStrain, ResidualsAtSeveralTimes)
{
  Random random;
  double error = 0, largest_damping = 0;
  for (const Example &example : examples())
    for (const auto &measure : measures)
      for (unsigned int n = 1; n <= 3; ++n)
        for (const auto &[alpha, beta] :
             {std::pair(0., 0.), {0.01, 0.}, {0., 0.01}, {0.01, 0.01}})
          {
            const TestMotion test(example, n, alpha, beta, random);
            std::vector<NodalVector> residuals(n, NodalVector(test.x.size()));
            std::vector<NodalVector *> targets;
            for (NodalVector &residual : residuals)
              {
                residual = 1e10; // to be overwritten
                targets.push_back(&residual);
              }
            // again in the same memory
            for (unsigned int repetition = 0; repetition < 2; ++repetition)
              ASSERT_TRUE(reduced_strain_residual(
                example.body, measure.first, test.motion, targets));
            for (unsigned int i = 0; i < n; ++i)
              {
                auto [expected, damping] =
                  expected_residual(example, measure.first, test, i);
                const double scale = example.force_scale();
                expected -= residuals[i];
                error = std::max(error, expected.linfty_norm() / scale);
                largest_damping =
                  std::max(largest_damping, damping.linfty_norm() / scale);
              }
          }
  EXPECT_LT(error, 1e-13);
  EXPECT_GT(largest_damping, 0.01); // it is noticeable
  report("largest damping of the motions over the largest force",
         largest_damping);
  report("residuals of motions", error);
}

// Many windows of nodes, and two parts that reach into each other; after a
// small body, whose windows are smaller.
TEST(ReducedStrain, ResidualsOfALongBody)
{
  const ThreadLimit threads;
  Random random;
  const Example example("beam",
                        generate_box(Point<dim>(0, 0, 0),
                                     Point<dim>(1, 0.05, 0.04),
                                     {{470, 1, 1}},
                                     ReferenceCells::Hexahedron));
  ASSERT_GE(example.body.n_nodes, 2 * smallest_range);
  double error = 0;
  for (const double alpha : {0., 0.01})
    {
      const TestMotion test(example, 2, alpha, 0.5 * alpha, random);
      for (const unsigned int n_threads : {1, 2})
        {
          MultithreadInfo::set_thread_limit(n_threads);
          const auto residuals_of = [](const Example &example,
                                       const NodalMotion &motion) {
            std::vector<NodalVector> residuals(
              2, NodalVector(example.body.n_unknowns()));
            EXPECT_TRUE(
              reduced_strain_residual(example.body,
                                      RotationMeasure::polar,
                                      motion,
                                      {&residuals[0], &residuals[1]}));
            return residuals;
          };
          const TestMotion small(examples().front(), 2, 0, 0, random);
          residuals_of(examples().front(), small.motion);
          const auto residuals = residuals_of(example, test.motion);
          for (unsigned int i = 0; i < 2; ++i)
            error = std::max(
              error,
              relative_difference(
                residuals[i],
                expected_residual(example, RotationMeasure::polar, test, i)
                  .first));
        }
    }
  EXPECT_LT(error, 1e-13);
  report("residuals of a long body over the largest force", error);
}

TEST(ReducedStrain, EnergyAgainstIntegralOverElements)
{
  Random random;
  double error = 0, density = 0;
  for (const Example &example : examples())
    for (const auto &measure : measures)
      for (unsigned int n = 0; n < 5; ++n)
        {
          const NodalVector x = deformed(example, random);
          const double exact  = energy_by_elements(example, measure.first, x);
          const double energy = *force_of(example, measure.first, x).energy;
          error               = std::max(error, std::abs(energy / exact - 1));
          EXPECT_NEAR(*reduced_strain_energy(example.body, measure.first, x) /
                        energy,
                      1,
                      1e-13);
          density = std::max(density,
                             energy / (test_material().youngs_modulus *
                                       example.body.volume));
        }
  EXPECT_LT(error, 1e-11);
  EXPECT_GT(density, 1e-3); // the deformations are noticeable
  report("energy against the integral over the elements", error);
  report("largest energy of the random deformations over E V", density);
}

TEST(ReducedStrain, ForceIsTheGradientOfTheEnergy)
{
  Random random;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      {
        double error = 0, error_without_rotation = 1;
        for (unsigned int n = 0; n < 3; ++n)
          {
            const NodalVector x     = deformed(example, random);
            const NodalVector force = force_of(example, measure, x).value;

            const double h = 1e-5 * example.body.length;
            NodalVector gradient(x.size()), moved(x);
            for (unsigned int k = 0; k < x.size(); ++k)
              {
                moved[k]           = x[k] + h;
                const double right = energy_of(example.body, measure, moved);
                moved[k]           = x[k] - h;
                const double left  = energy_of(example.body, measure, moved);
                moved[k]           = x[k];
                gradient[k]        = (right - left) / (2 * h);
              }
            error = std::max(error, relative_difference(force, gradient));

            // R A q alone, without the variation of the rotation
            const Matrix3 R =
              body_rotation(mean_deformation_gradient(example.body, x), measure)
                ->rotation;
            NodalVector q(x.size()), Aq(x.size());
            co_rotated_displacement(example.body, x, R, q);
            example.body.stiffness_matrix.vmult(Aq, q);
            const NodalVector incomplete =
              transformed(Aq, [&](const Vector3 &k) { return R * k; });
            error_without_rotation =
              std::min(error_without_rotation,
                       relative_difference(incomplete, gradient));
          }
        const std::string label = example.name + ", " + name;
        EXPECT_LT(error, 1e-7) << label;
        EXPECT_GT(error_without_rotation, 1e-4) << label;
        report(label + ", force against differences of the energy", error);
        report(label + ", the same without the term P g_a",
               error_without_rotation);
      }
}

TEST(ReducedStrain, RigidMotionsAreFree)
{
  Random random;
  double largest_force = 0, largest_energy = 0;
  for (const Example &example : examples())
    for (const auto &measure : measures)
      for (unsigned int n = 0; n < 20; ++n)
        {
          const Matrix3 Q = random.rotation();
          const Vector3 t = random.vector(10);
          const NodalVector x =
            transformed(example.body.reference_positions,
                        [&](const Vector3 &X) { return t + Q * X; });
          const Force force = force_of(example, measure.first, x);
          largest_force =
            std::max(largest_force,
                     force.value.linfty_norm() / example.force_scale());
          largest_energy =
            std::max(largest_energy,
                     std::abs(*force.energy) /
                       (test_material().youngs_modulus * example.body.volume));
        }
  // round-off of positions ten lengths away, and some ten nodes per length
  EXPECT_LT(largest_force, 1e-12);
  EXPECT_LT(largest_energy, 1e-25);
  report("force of rigid motions over E V / l", largest_force);
  report("energy of rigid motions over E V", largest_energy);
}

TEST(ReducedStrain, IndependentOfTheObserver)
{
  Random random;
  double energy_error = 0, force_error = 0;
  for (const Example &example : examples())
    for (const auto &measure : measures)
      for (unsigned int n = 0; n < 5; ++n)
        {
          const NodalVector x = deformed(example, random);
          const Matrix3 Q     = random.rotation();
          const Vector3 t     = random.vector(1);
          const auto rotate   = [&](const Vector3 &v) { return Q * v; };
          const Force here    = force_of(example, measure.first, x);
          const Force there   = force_of(example,
                                       measure.first,
                                       transformed(x, [&](const Vector3 &v) {
                                         return t + Q * v;
                                       }));
          energy_error =
            std::max(energy_error, std::abs(*there.energy / *here.energy - 1));
          force_error =
            std::max(force_error,
                     relative_difference(there.value,
                                         transformed(here.value, rotate)));
        }
  EXPECT_LT(energy_error, 1e-12);
  EXPECT_LT(force_error, 1e-12);
  report("change of the energy by a superposed motion", energy_error);
  report("change of the force by a superposed motion", force_error);
}

TEST(ReducedStrain, NoResultant)
{
  Random random;
  double force_sum = 0, moment_sum = 0, incomplete = 1;
  for (const Example &example : examples())
    for (const auto &measure : measures)
      for (unsigned int n = 0; n < 5; ++n)
        {
          const NodalVector x     = deformed(example, random);
          const NodalVector force = force_of(example, measure.first, x).value;
          const double scale      = force.l1_norm();
          force_sum  = std::max(force_sum, resultant(force).norm() / scale);
          moment_sum = std::max(moment_sum,
                                moment(force, x, random.vector(5)).norm() /
                                  (scale * example.body.length));

          // R A q has a moment: it is the other term that balances it
          const Matrix3 R =
            body_rotation(mean_deformation_gradient(example.body, x),
                          measure.first)
              ->rotation;
          NodalVector q(x.size()), Aq(x.size());
          co_rotated_displacement(example.body, x, R, q);
          example.body.stiffness_matrix.vmult(Aq, q);
          const NodalVector first =
            transformed(Aq, [&](const Vector3 &k) { return R * k; });
          incomplete = std::min(incomplete,
                                moment(first, x, Vector3()).norm() /
                                  (scale * example.body.length));
        }
  EXPECT_LT(force_sum, 1e-13);
  EXPECT_LT(moment_sum, 1e-13);
  EXPECT_GT(incomplete, 1e-6);
  report("resultant of the force, relative", force_sum);
  report("moment of the force, relative", moment_sum);
  report("moment of the force without the term P g_a", incomplete);
}

TEST(ReducedStrain, SmallDeformationsAreLinear)
{
  Random random;
  for (const Example &example : examples())
    for (const auto &[measure, name] : measures)
      {
        const BodyOperators &body = example.body;
        const Matrix3 Q           = random.rotation();
        const Matrix3 G           = random.matrix(0.3);
        const NodalVector u =
          transformed(body.reference_positions, [&](const Vector3 &X) {
            return G * X + X[0] * X[1] * Vector3({0.2, 0.3, -0.1});
          });
        NodalVector Au(u.size());
        body.stiffness_matrix.vmult(Au, u);
        const NodalVector linear =
          transformed(Au, [&](const Vector3 &k) { return Q * k; });

        std::vector<double> errors;
        for (const double size : {1e-2, 1e-3, 1e-4})
          {
            NodalVector x(body.reference_positions);
            x.add(size, u);
            x = transformed(x, [&](const Vector3 &v) { return Q * v; });
            NodalVector force = force_of(example, measure, x).value;
            force /= size;
            errors.push_back(relative_difference(force, linear));
          }
        // the error of the force itself is one order higher
        for (unsigned int k = 1; k < errors.size(); ++k)
          EXPECT_NEAR(std::log10(errors[k - 1] / errors[k]), 1, 0.05);
        report(example.name + ", " + name +
                 ", order of the error of the linear force",
               1 + std::log10(errors[1] / errors[2]));
      }
}

TEST(ReducedStrain, NothingForInvertedBodies)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Example &example : examples())
    for (const auto &measure : measures)
      {
        const NodalVector &X = example.body.reference_positions;
        for (const double factor : {-1., 0.})
          {
            const NodalVector x = transformed(X, [&](const Vector3 &v) {
              return Vector3({v[0], factor * v[1], v[2]});
            });
            EXPECT_FALSE(force_of(example, measure.first, x).energy);
          }
        NodalVector x(X);
        x[5] = nan;
        EXPECT_FALSE(force_of(example, measure.first, x).energy);
        EXPECT_TRUE(force_of(example, measure.first, X).energy);

        // a motion whose second time has no rotation
        const NodalVector zero(X.size());
        NodalVector back(X);
        back *= -1;
        NodalVector forces[2] = {zero, zero};
        NodalMotion motion;
        motion.position     = &X;
        motion.velocity     = &zero;
        motion.times        = {0, 0};
        motion.increments   = {&zero, &back};
        motion.second_rates = Eigen::MatrixXd::Identity(2, 2);
        motion.moments      = {nodal_moments(example.body, X),
                               nodal_moments(example.body, zero)};
        motion.gravity      = {Vector3(), Vector3()};
        EXPECT_FALSE(reduced_strain_residual(
          example.body, measure.first, motion, {&forces[0], &forces[1]}));
      }
}
