// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_generation.h>

#include <deal.II/base/geometry_info.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <unit/mesh_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const std::string box =
    "set Mesh = box\n set Box from = -1, -0.5, 0\n"
    "set Box to = 1, 0.5, 3\n set Cells = 2, 3, 4\n";
  const std::string hexahedra = "set Element = hexahedron\n";

  std::string
  cylinder(const std::string &cells,
           const std::string &to     = "2, 0, 0",
           const std::string &radius = "0.5")
  {
    return "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
           "set Cylinder to = " +
           to + "\n set Cylinder radius = " + radius +
           "\n set Cells = " + cells + "\n";
  }

  double
  factorial(const unsigned int n)
  {
    return n == 0 ? 1. : n * factorial(n - 1);
  }

  /** Quadratic unknowns: vertices and edges, and for hexahedra also faces and
   * cells; the edges follow from Euler's formula for a solid ball. */
  unsigned int
  n_quadratic_dofs(const BodyMesh &mesh)
  {
    const unsigned int n_vertices = mesh.triangulation().n_used_vertices();
    const unsigned int n_cells    = mesh.triangulation().n_active_cells();
    std::size_t n_cell_faces = 0, n_boundary_faces = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        {
          ++n_cell_faces;
          n_boundary_faces += (face->at_boundary() ? 1 : 0);
        }
    const unsigned int n_faces = (n_cell_faces + n_boundary_faces) / 2;
    const unsigned int n_edges = n_vertices + n_faces - n_cells - 1;
    return 3 *
           (n_vertices + n_edges + (mesh.is_simplex() ? 0 : n_faces + n_cells));
  }

  unsigned int
  distribute(const BodyMesh &mesh)
  {
    const std::unique_ptr<const FiniteElement<dim>> scalar =
      mesh.is_simplex() ? std::unique_ptr<const FiniteElement<dim>>(
                            std::make_unique<const FE_SimplexP<dim>>(2))
                        : std::unique_ptr<const FiniteElement<dim>>(
                            std::make_unique<const FE_Q<dim>>(2));
    const FESystem<dim> fe(*scalar, dim);
    DoFHandler<dim> dof_handler(mesh.triangulation());
    dof_handler.distribute_dofs(fe);

    // the volume as the sum of the integrals of all shape functions
    FEValues<dim> fe_values(mesh.mapping(),
                            fe,
                            mesh.cell_quadrature(4),
                            update_values | update_JxW_values);
    double sum = 0;
    for (const auto &cell : dof_handler.active_cell_iterators())
      {
        fe_values.reinit(cell);
        for (const unsigned int q : fe_values.quadrature_point_indices())
          for (const unsigned int i : fe_values.dof_indices())
            sum += fe_values.shape_value(i, q) * fe_values.JxW(q);
      }
    EXPECT_NEAR(sum, 3 * volume(mesh), 1e-12 * sum);
    return dof_handler.n_dofs();
  }

  /** Rounded coordinates, to compare sets of points. */
  std::array<long, 3>
  rounded(const Point<dim> &point)
  {
    return {{std::lround(point[0] * 1e9),
             std::lround(point[1] * 1e9),
             std::lround(point[2] * 1e9)}};
  }

  /** Vertices and cell centres, reflected at a plane. */
  std::set<std::array<long, 3>>
  reflected_points(const BodyMesh &mesh,
                   const unsigned int axis,
                   const double plane,
                   const double sign)
  {
    std::set<std::array<long, 3>> points;
    const auto add = [&](Point<dim> point) {
      point[axis] = plane + sign * (point[axis] - plane);
      points.insert(rounded(point));
    };
    for (const Point<dim> &vertex : mesh.triangulation().get_vertices())
      add(vertex);
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      add(cell->center());
    return points;
  }

  bool
  is_symmetric(const BodyMesh &mesh,
               const unsigned int axis,
               const double plane)
  {
    return reflected_points(mesh, axis, plane, 1) ==
           reflected_points(mesh, axis, plane, -1);
  }
} // namespace

TEST(MeshParameters, DefaultsAndMissingEntries)
{
  const MeshParameters defaults = parse_mesh("");
  EXPECT_EQ(defaults.mesh, "");
  EXPECT_EQ(defaults.element, "tetrahedron");
  EXPECT_TRUE(defaults.box_from.empty() && defaults.cells.empty());
  expect_mesh_error(
    "", {"Bodies/b", "'Mesh'", "found no value", "box, cylinder", ".step"});
  expect_mesh_error("set Mesh = body.stl", {"'Mesh'", "'body.stl'", ".msh"});
  expect_mesh_error("set Mesh = box", {"'Box from'", "three coordinates"});
  expect_mesh_error("set Mesh = box\n set Box from = 0, 0\n",
                    {"'Box from'", "'0, 0'", "three coordinates"});
  expect_mesh_error("set Mesh = box\n set Box from=0,0,0\n set Box to=1,1,1\n",
                    {"'Cells'", "no value", "three positive counts"});
  expect_mesh_error(
    "set Mesh = cylinder\n set Cylinder from=0,0,0\n"
    "set Cylinder to=1,1,1\n set Cells=4,4\n",
    {"'Cylinder radius'", "found 0", "positive"});
}

TEST(MeshParameters, ValuesThatMakeNoSense)
{
  expect_mesh_error(box + "set Box to = 1, -0.5, 3\n",
                    {"'Box to'", "'1, -0.5, 3'", "larger", "-1, -0.5, 0"});
  expect_mesh_error(box + "set Cells = 2, 3\n", {"'Cells'", "'2, 3'", "three"});
  expect_mesh_error(box + "set Cells = 1000, 1000, 1000\n",
                    {"'Cells'", "'1000, 1000, 1000'", "20 million"});
  expect_mesh_error(cylinder("2, 2"), {"'Cells'", "'2, 2'", "at least 3"});
  expect_mesh_error(cylinder("4, 2, 2"), {"'Cells'", "'4, 2, 2'", "two"});
  expect_mesh_error(cylinder("4, 2", "0, 0, 0"),
                    {"'Cylinder to'", "'0, 0, 0'", "Cylinder from"});

  // counts of zero do not pass the pattern, nor this check
  MeshParameters parameters = parse_mesh(box);
  parameters.cells          = {2, 0, 1};
  expect_input_error([&]() { parameters.check("Bodies/b"); },
                     {"'Cells'", "'2, 0, 1'", "positive"});
  EXPECT_ANY_THROW(parse_mesh(box + "set Cells = 2, 0, 1\n"));
  EXPECT_ANY_THROW(parse_mesh(box + "set Element = wedge\n"));
  EXPECT_ANY_THROW(parse_mesh(box + "set Mirror = w\n"));
}

TEST(MeshParameters, EntriesThatDoNotApply)
{
  for (const std::string entry : {"Box from = 0, 0, 0",
                                  "Box to = 0, 0, 0",
                                  "Cylinder from = 1, 1, 1",
                                  "Cylinder to = 1, 1, 1",
                                  "Cells = 1, 1, 1",
                                  "Cylinder radius = 2"})
    expect_mesh_error("set Mesh = a.msh\n set " + entry,
                      {"'" + entry.substr(0, entry.find(" =")) + "'",
                       "no value for Mesh = a.msh"});
  expect_mesh_error("set Mesh = a.msh\n set Mesh size = 0.25",
                    {"'Mesh size'", "0.25", "Mesh = a.msh"});
  expect_mesh_error(box + "set Mesh size = 1", {"'Mesh size'", "Mesh = box"});
  expect_mesh_error(box + "set Cylinder to = 1, 1, 1",
                    {"'Cylinder to'", "Mesh = box"});
  expect_mesh_error(cylinder("4, 4") + "set Box to = 1, 1, 1",
                    {"'Box to'", "Mesh = cylinder"});
}

TEST(Box, VolumeSurfacesAndUnknowns)
{
  for (const std::string element : {"tetrahedron", "hexahedron"})
    {
      const auto mesh = mesh_of(box + "set Element = " + element);
      EXPECT_EQ(mesh->is_simplex(), element == "tetrahedron");
      EXPECT_EQ(mesh->triangulation().n_active_cells(),
                mesh->is_simplex() ? 24 * 24 : 24);
      EXPECT_NEAR(volume(*mesh), 6, 1e-11);
      EXPECT_NEAR(integrate(*mesh, [](const auto &p) { return p[2] * p[2]; }),
                  2 * 9,
                  1e-12);

      EXPECT_EQ(names(mesh->surfaces()), "x max|x min|y max|y min|z max|z min");
      EXPECT_EQ(names(mesh->regions()), "body");
      const std::array<double, 3> areas = {{3, 6, 2}};
      for (unsigned int d = 0; d < dim; ++d)
        for (const double side : {-1., 1.})
          {
            const std::string name =
              std::string(1, "xyz"[d]) + (side < 0 ? " min" : " max");
            Vector3 expected;
            expected[d] = side * areas[d];
            const auto [normal, surface_area] =
              integrate_normal(*mesh, mesh->surface(name, "", ""));
            EXPECT_NEAR((normal - expected).norm(), 0, 1e-13) << name;
            EXPECT_NEAR(surface_area, areas[d], 1e-13) << name;
          }
      EXPECT_NEAR(integrate_normal(*mesh, {}).second, 22, 1e-12);
      for (const auto &cell : mesh->triangulation().active_cell_iterators())
        EXPECT_EQ(mesh->region("body", "", "").count(cell->material_id()), 1);

      const unsigned int n_dofs = distribute(*mesh);
      EXPECT_EQ(n_dofs, n_quadratic_dofs(*mesh));
      if (!mesh->is_simplex())
        {
          EXPECT_EQ(n_dofs, 3 * 5 * 7 * 9);
        }
    }
}

TEST(Box, TetrahedraAreSymmetricToAllMidPlanes)
{
  const auto mesh = mesh_of(box);
  EXPECT_TRUE(is_symmetric(*mesh, 0, 0));
  EXPECT_TRUE(is_symmetric(*mesh, 1, 0));
  EXPECT_TRUE(is_symmetric(*mesh, 2, 1.5));
  EXPECT_FALSE(is_symmetric(*mesh, 2, 1.4));
}

TEST(Box, LookUpOfNames)
{
  const auto mesh = mesh_of(box);
  expect_input_error(
    [&]() { mesh->surface("top", "Joints/j", "Between"); },
    {"Joints/j", "'Between'", "surface 'top'", "'x max', 'x min'"});
  expect_input_error([&]() { mesh->region("top", "Bodies/b", "Region"); },
                     {"'Region'", "region 'top'", "allowed: 'body'"});
}

TEST(Cylinder, HexahedraFillThePrism)
{
  for (unsigned int n = 3; n <= 9; ++n)
    {
      const auto mesh =
        mesh_of(cylinder(std::to_string(n) + ", 3") + hexahedra);
      const int n_rings = std::max(1L, std::lround(n / 4.));
      const int n_sides = 4 * (n - 2 * n_rings);
      const int n_inner = (n_sides / 4) * (n_sides / 4);
      const double polygon =
        0.5 * n_sides * 0.25 * std::sin(2 * numbers::PI / n_sides);
      EXPECT_EQ(mesh->triangulation().n_active_cells(),
                3 * (n_inner + n_sides * n_rings));
      EXPECT_NEAR(volume(*mesh), 2 * polygon, 1e-13) << n;
      EXPECT_NEAR(area(*mesh, "start"), polygon, 1e-13);
      EXPECT_NEAR(area(*mesh, "side"),
                  2 * n_sides * std::sin(numbers::PI / n_sides),
                  1e-12);
      EXPECT_EQ(distribute(*mesh), n_quadratic_dofs(*mesh));
    }
}

TEST(Cylinder, ConvergesWithSecondOrder)
{
  for (const std::string element : {"tetrahedron", "hexahedron"})
    {
      std::array<double, 2> error;
      for (const unsigned int level : {0, 1})
        {
          const std::string cells = (level == 0 ? "8, 4" : "16, 8");
          const auto mesh =
            mesh_of(cylinder(cells) + "set Element = " + element);
          error[level] = numbers::PI * 0.25 * 2 - volume(*mesh);
          EXPECT_NEAR(area(*mesh, "side"), 2 * numbers::PI, 0.1);
          EXPECT_EQ(names(mesh->surfaces()), "end|side|start");
        }
      EXPECT_GT(error[1], 0) << element;
      EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.05) << element;
    }
}

TEST(Cylinder, AnyDirectionAndVerticesOnTheRadius)
{
  const Point<dim> to(0.6, -1, 2);
  const Vector3 axis = to / to.norm();
  for (const std::string element : {"tetrahedron", "hexahedron"})
    {
      const auto mesh  = mesh_of(cylinder("6, 4", "0.6, -1, 2", "0.25") +
                                "set Element = " + element);
      const auto start = mesh->surface("start", "", "");
      const auto end   = mesh->surface("end", "", "");
      const auto side  = mesh->surface("side", "", "");
      EXPECT_NEAR((integrate_normal(*mesh, start).first +
                   area(*mesh, "start") * axis)
                    .norm(),
                  0,
                  1e-14);
      EXPECT_NEAR(
        (integrate_normal(*mesh, end).first - area(*mesh, "end") * axis).norm(),
        0,
        1e-14);
      std::set<types::boundary_id> used_ids;
      for (const auto &cell : mesh->triangulation().active_cell_iterators())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            for (const unsigned int v : face->vertex_indices())
              {
                used_ids.insert(face->boundary_id());
                const Vector3 distance = face->vertex(v) - Point<dim>();
                const double along     = distance * axis;
                if (side.count(face->boundary_id()) > 0)
                  EXPECT_NEAR((distance - along * axis).norm(), 0.25, 1e-15);
                else
                  EXPECT_NEAR(along,
                              start.count(face->boundary_id()) > 0 ? 0.
                                                                   : to.norm(),
                              1e-15);
              }
      EXPECT_EQ(used_ids.size(), 3); // no face without a name
    }
}

TEST(Cylinder, IsSymmetricToTheCoordinatePlanes)
{
  const auto mesh = mesh_of(cylinder("7, 2"));
  EXPECT_TRUE(is_symmetric(*mesh, 0, 1));
  EXPECT_TRUE(is_symmetric(*mesh, 1, 0));
  EXPECT_TRUE(is_symmetric(*mesh, 2, 0));
}

TEST(Quadrature, IsExactForMonomials)
{
  const auto tetrahedra = mesh_of(box);
  const auto hexahedral = mesh_of(box + hexahedra);
  const auto monomial   = [](const auto &rule, const auto &powers) {
    double sum = 0;
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        double value = rule.weight(q);
        for (unsigned int d = 0; d < powers.size(); ++d)
          value *= std::pow(rule.point(q)[d], powers[d]);
        sum += value;
      }
    return sum;
  };
  for (unsigned int degree = 0; degree <= 9; ++degree)
    for (unsigned int a = 0; a <= degree; ++a)
      for (unsigned int b = 0; a + b <= degree; ++b)
        {
          EXPECT_NEAR(monomial(tetrahedra->face_quadrature(degree),
                               std::array<unsigned int, 2>{{a, b}}),
                      factorial(a) * factorial(b) / factorial(a + b + 2),
                      1e-14);
          for (unsigned int c = 0; a + b + c <= degree; ++c)
            EXPECT_NEAR(monomial(tetrahedra->cell_quadrature(degree),
                                 std::array<unsigned int, 3>{{a, b, c}}),
                        factorial(a) * factorial(b) * factorial(c) /
                          factorial(a + b + c + 3),
                        1e-14)
              << degree << ": " << a << b << c;
          EXPECT_NEAR(monomial(hexahedral->cell_quadrature(degree),
                               std::array<unsigned int, 3>{
                                 {degree, a, degree}}),
                      1. / ((degree + 1) * (a + 1) * (degree + 1)),
                      1e-14);
          EXPECT_NEAR(monomial(hexahedral->face_quadrature(degree),
                               std::array<unsigned int, 2>{{degree, b}}),
                      1. / ((degree + 1) * (b + 1)),
                      1e-14);
        }
  for (unsigned int degree = 10; degree <= 13; ++degree)
    EXPECT_NEAR(monomial(tetrahedra->face_quadrature(degree),
                         std::array<unsigned int, 2>{{degree, 0}}),
                1. / ((degree + 1) * (degree + 2)),
                1e-14);
  EXPECT_EQ(tetrahedra->cell_quadrature(2).size(), 4);
  EXPECT_EQ(tetrahedra->cell_quadrature(4).size(), 14);
  EXPECT_ANY_THROW(tetrahedra->cell_quadrature(10));
  EXPECT_ANY_THROW(tetrahedra->face_quadrature(14));
}

TEST(MeshData, HexahedraNumberedFromAnyVertex)
{
  // Each cell of a bent block gets one of the 24 numberings of a cube.
  MeshData data = generate_box(Point<dim>(0, 0, 0),
                               Point<dim>(1, 1, 1),
                               {{3, 3, 3}},
                               ReferenceCells::Hexahedron);
  for (Point<dim> &vertex : data.vertices)
    vertex[2] += 0.2 * vertex[0] * vertex[1];
  std::mt19937 random(1);
  for (CellData<dim> &cell : data.cells)
    for (unsigned int turn = random() % 12; turn > 0; --turn)
      {
        // about the third axis, or about the diagonal
        const std::array<unsigned int, 8> quarter = {{1, 3, 0, 2, 5, 7, 4, 6}};
        const std::array<unsigned int, 8> third   = {{0, 2, 4, 6, 1, 3, 5, 7}};
        const auto &turned = (random() % 2 == 0 ? quarter : third);
        const auto old     = cell.vertices;
        for (unsigned int v = 0; v < 8; ++v)
          cell.vertices[v] = old[turned[v]];
      }
  const BodyMesh mesh(data, {"Bodies/b", "block"});
  EXPECT_NEAR(volume(mesh), 1, 1e-13);
  EXPECT_EQ(distribute(mesh), 3 * 7 * 7 * 7);
  EXPECT_NEAR(area(mesh, "x max"), 1, 1e-13);
  EXPECT_NEAR(area(mesh, "y min"), 1, 1e-13);
  // the flux of (x, 0, 0) is the volume
  EXPECT_NEAR(integrate_normal(mesh, mesh.surface("x max", "", "")).first[0],
              1,
              1e-13);
  EXPECT_NEAR(integrate_normal(mesh, {}).first.norm(), 0, 1e-13);
}
