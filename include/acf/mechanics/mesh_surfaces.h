// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_surfaces_h
#define acf_mechanics_mesh_surfaces_h

#include <acf/mechanics/mesh_data.h>

#include <array>
#include <string>
#include <vector>

namespace ACF
{
  /** A surface that is selected by its place: one of the entry 'Surfaces'. */
  struct SurfaceSelection
  {
    enum class Shape
    {
      plane,
      cylinder,
      box
    };

    std::string name;

    Shape shape = Shape::plane;

    /** A point of the plane or of the axis; the corner of the box with the
     * smallest coordinates, m. */
    Point<dim> point;

    /** Unit normal of the plane, or unit vector along the axis. */
    Vector3 direction;

    /** Of the cylinder, m. */
    double radius = 0;

    /** The corner of the box with the largest coordinates, m. */
    Point<dim> corner;

    /** How far vertices may be from the shape, m; 0: 1e-5 of the diagonal of
     * the bounding box of the mesh. */
    double tolerance = 0;

    /** What the user wrote, for messages. */
    std::string text;

    /** Distance of a point from the plane, from the surface of the cylinder, or
     * from the solid box (0 in it), m. */
    double
    distance(const Point<dim> &x) const;

    /** The tolerance, or its default for a mesh with this diagonal. */
    double
    tolerance_for(const double diagonal) const;
  };

  /**
   * Read "NAME: plane x y z nx ny nz; NAME: cylinder x y z ax ay az r;
   * NAME: box x1 y1 z1 x2 y2 z2", each with " tolerance t" after it or not.
   * @param section path of the body's subsection, for errors
   * @throws InputError if the text has another form
   */
  std::vector<SurfaceSelection>
  parse_surfaces(const std::string &text, const std::string &section);

  /** Diagonal of the bounding box of the vertices. */
  double
  mesh_diagonal(const std::vector<Point<dim>> &vertices);

  /**
   * Give names to faces on the boundary all of whose vertices are on a plane or
   * the surface of a cylinder, or in a box, up to the tolerance. Faces that are
   * more across the axis of a cylinder than along it do not belong to its
   * surface. Faces keep the names that they have.
   * @throws InputError if no face is selected, or the name exists
   */
  void
  select_surfaces(MeshData &data,
                  const std::vector<SurfaceSelection> &selections,
                  const MeshSource &source);
} // namespace ACF

#endif
