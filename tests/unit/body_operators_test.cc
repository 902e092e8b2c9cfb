// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/numerics/matrix_creator.h>

#include <cmath>
#include <list>

#include <unit/mechanics_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  struct Example
  {
    std::string name;
    BodyDiscretization body;
    BodyOperators operators;

    /** Affine cells: the quadrature of the stiffness is exact. */
    bool is_affine;

    Example(const std::string &name, const MeshData &data, const bool is_affine)
      : name(name)
      , body(discretize(data))
      , operators(assemble_body_operators(body, test_material()))
      , is_affine(is_affine)
    {}
  };

  const Point<dim> lower(0.3, -0.2, 1), upper(1.5, 0.4, 1.5);

  MeshData
  box(const ReferenceCell &cell, const std::array<unsigned int, dim> &n_cells)
  {
    return generate_box(lower, upper, n_cells, cell);
  }

  MeshData
  cylinder(const ReferenceCell &cell, const unsigned int n_cells_across)
  {
    return generate_cylinder(Point<dim>(1, 0, 0.5),
                             Point<dim>(1.5, 1, 1.5),
                             0.4,
                             n_cells_across,
                             2,
                             cell);
  }

  /** Boxes and cylinders of both elements, distorted ones too. */
  const std::list<Example> &
  examples()
  {
    static const std::list<Example> list = []() {
      const ReferenceCell tetrahedron = ReferenceCells::Tetrahedron;
      const ReferenceCell hexahedron  = ReferenceCells::Hexahedron;
      const MeshData tetrahedra       = box(tetrahedron, {{2, 1, 1}});
      const MeshData hexahedra        = box(hexahedron, {{3, 2, 2}});
      const MeshData short_cylinder   = generate_cylinder(
        Point<dim>(1, 0, 0.5), Point<dim>(1, 2, 1), 0.4, 3, 1, tetrahedron);

      std::list<Example> all;
      all.emplace_back("box of hexahedra", hexahedra, true);
      all.emplace_back("box of tetrahedra", tetrahedra, true);
      all.emplace_back("cylinder of hexahedra", cylinder(hexahedron, 3), false);
      all.emplace_back("cylinder of tetrahedra", short_cylinder, true);
      all.emplace_back("distorted hexahedra",
                       distorted(hexahedra, 0.05),
                       false);
      all.emplace_back("distorted tetrahedra",
                       distorted(tetrahedra, 0.03),
                       true);
      return all;
    }();
    return list;
  }

  SymmetricTensor<4, dim>
  elasticity(const Material &material)
  {
    const double E  = material.youngs_modulus;
    const double nu = material.poissons_ratio;
    return E / (1 + nu) *
           (identity_tensor<dim>() +
            nu / (1 - 2 * nu) *
              outer_product(unit_symmetric_tensor<dim>(),
                            unit_symmetric_tensor<dim>()));
  }

  /** Stiffness from the symmetric gradients of the vector-valued element. */
  Eigen::MatrixXd
  reassemble_stiffness(const BodyDiscretization &body,
                       const Quadrature<dim> &quadrature)
  {
    const SymmetricTensor<4, dim> C = elasticity(test_material());
    FEValues<dim> values(body.mesh().mapping(),
                         body.finite_element(),
                         quadrature,
                         update_gradients | update_JxW_values);
    const FEValuesExtractors::Vector u(0);
    const unsigned int n = values.dofs_per_cell;
    std::vector<types::global_dof_index> dofs(n);
    Eigen::MatrixXd K =
      Eigen::MatrixXd::Zero(dim * body.n_nodes(), dim * body.n_nodes());
    for (const auto &cell : body.dof_handler().active_cell_iterators())
      {
        values.reinit(cell);
        cell->get_dof_indices(dofs);
        for (const unsigned int q : values.quadrature_point_indices())
          for (unsigned int i = 0; i < n; ++i)
            {
              const SymmetricTensor<2, dim> stress =
                C * values[u].symmetric_gradient(i, q);
              for (unsigned int j = 0; j < n; ++j)
                K(dofs[i], dofs[j]) +=
                  stress * values[u].symmetric_gradient(j, q) * values.JxW(q);
            }
      }
    return K;
  }

  Eigen::MatrixXd
  reassemble_mass(const BodyDiscretization &body,
                  const Quadrature<dim> &quadrature)
  {
    DynamicSparsityPattern pattern(body.dof_handler().n_dofs());
    DoFTools::make_sparsity_pattern(body.dof_handler(), pattern);
    SparsityPattern sparsity;
    sparsity.copy_from(pattern);
    SparseMatrix<double> mass(sparsity);
    const Functions::ConstantFunction<dim> density(test_material().density,
                                                   dim);
    MatrixCreator::create_mass_matrix(
      body.mesh().mapping(), body.dof_handler(), quadrature, mass, &density);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(mass.m(), mass.n());
    for (const auto &entry : mass)
      result(entry.row(), entry.column()) = entry.value();
    return result;
  }

  /** Another rule than that of the library, and exact to a higher degree. */
  Quadrature<dim>
  fine_quadrature(const BodyMesh &mesh)
  {
    return mesh.is_simplex() ? Quadrature<dim>(QWitherdenVincentSimplex<dim>(4))
                             : Quadrature<dim>(QGauss<dim>(5));
  }

  NodalVector
  affine(const NodalVector &X, const Matrix3 &G, const Vector3 &t)
  {
    return transformed(X, [&](const Vector3 &x) { return t + G * x; });
  }
} // namespace

TEST(BodyOperators, MassAndStiffnessAgainstReassembly)
{
  for (const Example &example : examples())
    {
      const BodyOperators &body       = example.operators;
      const Eigen::MatrixXd mass      = to_dense(body.mass_matrix);
      const Eigen::MatrixXd stiffness = to_dense(body.stiffness_matrix);

      EXPECT_LT(relative_difference(mass, mass.transpose()), 1e-14);
      EXPECT_LT(relative_difference(stiffness, stiffness.transpose()), 1e-13);

      const auto errors = [&](const Quadrature<dim> &rule) {
        return std::make_pair(
          relative_difference(mass, reassemble_mass(example.body, rule)),
          relative_difference(stiffness,
                              reassemble_stiffness(example.body, rule)));
      };
      const auto [mass_error, stiffness_error] =
        errors(fine_quadrature(example.body.mesh()));
      report(example.name + ", mass", mass_error);
      report(example.name + ", stiffness", stiffness_error);
      // three Gauss points per direction: inexact for the mass, whose degree is
      // six in each direction, and for the rational functions of the stiffness
      EXPECT_LT(mass_error, example.is_affine ? 1e-13 : 2e-3) << example.name;
      EXPECT_LT(stiffness_error, example.is_affine ? 1e-12 : 5e-3)
        << example.name;
      if (!example.is_affine)
        {
          const auto same_rule = errors(QGauss<dim>(3));
          EXPECT_LT(same_rule.first, 1e-13) << example.name;
          EXPECT_LT(same_rule.second, 1e-12) << example.name;
        }
    }
}

TEST(BodyOperators, ProductsAgainstDenseMatrices)
{
  Random random;
  for (const Example &example : examples())
    {
      const BodyOperators &body = example.operators;
      const NodalVector x       = random.nodal_vector(body.n_unknowns(), 1);
      const Eigen::Map<const Eigen::VectorXd> dense_x(x.begin(), x.size());
      // old contents must not matter
      NodalVector y = random.nodal_vector(body.n_unknowns(), 1e10);
      const Eigen::Map<const Eigen::VectorXd> dense_y(y.begin(), y.size());
      body.mass_matrix.vmult(y, x);
      EXPECT_LT(relative_difference(dense_y,
                                    to_dense(body.mass_matrix) * dense_x),
                1e-14);
      body.stiffness_matrix.vmult(y, x);
      EXPECT_LT(relative_difference(dense_y,
                                    to_dense(body.stiffness_matrix) * dense_x),
                1e-14);
    }
}

TEST(BodyOperators, Definiteness)
{
  for (const Example &example : examples())
    {
      using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
      const Solver stiffness(to_dense(example.operators.stiffness_matrix),
                             Eigen::EigenvaluesOnly);
      const Eigen::VectorXd &values = stiffness.eigenvalues();
      const double largest          = values(values.size() - 1);
      // exactly the six rigid motions cost nothing
      EXPECT_LT(values.head(6).cwiseAbs().maxCoeff(), 1e-13 * largest)
        << example.name;
      EXPECT_GT(values(6), 1e-5 * largest) << example.name;

      const Solver mass(to_dense(example.operators.mass_matrix),
                        Eigen::EigenvaluesOnly);
      EXPECT_GT(mass.eigenvalues()(0), 0) << example.name;
    }
}

TEST(BodyOperators, StiffnessOfAffineFields)
{
  Random random;
  for (const Example &example : examples())
    {
      const BodyOperators &body = example.operators;
      const NodalVector &X      = body.reference_positions;
      const double stiffness =
        to_dense(body.stiffness_matrix).cwiseAbs().rowwise().sum().maxCoeff();
      NodalVector force(X.size());
      double rigid = 0, energy_error = 0;
      for (unsigned int n = 0; n < 10; ++n)
        {
          const Matrix3 spin  = cross_product_matrix(random.vector(1));
          const NodalVector u = affine(X, spin, random.vector(1));
          body.stiffness_matrix.vmult(force, u);
          rigid = std::max(rigid,
                           force.linfty_norm() / (stiffness * u.linfty_norm()));

          const Matrix3 G      = random.matrix(1);
          const NodalVector u2 = affine(X, G, random.vector(1));
          body.stiffness_matrix.vmult(force, u2);
          const SymmetricTensor<2, dim> strain = symmetrize(G);
          const double energy =
            body.volume / 2 * strain * (elasticity(test_material()) * strain);
          energy_error =
            std::max(energy_error, std::abs(u2 * force / 2 / energy - 1));
        }
      EXPECT_LT(rigid, 1e-14) << example.name;
      EXPECT_LT(energy_error, 1e-11) << example.name;
      report(example.name + ", force of linear rigid motions", rigid);
      report(example.name + ", energy of affine fields", energy_error);
    }
}

TEST(BodyOperators, AveragingVectors)
{
  for (const Example &example : examples())
    {
      const BodyOperators &body = example.operators;
      Vector3 sum;
      Matrix3 gradient;
      for (unsigned int a = 0; a < body.n_nodes; ++a)
        {
          const Vector3 g = node_value(body.averaging_vectors, a);
          sum += g;
          gradient += outer_product(node_value(body.reference_positions, a), g);
        }
      EXPECT_LT(sum.norm() * body.length, 1e-12) << example.name;
      EXPECT_LT((gradient - identity_matrix()).norm(), 1e-12) << example.name;

      // Gauss: V g_a = int phi_a n dA over the boundary
      NodalVector boundary(body.n_unknowns());
      FEFaceValues<dim> values(example.body.mesh().mapping(),
                               example.body.finite_element(),
                               example.body.mesh().face_quadrature(6),
                               update_values | update_normal_vectors |
                                 update_JxW_values);
      const FEValuesExtractors::Vector u(0);
      std::vector<types::global_dof_index> dofs(values.dofs_per_cell);
      double enclosed = 0;
      for (const auto &cell :
           example.body.dof_handler().active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            {
              values.reinit(cell, f);
              cell->get_dof_indices(dofs);
              for (const unsigned int q : values.quadrature_point_indices())
                for (unsigned int i = 0; i < dofs.size(); ++i)
                  boundary[dofs[i]] += values[u].value(i, q) *
                                       values.normal_vector(q) * values.JxW(q);
            }
      for (unsigned int a = 0; a < body.n_nodes; ++a)
        enclosed +=
          node_value(boundary, a) * node_value(body.reference_positions, a) / 3;
      boundary /= enclosed;
      const double error =
        relative_difference(body.averaging_vectors, boundary);
      EXPECT_NEAR(body.volume / enclosed, 1, 1e-12) << example.name;
      EXPECT_LT(error, 1e-12) << example.name;
      report(example.name + ", averaging vectors against Gauss' theorem",
             error);
    }
}

TEST(BodyOperators, NumberingOfUnknowns)
{
  Random random;
  for (const Example &example : examples())
    {
      const BodyDiscretization &body = example.body;
      std::vector<Point<dim>> points(body.dof_handler().n_dofs());
      DoFTools::map_dofs_to_support_points(body.mesh().mapping(),
                                           body.dof_handler(),
                                           points);
      std::vector<types::global_dof_index> dofs(
        body.finite_element().n_dofs_per_cell());
      for (const auto &cell : body.dof_handler().active_cell_iterators())
        {
          cell->get_dof_indices(dofs);
          for (unsigned int i = 0; i < dofs.size(); ++i)
            ASSERT_EQ(dofs[i] % dim,
                      body.finite_element().system_to_component_index(i).first);
        }
      for (unsigned int k = 0; k < points.size(); ++k)
        ASSERT_LT(points[k].distance(Point<dim>(
                    node_value(body.reference_positions(), k / dim))),
                  1e-14);

      // a field of deal.II with these unknowns is the function it comes from
      const Matrix3 F     = random.matrix(1);
      const Vector3 t     = random.vector(1);
      const NodalVector x = affine(body.reference_positions(), F, t);
      FEValues<dim> values(body.mesh().mapping(),
                           body.finite_element(),
                           fine_quadrature(body.mesh()),
                           update_values | update_gradients |
                             update_quadrature_points);
      std::vector<Vector3> interpolated(values.n_quadrature_points);
      std::vector<Matrix3> gradients(values.n_quadrature_points);
      const FEValuesExtractors::Vector u(0);
      for (const auto &cell : body.dof_handler().active_cell_iterators())
        {
          values.reinit(cell);
          values[u].get_function_values(x, interpolated);
          values[u].get_function_gradients(x, gradients);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              ASSERT_LT((interpolated[q] - t -
                         F * Vector3(values.quadrature_point(q)))
                          .norm(),
                        1e-13);
              ASSERT_LT((gradients[q] - F).norm(), 1e-11);
            }
        }
    }
}

TEST(BodyOperators, RigidBodyOfBoxes)
{
  for (const Example &example : examples())
    {
      const BodyOperators &body = example.operators;
      const Eigen::VectorXd masses =
        reassemble_mass(example.body, fine_quadrature(example.body.mesh()))
          .rowwise()
          .sum();
      for (unsigned int k = 0; k < body.n_unknowns(); ++k)
        ASSERT_NEAR(masses(k), body.nodal_masses[k / dim], 1e-14 * body.mass);
      EXPECT_NEAR(body.mass / (1200 * body.volume), 1, 1e-12);

      if (example.name.substr(0, 3) != "box")
        continue;
      const Vector3 edges = upper - lower;
      const double volume = edges[0] * edges[1] * edges[2];
      EXPECT_NEAR(body.volume, volume, 1e-14);
      EXPECT_NEAR(body.mass, 1200 * volume, 1e-11);
      EXPECT_LT((body.centre - 0.5 * Vector3(lower + Vector3(upper))).norm(),
                1e-14);
      EXPECT_NEAR(body.length, edges.norm(), 1e-14);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          EXPECT_NEAR(body.inertia[i][j],
                      i != j ? 0.
                             : body.mass / 12 *
                                 (edges.norm_square() - edges[i] * edges[i]),
                      1e-12 * body.mass);
    }
}

TEST(BodyOperators, RigidBodyOfCylindersConverges)
{
  const double radius = 0.4, length = 1.5;
  const Vector3 axis({1. / 3, 2. / 3, 2. / 3});
  const Vector3 centre({1.25, 0.5, 1});
  for (const ReferenceCell cell :
       {ReferenceCells::Hexahedron, ReferenceCells::Tetrahedron})
    {
      std::vector<double> volume_errors, inertia_errors;
      for (const unsigned int n : {4, 8, 16})
        {
          if (n == 16 && cell == ReferenceCells::Tetrahedron)
            continue; // the same polygon, 24 times the cells
          const BodyOperators body =
            assemble_body_operators(discretize(cylinder(cell, n)),
                                    test_material());
          const double exact = numbers::PI * radius * radius * length;
          const double mass  = 1200 * exact;
          const double along = mass * radius * radius / 2;
          const double across =
            mass / 12 * (3 * radius * radius + length * length);
          const Matrix3 inertia = across * identity_matrix() +
                                  (along - across) * outer_product(axis, axis);
          EXPECT_LT((body.centre - centre).norm(), 1e-13);
          volume_errors.push_back(1 - body.volume / exact);
          inertia_errors.push_back((body.inertia - inertia).norm() /
                                   inertia.norm());
        }
      for (unsigned int k = 1; k < volume_errors.size(); ++k)
        for (const auto &errors : {volume_errors, inertia_errors})
          {
            const double order = std::log2(errors[k - 1] / errors[k]);
            EXPECT_NEAR(order, 2, 0.15);
            report("cylinder, order of convergence", order);
          }
      EXPECT_LT(volume_errors.back(), 0.03);
    }
}
