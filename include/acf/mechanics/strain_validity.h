// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_strain_validity_h
#define acf_mechanics_strain_validity_h

#include <acf/mechanics/body.h>
#include <acf/mechanics/cell_gradients.h>

#include <optional>

namespace ACF
{
  /**
   * How far a body is from the assumption of its strain, in figures that are
   * small where it holds. With the co-rotated displacement q and its gradient
   * $H = R^T F - I$ at the integration points of the cells,
   * $\varepsilon = \mathrm{Sym}(H)$ and the Green-Lagrange strain
   * $E = \varepsilon + \frac12 H^T H$ they are the following maxima or, where
   * the norm is $\|e\|^2 = \int e : C : e\, dV$ with the elasticity tensor,
   * means over the body. With the strain of Green and Lagrange E takes the
   * place of $\varepsilon$, and nothing is neglected.
   */
  struct StrainValidity
  {
    /** Largest magnitude of a principal strain of $\varepsilon$. */
    double strain = 0;

    /**
     * Largest rotation of the material against the frame of the body, rad: the
     * angle of the polar rotation of $R^T F = I + H$ where the skew part of H
     * is largest; $\pi$ if there is none.
     */
    double rotation = 0;

    /**
     * $\| \frac12 H^T H \| / \| \varepsilon \|$: the strain that the reduced
     * strain neglects against the strain.
     */
    double neglected_strain = 0;

    /**
     * $2\, |\int \varepsilon : C : \frac12 H^T H\, dV| /
     * \| \varepsilon \|^2$: the first-order change of the elastic energy by the
     * neglected strain, which is what stress stiffens, against the energy.
     */
    double neglected_energy = 0;

    /**
     * Largest displacement of a node, each component divided by the thickness
     * of the body along it: $\max_a \sqrt{q_a \cdot (12 J)^{-1} q_a}$ with the
     * second moments
     * $J = \frac1V \int (X - \bar X) \otimes (X - \bar X)\, dV$. The
     * thicknesses $\sqrt{12 J_i}$ of a box are the lengths of its edges, the
     * smaller one of a rod of radius r is $\sqrt3\, r$.
     */
    double deflection = 0;

    /**
     * How much single cells bend: the largest sagitta
     * $s = q_m - \frac12 (q_a + q_b)$ of an edge with the middle node m between
     * the vertices a and b, measured like the deflection. With the strain of
     * Green and Lagrange a bent cell is too stiff, relative to bending by about
     * $(s/h)^2$: the quadratic part of its strain has higher degree than the
     * linear part, which cannot balance it (membrane locking). The reduced
     * strain has no such part.
     */
    double cell_bending = 0;
  };

  /**
   * One loop over the integration points of the cells of a body. Strains at the
   * surface of a bent body are therefore larger than what is found: by a factor
   * of $\sqrt3$ with one hexahedron over its thickness. See theory (5.1),
   * theory (5.2), theory (5.3), theory (5.4).
   *
   * @param gradients of the body's cells
   * @param positions $x_a$, m
   * @return nothing if the mean deformation gradient has no rotation
   */
  std::optional<StrainValidity>
  strain_validity(const Body &body,
                  const CellGradients &gradients,
                  const NodalVector &positions);
} // namespace ACF

#endif
