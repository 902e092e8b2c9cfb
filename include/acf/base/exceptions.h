// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_exceptions_h
#define acf_base_exceptions_h

#include <stdexcept>
#include <string>

namespace ACF
{
  /**
   * The input (model file, mesh, command line) is wrong. Ends the program with
   * exit status 2.
   */
  class InputError : public std::runtime_error
  {
  public:
    /**
     * An entry of the model file is wrong.
     * @param section path of the subsection, "Bodies/pendulum"; may be empty
     * @param entry name of the entry in it; may be empty
     * @param found what stands there
     * @param allowed what may stand there
     */
    InputError(const std::string &section,
               const std::string &entry,
               const std::string &found,
               const std::string &allowed);

    /** Something without an entry is wrong: a file, the command line. */
    explicit InputError(const std::string &message);

    /** The same error, preceded by the file (and the line, if not zero). */
    InputError
    located(const std::string &file, const unsigned int line) const;

    /** Path of the subsection; empty if the error concerns no entry. */
    std::string section;

    /** Name of the entry; empty if the error concerns no entry. */
    std::string entry;
  };

  /**
   * A simulation with valid input fails: no convergence, an inverted body, a
   * file that cannot be written. Ends the program with exit status 1.
   */
  class SimulationError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };
} // namespace ACF

#endif
