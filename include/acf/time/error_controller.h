// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_error_controller_h
#define acf_time_error_controller_h

#include <functional>
#include <map>

namespace ACF
{
  class Archive;

  /** What an accepted step took. */
  struct StepWork
  {
    /** Linear solves. */
    double n_solves = 0;

    /** Whether it needed another tangent than that of the factorisations. */
    bool is_hard = false;
  };

  /**
   * Chooses step sizes on the lattice $\tau_0 2^{k/2}$, k of any sign, so that
   * the estimated errors e of the steps are at most $r \tau$, with r the
   * tolerance divided by the simulated time: their sum is at most the
   * tolerance.
   *
   * With $\epsilon = e / (r \tau)$, proportional to $\tau^{p - 1}$, the step
   * that is allowed next is $0.9\, \epsilon_n^{-1/(p-1)}$ times the last one,
   * and that times $(\epsilon_{n-1} / \epsilon_n)^{0.4/(p-1)}$ if this is less
   * (predictive control, Gustafsson 1994). A step whose error is too large is
   * repeated with the allowed size, at least one point of the lattice lower; a
   * step that does not converge with half the size. The size rises by one or
   * two points if what they need was allowed by several steps in a row: two if
   * there are factorisations for that size, three for two points and eight for
   * one if not, and twice as many each time a rise has been taken back at once.
   *
   * Large steps may need the tangent at the present state, which takes many
   * solves. After such a step the size falls by one point, unless steps of that
   * size took more solves per time, or those of the size above less. It rises
   * to such a size after 8 steps at the soonest, twice as many each time. See
   * theory (14.1).
   */
  class ErrorController
  {
  public:
    /**
     * @param first_step $\tau_0$, s
     * @param largest_step s
     * @param rate r, 1/s
     * @param order p
     */
    ErrorController(const double first_step,
                    const double largest_step,
                    const double rate,
                    const unsigned int order);

    /** End of the accepted steps, s. */
    double
    time() const
    {
      return end;
    }

    /** Size of the next step, s. */
    double
    step_size() const
    {
      return lattice_size(level);
    }

    bool
    allows(const double error) const
    {
      return error <= rate * step_size();
    }

    /** The step was accepted: advances the time.
     * @param has_factors whether there are factorisations for a step size */
    void
    accept(const double error,
           const std::function<bool(double)> &has_factors,
           const StepWork &work = {});

    /** The error of the step is too large. */
    void
    reject(const double error);

    /** The step did not converge. */
    void
    fail();

    /** Steps in a row that were not accepted. */
    unsigned int
    n_rejections() const
    {
      return rejections;
    }

    /** Begins anew at a time, s. */
    void
    start_at(const double time);

    /** Saves or loads; begins anew if the first step was another one. */
    void
    exchange(Archive &archive);

  private:
    double
    lattice_size(const int k) const;

    /** Allowed size / size of the step. */
    double
    allowed_factor(const double epsilon) const;

    /** Takes note of the work. @return whether smaller steps may take less */
    bool
    is_too_hard(const StepWork &work);

    void
    decrease(const int points);

    const double first_step;
    const double largest_step;
    const double rate;
    const double exponent;

    int level = 0;

    /** Sum of the steps, and what rounding has cut off it. */
    double end  = 0;
    double rest = 0;

    /** $\epsilon$ of the last step; 0: not of this size. */
    double previous = 0;

    /** Accepted steps in a row that allowed one, and two points more. */
    unsigned int allowed_one = 0;
    unsigned int allowed_two = 0;

    /** Solves per time of the last step of each level, 1/s. */
    std::map<int, double> costs;

    /** Level of the last step that was too hard, for how many steps no such
     * level is tried, and for how many the next time (eighths). */
    int hard_level         = 0;
    unsigned int blocked   = 0;
    unsigned int hard_wait = 1;

    unsigned int patience   = 1;
    unsigned int since_rise = 1000;
    unsigned int rejections = 0;
  };
} // namespace ACF

#endif
