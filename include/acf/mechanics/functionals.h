// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_functionals_h
#define acf_mechanics_functionals_h

#include <acf/base/types.h>

#include <deal.II/base/point.h>

#include <deal.II/dofs/dof_handler.h>

#include <map>
#include <set>

namespace ACF
{
  class BodyDiscretization;

  /** A surface of a mesh. */
  using Surface = std::set<types::boundary_id>;

  /**
   * A linear functional of a body's positions whose value is a vector,
   * $s(x) = \sum_a w_a x_a$, with few nonzero weights. Joints, force elements
   * and probes see a body only through such values.
   */
  struct NodalFunctional
  {
    /** Nodes with a weight, ascending. */
    std::vector<unsigned int> nodes;

    /** Their weights $w_a$. */
    std::vector<double> weights;

    /** $s(x)$ for nodal positions, displacements or velocities x. */
    Vector3
    operator()(const NodalVector &x) const;

    /** Adjoint: adds $w_a F$ to the nodal force of each node. */
    void
    add_adjoint(const Vector3 &F, NodalVector &force) const;

    /** Whether it has the same nodes and, up to round-off, weights. */
    bool
    is_close(const NodalFunctional &other) const;
  };



  /** $\sum_a w_a v_a$ of two functionals' weights. */
  double
  scalar_product(const NodalFunctional &first, const NodalFunctional &second);



  /** Area, centroid and second moments of a surface in the reference state. */
  struct SurfaceGeometry
  {
    /** m^2 */
    double area = 0;

    /** $\bar X$, m */
    Vector3 centroid;

    /** $J = \frac1A \int (X - \bar X) \otimes (X - \bar X)\, dA$, m^2 */
    Matrix3 second_moment;

    /**
     * How well the surface's mean deformation gradient resolves a direction:
     * $\sqrt{a \cdot J a}$, m; zero for the normal of a plane surface.
     */
    double
    extent(const Vector3 &unit_direction) const;

    /** $J^+ a$ with the pseudo-inverse of J. */
    Vector3
    solve_second_moment(const Vector3 &a) const;

    /** Whether $J J^+ a = a$ up to round-off: a lies in the surface's span. */
    bool
    resolves(const Vector3 &unit_direction) const;
  };

  SurfaceGeometry
  surface_geometry(const BodyDiscretization &body, const Surface &surface);

  /**
   * Mean position: $s(x) = \frac1A \int x\, dA$, m. See theory (8.1).
   */
  NodalFunctional
  surface_mean(const BodyDiscretization &body, const Surface &surface);

  /**
   * First moment of the positions: $s(x) = \frac1A \int
   * (v \cdot (X - \bar X))\, x\, dA$, with affine weights (paper Sec. 4).
   */
  NodalFunctional
  surface_moment(const BodyDiscretization &body,
                 const Surface &surface,
                 const Vector3 &v);

  /**
   * Mean of a material direction d (unit vector in the reference state):
   * $s(x) = \frac1A \int (d \cdot J^+ (X - \bar X))\, x\, dA$,
   * the surface_moment() of $J^+ d$. For an affine motion x = F X it is F d.
   * See theory (8.2).
   *
   * @pre surface_geometry().resolves(d)
   */
  NodalFunctional
  surface_director(const BodyDiscretization &body,
                   const Surface &surface,
                   const Vector3 &direction);

  /** $\int \phi_a N\, dA$ with the outward normal, m^2, of nodes a. */
  std::map<unsigned int, Vector3>
  surface_normals(const BodyDiscretization &body, const Surface &surface);

  /** A point of a cell. */
  struct CellPoint
  {
    typename DoFHandler<dim>::active_cell_iterator cell;

    /** In the coordinates of the reference cell. */
    Point<dim> unit;
  };

  /**
   * The cells that contain a material point: several where they meet.
   *
   * @throws SimulationError if the body does not contain the point; its text
   * names the distance of the nearest node
   */
  std::vector<CellPoint>
  cells_at(const BodyDiscretization &body, const Point<dim> &X);

  /**
   * Position of a material point: $s(x) = \sum_a \phi_a(X) x_a$, m.
   *
   * @throws SimulationError as cells_at()
   */
  NodalFunctional
  material_point(const BodyDiscretization &body, const Point<dim> &X);
} // namespace ACF

#endif
