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

  /**
   * Does what the command line asks for: runs or validates a model, or prints
   * what was asked.
   *
   * @param stream where messages go
   * @throws InputError, SimulationError
   */
  void
  run_command(const CommandLine &command_line, std::ostream &stream);

  /**
   * Runs a model and writes its results. Also a run that fails leaves its
   * results so far and its statistics.
   */
  void
  run_model(const Model &model,
            const std::filesystem::path &output_directory,
            std::ostream &stream,
            const bool quiet);

  /** The statistics of a run as JSON text. */
  std::string
  statistics_json(const Statistics &statistics,
                  const MultibodySystem &system,
                  const bool finished);
} // namespace ACF

#endif
