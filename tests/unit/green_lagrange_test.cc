// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/mechanics/green_lagrange.h>

#include <cmath>

#include <unit/reduced_strain_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** Derivative of a vector in a direction, by differences of fourth order. */
  template <typename Function>
  auto
  differences(const Function &function,
              const NodalVector &x,
              const NodalVector &direction,
              const double h)
  {
    const auto at = [&](const double size) {
      NodalVector y(x);
      y.add(size, direction);
      return function(y);
    };
    auto derivative = at(h);
    derivative -= at(-h);
    derivative *= 8.;
    derivative -= at(2 * h);
    derivative += at(-2 * h);
    derivative *= 1 / (12 * h);
    return derivative;
  }

  NodalVector
  force_at(const GreenLagrangeOperator &law, const NodalVector &x)
  {
    NodalVector force(x.size());
    EXPECT_TRUE(law.force(x, force));
    return force;
  }

  NodalVector
  apply_tangent(const GreenLagrangeOperator &law,
                const NodalVector &x,
                const NodalVector &direction)
  {
    NodalVector result(x.size());
    law.apply_tangent(x, direction, result);
    return result;
  }
} // namespace

TEST(GreenLagrange, HomogeneousDeformation)
{
  Random random;
  const Material material = test_material();
  for (const Example &example : examples())
    {
      const GreenLagrangeOperator law(example.discretization, material);
      const Matrix3 F =
        random.rotation() * (identity_matrix() + random.matrix(0.3));
      const Vector3 shift = random.vector(10);
      const NodalVector x =
        transformed(example.body.reference_positions,
                    [&](const Vector3 &X) { return shift + F * X; });
      const SymmetricTensor<2, dim> E =
        0.5 * (symmetrize(transpose(F) * F) - unit_symmetric_tensor<dim>());
      const double density =
        0.5 * material.lambda() * trace(E) * trace(E) + material.mu() * (E * E);
      NodalVector force(x.size());
      const double energy = law.force(x, force).value();
      EXPECT_NEAR(energy / (density * example.body.volume), 1, 1e-12);

      // the work of a homogeneous change is that of the stress on it
      const Matrix3 S = material.lambda() * trace(E) * identity_matrix() +
                        2 * material.mu() * Matrix3(E);
      const Matrix3 change = random.matrix(1);
      const NodalVector delta =
        transformed(example.body.reference_positions,
                    [&](const Vector3 &X) { return change * X; });
      EXPECT_NEAR(force * delta /
                    (scalar_product(F * S, change) * example.body.volume),
                  1,
                  1e-11);
      EXPECT_LT(resultant(force).norm() / force.linfty_norm(), 1e-12);
      EXPECT_LT(moment(force, x, shift).norm() /
                  (force.linfty_norm() * example.body.length),
                1e-12);
    }
}

TEST(GreenLagrange, RigidMotionsAreFree)
{
  Random random;
  for (const Example &example : examples())
    {
      const GreenLagrangeOperator law(example.discretization, test_material());
      const Matrix3 R     = random.rotation();
      const Vector3 shift = random.vector(3);
      const NodalVector x =
        transformed(example.body.reference_positions,
                    [&](const Vector3 &X) { return shift + R * X; });
      const double size =
        force_at(law, x).linfty_norm() / example.force_scale();
      EXPECT_LT(size, 1e-13);
      report(example.name + ", force of a rigid motion", size);
    }
}

TEST(GreenLagrange, ForceIsTheGradientOfTheEnergy)
{
  Random random;
  for (const Example &example : examples())
    {
      const GreenLagrangeOperator law(example.discretization, test_material());
      const NodalVector x = deformed(example, random);
      const NodalVector direction =
        random.nodal_vector(x.size(), example.body.length);
      NodalVector scratch(x.size());
      const double work = differences(
        [&](const NodalVector &y) { return law.force(y, scratch).value(); },
        x,
        direction,
        1e-4);
      const double error = std::abs(force_at(law, x) * direction / work - 1);
      EXPECT_LT(error, 1e-9);
      report(example.name + ", force against differences of the energy", error);
    }
}

TEST(GreenLagrange, TangentIsTheGradientOfTheForce)
{
  Random random;
  for (const Example &example : examples())
    {
      const GreenLagrangeOperator law(example.discretization, test_material());
      const NodalVector x = deformed(example, random);
      const NodalVector direction =
        random.nodal_vector(x.size(), example.body.length);
      const NodalVector product = apply_tangent(law, x, direction);
      const double error        = relative_difference(
        product,
        differences([&](const NodalVector &y) { return force_at(law, y); },
                    x,
                    direction,
                    1e-4));
      EXPECT_LT(error, 1e-9);
      report(example.name + ", tangent against differences of the force",
             error);

      // and the matrix in frames of the nodes is the same map
      std::vector<Matrix3> rotations;
      for (unsigned int a = 0; a < example.body.n_nodes; ++a)
        rotations.push_back(random.rotation());
      const NodeRotations frames(rotations);
      BlockNodeMatrix matrix(example.body.stiffness_matrix);
      matrix = 0.;
      law.add_tangent(x, frames, matrix);
      NodalVector local(x.size()), result(x.size());
      frames.to_body(direction, example.body.n_nodes, local);
      matrix.vmult(result, local);
      frames.to_world(result, example.body.n_nodes, result);
      EXPECT_LT(relative_difference(result, product), 1e-12);
    }
}

TEST(GreenLagrange, TangentAtRestIsTheStiffness)
{
  // on straight hexahedra 27 points integrate the stiffness exactly
  Random random;
  for (const auto &cells :
       {ReferenceCells::Hexahedron, ReferenceCells::Tetrahedron})
    {
      const Example example("box",
                            generate_box(Point<dim>(0, 0, 0),
                                         Point<dim>(1, 0.3, 0.2),
                                         {{3, 1, 1}},
                                         cells));
      const GreenLagrangeOperator law(example.discretization, test_material());
      const Matrix3 R = random.rotation();
      const NodalVector x =
        transformed(example.body.reference_positions,
                    [&](const Vector3 &X) { return R * X; });
      const NodalVector direction = random.nodal_vector(x.size(), 1);
      NodalVector product(x.size());
      example.body.stiffness_matrix.vmult(product, direction);
      const double error = relative_difference(
        apply_tangent(law,
                      x,
                      transformed(direction,
                                  [&](const Vector3 &v) { return R * v; })),
        transformed(product, [&](const Vector3 &k) { return R * k; }));
      EXPECT_LT(error, 1e-11);
    }
}

TEST(GreenLagrange, CellsThatAreTurnedInsideOutHaveNoForce)
{
  for (const Example &example : examples())
    {
      const GreenLagrangeOperator law(example.discretization, test_material());
      NodalVector x(example.body.reference_positions), force(x.size());
      EXPECT_TRUE(law.force(x, force));
      for (unsigned int k = 0; k < x.size(); k += dim)
        x[k] = -x[k];
      EXPECT_FALSE(law.force(x, force));
    }
}

TEST(GreenLagrange, ThreadsChangeNothing)
{
  Random random;
  const Example example("box",
                        generate_box(Point<dim>(0, 0, 0),
                                     Point<dim>(1, 0.3, 0.2),
                                     {{8, 4, 3}},
                                     ReferenceCells::Tetrahedron));
  const GreenLagrangeOperator law(example.discretization, test_material());
  const NodalVector x = deformed(example, random);
  const ThreadLimit threads;
  MultithreadInfo::set_thread_limit(1);
  const NodalVector one = force_at(law, x);
  MultithreadInfo::set_thread_limit(2);
  const NodalVector two = force_at(law, x);
  EXPECT_EQ(one, two);
}

// Bodies that share an operator: a thread that waits for its part of one call
// may begin another one.
TEST(GreenLagrange, CallsAtTheSameTimeDoNotMeet)
{
  Random random;
  const Example example("box",
                        generate_box(Point<dim>(0, 0, 0),
                                     Point<dim>(1, 0.3, 0.2),
                                     {{8, 4, 3}},
                                     ReferenceCells::Tetrahedron));
  const GreenLagrangeOperator law(example.discretization, test_material());
  constexpr unsigned int n_calls = 40;
  std::vector<NodalVector> positions, alone, together;
  for (unsigned int k = 0; k < n_calls; ++k)
    {
      positions.push_back(deformed(example, random));
      alone.push_back(force_at(law, positions.back()));
      together.emplace_back(positions.back().size());
    }
  const ThreadLimit threads;
  MultithreadInfo::set_thread_limit(2);
  run_tasks(n_calls, [&](const unsigned int k) {
    law.force(positions[k], together[k]);
  });
  for (unsigned int k = 0; k < n_calls; ++k)
    EXPECT_EQ(alone[k], together[k]) << "call " << k;
}
