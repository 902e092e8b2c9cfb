// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_data.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ACF
{
  namespace
  {
    InputError
    mirror_error(const MeshSource &source,
                 const std::string &found,
                 const std::string &allowed)
    {
      return InputError(source.section,
                        "Mirror",
                        "'" + source.name + "' with " + found,
                        allowed);
    }

    /** Add the images of vertices; the result are their numbers, which are
     * those of the vertices themselves on the plane. */
    std::vector<unsigned int>
    mirror_vertices(std::vector<Point<dim>> &vertices,
                    const unsigned int axis,
                    const MeshSource &source)
    {
      const std::string plane = std::string(1, "xyz"[axis]) + " = 0";
      Point<dim> lower = vertices.front(), upper = lower;
      for (const Point<dim> &vertex : vertices)
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = std::min(lower[d], vertex[d]);
            upper[d] = std::max(upper[d], vertex[d]);
          }
      const double tolerance = 1e-7 * lower.distance(upper);
      if (lower[axis] < -tolerance && upper[axis] > tolerance)
        {
          const auto [first, last] =
            std::minmax_element(vertices.begin(),
                                vertices.end(),
                                [&](const auto &a, const auto &b) {
                                  return a[axis] < b[axis];
                                });
          throw mirror_error(source,
                             "vertices on both sides of the plane " + plane +
                               ": " + describe_point(*first) + " and " +
                               describe_point(*last),
                             "half a body, on one side of the plane");
        }

      const unsigned int n_vertices = vertices.size();
      std::vector<unsigned int> image(n_vertices);
      unsigned int n_on_plane = 0;
      for (unsigned int v = 0; v < n_vertices; ++v)
        {
          Point<dim> vertex = vertices[v];
          image[v]          = v;
          if (std::abs(vertex[axis]) <= tolerance)
            {
              vertices[v][axis] = 0;
              ++n_on_plane;
              continue;
            }
          vertex[axis] = -vertex[axis];
          image[v]     = vertices.size();
          vertices.push_back(vertex);
        }
      if (n_on_plane < 3)
        throw mirror_error(source,
                           std::to_string(n_on_plane) +
                             " vertices on the plane " + plane,
                           "half a body that ends on the plane with a face");
      return image;
    }

    /** Add the images of faces and their surfaces; drop faces on the plane. */
    void
    mirror_surfaces(MeshData &data,
                    const std::vector<unsigned int> &image,
                    const MeshSource &source)
    {
      types::boundary_id offset = 0;
      for (const CellData<dim - 1> &face : data.faces)
        offset = std::max(offset, face.boundary_id);

      std::vector<CellData<dim - 1>> faces;
      std::set<types::boundary_id> used_ids;
      for (CellData<dim - 1> face : data.faces)
        if (std::any_of(face.vertices.begin(),
                        face.vertices.end(),
                        [&](const unsigned int v) { return image[v] != v; }))
          {
            faces.push_back(face);
            used_ids.insert(face.boundary_id);
            for (unsigned int &vertex : face.vertices)
              vertex = image[vertex];
            face.boundary_id += offset;
            faces.push_back(face);
          }
      data.faces = std::move(faces);

      const auto surfaces = data.surfaces;
      for (const auto &[name, ids] : surfaces)
        {
          for (const std::string suffix : {" mirrored", " both"})
            if (surfaces.count(name + suffix) > 0)
              throw mirror_error(source,
                                 "a surface '" + name + suffix + "'",
                                 "names that mirrored surfaces do not get");
          for (const types::boundary_id id : ids)
            {
              data.surfaces[name + " mirrored"].insert(id + offset);
              data.surfaces[name + " both"].insert(
                {id, static_cast<types::boundary_id>(id + offset)});
            }
        }
      drop_empty_surfaces(data);
    }
  } // namespace

  void
  mirror_mesh(MeshData &data, const unsigned int axis, const MeshSource &source)
  {
    const std::vector<unsigned int> image =
      mirror_vertices(data.vertices, axis, source);

    const std::size_t n_cells = data.cells.size();
    for (std::size_t c = 0; c < n_cells; ++c)
      {
        CellData<dim> cell = data.cells[c];
        for (unsigned int &vertex : cell.vertices)
          vertex = image[vertex];
        // a mirrored cell is inverted unless its numbering is mirrored too
        std::swap(cell.vertices[0], cell.vertices[1]);
        for (unsigned int v = 2; cell.vertices.size() == 8 && v < 8; v += 2)
          std::swap(cell.vertices[v], cell.vertices[v + 1]);
        data.cells.push_back(cell);
      }
    if (!data.cell_numbers.empty())
      for (std::size_t c = 0; c < n_cells; ++c)
        data.cell_numbers.push_back(data.cell_numbers[c]);

    const auto curved_edges = data.curved_edges;
    for (const auto &[edge, node] : curved_edges)
      {
        Point<dim> mirrored = node;
        if (image[edge.first] == edge.first &&
            image[edge.second] == edge.second)
          mirrored[axis] = 0; // as both ends are on the plane
        else
          mirrored[axis] = -mirrored[axis];
        data
          .curved_edges[std::minmax({image[edge.first], image[edge.second]})] =
          mirrored;
      }
    mirror_surfaces(data, image, source);
  }
} // namespace ACF
