// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_plausibility_h
#define acf_plausibility_h

#include <acf/model.h>

namespace ACF
{
  /**
   * Stop if a simulation would take too much of time or space: more than a
   * million VTU files or 100 million lines of probes, angular velocities that
   * are integrated over more than 20000 s (in intervals of 1 ms).
   * @throws InputError
   */
  void
  check_amounts(const Model &model);

  /**
   * One sentence for each value that is likely to have another unit than the
   * program's, or that asks for no results:
   * - densities below 0.01 or above 1e5 kg/m^3 (of gases, or beyond osmium),
   * - longitudinal waves in bars, with the velocity \f$\sqrt{E / \rho}\f$,
   *   faster than 1e5 m/s (ten times as fast as in diamond), slower than 0.3
   * m/s (as if in GPa), or slower than 10 m/s with more than 2000 kg/m^3 (a
   * metal in MPa),
   * - accelerations of gravity above 300 m/s^2 (of the Earth in mm/s^2),
   * - intervals of output longer than the simulation.
   */
  std::vector<std::string>
  plausibility_warnings(const Model &model);

  /** The same for bodies that are longer than 100 m. */
  std::vector<std::string>
  size_warnings(const MultibodySystem &system);
} // namespace ACF

#endif
