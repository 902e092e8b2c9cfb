// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/functionals.h>
#include <acf/mechanics/mesh_division.h>

#include <deal.II/dofs/dof_handler.h>

#include <filesystem>

#include <unit/mesh_files.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** Radius 0.5 m and length 1 m, about the z axis. */
  std::string
  cylinder(const unsigned int n_cells)
  {
    return "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
           "set Cylinder to = 0, 0, 1\n set Cylinder radius = 0.5\n"
           "set Cells = " +
           std::to_string(n_cells) + ", 2\n";
  }

  const std::string quadratic = "set Geometry = quadratic\n";

  /** One tetrahedron of second order, with the node in the middle of its first
   * edge at a place. */
  std::string
  one_tetrahedron(const std::string &middle)
  {
    return "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, " +
           middle +
           "\n6, 0.5, 0.5, 0\n7, 0, 0.5, 0\n8, 0, 0, 0.5\n9, 0.5, 0, 0.5\n"
           "10, 0, 0.5, 0.5\n*ELEMENT, TYPE=C3D10, ELSET=all\n"
           "7, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10\n";
  }
} // namespace

TEST_F(MeshFiles, CurvedCylinderConverges)
{
  // relative errors of the volume and of the moment of inertia about the axis
  std::array<double, 2> last_error = {{1, 1}};
  for (const unsigned int n : {4, 8, 16})
    {
      const auto straight = mesh_of(cylinder(n));
      const auto curved   = mesh_of(cylinder(n) + quadratic);
      EXPECT_FALSE(straight->is_curved());
      EXPECT_TRUE(curved->is_curved());
      EXPECT_EQ(curved->triangulation().n_active_cells(),
                straight->triangulation().n_active_cells());
      const auto errors = [](const BodyMesh &mesh) {
        const auto polar = [](const Point<dim> &p) {
          return p[0] * p[0] + p[1] * p[1];
        };
        return std::array<double, 2>{
          {volume(mesh) / (numbers::PI / 4) - 1,
           integrate(mesh, polar) / (numbers::PI / 32) - 1}};
      };
      const auto straight_errors = errors(*straight);
      const auto curved_errors   = errors(*curved);
      for (unsigned int i = 0; i < 2; ++i)
        {
          EXPECT_LT(std::abs(curved_errors[i]),
                    0.07 * std::abs(straight_errors[i]))
            << n;
          // of fourth order, the straight ones of second
          if (n > 4)
            {
              EXPECT_LT(std::abs(curved_errors[i]), last_error[i] / 12) << n;
            }
          last_error[i] = std::abs(curved_errors[i]);
        }
      const double side = area(*curved, "side") / numbers::PI - 1;
      EXPECT_LT(std::abs(side), 0.2 / std::pow(n, 3)) << n;
      EXPECT_NEAR(integrate_normal(*curved, {}).first.norm(), 0, 1e-13);
    }
}

TEST_F(MeshFiles, CurvedMeshesOfFiles)
{
  convert("cylinder.geo", "curved.msh", 3, 4.1, false, 2);
  std::filesystem::copy(std::string(ACF_TEST_DATA) + "/cylinder.geo", folder);
  for (const std::string name : {"curved.msh", "cylinder.geo"})
    {
      const auto mesh =
        mesh_of("set Mesh = " + name + "\n" + quadratic, folder);
      EXPECT_NEAR(volume(*mesh), numbers::PI / 4, 1.5e-3 * numbers::PI / 4);
    }
  expect_mesh_error("set Mesh = curved.msh",
                    {"curved element ",
                     "node ",
                     "Mesh.ElementOrder = 1",
                     "Geometry = quadratic"},
                    folder);

  // plane geometries stay plane, and get the mapping of straight cells
  convert("two_boxes.geo", "boxes.msh", 3, 4.1, false, 2);
  const auto boxes = mesh_of("set Mesh = boxes.msh\n" + quadratic, folder);
  EXPECT_FALSE(boxes->is_curved());
  EXPECT_NEAR(volume(*boxes), 2, 1e-12);

  convert("two_boxes.geo", "first.msh");
  expect_mesh_error("set Mesh = first.msh\n" + quadratic,
                    {"Tetrahedron 4", "second order", "ElementOrder = 2"},
                    folder);
  convert("two_boxes.geo", "third.msh", 3, 4.1, false, 3);
  expect_mesh_error("set Mesh = third.msh\n" + quadratic,
                    {"Tetrahedron 20", "second order"},
                    folder);
  expect_mesh_error(
    "set Mesh = bar_hexahedra.geo\n set Element = hexahedron\n" + quadratic,
    {"'Geometry'", "'quadratic'", "straight for hexahedra"});
  expect_mesh_error(
    "set Mesh = box\n set Box from = 0, 0, 0\n"
    "set Box to = 1, 1, 1\n set Cells = 1, 1, 1\n" +
      quadratic,
    {"'Geometry'", "straight for Mesh = box"});
}

TEST_F(MeshFiles, FoldedCells)
{
  write("good.inp", one_tetrahedron("0.5, -0.1, -0.1"));
  const auto good = mesh_of("set Mesh = good.inp\n" + quadratic, folder);
  EXPECT_GT(volume(*good), 1. / 6);
  write("folded.inp", one_tetrahedron("0.5, 0.4, 0.4"));
  expect_mesh_error("set Mesh = folded.inp\n" + quadratic,
                    {"1 folded cells",
                     "Jacobian",
                     "element 7 at (0.25, 0.25, 0.25)",
                     "at the point (",
                     "Geometry = straight"},
                    folder);
  // a node beyond the quarter points folds the edge itself
  write("edge.inp", one_tetrahedron("0.8, 0, 0"));
  expect_mesh_error("set Mesh = edge.inp\n" + quadratic,
                    {"1 folded cells", "at the point (1, 0, 0)"},
                    folder);

  // two elements that do not agree on the node of an edge
  std::string apart = one_tetrahedron("0.5, -0.1, -0.1");
  apart.insert(apart.find("*ELEMENT"),
               "11, 0, 0, -1\n12, 0.5, 0, 0\n13, 0, 0, -0.5\n"
               "14, 0.5, 0, -0.5\n15, 0, 0.5, -0.5\n");
  apart += "8, 2, 1, 3, 11, 12, 7, 6, 14, 13, 15\n";
  write("apart.inp", apart);
  expect_mesh_error("set Mesh = apart.inp\n" + quadratic,
                    {"element 8", "node 12 at (0.5, 0, 0)", "another place"},
                    folder);
}

TEST_F(MeshFiles, CurvedMeshesAreMirroredAndCut)
{
  // a half cylinder: its image makes it whole
  write("half.geo",
        "SetFactory(\"OpenCASCADE\"); Cylinder(1) = {0, 0, 0, 0, 0, 1, 0.5};"
        "Box(2) = {0, -1, -1, 1, 2, 3};"
        "BooleanIntersection{ Volume{1}; Delete; }{ Volume{2}; Delete; }\n"
        "Mesh.MeshSizeMax = 0.3;\n");
  const auto half = mesh_of("set Mesh = half.geo\n" + quadratic, folder);
  const auto whole =
    mesh_of("set Mesh = half.geo\n set Mirror = x\n" + quadratic, folder);
  EXPECT_TRUE(whole->is_curved());
  EXPECT_NEAR(volume(*whole), 2 * volume(*half), 1e-12);
  EXPECT_NEAR(volume(*half), numbers::PI / 8, 2e-3);
  EXPECT_NEAR(integrate_normal(*whole, {}).first.norm(), 0, 1e-12);

  const MeshParameters parameters = parse_mesh(cylinder(6) + quadratic);
  const MeshSource source{"Bodies/b", "cylinder"};
  const DividedMesh parts =
    divide_mesh(make_mesh_data(parameters, "Bodies/b", ""),
                parse_cut("2 along z", "Bodies/b"),
                source);
  double sum = 0;
  for (const MeshData &part : parts.parts)
    {
      const BodyMesh mesh(part, source);
      EXPECT_TRUE(mesh.is_curved());
      sum += volume(mesh);
    }
  EXPECT_NEAR(sum, volume(*mesh_of(cylinder(6) + quadratic)), 1e-12);
}

TEST_F(MeshFiles, OperatorsOfCurvedBodies)
{
  const BodyDiscretization body(mesh_of(cylinder(6) + quadratic));
  Material material;
  material.youngs_modulus       = 2e11;
  material.poissons_ratio       = 0.3;
  material.density              = 1000;
  const BodyOperators operators = assemble_body_operators(body, material);
  const double V                = volume(body.mesh());
  EXPECT_NEAR(operators.volume, V, 1e-12);
  EXPECT_NEAR(operators.mass, 1000 * V, 1e-9);
  EXPECT_NEAR((operators.centre - Vector3(Point<dim>(0, 0, 0.5))).norm(),
              0,
              1e-12);
  EXPECT_NEAR(operators.inertia[2][2],
              1000 * integrate(body.mesh(),
                               [](const Point<dim> &p) {
                                 return p[0] * p[0] + p[1] * p[1];
                               }),
              1e-9);

  // nodes of the side are on the radius
  const NodalVector &X = body.reference_positions();
  double largest       = 0;
  for (unsigned int a = 0; a < body.n_nodes(); ++a)
    largest = std::max(largest, std::hypot(X[3 * a], X[3 * a + 1]));
  EXPECT_NEAR(largest, 0.5, 1e-14);

  // affine displacements are represented exactly: the mean gradient and the
  // energy of x -> H X, and no force of rigid motions
  Matrix3 H;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      H[i][j] = 1e-3 * (1. + i + 2. * j * j);
  NodalVector u(X.size()), force(X.size()), rotation(X.size());
  for (unsigned int a = 0; a < body.n_nodes(); ++a)
    for (unsigned int i = 0; i < dim; ++i)
      {
        for (unsigned int j = 0; j < dim; ++j)
          {
            u[3 * a + i] += H[i][j] * X[3 * a + j];
            rotation[3 * a + i] += (H[i][j] - H[j][i]) * X[3 * a + j];
          }
      }
  Matrix3 mean;
  for (unsigned int a = 0; a < body.n_nodes(); ++a)
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        mean[i][j] += u[3 * a + i] * operators.averaging_vectors[3 * a + j];
  EXPECT_NEAR((mean - H).norm(), 0, 1e-15);
  operators.stiffness_matrix.vmult(force, u);
  const SymmetricTensor<2, dim> strain = symmetrize(H);
  const double energy = V * (material.lambda() * trace(strain) * trace(strain) +
                             2 * material.mu() * (strain * strain));
  EXPECT_NEAR(u * force / energy, 1, 1e-12);
  const double scale = force.linfty_norm();
  operators.stiffness_matrix.vmult(force, rotation);
  EXPECT_LT(force.linfty_norm(), 1e-11 * scale);
}

TEST_F(MeshFiles, PointsOfCurvedBodies)
{
  const BodyDiscretization body(mesh_of(cylinder(5) + quadratic));
  // between the chord of an edge and the arc, at many angles and inside
  for (unsigned int i = 0; i < 40; ++i)
    for (const double radius : {0.1, 0.4, 0.47, 0.4985})
      {
        const double angle = 0.01 + 2 * numbers::PI * i / 40;
        const Point<dim> point(radius * std::cos(angle),
                               radius * std::sin(angle),
                               0.3 + 0.01 * i);
        const NodalFunctional value = material_point(body, point);
        EXPECT_LT((value(body.reference_positions()) - Vector3(point)).norm(),
                  1e-10);
      }
  EXPECT_THROW(material_point(body, Point<dim>(0.501, 0, 0.5)),
               SimulationError);
}

TEST_F(MeshFiles, SurfaceMeshSizes)
{
  const auto coarse = mesh_of("set Mesh = two_boxes.geo");
  const auto at     = [](const BodyMesh &mesh, const std::string &name) {
    double largest = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() &&
            mesh.surface(name, "", "").count(face->boundary_id()) > 0)
          largest = std::max(largest, face->diameter());
    return largest;
  };
  const auto fine =
    mesh_of("set Mesh = two_boxes.geo\n set Surface mesh sizes = start: 0.05");
  EXPECT_LT(at(*fine, "start"), 0.08);
  EXPECT_GT(at(*fine, "ends"), 0.15); // the other end stays coarse
  EXPECT_NEAR(volume(*fine), 2, 1e-12);
  EXPECT_GT(fine->triangulation().n_active_cells(),
            4 * coarse->triangulation().n_active_cells());
  // far fewer than with that size everywhere
  EXPECT_LT(fine->triangulation().n_active_cells(), 2 / (0.118 * 1.25e-4) / 4);

  // in CAD, by the number of the surface, or by its place; sizes are in m
  std::filesystem::copy(std::string(ACF_TEST_DATA) + "/box.igs", folder);
  const auto cad = mesh_of(
    "set Mesh = box.igs\n"
    "set Surfaces = end: plane 0.002 0 0 1 0 0\n"
    "set Surface mesh sizes = end: 5e-5",
    folder);
  EXPECT_LT(at(*cad, "end"), 8e-5);
  EXPECT_NEAR(volume(*cad), 2e-9, 1e-20);
  const auto numbered =
    mesh_of("set Mesh = box.igs\n set Surface mesh sizes = surface 1: 5e-5",
            folder);
  EXPECT_LT(at(*numbered, "surface 1"), 8e-5);

  expect_mesh_error(
    "set Mesh = two_boxes.geo\n set Surface mesh sizes = begin: 0.05",
    {"'Surface mesh sizes'", "'begin: 0.05'", "'start'", "'ends'"});
  expect_mesh_error(
    "set Mesh = two_boxes.geo\n set Surface mesh sizes = part: 0.05\n"
    "set Surfaces = part: box 0 0 0 0.5 0.5 0.5",
    {"'Surface mesh sizes'", "no whole surface"});
  expect_mesh_error(
    "set Mesh = two_boxes.geo\n set Surface mesh sizes = start: 1e-5",
    {"'Surface mesh sizes'", "'start: 1e-05'", "million cells"});
  for (const std::string text :
       {"start", "start: x", "start: -1", ": 1", "start: 1,", "start: nan"})
    expect_mesh_error("set Mesh = two_boxes.geo\n set Surface mesh sizes = " +
                        text,
                      {"'Surface mesh sizes'", "'NAME: size'"});
  expect_mesh_error(
    "set Mesh = two_boxes.geo\n set Surface mesh sizes = a: 1, a: 2",
    {"'Surface mesh sizes'", "two sizes for 'a'"});
  expect_mesh_error(
    "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
    "set Cylinder to = 0, 0, 1\n set Cylinder radius = 1\n"
    "set Cells = 4, 1\n set Surface mesh sizes = end: 1",
    {"'Surface mesh sizes'", "only geometries"});
}
