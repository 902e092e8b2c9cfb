// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_generation_h
#define acf_mechanics_mesh_generation_h

#include <acf/mechanics/mesh_data.h>

#include <array>

namespace ACF
{
  /**
   * A box of @p n_cells[d] hexahedra along coordinate d, each split into 24
   * tetrahedra if these are asked for; this split is symmetric to all planes of
   * symmetry of the box. Surfaces "x min", "x max", ..., region "body".
   * @pre from < to in each coordinate (m), all counts positive
   */
  MeshData
  generate_box(const Point<dim> &from,
               const Point<dim> &to,
               const std::array<unsigned int, dim> &n_cells,
               const ReferenceCell &reference_cell);

  /**
   * A circular cylinder, meshed with an O-grid: a square of cells around the
   * axis and rings of cells around it, repeated along the axis; split into
   * tetrahedra like a box. All vertices of the lateral surface lie on the
   * radius. Surfaces "start", "end", "side"; region "body".
   *
   * With n cells across the diameter, r = max(1, round(n/4)) of them on
   * either side belong to rings, so that 4 (n - 2 r) cells go around.
   *
   * @param is_quadratic the nodes in the middle of the edges of the lateral
   * surface lie on the radius, too
   *
   * @pre no quadratic hexahedra, from != to (m), radius > 0 (m), n_cells_across
   * >= 3, n_cells_along > 0
   */
  MeshData
  generate_cylinder(const Point<dim> &from,
                    const Point<dim> &to,
                    const double radius,
                    const unsigned int n_cells_across,
                    const unsigned int n_cells_along,
                    const ReferenceCell &reference_cell,
                    const bool is_quadratic = false);
} // namespace ACF

#endif
