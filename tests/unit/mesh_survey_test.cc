// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_survey.h>
#include <acf/mechanics/rotation.h>

#include <cmath>

#include <unit/mesh_test.h>

using namespace ACF;
using namespace ACF::Testing;
using Kind = SurfaceShape::Kind;

namespace
{
  const SurfaceSurvey &
  surface(const MeshSurvey &survey, const std::string &name)
  {
    for (const SurfaceSurvey &candidate : survey.surfaces)
      if (candidate.name == name)
        return candidate;
    throw std::runtime_error("no surface " + name);
  }

  // Vertices of a grid of quadrilaterals and their facets, whose outward side
  // is that of increasing distance from a point, or of decreasing distance.
  struct Patch
  {
    template <typename Place>
    Patch(const unsigned int n,
          const unsigned int m,
          const Place &place,
          const Point<dim> &inside,
          const bool is_hole = false)
    {
      for (unsigned int j = 0; j <= m; ++j)
        for (unsigned int i = 0; i <= n; ++i)
          vertices.push_back(place(1. * i / n, 1. * j / m));
      for (unsigned int j = 0; j < m; ++j)
        for (unsigned int i = 0; i < n; ++i)
          {
            const Point<dim> a = vertices[j * (n + 1) + i],
                             b = vertices[j * (n + 1) + i + 1],
                             c = vertices[(j + 1) * (n + 1) + i],
                             d = vertices[(j + 1) * (n + 1) + i + 1];
            Facet facet;
            facet.centre = a + ((b - a) + (c - a) + (d - a)) / 4.;
            facet.normal = cross_product_3d(d - a, c - b);
            facet.area   = facet.normal.norm() / 2;
            facet.normal /= facet.normal.norm();
            if ((facet.normal * (facet.centre - inside) < 0) != is_hole)
              facet.normal *= -1.;
            facets.push_back(facet);
          }
    }

    SurfaceShape
    shape() const
    {
      return surface_shape(vertices, facets);
    }

    std::vector<Point<dim>> vertices;
    std::vector<Facet> facets;
  };

  // A place in a frame that is turned and moved.
  Point<dim>
  placed(const double x, const double y, const double z)
  {
    static const Matrix3 R = rotation_matrix(Vector3({0.3, -1.1, 0.7}));
    return Point<dim>(100, 20, -3) + R * Vector3({x, y, z});
  }

  Vector3
  turned(const Vector3 &v)
  {
    return placed(v[0], v[1], v[2]) - placed(0, 0, 0);
  }
} // namespace



TEST(SurfaceShape, FindsAPlaneWithItsOutwardNormal)
{
  const Patch patch(
    3,
    2,
    [](double s, double t) { return placed(s, 2 * t, 0.5); },
    placed(0, 0, 0));
  const SurfaceShape shape = patch.shape();
  EXPECT_EQ(shape.kind, Kind::plane);
  EXPECT_LT((shape.direction - turned(Vector3({0, 0, 1}))).norm(), 1e-10);
}

TEST(SurfaceShape, FindsACylinderAndWhetherItIsAHole)
{
  // a third of a circle, small against its distance from the origin
  const auto place = [](double s, double t) {
    const double angle = 2 + s * 2 * M_PI / 3;
    return placed(0.01 * std::cos(angle), 0.01 * std::sin(angle), 0.02 * t * t);
  };
  for (const bool is_hole : {false, true})
    {
      const SurfaceShape shape =
        Patch(6, 3, place, placed(0, 0, 0), is_hole).shape();
      EXPECT_EQ(shape.kind, Kind::cylinder);
      EXPECT_EQ(shape.is_hole, is_hole);
      EXPECT_NEAR(shape.radius, 0.01, 1e-9);
      const Vector3 axis = turned(Vector3({0, 0, 1}));
      EXPECT_NEAR(std::abs(shape.direction * axis), 1, 1e-10);
      const Vector3 arm = shape.point - placed(0, 0, 0);
      EXPECT_LT((arm - (arm * axis) * axis).norm(), 1e-9);
    }
}

TEST(SurfaceShape, FindsASphere)
{
  const auto place = [](double s, double t) {
    const double a = 3 * s, b = 0.2 + 0.9 * t;
    return placed(2 * std::cos(a) * std::cos(b),
                  2 * std::sin(a) * std::cos(b),
                  2 * std::sin(b));
  };
  const SurfaceShape shape = Patch(8, 3, place, placed(0, 0, 0)).shape();
  EXPECT_EQ(shape.kind, Kind::sphere);
  EXPECT_NEAR(shape.radius, 2, 1e-9);
  EXPECT_LT(shape.point.distance(placed(0, 0, 0)), 1e-8);
  EXPECT_FALSE(shape.is_hole);
}

TEST(SurfaceShape, TakesNothingElseForOneOfThem)
{
  const auto shape = [](const auto &place) {
    return Patch(8, 4, place, placed(0, 0, 0)).shape().kind;
  };
  // a cone, and a cylinder with a dent of a thousandth of its radius
  EXPECT_EQ(shape([](double s, double t) {
              return placed((1 + t) * std::cos(4 * s),
                            (1 + t) * std::sin(4 * s),
                            t);
            }),
            Kind::other);
  EXPECT_EQ(shape([](double s, double t) {
              const double r = s == 0.5 && t == 0.5 ? 0.999 : 1;
              return placed(r * std::cos(4 * s), r * std::sin(4 * s), t);
            }),
            Kind::other);
  // the four sides of a box, whose edges are on a cylinder
  EXPECT_EQ(Patch(
              4,
              1,
              [](double s, double t) {
                return placed(std::cos(2 * M_PI * s),
                              std::sin(2 * M_PI * s),
                              t);
              },
              placed(0, 0, 0.5))
              .shape()
              .kind,
            Kind::other);
}

TEST(MeshSurvey, KnowsABoxOfEitherElement)
{
  for (const std::string element : {"tetrahedron", "hexahedron"})
    {
      const auto mesh = mesh_of(
        "set Mesh = box\n set Box from = 1, 0, -1\n set Box to = 3, 1, "
        "3\n set Cells = 2, 1, 4\n set Element = " +
        element + "\n");
      const MeshSurvey survey = survey_mesh(*mesh);
      EXPECT_NEAR(survey.volume, 8, 1e-12);
      EXPECT_LT(survey.centre.distance(Point<dim>(2, 0.5, 1)), 1e-12);
      EXPECT_NEAR(survey.inertia[0][0], 8 * (1 + 16) / 12., 1e-12);
      EXPECT_NEAR(survey.inertia[1][1], 8 * (4 + 16) / 12., 1e-12);
      EXPECT_NEAR(survey.inertia[2][2], 8 * (4 + 1) / 12., 1e-12);
      EXPECT_NEAR(survey.inertia[0][1], 0, 1e-12);
      EXPECT_EQ(survey.lower, Point<dim>(1, 0, -1));
      EXPECT_EQ(survey.upper, Point<dim>(3, 1, 3));
      EXPECT_EQ(survey.n_unnamed_faces, 0);
      ASSERT_EQ(survey.surfaces.size(), 6);
      const SurfaceSurvey &end = surface(survey, "z max");
      EXPECT_NEAR(end.area, 2, 1e-12);
      EXPECT_EQ(end.n_pieces, 1);
      EXPECT_LT(end.centre.distance(Point<dim>(2, 0.5, 3)), 1e-12);
      EXPECT_EQ(end.shape.kind, Kind::plane);
      EXPECT_LT((end.shape.direction - Vector3({0, 0, 1})).norm(), 1e-12);
      if (element == "hexahedron")
        {
          EXPECT_EQ(survey.qualities, std::vector<double>(8, 1.));
          EXPECT_EQ(survey.shortest_edge, 1);
          EXPECT_EQ(survey.longest_edge, 1);
        }
    }
}

TEST(MeshSurvey, MeasuresTheShapeOfCells)
{
  const auto quality = [](const std::vector<Point<dim>> &vertices,
                          const ReferenceCell &type) {
    MeshData data;
    data.reference_cell = type;
    data.vertices       = vertices;
    CellData<dim> cell(vertices.size());
    for (unsigned int v = 0; v < vertices.size(); ++v)
      cell.vertices[v] = v;
    data.cells = {cell};
    return survey_mesh(BodyMesh(data, {"", "m"})).qualities.at(0);
  };
  const double h = std::sqrt(2. / 3.), m = std::sqrt(3.) / 2;
  const auto tetrahedron = [&](const double height) {
    return quality({{0, 0, 0}, {1, 0, 0}, {0.5, m, 0}, {0.5, m / 3, height}},
                   ReferenceCells::Tetrahedron);
  };
  EXPECT_NEAR(tetrahedron(h), 1, 1e-12);
  // r = h A / (A + 3 B), R = (h^2 + 1/3) / (2 h) for the height h
  const double flat = 0.05, A = m / 2,
               B = 0.5 * std::sqrt(m * m / 9 + flat * flat);
  EXPECT_NEAR(tetrahedron(flat),
              3 * (flat * A / (A + 3 * B)) /
                ((flat * flat + 1. / 3) / (2 * flat)),
              1e-12);
  // a sheared cube: the edges meet at 45 and 135 degrees
  EXPECT_NEAR(quality({{0, 0, 0},
                       {1, 0, 0},
                       {1, 1, 0},
                       {2, 1, 0},
                       {0, 0, 1},
                       {1, 0, 1},
                       {1, 1, 1},
                       {2, 1, 1}},
                      ReferenceCells::Hexahedron),
              std::sqrt(0.5),
              1e-12);
}

TEST(MeshSurvey, FindsTheWorstCellAndPieces)
{
  // two boxes with a common group of faces at both ends
  const auto mesh = mesh_of(
    "set Mesh = cylinder\n set Element = hexahedron\n set Cylinder "
    "from = 0, 0, 0\n set Cylinder to = 2, 0, 0\n set Cylinder radius "
    "= 0.5\n set Cells = 6, 3\n set Mirror = x\n");
  const MeshSurvey survey   = survey_mesh(*mesh);
  const SurfaceSurvey &ends = surface(survey, "end both");
  EXPECT_EQ(ends.n_pieces, 2);
  EXPECT_EQ(ends.shape.kind, Kind::other);
  EXPECT_LT(ends.centre.norm(), 1e-12);
  const SurfaceSurvey &side = surface(survey, "side both");
  EXPECT_EQ(side.shape.kind, Kind::cylinder);
  EXPECT_NEAR(side.shape.radius, 0.5, 1e-9);
  EXPECT_NEAR(std::abs(side.shape.direction[0]), 1, 1e-9);

  double worst = 2;
  Point<dim> place;
  for (const auto &cell : mesh->triangulation().active_cell_iterators())
    if (cell_shape_quality(cell) < worst)
      {
        worst = cell_shape_quality(cell);
        place = cell->center();
      }
  EXPECT_EQ(survey.qualities[survey.worst_cell], worst);
  EXPECT_LT(survey.worst_place.distance(place), 1e-12);
}
