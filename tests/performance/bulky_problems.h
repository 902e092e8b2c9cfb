// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_bulky_problems_h
#define acf_tests_bulky_problems_h

#include "static_problem.h"

namespace Tests
{
  /**
   * A thick ring with free end faces (radii 1 m and 2 m, length 1 m) under
   * inner pressure against Lame's solution: root mean square errors over the
   * nodes, of displacements and of von Mises stresses.
   * @param n cells through the wall, a fourth of those around it
   */
  Figures
  inflate_ring(const unsigned int n,
               const std::string &element,
               const double poissons_ratio);

  /** The same for a hollow sphere of tetrahedra of a size in m. */
  Figures
  inflate_sphere(const double mesh_size, const double poissons_ratio);

  /**
   * Cook's panel (48 m long, 44 m and 16 m high at its ends, 12 m thick) under
   * a shear traction at its end: by how much its compliance is too small.
   * @param n cells through the thickness, half of those along the edges
   * @param n_fine those of the hexahedra with which it is compared
   */
  Figures
  bend_panel(const unsigned int n,
             const unsigned int n_fine,
             const std::string &element,
             const double poissons_ratio);

  /** The same for the torsion of a square bar, three times as long as thick. */
  Figures
  twist_bar(const unsigned int n,
            const unsigned int n_fine,
            const std::string &element,
            const double poissons_ratio);

  /**
   * The same for a square plate, a hundred times as long as thick, clamped at
   * an edge and loaded at the opposite one; one cell through the thickness.
   */
  Figures
  bend_plate(const unsigned int n,
             const unsigned int n_fine,
             const std::string &element,
             const double poissons_ratio);
} // namespace Tests

#endif
