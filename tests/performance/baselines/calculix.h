// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_baselines_calculix_h
#define acf_tests_baselines_calculix_h

#include <filesystem>

#include "performance/baselines/method.h"

// The same model with CalculiX (version 2.20, http://www.calculix.de), which
// Debian has as the package `calculix-ccx`: the cells of a body as C3D10 with
// the same nodes, large displacements, the method of Hilber, Hughes and Taylor
// with fixed steps, and the joints as linear equations between the
// displacements of the nodes, with the weights of the markers.

namespace Baselines
{
  /**
   * Writes `model.inp`. All displacements are printed at the multiples of the
   * probe interval, which must be one of the step size; zero: every step.
   * @throws SimulationError unless the system is one body of tetrahedra at
   * rest, with constant linear joints and constant gravity
   */
  void
  write_calculix_model(const Model &model,
                       const MultibodySystem &system,
                       const double alpha,
                       const std::filesystem::path &directory);

  /**
   * Runs `ccx` in the directory of `model.inp`; its messages go to `ccx.log`.
   * The phase "time steps" of the statistics is the time of the whole program,
   * and iterations count as factorisations.
   * @throws SimulationError if there is no such program or it fails
   */
  void
  run_calculix(const std::filesystem::path &directory, Statistics &statistics);

  /** Shows observers the start and the states of `model.dat`, without
   * velocities. */
  void
  read_calculix_results(const MultibodySystem &system,
                        const std::filesystem::path &directory,
                        const std::vector<Observer *> &observers);
} // namespace Baselines

#endif
