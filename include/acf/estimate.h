// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_estimate_h
#define acf_estimate_h

#include <acf/mechanics/multibody_system.h>

#include <iosfwd>

namespace ACF
{
  struct Model;

  /**
   * Shows what a run of the model needs without factorising anything: unknowns,
   * constraints, factorisations and their entries and memory, which are those
   * of the run if no step is repeated with another size, and about how long it
   * takes on this machine.
   *
   * @param assembly_time that making the system took, s
   */
  void
  estimate_run(const Model &model,
               const MultibodySystem &system,
               const double assembly_time,
               std::ostream &stream);
} // namespace ACF

#endif
