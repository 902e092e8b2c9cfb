// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/mechanics/stress.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <unit/output_test.h>

using namespace ACF;
using namespace OutputTest;

namespace
{
  constexpr double youngs_modulus = 2e11;

  Symmetric3
  dyad(const double c, const Vector3 &v)
  {
    return c * symmetrize(outer_product(v, v));
  }

  void
  expect_near(const Symmetric3 &value,
              const Symmetric3 &expected,
              const double tolerance)
  {
    EXPECT_LT((value - expected).norm(), tolerance)
      << value << " instead of " << expected;
  }
} // namespace



TEST(VonMisesStress, OfSimpleStates)
{
  Symmetric3 stress;
  EXPECT_EQ(von_mises_stress(stress), 0);
  stress[0][0] = -3;
  EXPECT_NEAR(von_mises_stress(stress), 3, 1e-14);
  stress[1][1] = stress[2][2] = -3;
  EXPECT_NEAR(von_mises_stress(stress), 0, 1e-14);
  stress[0][1] = 2;
  EXPECT_NEAR(von_mises_stress(stress), 2 * std::sqrt(3.), 1e-14);
}



TEST(Stress, UniaxialStretch)
{
  constexpr double strain = 1e-3;
  const Matrix3 rotation  = rotation_matrix(vector(-2, 1, 1.5));
  const Vector3 axis      = rotation * vector(1, 0, 0);
  for (BodyParameters parameters : all_shapes())
    for (const RotationMeasure measure :
         {RotationMeasure::polar, RotationMeasure::three_points})
      {
        parameters.rotation_measure  = measure;
        const MultibodySystem system = make_system({parameters});
        const Body &body             = system.bodies()[0];
        const StressEvaluation evaluation(
          body,
          nodal_values(body.operators().reference_positions,
                       [&](const Vector3 &X) {
                         return rotation *
                                vector((1 + strain) * X[0] + 5, X[1], X[2]);
                       }),
          0);
        EXPECT_LT((evaluation.rotation() - rotation).norm(), 1e-12);
        const Symmetric3 expected = dyad(youngs_modulus * strain, axis);
        const double tolerance    = 1e-9 * youngs_modulus * strain;
        std::vector<double> largest;
        const auto nodal_values = evaluation.nodal_values(&largest);
        ASSERT_EQ(nodal_values.size(), body.discretization().n_nodes());
        for (const StressAndStrain &value : nodal_values)
          {
            expect_near(value.stress, expected, tolerance);
            expect_near(value.strain, dyad(strain, axis), 1e-9 * strain);
          }
        const auto means = evaluation.cell_means();
        const unsigned int n_cells =
          body.discretization().mesh().triangulation().n_active_cells();
        ASSERT_EQ(means.size(), n_cells);
        ASSERT_EQ(largest.size(), n_cells);
        for (unsigned int cell = 0; cell < n_cells; ++cell)
          {
            expect_near(means[cell], expected, tolerance);
            EXPECT_NEAR(largest[cell], youngs_modulus * strain, tolerance);
          }
      }
}



// E = ((1 + e)^2 - 1) / 2, and Cauchy's stress (1 + e)^2 / (1 + e) times the
// second stress of Piola and Kirchhoff, as nu = 0.
TEST(Stress, LargeStretchWithTheStrainOfGreenAndLagrange)
{
  constexpr double stretch     = 1.3;
  BodyParameters parameters    = box("tetrahedron");
  parameters.strain_measure    = StrainMeasure::green_lagrange;
  const MultibodySystem system = make_system({parameters});
  const Body &body             = system.bodies()[0];
  const Matrix3 rotation       = rotation_matrix(vector(1, 0.3, -1));
  const Vector3 axis           = rotation * vector(0, 1, 0);
  const StressEvaluation evaluation(
    body,
    nodal_values(body.operators().reference_positions,
                 [&](const Vector3 &X) {
                   return rotation * vector(X[0], stretch * X[1], X[2]);
                 }),
    0);
  const double strain = (stretch * stretch - 1) / 2;
  for (const StressAndStrain &value : evaluation.nodal_values())
    {
      expect_near(value.strain, dyad(strain, axis), 1e-11);
      expect_near(value.stress,
                  dyad(youngs_modulus * strain * stretch, axis),
                  1e-11 * youngs_modulus);
    }
}



TEST(Stress, VanishesForRotations)
{
  const MultibodySystem system = make_system(all_shapes());
  const Matrix3 rotation       = rotation_matrix(vector(1, -2, 0.5));
  for (const Body &body : system.bodies())
    {
      const StressEvaluation evaluation(body,
                                        nodal_values(body.initial_positions(),
                                                     [&](const Vector3 &x) {
                                                       return rotation * x +
                                                              vector(1, 2, 3);
                                                     }),
                                        0);
      // rounding: strains of 1e-13, from coordinates of 40 m
      for (const StressAndStrain &value : evaluation.nodal_values())
        EXPECT_LT(value.stress.norm(), youngs_modulus * 1e-12);
    }
}



// u = k (x y, -x^2 / 2, 0), of which the mean gradient vanishes in a box around
// the origin: the only strain is k y along x. A quadratic displacement is
// exact in all elements, so that values of cells, nodes and points agree.
TEST(Stress, PureBendingWithLateralContraction)
{
  constexpr double curvature = 1e-3;
  constexpr double nu        = 0.3;
  const double mu            = youngs_modulus / (2 * (1 + nu));
  const double lambda        = 2 * mu * nu / (1 - 2 * nu);
  for (const std::string element : {"hexahedron", "tetrahedron"})
    {
      BodyParameters parameters          = box(element);
      parameters.mesh.box_from           = {-2, -1, -0.5};
      parameters.mesh.box_to             = {2, 1, 0.5};
      parameters.material.poissons_ratio = nu;
      const MultibodySystem system       = make_system({parameters});
      const Body &body                   = system.bodies()[0];
      const NodalVector &X               = body.operators().reference_positions;
      const Matrix3 rotation             = rotation_matrix(vector(0.3, -2, 1));
      const StressEvaluation evaluation(
        body,
        nodal_values(X,
                     [&](const Vector3 &p) {
                       return rotation *
                              (p + curvature *
                                     vector(p[0] * p[1], -p[0] * p[0] / 2, 0));
                     }),
        0);
      const auto expected = [&](const double y) {
        const double strain = curvature * y;
        return lambda * strain * unit_symmetric_tensor<dim>() +
               dyad(2 * mu * strain, rotation * vector(1, 0, 0));
      };
      const double tolerance = 1e-9 * youngs_modulus * curvature;
      std::vector<double> largest_in_cells;
      const auto nodal_values = evaluation.nodal_values(&largest_in_cells);
      for (unsigned int a = 0; a < nodal_values.size(); ++a)
        {
          const double y = X[dim * a + 1];
          expect_near(nodal_values[a].stress, expected(y), tolerance);
          EXPECT_NEAR(von_mises_stress(nodal_values[a].stress),
                      2 * mu * curvature * std::abs(y),
                      tolerance);
        }

      const auto means = evaluation.cell_means();
      for (const auto &cell :
           body.discretization().mesh().triangulation().active_cell_iterators())
        {
          const unsigned int c = cell->active_cell_index();
          expect_near(means[c], expected(cell->center()[1]), tolerance);
          double largest = 0;
          for (const unsigned int v : cell->vertex_indices())
            largest = std::max(largest, std::abs(cell->vertex(v)[1]));
          EXPECT_NEAR(largest_in_cells[c],
                      2 * mu * curvature * largest,
                      tolerance);
        }

      // in a cell, on a face and at a node of several cells
      for (const Point<dim> &point : {Point<dim>(0.123, 0.456, 0.01),
                                      Point<dim>(0.2, 0, 0.1),
                                      Point<dim>(2. / 3, 0, 0)})
        expect_near(PointStress(body, point)(evaluation).stress,
                    expected(point[1]),
                    tolerance);
    }
}



// A displacement of order four, which the elements interpolate: its slope jumps
// between cells, and where they meet, the mean is taken.
TEST(Stress, IsAveragedWhereCellsMeet)
{
  BodyParameters parameters    = box("hexahedron");
  parameters.mesh.cells        = {2, 1, 1};
  parameters.mesh.box_from     = {-1, -0.5, -0.5};
  parameters.mesh.box_to       = {1, 0.5, 0.5};
  const MultibodySystem system = make_system({parameters});
  const Body &body             = system.bodies()[0];
  constexpr double c           = 1e-3;
  const StressEvaluation evaluation(
    body,
    nodal_values(body.operators().reference_positions,
                 [&](const Vector3 &X) {
                   return X + vector(c * (std::pow(X[0], 4) + X[0]), 0, 0);
                 }),
    0);
  // parabolas through -1, -1/2, 0 and 0, 1/2, 1
  const auto slope = [](const double x) {
    return c * (3.5 * x + (x < 0 ? 1.75 : 0.25));
  };
  const auto strain_at = [&](const double x) {
    return PointStress(body, Point<dim>(x, 0.1, 0.2))(evaluation).strain[0][0];
  };
  for (const double x : {-0.75, -0.25, 0.3, 0.9})
    EXPECT_NEAR(strain_at(x), slope(x), 1e-12);
  EXPECT_NEAR(strain_at(0), c, 1e-12);
  std::vector<double> largest;
  const auto nodal_values = evaluation.nodal_values(&largest);
  for (unsigned int a = 0; a < nodal_values.size(); ++a)
    if (std::abs(body.operators().reference_positions[dim * a]) < 1e-12)
      {
        EXPECT_NEAR(nodal_values[a].strain[0][0], c, 1e-12);
      }

  ASSERT_EQ(largest.size(), 2U);
  std::sort(largest.begin(), largest.end());
  const double tolerance = 1e-6 * c * youngs_modulus;
  EXPECT_NEAR(largest[0], 1.75 * c * youngs_modulus, tolerance);
  EXPECT_NEAR(largest[1], 3.75 * c * youngs_modulus, tolerance);
}



TEST(Stress, NeedsARotation)
{
  const MultibodySystem system = make_system({box("hexahedron")});
  NodalVector positions        = system.initial_state().positions[0];
  // a mirrored body
  for (unsigned int i = 0; i < positions.size(); i += dim)
    positions[i] *= -1;
  EXPECT_THROW(StressEvaluation(system.bodies()[0], positions, 1),
               SimulationError);
}



TEST(Stress, PointMustBeInTheBody)
{
  const MultibodySystem system = make_system({box("tetrahedron")});
  EXPECT_THROW(PointStress(system.bodies()[0], Point<dim>(0, 0.6, 0)),
               SimulationError);
}
