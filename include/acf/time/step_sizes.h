// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_step_sizes_h
#define acf_time_step_sizes_h

#include <acf/time/error_controller.h>
#include <acf/time/step_controller.h>
#include <acf/time/time_parameters.h>

namespace ACF
{
  /**
   * Sizes of the steps as the parameters ask for: of a StepController, or with
   * a tolerance of an ErrorController.
   */
  class StepSizes
  {
  public:
    explicit StepSizes(const TimeParameters &parameters);

    /** s */
    double
    next() const;

    /** End of the accepted steps, s. */
    double
    time() const;

    /** The step did not converge. @return false if it cannot be repeated */
    bool
    fail();

    /** Whether the estimated error of the step is small enough. */
    bool
    allows(const double error) const;

    /** The error is too large. @return false if the step cannot be repeated */
    bool
    reject(const double error);

    /** @param has_factors whether there are factorisations for a step size */
    void
    accept(const double error,
           const std::function<bool(double)> &has_factors,
           const StepWork &work);

    /** Saves or loads; begins anew if the sizes were found in another way. */
    void
    exchange(Archive &archive);

  private:
    const bool is_controlled;
    const unsigned int max_halvings;
    const double least_step;
    StepController fixed;
    ErrorController controlled;
    unsigned int n_failures = 0;
  };
} // namespace ACF

#endif
