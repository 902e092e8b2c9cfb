// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_first_iteration_h
#define acf_time_first_iteration_h

#include <vector>

namespace ACF
{
  class Archive;

  /**
   * Whether the first iteration of a step was enough: what it leaves is
   * $\theta / (1 - \theta)\, |\Delta Z^1|$ with a contraction that was
   * measured in an earlier step, at most 16 steps ago, and is taken to be 1.1
   * times as large for each of them. The measurement does not hold if the step
   * size or the linearisation is another one, or if $|\Delta Z^1|$ is more than
   * four times that of the last step: something new has happened.
   * See theory (13.2).
   */
  class FirstIteration
  {
  public:
    /** @param kind of the linearisation */
    void
    start_step(const double step_size, const int kind);

    /** Predicted error that the first iteration of a step leaves; without a
     * measurement that holds at least the increment itself.
     * @param norm $|\Delta Z^1|$ */
    double
    error(const double norm) const;

    /** A step has converged.
     * @param norms $|\Delta Z^k|$ of all iterations */
    void
    end_step(const std::vector<double> &norms);

    /** Saves or loads. */
    void
    exchange(Archive &archive);

  private:
    double step_size     = 0;
    int kind             = 0;
    double factor        = 1;
    double previous_norm = 0;
    unsigned int age     = 0;
    bool is_measured     = false;
  };
} // namespace ACF

#endif
