// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_checkpoint_h
#define acf_io_checkpoint_h

#include <acf/time/time_loop.h>

#include <filesystem>

namespace ACF
{
  /** What a checkpoint and the run that goes on from it must have in common. */
  struct CheckpointedModel
  {
    const MultibodySystem &system;

    /** All entries and their values, see used_parameters(). */
    std::string used_parameters;

    /** Of the simulation, s. */
    double end_time;
  };

  /**
   * Saves a simulation in a folder as the newest checkpoint; the one before it
   * is kept, older ones are not.
   * @throws SimulationError; the earlier checkpoints are still there then
   */
  void
  save_checkpoint(const std::filesystem::path &directory,
                  CheckpointedModel model,
                  TimeLoop &loop,
                  Statistics &statistics);

  /**
   * Loads a simulation from a checkpoint. Entries of the output, the time
   * integration (but for the stages), the validity and the modes may differ
   * from those of the model that was saved.
   *
   * @param prepare called when it is sure that the checkpoint is one of this
   * model, before observers touch their files
   * @return the number of threads of the run that was saved
   * @throws InputError if the checkpoint cannot be read or is that of another
   * model, naming the first entry that differs
   */
  unsigned int
  load_checkpoint(const std::filesystem::path &file,
                  const CheckpointedModel &model,
                  const std::function<void()> &prepare,
                  TimeLoop &loop,
                  Statistics &statistics);
} // namespace ACF

#endif
