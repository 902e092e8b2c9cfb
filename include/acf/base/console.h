// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_console_h
#define acf_base_console_h

#include <chrono>
#include <iosfwd>
#include <string>

namespace ACF
{
  /** "1.5 h", "12 min", "3.2 s" */
  std::string
  format_duration(const double seconds);

  /** "217 MB" */
  std::string
  format_bytes(const double bytes);

  /** A number with six significant digits. */
  std::string
  format_number(const double value);

  /** "1 step", "2 steps" */
  std::string
  counted(const unsigned long n, const std::string &noun);

  /**
   * The line that shows how far a simulation is: a bar, simulated time, step
   * size, iterations, time left and the wall time for a simulated second. On a
   * terminal it is rewritten in place a few times per second, cut to its width;
   * elsewhere nothing is shown.
   */
  class Progress
  {
  public:
    /**
     * @param stream where to write
     * @param enabled false for a silent object
     * @param end_time simulated time at the end, s
     * @param start_time where this run of the program begins, s
     */
    Progress(std::ostream &stream,
             const bool enabled,
             const double end_time,
             const double start_time = 0);

    /** Ends the line, if one is shown. */
    ~Progress();

    void
    update(const double time,
           const double step_size,
           const unsigned int iterations,
           const unsigned long n_steps);

  private:
    using Clock = std::chrono::steady_clock;

    std::ostream &stream;
    const bool enabled;
    const double end_time;
    const double start_time;
    const Clock::time_point start;
    Clock::time_point last_update;
    bool line_open = false;
  };

  /**
   * One line, "acf-dealii: warning: MESSAGE.", in place of the line of the
   * Progress if both are on terminals. Here and in errors the first words are
   * coloured if standard error is a terminal that has colours, and the
   * variable NO_COLOR of the environment is empty.
   */
  void
  print_warning(std::ostream &stream, const std::string &message);

  /** One line, "acf-dealii: MESSAGE". */
  void
  print_error(std::ostream &stream, const std::string &message);

  /** Whether standard output is a terminal. */
  bool
  standard_output_is_terminal();
} // namespace ACF

#endif
