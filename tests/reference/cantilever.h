// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef tests_reference_cantilever_h
#define tests_reference_cantilever_h

#include "reference/planar_beam.h"

namespace Reference
{
  /** The tip of a cantilever under a force. */
  struct CantileverTip
  {
    /** In the direction of the force. Units: m. */
    double deflection;

    /** By how much the tip comes closer to the clamp's plane. Units: m. */
    double shortening;
  };

  /**
   * Static deflection of a cantilever by a force at its tip that keeps its
   * direction, across the undeformed beam in its plane: the geometrically exact
   * beam (E. Reissner, On one-dimensional finite-strain beam theory, ZAMP 23
   * (1972)), whose section turns by theta, with
   * \f[ EI\, \theta'' = -F x', \quad
   *     x' = (1 + \epsilon) \cos\theta - \gamma \sin\theta, \quad
   *     z' = (1 + \epsilon) \sin\theta + \gamma \cos\theta, \f]
   * $EA\, \epsilon = F \sin\theta$, $\kappa GA\, \gamma = F \cos\theta$. By
   * bisection for the moment at the clamp, with the method of Runge and Kutta.
   * @param force N; density and gravity of the beam do not count
   * @param theory without shear the beam does not become longer either
   */
  CantileverTip
  cantilever_tip(const PlanarBeam &beam,
                 const double force,
                 const BeamTheory theory = BeamTheory::timoshenko);
} // namespace Reference

#endif
