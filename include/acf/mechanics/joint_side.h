// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_joint_side_h
#define acf_mechanics_joint_side_h

#include <acf/mechanics/body.h>
#include <acf/mechanics/marker_function.h>

#include <optional>
#include <set>

namespace ACF
{
  /** A surface of a body, as model files name it: "BODY: SURFACE". */
  struct SurfaceName
  {
    std::string body;
    std::string surface;
  };

  /**
   * Splits "BODY: SURFACE".
   * @throws InputError naming @p section and @p entry if it has another form
   */
  SurfaceName
  parse_surface_name(const std::string &text,
                     const std::string &section,
                     const std::string &entry);

  /**
   * The body of a name, or all parts of the divided body of that name.
   * @throws InputError that names the bodies that exist
   */
  std::vector<unsigned int>
  find_bodies(const std::vector<Body> &bodies,
              const std::string &name,
              const std::string &section,
              const std::string &entry);

  /** A surface of one of the bodies. */
  struct BodySurface
  {
    unsigned int body;
    Surface surface;
  };

  /**
   * The surface "BODY: SURFACE"; of a divided body, those of the parts that
   * have some of it.
   * @throws InputError that names the bodies or surfaces that exist
   */
  std::vector<BodySurface>
  find_surfaces(const std::string &text,
                const std::vector<Body> &bodies,
                const std::string &section,
                const std::string &entry);

  /** The same, @throws InputError also if several parts share the surface */
  BodySurface
  find_surface(const std::string &text,
               const std::vector<Body> &bodies,
               const std::string &section,
               const std::string &entry);



  /** A functional of a surface of one of the bodies. */
  struct Marker
  {
    unsigned int body;
    Surface surface;
    NodalFunctional functional;

    /** Whether it is a mean position (m); else a director (no unit). */
    bool is_position;
  };

  /**
   * The markers through which a joint, a force element or a probe sees the
   * bodies.
   */
  class MarkerSet
  {
  public:
    /** @return the number of the marker, an old one if it exists */
    unsigned int
    add(const Marker &marker);

    const std::vector<Marker> &
    markers() const
    {
      return set;
    }

    /** Values for nodal positions or velocities of all bodies, size 3 n. */
    Eigen::VectorXd
    values(const std::vector<NodalVector> &x) const;

  private:
    std::vector<Marker> set;
  };



  /**
   * A unit vector that turns with a surface,
   * $d = \text{along} + \text{normal}\ (\text{first} \times \text{second})$.
   * The second part serves the normal of plane surfaces, whose mean direction
   * no functional of the surface gives.
   */
  struct SurfaceDirection
  {
    MarkerExpression along;
    double normal = 0;
    MarkerExpression first;
    MarkerExpression second;

    Vector3
    operator()(const Eigen::VectorXd &marker_values) const;
  };

  /** Adds $c\, v \cdot d$. */
  void
  add_product(MarkerPolynomial &polynomial,
              const double c,
              const MarkerExpression &v,
              const SurfaceDirection &d);

  /** Adds $c\, d \cdot e$. */
  void
  add_product(MarkerPolynomial &polynomial,
              const double c,
              const SurfaceDirection &d,
              const SurfaceDirection &e);



  /**
   * One side of a joint: a surface of a body, or the ground. Directions are
   * those of the placement of the body, in world axes.
   */
  class JointSide
  {
  public:
    /** The ground. */
    JointSide() = default;

    /**
     * @param text "BODY: SURFACE" or "ground"
     * @throws InputError that names what exists
     */
    JointSide(const std::string &text,
              const std::vector<Body> &bodies,
              const std::string &section,
              const std::string &entry);

    bool
    is_ground() const
    {
      return side_body == nullptr;
    }

    /** @pre not the ground */
    unsigned int
    body_index() const
    {
      return index;
    }

    /** Whether a marker is one of the side's surface. */
    bool
    owns(const Marker &marker) const
    {
      return !is_ground() && marker.body == index && marker.surface == surface;
    }

    /** Shortest side of the body's size, m; zero for the ground. */
    double
    length() const;

    /** Mean position. @pre not the ground */
    MarkerExpression
    position(MarkerSet &markers) const;

    /** Its value at the placement, m. @pre not the ground */
    Vector3
    start_position() const;

    /** A unit vector that turns with the surface; constant for the ground. */
    SurfaceDirection
    direction(MarkerSet &markers, const Vector3 &unit_vector) const;

    /** Whether direction() is a director without the normal's product. */
    bool
    resolves(const Vector3 &unit_vector) const;

    /** See SurfaceGeometry::extent(), m; zero for the ground. */
    double
    extent(const Vector3 &unit_vector) const;

    /**
     * Directions in which the surface extends, the principal axes of its second
     * moment, with their extents (m); two or three. @pre not the ground
     */
    std::vector<std::pair<Vector3, double>>
    principal_directions() const;

  private:
    MarkerExpression
    director(MarkerSet &markers, const Vector3 &unit_vector) const;

    /** Unit normal of a plane surface in world axes; zero for others. */
    Vector3
    plane_normal() const;

    const Body *side_body = nullptr;
    unsigned int index    = 0;
    Surface surface;
    SurfaceGeometry geometry;
  };

  /** Two unit vectors so that they and a unit vector are right-handed. */
  std::array<Vector3, 2>
  perpendicular(const Vector3 &axis);
} // namespace ACF

#endif
