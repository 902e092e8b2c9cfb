// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_vtk_cells_h
#define acf_io_vtk_cells_h

#include <acf/mechanics/body_operators.h>

#include <cstdint>
#include <vector>

namespace ACF
{
  namespace Vtk
  {
    /** The cells of a body as VTK numbers their nodes: quadratic tetrahedra or
     * triquadratic hexahedra. */
    struct Cells
    {
      /** In VTU files. */
      std::uint8_t type;

      unsigned int n_cells;
      unsigned int n_nodes_per_cell;

      /** The nodes of one cell after those of the other. */
      std::vector<std::int64_t> nodes;
    };

    Cells
    cells_of(const BodyDiscretization &body);
  } // namespace Vtk
} // namespace ACF

#endif
