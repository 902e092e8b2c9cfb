// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_surface_shape_h
#define acf_mechanics_surface_shape_h

#include <acf/base/types.h>

#include <deal.II/base/point.h>

#include <vector>

namespace ACF
{
  /** A flat piece of a surface, in place of a curved one too. */
  struct Facet
  {
    Point<dim> centre;

    /** Out of the body, of length one. */
    Vector3 normal;

    /** m^2 */
    double area = 0;
  };

  /** What a surface is, as far as the vertices of its mesh show. */
  struct SurfaceShape
  {
    enum class Kind
    {
      plane,
      cylinder,
      sphere,
      other
    };

    Kind kind = Kind::other;

    /** Of a plane: the normal out of the body; of a cylinder: the axis. */
    Vector3 direction;

    /** On the plane, on the axis in the middle of the cylinder, or the
     * centre. */
    Point<dim> point;

    /** Of a cylinder or a sphere, m. */
    double radius = 0;

    /** Whether the body is outside of the cylinder or the sphere. */
    bool is_hole = false;
  };

  /**
   * Fits a plane, a circular cylinder and a sphere to the vertices of a
   * surface, in this order, and takes the first one that all vertices lie on,
   * up to 1e-5 of the size of the surface. Of the curved ones the centres of
   * the facets must not lie deeper than a tenth of the radius: the sides of a
   * box are no cylinder, those of an eight-sided prism are.
   */
  SurfaceShape
  surface_shape(const std::vector<Point<dim>> &vertices,
                const std::vector<Facet> &facets);
} // namespace ACF

#endif
