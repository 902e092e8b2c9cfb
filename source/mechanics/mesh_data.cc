// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_data.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "mesh_curvature.h"

namespace ACF
{
  namespace
  {
    Point<dim>
    centre(const MeshData &data, const std::vector<unsigned int> &vertices)
    {
      Point<dim> result;
      for (const unsigned int vertex : vertices)
        result += Vector3(data.vertices[vertex]);
      return result / static_cast<double>(vertices.size());
    }

    /** Derivative of the trilinear map at @p xi, one column per row. */
    Tensor<2, dim>
    derivative(const MeshData &data,
               const CellData<dim> &hexahedron,
               const Point<dim> &xi)
    {
      Tensor<2, dim> columns;
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < dim; ++d)
          {
            double slope = 1;
            for (unsigned int e = 0; e < dim; ++e)
              {
                const bool upper = ((v >> e) & 1U) != 0;
                slope *=
                  (e == d ? (upper ? 1. : -1.) : (upper ? xi[e] : 1 - xi[e]));
              }
            columns[d] +=
              slope * Vector3(data.vertices[hexahedron.vertices[v]]);
          }
      return columns;
    }

    struct CellShape
    {
      /** The smallest determinant of the derivative relative to the lengths of
       * its columns; of a tetrahedron at the vertex where it is largest. */
      double quality;

      /** The smallest determinant relative to the cube with the longest
       * distance of two vertices as diagonal. */
      double volume;
    };

    CellShape
    cell_shape(const MeshData &data, const CellData<dim> &cell)
    {
      double diameter = 0;
      for (const unsigned int v : cell.vertices)
        for (const unsigned int w : cell.vertices)
          diameter =
            std::max(diameter, data.vertices[v].distance(data.vertices[w]));
      const double cube = std::pow(diameter / std::sqrt(3.), 3);

      if (data.reference_cell == ReferenceCells::Hexahedron)
        {
          CellShape shape{1, 1};
          for (unsigned int p = 0; p < 27; ++p)
            {
              const Tensor<2, dim> columns = derivative(
                data,
                cell,
                Point<dim>(0.5 * (p % 3), 0.5 * (p / 3 % 3), 0.5 * (p / 9)));
              const double lengths =
                columns[0].norm() * columns[1].norm() * columns[2].norm();
              const double jacobian = determinant(columns);
              const double quality  = lengths > 0 ? jacobian / lengths : 0.;
              // in this order, not-a-number is the worst of all
              shape.quality =
                (quality >= shape.quality ? shape.quality : quality);
              shape.volume =
                (jacobian / cube >= shape.volume ? shape.volume
                                                 : jacobian / cube);
            }
          return shape;
        }

      const auto vertex = [&](const unsigned int v) {
        return Vector3(data.vertices[cell.vertices[v % 4]]);
      };
      const Vector3 a = vertex(1) - vertex(0), b = vertex(2) - vertex(0),
                    c = vertex(3) - vertex(0);
      double smallest = std::numeric_limits<double>::infinity();
      for (unsigned int v = 0; v < 4; ++v)
        smallest = std::min(smallest,
                            (vertex(v + 1) - vertex(v)).norm() *
                              (vertex(v + 2) - vertex(v)).norm() *
                              (vertex(v + 3) - vertex(v)).norm());
      const double jacobian = cross_product_3d(a, b) * c;
      return {smallest > 0 ? jacobian / smallest : 0., jacobian / cube};
    }

    void
    check_duplicates(const MeshData &data, const MeshSource &source)
    {
      std::vector<std::pair<std::vector<unsigned int>, unsigned int>> cells;
      for (unsigned int c = 0; c < data.cells.size(); ++c)
        {
          cells.emplace_back(data.cells[c].vertices, c);
          std::sort(cells.back().first.begin(), cells.back().first.end());
        }
      std::sort(cells.begin(), cells.end());
      for (std::size_t i = 1; i < cells.size(); ++i)
        if (cells[i - 1].first == cells[i].first)
          throw source.error("duplicate cells with the same vertices, " +
                               describe_cell(data, cells[i - 1].second) +
                               " and " + describe_cell(data, cells[i].second),
                             "each cell once");
    }

    /** Are the centres of two cells on one side of their common face? */
    bool
    on_one_side(const MeshData &data,
                const FaceKey &face,
                const unsigned int cell_a,
                const unsigned int cell_b)
    {
      const Vector3 origin(data.vertices[face[0]]);
      const Vector3 normal =
        cross_product_3d(Vector3(data.vertices[face[1]]) - origin,
                         Vector3(data.vertices[face[2]]) - origin);
      const auto side = [&](const unsigned int cell) {
        return normal *
                 (Vector3(centre(data, data.cells[cell].vertices)) - origin) >
               0;
      };
      return side(cell_a) == side(cell_b);
    }

    /** Entries i - 1 and i of the face table must be the only ones of their
     * face, on either side of it. */
    void
    check_neighbors(const MeshData &data,
                    const std::vector<std::pair<FaceKey, unsigned int>> &table,
                    const std::size_t i,
                    const MeshSource &source)
    {
      const FaceKey &face         = table[i].first;
      const unsigned int cell     = table[i].second;
      const unsigned int neighbor = table[i - 1].second;
      const auto describe         = [&](const unsigned int index) {
        return describe_cell(data, index);
      };
      if (i + 1 < table.size() && table[i + 1].first == face)
        throw source.error("three cells with one common face: " +
                             describe(neighbor) + ", " + describe(cell) +
                             " and " + describe(table[i + 1].second),
                           "two cells at each face inside the body");
      if (on_one_side(data, face, neighbor, cell))
        throw source.error(
          "overlapping cells, on the same side of their "
          "common face: " +
            describe(neighbor) + " and " + describe(cell),
          "cells that do not overlap");
    }

    /** Number of the connected part of each cell, counted from 0. */
    std::vector<unsigned int>
    find_parts(const MeshData &data,
               const std::vector<std::pair<FaceKey, unsigned int>> &table)
    {
      std::vector<std::vector<unsigned int>> neighbors(data.cells.size());
      for (std::size_t i = 1; i < table.size(); ++i)
        if (table[i].first == table[i - 1].first)
          {
            neighbors[table[i].second].push_back(table[i - 1].second);
            neighbors[table[i - 1].second].push_back(table[i].second);
          }
      std::vector<unsigned int> parts(data.cells.size(),
                                      numbers::invalid_unsigned_int);
      unsigned int n_parts = 0;
      for (unsigned int seed = 0; seed < parts.size(); ++seed)
        {
          if (parts[seed] != numbers::invalid_unsigned_int)
            continue;
          std::vector<unsigned int> stack = {seed};
          parts[seed]                     = n_parts;
          while (!stack.empty())
            {
              const unsigned int cell = stack.back();
              stack.pop_back();
              for (const unsigned int neighbor : neighbors[cell])
                if (parts[neighbor] == numbers::invalid_unsigned_int)
                  {
                    parts[neighbor] = n_parts;
                    stack.push_back(neighbor);
                  }
            }
          ++n_parts;
        }
      return parts;
    }

    /** The faces of surfaces must be those of one cell each. */
    void
    check_surfaces(MeshData &data,
                   const std::vector<std::pair<FaceKey, unsigned int>> &table,
                   const MeshSource &source)
    {
      std::map<types::boundary_id, std::string> names;
      for (const auto &[name, ids] : data.surfaces)
        for (const types::boundary_id id : ids)
          names[id] += (names[id].empty() ? "'" : ", '") + name + "'";

      std::vector<CellData<dim - 1>> boundary_faces;
      std::map<FaceKey, types::boundary_id> known;
      for (const CellData<dim - 1> &face : data.faces)
        {
          const FaceKey key   = make_face_key(face.vertices);
          const auto first    = std::lower_bound(table.begin(),
                                              table.end(),
                                              std::make_pair(key, 0U));
          std::size_t n_cells = 0;
          for (auto i = first; i != table.end() && i->first == key; ++i)
            ++n_cells;
          if (n_cells != 1 && data.surfaces_of_geometry)
            continue;

          const std::string where =
            "with a face at " + describe_point(centre(data, face.vertices));
          if (n_cells != 1)
            throw source.error("surface " + names[face.boundary_id] + " " +
                                 where +
                                 (n_cells == 0
                                    ? " that is no face of a cell"
                                    : " inside the body, between two cells"),
                               "faces on the boundary of the body");
          const auto [entry, is_new] = known.try_emplace(key, face.boundary_id);
          if (!is_new && entry->second != face.boundary_id)
            throw source.error(
              "surfaces " + names[entry->second] + " and " +
                names[face.boundary_id] + " " + where + " that is listed twice",
              "each face once, in an entity with several groups");
          boundary_faces.push_back(face);
        }
      data.faces = std::move(boundary_faces);
    }
  } // namespace

  InputError
  MeshSource::error(const std::string &found, const std::string &allowed) const
  {
    return InputError(section, "Mesh", "'" + name + "': " + found, allowed);
  }

  std::string
  describe_point(const Point<dim> &point)
  {
    std::ostringstream text;
    text << "(" << point[0] << ", " << point[1] << ", " << point[2] << ")";
    return text.str();
  }

  std::string
  describe_cell(const MeshData &data, const std::size_t index)
  {
    return "element " +
           std::to_string(
             data.cell_numbers.empty() ? index + 1 : data.cell_numbers[index]) +
           " at " + describe_point(centre(data, data.cells[index].vertices));
  }

  FaceKey
  make_face_key(const std::vector<unsigned int> &vertices)
  {
    FaceKey key;
    key.fill(numbers::invalid_unsigned_int);
    std::copy(vertices.begin(), vertices.end(), key.begin());
    std::sort(key.begin(), key.end());
    return key;
  }

  std::vector<std::pair<FaceKey, unsigned int>>
  make_face_table(const MeshData &data)
  {
    const ReferenceCell &reference_cell = data.reference_cell;
    std::vector<std::pair<FaceKey, unsigned int>> table;
    for (unsigned int c = 0; c < data.cells.size(); ++c)
      for (const unsigned int f : reference_cell.face_indices())
        {
          const auto n = reference_cell.face_reference_cell(f).n_vertices();
          std::vector<unsigned int> vertices(n);
          for (unsigned int v = 0; v < n; ++v)
            vertices[v] =
              data.cells[c]
                .vertices[reference_cell.face_to_cell_vertices(f, v, 1)];
          table.emplace_back(make_face_key(vertices), c);
        }
    std::sort(table.begin(), table.end());
    return table;
  }

  void
  check_cells(const MeshData &data, const MeshSource &source)
  {
    constexpr double smallest_quality = 1e-6;
    constexpr double smallest_volume  = 1e-11; // deal.II's bound is 1e-12
    std::vector<unsigned int> inverted, degenerate;
    for (unsigned int c = 0; c < data.cells.size(); ++c)
      {
        const CellShape shape = cell_shape(data, data.cells[c]);
        if (shape.quality < -smallest_quality)
          inverted.push_back(c);
        else if (!(shape.quality > smallest_quality &&
                   shape.volume > smallest_volume))
          degenerate.push_back(c);
      }
    if (!inverted.empty())
      throw source.error(std::to_string(inverted.size()) +
                           " inverted cells (with negative volume, or with "
                           "negative Jacobian somewhere), the first: " +
                           describe_cell(data, inverted.front()),
                         "cells with positive volume");
    if (!degenerate.empty())
      throw source.error(std::to_string(degenerate.size()) +
                           " degenerate cells (without volume, without angle "
                           "at a vertex, or like needles), the first: " +
                           describe_cell(data, degenerate.front()),
                         "cells with a volume not negligible for their edges");
    if (!data.curved_edges.empty())
      check_curved_cells(data, source);
  }

  void
  check_topology(MeshData &data, const MeshSource &source)
  {
    check_duplicates(data, source);
    const auto table = make_face_table(data);
    for (std::size_t i = 1; i < table.size(); ++i)
      if (table[i].first == table[i - 1].first)
        check_neighbors(data, table, i, source);
    check_surfaces(data, table, source);
    drop_empty_surfaces(data);

    std::map<unsigned int, std::pair<std::size_t, unsigned int>> parts;
    const std::vector<unsigned int> part_of_cell = find_parts(data, table);
    for (unsigned int c = 0; c < part_of_cell.size(); ++c)
      ++parts.try_emplace(part_of_cell[c], 0, c).first->second.first;
    if (parts.size() > 1)
      {
        std::string list;
        for (const auto &part : parts)
          if (part.first < 3)
            list += (part.first > 0 ? "; " : "") +
                    std::to_string(part.second.first) + " cells from " +
                    describe_cell(data, part.second.second);
        throw source.error(std::to_string(parts.size()) +
                             " parts that no common face connects: " + list +
                             (parts.size() > 3 ? "; ..." : ""),
                           "one connected body, whose parts share the vertices "
                           "of common faces (Coherence or BooleanFragments in "
                           "gmsh)");
      }
  }

  void
  drop_empty_surfaces(MeshData &data)
  {
    std::set<types::boundary_id> used_ids;
    for (const CellData<dim - 1> &face : data.faces)
      used_ids.insert(face.boundary_id);
    std::map<std::string, std::set<types::boundary_id>> surfaces;
    for (const auto &[name, ids] : data.surfaces)
      for (const types::boundary_id id : ids)
        if (used_ids.count(id) > 0)
          surfaces[name].insert(id);
    data.surfaces = std::move(surfaces);
  }

  void
  drop_unused_vertices(MeshData &data)
  {
    std::vector<unsigned int> new_index(data.vertices.size(),
                                        numbers::invalid_unsigned_int);
    for (const CellData<dim> &cell : data.cells)
      for (const unsigned int vertex : cell.vertices)
        new_index[vertex] = 0;
    std::vector<Point<dim>> vertices;
    for (unsigned int v = 0; v < data.vertices.size(); ++v)
      if (new_index[v] == 0)
        {
          new_index[v] = vertices.size();
          vertices.push_back(data.vertices[v]);
        }
    data.vertices = std::move(vertices);
    for (CellData<dim> &cell : data.cells)
      for (unsigned int &vertex : cell.vertices)
        vertex = new_index[vertex];
    for (CellData<dim - 1> &face : data.faces)
      for (unsigned int &vertex : face.vertices)
        vertex = new_index[vertex];
    // the order of the vertices has not changed
    std::map<std::pair<unsigned int, unsigned int>, Point<dim>> curved_edges;
    for (const auto &[edge, node] : data.curved_edges)
      {
        const unsigned int a = new_index[edge.first];
        const unsigned int b = new_index[edge.second];
        if (a != numbers::invalid_unsigned_int &&
            b != numbers::invalid_unsigned_int)
          curved_edges[{a, b}] = node;
      }
    data.curved_edges = std::move(curved_edges);
  }
} // namespace ACF
