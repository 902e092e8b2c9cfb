// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_interruption_h
#define acf_base_interruption_h

#include <array>
#include <csignal>
#include <string>

namespace ACF
{
  /**
   * As long as it exists, the first SIGINT, SIGTERM or SIGHUP is only noted, so
   * that the program can end in order; the second one ends it at once. Signals
   * that the program was told to ignore stay ignored. One object at a time.
   */
  class InterruptionGuard
  {
  public:
    InterruptionGuard();
    ~InterruptionGuard();

    InterruptionGuard(const InterruptionGuard &) = delete;
    InterruptionGuard &
    operator=(const InterruptionGuard &) = delete;

    /** Name of the noted signal; empty if there was none. */
    std::string
    signal() const;

  private:
    std::array<struct sigaction, 3> old_actions;
  };

  /**
   * Makes writes fail where they would otherwise end the program: into a closed
   * pipe, and beyond the largest size of files.
   */
  void
  ignore_signals_of_writes();
} // namespace ACF

#endif
