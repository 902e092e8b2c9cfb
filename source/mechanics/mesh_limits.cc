// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/mesh_limits.h>

#include <unistd.h>

namespace ACF
{
  namespace
  {
    constexpr double max_cells = 2e7;

    // Bytes of mass and stiffness per cell of a large mesh, rounded down.
    constexpr double tetrahedron_bytes = 1500;
    constexpr double hexahedron_bytes  = 15000;
  } // namespace



  double
  physical_memory()
  {
    return 1. * sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
  }



  void
  check_number_of_cells(const double n_cells,
                        const bool is_simplex,
                        const std::string &section,
                        const std::string &entry,
                        const std::string &found)
  {
    const std::string text =
      found + ", which makes " + format_number(n_cells) + " cells";
    if (!(n_cells <= max_cells))
      throw InputError(section,
                       entry,
                       text,
                       "at most " + format_number(max_cells / 1e6) +
                         " million cells in a body");
    const double bytes =
      n_cells * (is_simplex ? tetrahedron_bytes : hexahedron_bytes);
    if (bytes > physical_memory())
      throw InputError(section,
                       entry,
                       text + ", whose matrices take more than " +
                         format_bytes(bytes),
                       "bodies that fit into the memory of this machine, " +
                         format_bytes(physical_memory()));
  }
} // namespace ACF
