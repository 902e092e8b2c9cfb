// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_command_line_h
#define acf_command_line_h

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ACF
{
  /** What the user asks for on the command line. */
  struct CommandLine
  {
    enum class Action
    {
      /** Simulate the model. */
      run,
      /** Read and check the model only. */
      validate,
      /** Show what a run would need. */
      estimate,
      /** Show what a mesh or a geometry contains. */
      inspect,
      /** Print a documented file of the defaults. */
      print_parameters,
      help,
      version
    };

    Action action = Action::run;

    /** The model file; empty unless the action is run, validate or estimate.
     */
    std::filesystem::path model;

    /** The file of a mesh or a geometry to inspect. */
    std::filesystem::path part;

    /** Factor on the coordinates of the part. */
    double scale = 1;

    /** Of the part, kg/m^3; zero (not given): no mass is computed. */
    double density = 0;

    /** Largest element size of the part, m; zero (not given): the file's. */
    double mesh_size = 0;

    /** "Section/Entry=value", in the order given. */
    std::vector<std::string> overrides;

    /** Takes the place of the model's output directory. */
    std::optional<std::filesystem::path> output_directory;

    /** The checkpoint to go on from. */
    std::optional<std::filesystem::path> restart;

    /** Whether results of an earlier run are deleted instead of moved. */
    bool overwrite = false;

    /** Greatest number of threads; zero (not given): one per core. */
    unsigned int n_threads = 0;

    /** No messages but errors. */
    bool quiet = false;
  };

  /**
   * Understand the command line.
   * @param arguments without the name of the program
   * @throws InputError for unknown and repeated options, missing and wrong
   *   values, and a number of model files that the action does not take
   */
  CommandLine
  parse_command_line(const std::vector<std::string> &arguments);

  /** Usage, options and exit status, as printed by <tt>--help</tt>. */
  std::string
  help_text();
} // namespace ACF

#endif
