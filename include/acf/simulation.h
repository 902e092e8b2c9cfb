// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_simulation_h
#define acf_simulation_h

#include <acf/base/statistics.h>
#include <acf/command_line.h>
#include <acf/mechanics/multibody_system.h>

#include <iosfwd>

namespace ACF
{
  struct Model;
  class ValidityMonitor;

  /**
   * Does what the command line asks for: runs or validates a model, or prints
   * what was asked.
   *
   * @param stream where messages go
   * @param warnings where warnings go, also those of a quiet run
   * @throws InputError, SimulationError
   */
  void
  run_command(const CommandLine &command_line,
              std::ostream &stream,
              std::ostream &warnings);

  /**
   * Runs a model and writes its results. Also a run that fails leaves its
   * results so far and its statistics.
   */
  void
  run_model(const Model &model,
            const std::filesystem::path &output_directory,
            std::ostream &stream,
            std::ostream &warnings,
            const bool quiet);

  /**
   * The statistics of a run as JSON text.
   * @param validity of the bodies; null if nobody has watched it
   */
  std::string
  statistics_json(const Statistics &statistics,
                  const MultibodySystem &system,
                  const ValidityMonitor *const validity,
                  const bool finished);
} // namespace ACF

#endif
