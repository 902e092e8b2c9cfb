// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/mechanics/functionals.h>

#include <cmath>
#include <tuple>

#include <unit/mechanics_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const std::string tetrahedra = "set Element = tetrahedron\n";
  const std::string hexahedra  = "set Element = hexahedron\n";

  const std::string box =
    "set Mesh = box\n set Box from = -1, -0.5, 0\n"
    "set Box to = 1, 0.5, 3\n set Cells = 2, 1, 2\n";

  std::string
  cylinder(const unsigned int n_cells_across)
  {
    return "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
           "set Cylinder to = 0, 0, 1.2\n set Cylinder radius = 0.5\n"
           "set Cells = " +
           std::to_string(n_cells_across) + ", 2\n";
  }

  BodyDiscretization
  discretization_of(const std::string &entries)
  {
    return BodyDiscretization(mesh_of(entries));
  }

  std::set<types::boundary_id>
  surface(const BodyDiscretization &body, const std::string &name)
  {
    return body.mesh().surface(name, "", "");
  }

  Vector3
  unit(const Vector3 &v)
  {
    return v / v.norm();
  }
} // namespace

TEST(Functionals, RectangleAndDisc)
{
  for (const std::string &element : {tetrahedra, hexahedra})
    {
      const BodyDiscretization body = discretization_of(box + element);
      const SurfaceGeometry face =
        surface_geometry(body, surface(body, "x max"));
      EXPECT_NEAR(face.area, 3, 1e-13);
      EXPECT_LT((face.centroid - Vector3({1, 0, 1.5})).norm(), 1e-14);
      Matrix3 J;
      J[1][1] = 1. / 12;
      J[2][2] = 9. / 12;
      EXPECT_LT((face.second_moment - J).norm(), 1e-14);
      EXPECT_NEAR(face.extent(Vector3({0, 0.6, 0.8})),
                  std::sqrt(0.36 / 12 + 0.64 * 0.75),
                  1e-14);
      EXPECT_NEAR(face.extent(Vector3({1, 0, 0})), 0, 1e-7);
      EXPECT_TRUE(face.resolves(Vector3({0, 0.6, 0.8})));
      EXPECT_FALSE(face.resolves(Vector3({1, 0, 0})));
      EXPECT_FALSE(face.resolves(unit(Vector3({0.01, 1, 0}))));
      EXPECT_LT((face.solve_second_moment(Vector3({5, 1, 9})) -
                 Vector3({0, 12, 12}))
                  .norm(),
                1e-11);
    }

  // area and J of discs and of the lateral surface converge with order 2
  const double radius = 0.5, length = 1.2, pi = numbers::PI;
  for (const std::string name : {"start", "side"})
    {
      std::vector<double> area_errors, moment_errors;
      for (const unsigned int n : {4, 8})
        {
          const BodyDiscretization body =
            discretization_of(cylinder(n) + hexahedra);
          const SurfaceGeometry geometry =
            surface_geometry(body, surface(body, name));
          const bool side = (name == "side");
          const double area =
            side ? 2 * pi * radius * length : pi * radius * radius;
          Matrix3 J;
          J[0][0] = J[1][1] = radius * radius / (side ? 2 : 4);
          J[2][2]           = side ? length * length / 12 : 0;
          area_errors.push_back(std::abs(geometry.area / area - 1));
          moment_errors.push_back((geometry.second_moment - J).norm() /
                                  J.norm());
          EXPECT_LT(
            (geometry.centroid - Vector3({0, 0, side ? 0.6 : 0})).norm(),
            1e-14);
        }
      for (const auto &errors : {area_errors, moment_errors})
        {
          EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.15);
          EXPECT_LT(errors[1], 0.05);
        }
      report(std::string(name) + " of a cylinder, orders of area and moments",
             std::to_string(std::log2(area_errors[0] / area_errors[1])) + ", " +
               std::to_string(std::log2(moment_errors[0] / moment_errors[1])));
    }
}

TEST(Functionals, AffineMotions)
{
  Random random;
  double error = 0;
  for (const std::string &element : {tetrahedra, hexahedra})
    for (const auto &[mesh, name, normal] :
         std::vector<std::tuple<std::string, std::string, int>>{
           {box, "y min", 1},
           {cylinder(3), "end", 2},
           {cylinder(3), "side", -1}})
      {
        const BodyDiscretization body  = discretization_of(mesh + element);
        const auto ids                 = surface(body, name);
        const SurfaceGeometry geometry = surface_geometry(body, ids);
        for (unsigned int n = 0; n < 5; ++n)
          {
            const Matrix3 F = random.matrix(1);
            const Vector3 t = random.vector(1);
            const NodalVector x =
              transformed(body.reference_positions(),
                          [&](const Vector3 &X) { return t + F * X; });
            const Vector3 v   = random.vector(1);
            Vector3 direction = random.vector(1);
            if (normal >= 0)
              direction[normal] = 0;
            direction /= direction.norm();

            error = std::max(
              error,
              (surface_mean(body, ids)(x) - t - F * geometry.centroid).norm());
            error = std::max(error,
                             (surface_moment(body, ids, v)(x) -
                              F * (geometry.second_moment * v))
                               .norm());
            error = std::max(error,
                             (surface_director(body, ids, direction)(x) -
                              F * direction)
                               .norm());

            // the adjoint
            const NodalFunctional mean = surface_mean(body, ids);
            const Vector3 force        = random.vector(1);
            NodalVector nodal(x.size());
            mean.add_adjoint(force, nodal);
            mean.add_adjoint(force, nodal);
            EXPECT_NEAR(nodal * x, 2 * force * mean(x), 1e-13);
          }
      }
  EXPECT_LT(error, 2e-13);
  report("surface functionals of affine motions", error);
}

TEST(Functionals, MaterialPoints)
{
  Random random;
  const Matrix3 A = random.matrix(1), B = random.matrix(1);
  const auto quadratic = [&](const Vector3 &X) {
    return A * X + (X[0] * X[1] - X[2] * X[2]) * Vector3({1, -2, 0.5}) +
           (X * (B * X)) * Vector3({0.3, 1, 1});
  };
  double error = 0;
  for (const std::string &entries :
       {box + tetrahedra, box + hexahedra, cylinder(3) + tetrahedra})
    {
      const BodyDiscretization body = discretization_of(entries);
      const NodalVector &X          = body.reference_positions();
      const NodalVector x           = transformed(X, quadratic);

      // random points, and points on vertices, edges, faces and in cells
      std::vector<Point<dim>> points;
      for (const auto &cell : body.dof_handler().active_cell_iterators())
        {
          points.push_back(cell->center());
          for (const auto &face : cell->face_iterators())
            points.push_back(face->center());
          for (const unsigned int l : cell->line_indices())
            points.push_back(cell->line(l)->center());
          Point<dim> inside;
          double sum = 0;
          for (const unsigned int v : cell->vertex_indices())
            {
              const double weight = 0.5 + random.number(0.5);
              inside += weight * Vector3(cell->vertex(v));
              sum += weight;
            }
          points.push_back(inside / sum);
        }
      for (const Point<dim> &point : points)
        error = std::max(
          error,
          (material_point(body, point)(x) - quadratic(Vector3(point))).norm());

      for (unsigned int a = 0; a < body.n_nodes(); ++a)
        {
          const NodalFunctional point =
            material_point(body, Point<dim>(node_value(X, a)));
          for (unsigned int k = 0; k < point.nodes.size(); ++k)
            EXPECT_NEAR(point.weights[k], point.nodes[k] == a ? 1 : 0, 1e-12);
        }
    }
  EXPECT_LT(error, 1e-12);
  report("quadratic fields at material points", error);

  const BodyDiscretization body = discretization_of(box + hexahedra);
  try
    {
      material_point(body, Point<dim>(1.25, 0.5, 3));
      ADD_FAILURE() << "a point outside was accepted";
    }
  catch (const SimulationError &problem)
    {
      EXPECT_NE(std::string(problem.what()).find("0.25"), std::string::npos)
        << problem.what();
    }
}
