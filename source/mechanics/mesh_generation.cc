// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_generation.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace ACF
{
  namespace
  {
    /** A quadrilateral mesh in the plane, to be extruded. */
    struct CrossSection
    {
      std::vector<Point<2>> points;

      /** Vertices in deal.II's numbering, counter-clockwise area positive. */
      std::vector<std::array<unsigned int, 4>> quadrilaterals;

      /** Ends of the boundary lines, and the ids of the faces they sweep. */
      std::vector<std::pair<std::array<unsigned int, 2>, types::boundary_id>>
        lines;
    };

    CellData<dim - 1>
    make_face(const std::vector<unsigned int> &vertices,
              const types::boundary_id id)
    {
      CellData<dim - 1> face(vertices.size());
      face.vertices    = vertices;
      face.boundary_id = id;
      return face;
    }

    /**
     * Repeat a cross section in layers.
     * @param place position of a point of the section in layer k, 0 to n_layers
     */
    MeshData
    extrude(const CrossSection &section,
            const std::function<Point<dim>(Point<2>, unsigned int)> &place,
            const unsigned int n_layers,
            const types::boundary_id start_id,
            const types::boundary_id end_id)
    {
      MeshData data;
      data.reference_cell         = ReferenceCells::Hexahedron;
      const unsigned int n_points = section.points.size();
      for (unsigned int layer = 0; layer <= n_layers; ++layer)
        for (const Point<2> &point : section.points)
          data.vertices.push_back(place(point, layer));

      for (unsigned int layer = 0; layer < n_layers; ++layer)
        {
          const unsigned int below = layer * n_points;
          const unsigned int above = below + n_points;
          for (const auto &quadrilateral : section.quadrilaterals)
            {
              CellData<dim> cell(8);
              for (unsigned int v = 0; v < 4; ++v)
                {
                  cell.vertices[v]     = below + quadrilateral[v];
                  cell.vertices[v + 4] = above + quadrilateral[v];
                }
              cell.material_id = 1;
              data.cells.push_back(cell);
            }
          for (const auto &[ends, id] : section.lines)
            data.faces.push_back(make_face({below + ends[0],
                                            below + ends[1],
                                            above + ends[0],
                                            above + ends[1]},
                                           id));
        }

      const unsigned int last = n_layers * n_points;
      for (const auto &q : section.quadrilaterals)
        {
          data.faces.push_back(make_face({q[0], q[1], q[2], q[3]}, start_id));
          data.faces.push_back(
            make_face({last + q[0], last + q[1], last + q[2], last + q[3]},
                      end_id));
        }
      data.regions["body"] = {1};
      return data;
    }

    /**
     * Split each hexahedron into 24 tetrahedra: its centre, the centre of one
     * of its faces and one edge of that face are the vertices of each.
     */
    MeshData
    split_hexahedra(const MeshData &hexahedra)
    {
      MeshData data       = hexahedra;
      data.reference_cell = ReferenceCells::Tetrahedron;
      data.cells.clear();
      data.faces.clear();

      const auto centre_of = [&](const std::vector<unsigned int> &vertices) {
        Point<dim> centre;
        for (const unsigned int vertex : vertices)
          centre += Vector3(hexahedra.vertices[vertex]);
        data.vertices.push_back(centre / static_cast<double>(vertices.size()));
        return static_cast<unsigned int>(data.vertices.size() - 1);
      };
      // deal.II numbers the vertices of a quadrilateral line by line
      constexpr std::array<std::array<unsigned int, 2>, 4> lines = {
        {{{0, 1}}, {{1, 3}}, {{3, 2}}, {{2, 0}}}};

      std::map<std::vector<unsigned int>, unsigned int> face_centres;
      const auto face_centre = [&](std::vector<unsigned int> vertices) {
        std::sort(vertices.begin(), vertices.end());
        const auto known = face_centres.find(vertices);
        if (known != face_centres.end())
          return known->second;
        return face_centres[vertices] = centre_of(vertices);
      };

      for (const CellData<dim> &hexahedron : hexahedra.cells)
        {
          const unsigned int cell_centre = centre_of(hexahedron.vertices);
          for (const unsigned int f : GeometryInfo<dim>::face_indices())
            {
              std::vector<unsigned int> face(4);
              for (unsigned int v = 0; v < 4; ++v)
                face[v] =
                  hexahedron
                    .vertices[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
              const unsigned int centre = face_centre(face);
              for (const auto &line : lines)
                {
                  CellData<dim> cell(4);
                  cell.material_id         = hexahedron.material_id;
                  cell.vertices            = {face[line[0]],
                                              face[line[1]],
                                              centre,
                                              cell_centre};
                  const Point<dim> &origin = data.vertices[cell.vertices[0]];
                  const Vector3 normal =
                    cross_product_3d(Vector3(data.vertices[cell.vertices[1]] -
                                             origin),
                                     Vector3(data.vertices[centre] - origin));
                  if (normal * (data.vertices[cell_centre] - origin) < 0)
                    std::swap(cell.vertices[0], cell.vertices[1]);
                  data.cells.push_back(cell);
                }
            }
        }
      for (const CellData<dim - 1> &face : hexahedra.faces)
        for (const auto &line : lines)
          data.faces.push_back(make_face({face.vertices[line[0]],
                                          face.vertices[line[1]],
                                          face_centre(face.vertices)},
                                         face.boundary_id));
      return data;
    }

    /** Points around a square of (n + 1)^2 points, counter-clockwise. */
    std::vector<unsigned int>
    square_boundary(const unsigned int n)
    {
      std::vector<unsigned int> points;
      for (unsigned int i = 0; i < n; ++i)
        points.push_back(i);
      for (unsigned int j = 0; j < n; ++j)
        points.push_back(j * (n + 1) + n);
      for (unsigned int i = n; i > 0; --i)
        points.push_back(n * (n + 1) + i);
      for (unsigned int j = n; j > 0; --j)
        points.push_back(j * (n + 1));
      return points;
    }

    /**
     * A disc of unit radius: a square of cells with bulged sides and rings
     * around it, with boundary id 3.
     */
    CrossSection
    make_disc(const unsigned int n_cells_across)
    {
      const unsigned int n_rings  = std::max(1U, (n_cells_across + 2) / 4);
      const unsigned int n_square = n_cells_across - 2 * n_rings;
      const auto point_of_square  = [&](unsigned int i, unsigned int j) {
        return j * (n_square + 1) + i;
      };

      // The point (s, t) of [-1, 1]^2, spaced to give equal angles, moves
      // towards a circle through the corners by the fraction "bulge".
      constexpr double bulge   = 0.4;
      const double side_radius = 1 + bulge * (std::sqrt(2.) - 1);
      const double scale =
        static_cast<double>(n_square) / n_cells_across / side_radius;
      const auto spacing = [&](const unsigned int i) {
        const int twice = 2 * static_cast<int>(i) - static_cast<int>(n_square);
        return std::tan(numbers::PI_4 * twice / n_square);
      };
      CrossSection disc;
      for (unsigned int j = 0; j <= n_square; ++j)
        for (unsigned int i = 0; i <= n_square; ++i)
          {
            const Point<2> square(spacing(i), spacing(j));
            const double radius = square.norm();
            const double shell =
              std::max(std::abs(square[0]), std::abs(square[1]));
            const double circle =
              (radius > 0 ? std::sqrt(2.) * shell / radius : 1.);
            disc.points.push_back(
              Point<2>(scale * (1 - bulge + bulge * circle) * square));
          }
      for (unsigned int j = 0; j < n_square; ++j)
        for (unsigned int i = 0; i < n_square; ++i)
          disc.quadrilaterals.push_back({{point_of_square(i, j),
                                          point_of_square(i + 1, j),
                                          point_of_square(i, j + 1),
                                          point_of_square(i + 1, j + 1)}});

      std::vector<unsigned int> inner             = square_boundary(n_square);
      const std::vector<unsigned int> square_side = inner;
      const std::size_t n_around                  = inner.size();
      for (unsigned int ring = 1; ring <= n_rings; ++ring)
        {
          std::vector<unsigned int> outer;
          const double fraction = static_cast<double>(ring) / n_rings;
          for (const unsigned int p : square_side)
            {
              const double radius = disc.points[p].norm();
              outer.push_back(disc.points.size());
              disc.points.push_back(Point<2>(
                disc.points[p] * ((1 - fraction) + fraction / radius)));
            }
          for (std::size_t p = 0; p < n_around; ++p)
            {
              const std::size_t next = (p + 1) % n_around;
              disc.quadrilaterals.push_back(
                {{inner[p], outer[p], inner[next], outer[next]}});
              if (ring == n_rings)
                disc.lines.push_back({{{outer[p], outer[next]}}, 3});
            }
          inner = outer;
        }
      return disc;
    }
  } // namespace

  MeshData
  generate_box(const Point<dim> &from,
               const Point<dim> &to,
               const std::array<unsigned int, dim> &n_cells,
               const ReferenceCell &reference_cell)
  {
    // so that boxes around the origin are symmetric to the last digit
    const auto coordinate = [&](const unsigned int d, const unsigned int i) {
      return (from[d] * (n_cells[d] - i) + to[d] * i) / n_cells[d];
    };
    const auto point = [&](const unsigned int i, const unsigned int j) {
      return j * (n_cells[0] + 1) + i;
    };
    CrossSection rectangle;
    for (unsigned int j = 0; j <= n_cells[1]; ++j)
      for (unsigned int i = 0; i <= n_cells[0]; ++i)
        rectangle.points.push_back(
          Point<2>(coordinate(0, i), coordinate(1, j)));
    for (unsigned int j = 0; j < n_cells[1]; ++j)
      for (unsigned int i = 0; i < n_cells[0]; ++i)
        rectangle.quadrilaterals.push_back({{point(i, j),
                                             point(i + 1, j),
                                             point(i, j + 1),
                                             point(i + 1, j + 1)}});
    for (unsigned int j = 0; j < n_cells[1]; ++j)
      {
        rectangle.lines.push_back({{{point(0, j), point(0, j + 1)}}, 1});
        rectangle.lines.push_back(
          {{{point(n_cells[0], j), point(n_cells[0], j + 1)}}, 2});
      }
    for (unsigned int i = 0; i < n_cells[0]; ++i)
      {
        rectangle.lines.push_back({{{point(i, 0), point(i + 1, 0)}}, 3});
        rectangle.lines.push_back(
          {{{point(i, n_cells[1]), point(i + 1, n_cells[1])}}, 4});
      }

    MeshData data = extrude(
      rectangle,
      [&](const Point<2> &p, const unsigned int layer) {
        return Point<dim>(p[0], p[1], coordinate(2, layer));
      },
      n_cells[2],
      5,
      6);
    data.surfaces = {{"x min", {1}},
                     {"x max", {2}},
                     {"y min", {3}},
                     {"y max", {4}},
                     {"z min", {5}},
                     {"z max", {6}}};
    return reference_cell == ReferenceCells::Tetrahedron ? split_hexahedra(data)
                                                         : data;
  }

  MeshData
  generate_cylinder(const Point<dim> &from,
                    const Point<dim> &to,
                    const double radius,
                    const unsigned int n_cells_across,
                    const unsigned int n_cells_along,
                    const ReferenceCell &reference_cell,
                    const bool is_quadratic)
  {
    const Vector3 axis = (to - from) / from.distance(to);

    // the transverse directions keep the symmetry to the coordinate planes
    unsigned int smallest = 0;
    for (unsigned int d = 1; d < dim; ++d)
      if (std::abs(axis[d]) < std::abs(axis[smallest]))
        smallest = d;
    Vector3 first;
    first[smallest] = 1;
    first -= axis[smallest] * axis;
    first /= first.norm();
    const Vector3 second = cross_product_3d(axis, first);

    MeshData data = extrude(
      make_disc(n_cells_across),
      [&](const Point<2> &p, const unsigned int layer) {
        return Point<dim>(
          (Vector3(from) * (n_cells_along - layer) + Vector3(to) * layer) /
            n_cells_along +
          radius * (p[0] * first + p[1] * second));
      },
      n_cells_along,
      1,
      2);
    data.surfaces = {{"start", {1}}, {"end", {2}}, {"side", {3}}};
    if (reference_cell == ReferenceCells::Hexahedron)
      return data;

    // the centres of the faces of the side are inside the radius
    const auto on_side = [&](const Point<dim> &point) {
      const Vector3 distance = point - from;
      const Vector3 axial    = (distance * axis) * axis;
      const Vector3 radial   = distance - axial;
      return from + axial + radius / radial.norm() * radial;
    };
    const unsigned int n_vertices = data.vertices.size();
    data                          = split_hexahedra(data);
    for (const CellData<dim - 1> &face : data.faces)
      for (const unsigned int vertex : face.vertices)
        if (face.boundary_id == 3 && vertex >= n_vertices)
          data.vertices[vertex] = on_side(data.vertices[vertex]);
    if (is_quadratic)
      for (const CellData<dim - 1> &face : data.faces)
        for (unsigned int v = 0; face.boundary_id == 3 && v < 3; ++v)
          add_edge_node(data,
                        face.vertices[v],
                        face.vertices[(v + 1) % 3],
                        on_side(edge_middle(data,
                                            face.vertices[v],
                                            face.vertices[(v + 1) % 3])));
    drop_straight_edges(data);
    return data;
  }
} // namespace ACF
