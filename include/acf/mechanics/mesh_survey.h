// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_survey_h
#define acf_mechanics_mesh_survey_h

#include <acf/mechanics/mesh.h>
#include <acf/mechanics/surface_shape.h>

#include <string>
#include <vector>

namespace ACF
{
  /** What joints see of a surface, and what it looks like. */
  struct SurfaceSurvey
  {
    std::string name;

    unsigned int n_faces = 0;

    /** Parts of the surface that have no vertex in common. */
    unsigned int n_pieces = 0;

    /** m^2 */
    double area = 0;

    /** Mean position, m. */
    Point<dim> centre;

    SurfaceShape shape;
  };

  /** A named part of the volume. */
  struct RegionSurvey
  {
    std::string name;

    unsigned int n_cells = 0;

    /** m^3 */
    double volume = 0;
  };

  /** What a mesh is before anything is computed with it. */
  struct MeshSurvey
  {
    /** Corners of the bounding box of the vertices, m. */
    Point<dim> lower;
    Point<dim> upper;

    /** m^3 */
    double volume = 0;

    /** Of the volume, m. */
    Point<dim> centre;

    /** About the centre, of the density one: $\int (r^2 I - r r^T)\, dV$, m^5.
     */
    Matrix3 inertia;

    /** Edges, m. */
    double shortest_edge = 0;
    double longest_edge  = 0;

    /** Of each cell, see cell_shape_quality(). */
    std::vector<double> qualities;

    /** The index of the cell with the smallest one, and its centre, m. */
    unsigned int worst_cell = 0;
    Point<dim> worst_place;

    std::vector<RegionSurvey> regions;

    /** The named surfaces. */
    std::vector<SurfaceSurvey> surfaces;

    /** Boundary faces in no named surface, and their area, m^2. */
    unsigned int n_unnamed_faces = 0;
    double unnamed_area          = 0;
  };

  MeshSurvey
  survey_mesh(const BodyMesh &mesh);

  /**
   * How well a cell is shaped, 1 for the best: of a tetrahedron three times
   * the radius of the sphere inside over that of the sphere outside, of a
   * hexahedron the smallest determinant of the unit vectors along the three
   * edges at a vertex.
   */
  double
  cell_shape_quality(
    const typename Triangulation<dim>::active_cell_iterator &cell);
} // namespace ACF

#endif
