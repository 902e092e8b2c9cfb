// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_child_process_h
#define acf_base_child_process_h

#include <functional>
#include <stdexcept>
#include <vector>

namespace ACF
{
  /**
   * A child process ended before its task did: by a signal, or because a
   * library ended it. what() continues a sentence: "was ended by signal 11
   * (Segmentation fault)".
   */
  class ChildProcessEnded : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * Runs a task in a copy of this process, for libraries that may crash or end
   * the process on bad input, or keep memory for ever. The copy has only the
   * thread that calls this function, writes to standard output and standard
   * error in vain, and is killed when this process ends.
   *
   * @param task must not write to files that this process has opened, and must
   * not use its threads
   * @return what the task returns
   * @throws InputError if the task throws one, and std::runtime_error with the
   * text of any other exception
   * @throws ChildProcessEnded
   */
  std::vector<char>
  run_in_child_process(const std::function<std::vector<char>()> &task);

  /**
   * While it exists, the process is ended (signal SIGXCPU) when it has computed
   * for so long. Only for a process that runs a task of run_in_child_process().
   */
  class ProcessorTimeLimit
  {
  public:
    /** @param seconds from the start of the process */
    explicit ProcessorTimeLimit(const unsigned int seconds);

    ~ProcessorTimeLimit();

    ProcessorTimeLimit(const ProcessorTimeLimit &) = delete;
    ProcessorTimeLimit &
    operator=(const ProcessorTimeLimit &) = delete;
  };
} // namespace ACF

#endif
