// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "vtk_cells.h"

#include <algorithm>
#include <array>

namespace ACF
{
  namespace
  {
    /** A cell type of VTK and its nodes, in half edges of the unit cell. */
    struct VtkCell
    {
      std::uint8_t type;
      std::vector<std::array<unsigned int, dim>> nodes;
    };



    // VTK_QUADRATIC_TETRA and VTK_LAGRANGE_HEXAHEDRON: corners, edges,
    // faces (-x, +x, -y, +y, -z, +z), centre. VTK_TRIQUADRATIC_HEXAHEDRON has
    // the same order, but many versions of VTK cannot integrate over it.
    VtkCell
    vtk_cell(const bool is_simplex)
    {
      if (is_simplex)
        return {24,
                {{{0, 0, 0}},
                 {{2, 0, 0}},
                 {{0, 2, 0}},
                 {{0, 0, 2}},
                 {{1, 0, 0}},
                 {{1, 1, 0}},
                 {{0, 1, 0}},
                 {{0, 0, 1}},
                 {{1, 0, 1}},
                 {{0, 1, 1}}}};
      return {72,
              {{{0, 0, 0}}, {{2, 0, 0}}, {{2, 2, 0}}, {{0, 2, 0}}, {{0, 0, 2}},
               {{2, 0, 2}}, {{2, 2, 2}}, {{0, 2, 2}}, {{1, 0, 0}}, {{2, 1, 0}},
               {{1, 2, 0}}, {{0, 1, 0}}, {{1, 0, 2}}, {{2, 1, 2}}, {{1, 2, 2}},
               {{0, 1, 2}}, {{0, 0, 1}}, {{2, 0, 1}}, {{2, 2, 1}}, {{0, 2, 1}},
               {{0, 1, 1}}, {{2, 1, 1}}, {{1, 0, 1}}, {{1, 2, 1}}, {{1, 1, 0}},
               {{1, 1, 2}}, {{1, 1, 1}}}};
    }



    // For each node of VTK's cell, the index of the shape function that belongs
    // to it: found by its place, not to depend on deal.II's numbering.
    std::vector<unsigned int>
    shape_functions_in_vtk_order(const VtkCell &vtk,
                                 const FiniteElement<dim> &element)
    {
      const std::vector<Point<dim>> &support =
        element.get_unit_support_points();
      AssertDimension(support.size(), vtk.nodes.size());
      std::vector<unsigned int> order;
      for (const auto &node : vtk.nodes)
        {
          const Point<dim> point(node[0] / 2., node[1] / 2., node[2] / 2.);
          const auto it =
            std::find_if(support.begin(), support.end(), [&](const auto &p) {
              return p.distance(point) < 1e-6;
            });
          Assert(it != support.end(), ExcInternalError());
          order.push_back(it - support.begin());
        }
      return order;
    }
  } // namespace



  Vtk::Cells
  Vtk::cells_of(const BodyDiscretization &body)
  {
    const VtkCell vtk = vtk_cell(body.mesh().is_simplex());
    const std::vector<unsigned int> order =
      shape_functions_in_vtk_order(vtk, body.scalar_element());
    const unsigned int n_cells = body.mesh().triangulation().n_active_cells();
    const unsigned int n_nodes = order.size();

    Cells cells = {vtk.type, n_cells, n_nodes, {}};
    cells.nodes.reserve(n_cells * n_nodes);
    std::vector<unsigned int> nodes(n_nodes);
    for (const auto &cell : body.dof_handler().active_cell_iterators())
      {
        body.get_nodes(cell, nodes);
        for (const unsigned int i : order)
          cells.nodes.push_back(nodes[i]);
      }
    return cells;
  }
} // namespace ACF
