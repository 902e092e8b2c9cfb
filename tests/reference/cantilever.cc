// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "reference/cantilever.h"

#include <cmath>

namespace Reference
{
  namespace
  {
    // Angle of the section, bending moment, x and z of the axis.
    using Section = Eigen::Vector4d;

    struct Beam
    {
      double length, bending, compliance, shear_compliance, force;

      Section
      derivative(const Section &y) const
      {
        const double s = std::sin(y(0)), c = std::cos(y(0));
        const double stretch = 1 + force * s * compliance;
        const double shear   = force * c * shear_compliance;
        const double x       = stretch * c - shear * s;
        return {y(1) / bending, -force * x, x, stretch * s + shear * c};
      }

      Section
      tip(const double clamp_moment) const
      {
        const unsigned int n = 1000;
        const double h       = length / n;
        Section y(0, clamp_moment, 0, 0);
        for (unsigned int k = 0; k < n; ++k)
          {
            const Section k1 = derivative(y), k2 = derivative(y + h / 2 * k1),
                          k3 = derivative(y + h / 2 * k2),
                          k4 = derivative(y + h * k3);
            y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
          }
        return y;
      }
    };
  } // namespace



  CantileverTip
  cantilever_tip(const PlanarBeam &beam,
                 const double force,
                 const BeamTheory theory)
  {
    const double E = beam.youngs_modulus, nu = beam.poissons_ratio;
    const double area = beam.width * beam.height;
    Beam model{
      beam.length, E * area * beam.height * beam.height / 12, 0, 0, force};
    if (theory == BeamTheory::timoshenko)
      {
        model.compliance = 1 / (E * area);
        model.shear_compliance =
          2 * (1 + nu) / (cowper_coefficient(nu) * E * area);
      }
    // the moment at the tip grows with that at the clamp
    double lower = 0, upper = 1.5 * std::abs(force) * beam.length;
    for (unsigned int k = 0; k < 60; ++k)
      {
        const double middle                        = (lower + upper) / 2;
        (model.tip(middle)(1) > 0 ? upper : lower) = middle;
      }
    const Section tip = model.tip(lower);
    return {tip(3), beam.length - tip(2)};
  }
} // namespace Reference
