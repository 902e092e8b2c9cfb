// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_accuracy_h
#define acf_mechanics_accuracy_h

#include <acf/mechanics/multibody_system.h>

#include <string>
#include <vector>

namespace ACF
{
  /**
   * What is known of the accuracy of a body from its mesh and its material
   * alone. The limits are those up to which errors were measured,
   * tests/performance/locking.md.
   */
  struct BodyAccuracy
  {
    /**
     * How long and thin the cells are: ratio of the largest to the smallest
     * principal radius of gyration of the vertices of a cell, its mean over the
     * volume. The aspect ratio of a box, 1 for a regular tetrahedron.
     */
    double elongation = 1;

    /**
     * What rounding changes the softest stiffness by, relative, up to a factor
     * of about ten:
     * \f$\epsilon\, (L / h)^4 (\lambda + 2 \mu) / E\f$ with the machine
     * precision \f$\epsilon\f$, the largest and the smallest principal radius
     * of gyration L, h of the body, Lame's coefficients and Young's modulus.
     * The numbers in the stiffness matrix are those of compressed cells, and
     * bending of a thin body is a small difference of them.
     */
    double round_off = 0;
  };

  BodyAccuracy
  body_accuracy(const Body &body);

  /**
   * One sentence for each body that is outside of what was measured to be
   * accurate; bodies with the same operators, and parts of a body, have one in
   * common. Parts have the rounding errors of the whole.
   */
  std::vector<std::string>
  accuracy_warnings(const MultibodySystem &system);
} // namespace ACF

#endif
