// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_result_directory_h
#define acf_io_result_directory_h

#include <filesystem>

namespace ACF
{
  /** Files of the last two checkpoints in a folder of results. */
  constexpr char checkpoint_file[]          = "checkpoint.h5";
  constexpr char previous_checkpoint_file[] = "checkpoint-previous.h5";

  /** What happens to the results that are in a folder already. */
  enum class EarlierResults
  {
    /** They are moved into a folder of their own, `earlier-1`, `earlier-2`, ...
     */
    set_aside,

    /** They are deleted. */
    remove,

    /** They stay: the run goes on with them. */
    keep
  };

  /** Of what: each leaves the files of the other alone. */
  enum class ResultKind
  {
    run,
    inspection
  };

  /**
   * Makes a folder for results, if it does not exist, and removes what an
   * interrupted program has left half-written.
   *
   * @return the folder into which earlier results were moved; empty if there
   * were none
   * @throws SimulationError
   */
  std::filesystem::path
  prepare_result_directory(const std::filesystem::path &directory,
                           const EarlierResults earlier,
                           const ResultKind kind = ResultKind::run);
} // namespace ACF

#endif
