// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_data_h
#define acf_mechanics_mesh_data_h

#include <acf/base/exceptions.h>
#include <acf/base/types.h>

#include <deal.II/base/point.h>

#include <deal.II/grid/reference_cell.h>
#include <deal.II/grid/tria_description.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ACF
{
  /** Where a mesh comes from, to compose errors about it. */
  struct MeshSource
  {
    /** Path of the body's subsection. */
    std::string section;

    /** What the mesh is called in messages: the file, or the shape. */
    std::string name;

    /** An error in the mesh, to be thrown. */
    InputError
    error(const std::string &found, const std::string &allowed) const;
  };

  /**
   * A mesh of one cell type as plain data: what readers and generators make,
   * and what a BodyMesh is built from.
   */
  struct MeshData
  {
    ReferenceCell reference_cell = ReferenceCells::Tetrahedron;

    /** Coordinates in m. Vertices without a cell are allowed. */
    std::vector<Point<dim>> vertices;

    /** Cells in deal.II's numbering of vertices; the material ids are those
     * of @p regions, or 0. */
    std::vector<CellData<dim>> cells;

    /** Numbers of the cells in the file; empty: counted from 1. */
    std::vector<std::size_t> cell_numbers;

    /** The nodes in the middle of curved edges of tetrahedra, by the vertices
     * of the edge, the smaller index first. Other edges are straight. */
    std::map<std::pair<unsigned int, unsigned int>, Point<dim>> curved_edges;

    /** Boundary faces that belong to surfaces, vertices in any order; the
     * boundary ids are those of @p surfaces, never 0. */
    std::vector<CellData<dim - 1>> faces;

    /** Which ids make up a surface. A face in several surfaces has an id of its
     * own that all of them list. */
    std::map<std::string, std::set<types::boundary_id>> surfaces;

    /** Likewise for the cells. */
    std::map<std::string, std::set<types::material_id>> regions;

    /** The surfaces are all those of a geometry, not chosen by the user: their
     * faces that are not on the boundary of the body are left out. */
    bool surfaces_of_geometry = false;

    /** What the reader of a file left out, a sentence each, for people. */
    std::vector<std::string> notes;
  };

  /** "element 12 at (0, 0.5, 1)": number and centre of cell @p index. */
  std::string
  describe_cell(const MeshData &data, const std::size_t index);

  /** "(0, 0.5, 1)" */
  std::string
  describe_point(const Point<dim> &point);

  /** The middle of a straight edge. */
  Point<dim>
  edge_middle(const MeshData &data, const unsigned int a, const unsigned int b);

  /**
   * Put the node of an edge to a place.
   * @return whether the edge had no node at another place, up to 1e-10 of its
   * length
   */
  bool
  add_edge_node(MeshData &data,
                const unsigned int a,
                const unsigned int b,
                const Point<dim> &node);

  /** Forget the nodes that are in the middle of their edges, up to 1e-10 of the
   * lengths. */
  void
  drop_straight_edges(MeshData &data);

  /** Vertices of a face in ascending order; the fourth of a triangle is
   * invalid. */
  using FaceKey = std::array<unsigned int, 4>;

  FaceKey
  make_face_key(const std::vector<unsigned int> &vertices);

  /** All faces of all cells with their cells, sorted by faces. */
  std::vector<std::pair<FaceKey, unsigned int>>
  make_face_table(const MeshData &data);

  /**
   * Stop unless all cells have positive Jacobians, at 27 points of each
   * hexahedron, that are not negligible against the product of the edge lengths
   * (1e-6; for a tetrahedron, those at the best of its vertices), and curved
   * tetrahedra at 84 points one that is at least 1e-3 of that of the straight
   * one.
   * @throws InputError with the number of such cells and the first one
   */
  void
  check_cells(const MeshData &data, const MeshSource &source);

  /**
   * Stop unless the mesh is one piece, connected through faces, without
   * duplicate and overlapping neighbours, and the faces of all surfaces are on
   * its boundary. Faces of a geometry inside the body are removed instead, and
   * surfaces without faces with them.
   * @throws InputError
   */
  void
  check_topology(MeshData &data, const MeshSource &source);

  /** Forget boundary ids without faces, and surfaces without ids. */
  void
  drop_empty_surfaces(MeshData &data);

  /** Remove vertices that no cell has. @pre no face has them either */
  void
  drop_unused_vertices(MeshData &data);

  /**
   * Add the mirror image of a mesh at the plane through the origin normal to
   * coordinate @p axis. Vertices closer to the plane than 1e-7 of the size of
   * the mesh are put on it and shared by both halves. Surfaces of the image are
   * called "NAME mirrored", a surface with its image "NAME both"; faces on the
   * plane vanish, and surfaces that
   * consist of such faces only. The image belongs to the same regions.
   * @throws InputError if there are vertices on both sides of the plane, or no
   *   three on it
   */
  void
  mirror_mesh(MeshData &data,
              const unsigned int axis,
              const MeshSource &source);
} // namespace ACF

#endif
