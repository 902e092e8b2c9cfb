// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_model_h
#define acf_model_h

#include <acf/base/parameter_file.h>
#include <acf/io/field_output.h>
#include <acf/io/probes.h>
#include <acf/time/modes.h>
#include <acf/time/start.h>
#include <acf/time/validity_monitor.h>

namespace ACF
{
  /** What a model file says of the results. */
  struct OutputParameters
  {
    /** Relative to the folder in which the program runs; empty: see model. */
    std::string directory;

    /** s; zero: every step */
    double probe_interval = 0;

    /** Simulated time between two checkpoints, s; 0: none. */
    double checkpoint_interval = 0;

    /** The same in wall time. */
    double checkpoint_wall_interval = 600;

    FieldOutputParameters fields;

    void
    add_parameters(ParameterHandler &prm);
  };



  /** Everything that a model file says, checked as far as no mesh is needed. */
  struct Model
  {
    std::string title;
    SystemParameters system;
    StartParameters start;
    TimeParameters time;
    ModeParameters modes;
    ValidityParameters validity;
    OutputParameters output;
    std::vector<ProbeParameters> probes;

    /** Folder of the model file: relative mesh file names start here. */
    std::filesystem::path directory;

    /** Sentences about values that are allowed but not plausible. */
    std::vector<std::string> warnings;

    /** All values, as a model file. */
    std::string used_parameters;
  };

  /**
   * Reads and checks all values before anything is done with them.
   * @throws InputError with file and line; InputErrors for several
   */
  Model
  read_model(const ParameterFile &file);

  /** A documented model file of all entries and their defaults. */
  std::string
  default_model_file();
} // namespace ACF

#endif
