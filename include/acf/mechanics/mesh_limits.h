// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_limits_h
#define acf_mechanics_mesh_limits_h

#include <string>

namespace ACF
{
  /**
   * Stop if a mesh would have more cells than the program can handle: more than
   * 20 million, or so many that the mass and stiffness matrices of the body
   * alone do not fit into the memory of the machine.
   * @param n_cells also if it is only expected, before the mesh is made
   * @param is_simplex tetrahedra, otherwise hexahedra
   * @param section, entry what asks for them, for the message
   * @param found what stands there
   * @throws InputError
   */
  void
  check_number_of_cells(const double n_cells,
                        const bool is_simplex,
                        const std::string &section,
                        const std::string &entry,
                        const std::string &found);

  /** Physical memory of the machine, bytes. */
  double
  physical_memory();
} // namespace ACF

#endif
