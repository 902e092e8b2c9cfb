// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_step_controller_h
#define acf_time_step_controller_h

#include <cstdint>

namespace ACF
{
  class Archive;

  /**
   * Chooses step sizes on the lattice $\tau_0 2^{-k}$ so that all multiples of
   * $\tau_0$ remain ends of steps: a failed step is halved; after two
   * successful steps the next larger size is tried again where the lattice
   * allows it, after longer and longer waits if that fails again. Times are
   * computed from integers and do not drift.
   */
  class StepController
  {
  public:
    /**
     * @param base_step_size $\tau_0$, s
     * @param max_halvings largest k, at most 30
     */
    StepController(const double base_step_size,
                   const unsigned int max_halvings);

    /** End of the accepted steps, s. */
    double
    time() const;

    /** Size of the next step, s. */
    double
    step_size() const;

    /** The step was accepted: advances the time. */
    void
    accept();

    /**
     * The step failed: halves it.
     * @return false if it has been halved as often as allowed
     */
    bool
    halve();

    /** Begins anew at a time, s. */
    void
    start_at(const double time);

    /** Saves or loads; begins anew if the base step size was another one. */
    void
    exchange(Archive &archive);

  private:
    static constexpr int finest = 30;

    const double base_step_size;
    const unsigned int max_halvings;
    unsigned int n_halvings = 0;

    /** Where the base steps begin, s. */
    double start             = 0;
    std::uint64_t base_steps = 0;

    /** Part of the current base step that is done, in $2^{-30}$. */
    std::uint64_t fraction = 0;

    /** Successful steps since the last change, and how many it takes. */
    unsigned int n_successes      = 0;
    unsigned int needed_successes = 2;
    bool just_doubled             = false;
  };
} // namespace ACF

#endif
