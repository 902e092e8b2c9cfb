// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_simulation_h
#define acf_simulation_h

#include <acf/command_line.h>

#include <iosfwd>

namespace ACF
{
  struct Model;

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

  /** What the command line says of a run. */
  struct RunOptions
  {
    std::filesystem::path output_directory;

    /** No messages but warnings. */
    bool quiet = false;

    /** The checkpoint to go on from. */
    std::optional<std::filesystem::path> restart = {};

    /** Whether results of an earlier run are deleted instead of moved. */
    bool overwrite = false;
  };

  /**
   * Runs a model and writes its results. Also a run that fails leaves its
   * results so far, its statistics and a checkpoint. Results of an earlier run
   * in the same folder are moved into a folder of their own.
   */
  void
  run_model(const Model &model,
            const RunOptions &options,
            std::ostream &stream,
            std::ostream &warnings);
} // namespace ACF

#endif
