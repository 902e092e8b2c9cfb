// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_lumped_mass_h
#define acf_mechanics_lumped_mass_h

#include <acf/mechanics/joint_side.h>

namespace ACF
{
  /** What a model file says of a mass on a surface. */
  struct LumpedMassParameters
  {
    std::string name;

    /** "BODY: SURFACE". */
    std::string on;

    /** kg */
    double mass = 0;

    /** Inertia about the mean position, xx, yy, zz, yz, zx, xy in world axes at
     * the start, kg m^2. */
    std::vector<double> inertia;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError */
    void
    check() const;

    std::string
    section() const
    {
      return "Masses/" + name;
    }
  };



  /**
   * A rigid mass that moves with the mean position $\bar x$ of a surface and
   * turns with its directors $d_k$, with the constant mass matrix of
   * \f[ T = \tfrac12 m |\dot{\bar x}|^2 + \tfrac12 \sum_{kl} E_{kl}\,
   *     \dot d_k \cdot \dot d_l, \qquad
   *     E = \tfrac12 \mathrm{tr}(J) I - J \f]
   * for its inertia tensor J about the mean position.
   * See theory (9.2).
   */
  struct LumpedMass
  {
    std::string name;
    double mass = 0;
    MarkerSet markers;

    /** Mass per pair of markers, kg or kg m^2; times the unit matrix. */
    Eigen::MatrixXd mass_matrix;
  };

  /**
   * @throws InputError if a plane surface shall carry an inertia about axes in
   * the plane that needs a director normal to it
   */
  LumpedMass
  make_lumped_mass(const LumpedMassParameters &parameters,
                   const std::vector<Body> &bodies);
} // namespace ACF

#endif
