// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/time/step_sizes.h>

namespace ACF
{
  StepSizes::StepSizes(const TimeParameters &parameters)
    : is_controlled(parameters.tolerance > 0)
    , max_halvings(parameters.max_halvings)
    , least_step(1e-9 * parameters.end_time)
    , fixed(parameters.first_step(), parameters.max_halvings)
    , controlled(parameters.first_step(),
                 parameters.largest_step(),
                 parameters.tolerance / parameters.end_time,
                 2 * parameters.n_stages)
  {}



  double
  StepSizes::next() const
  {
    return is_controlled ? controlled.step_size() : fixed.step_size();
  }



  double
  StepSizes::time() const
  {
    return is_controlled ? controlled.time() : fixed.time();
  }



  bool
  StepSizes::fail()
  {
    if (!is_controlled)
      return fixed.halve();
    controlled.fail();
    return ++n_failures <= max_halvings;
  }



  bool
  StepSizes::allows(const double error) const
  {
    return !is_controlled || controlled.allows(error);
  }



  bool
  StepSizes::reject(const double error)
  {
    controlled.reject(error);
    return controlled.step_size() > least_step;
  }



  void
  StepSizes::accept(const double error,
                    const std::function<bool(double)> &has_factors,
                    const StepWork &work)
  {
    n_failures = 0;
    if (is_controlled)
      controlled.accept(error, has_factors, work);
    else
      fixed.accept();
  }



  void
  StepSizes::exchange(Archive &archive)
  {
    bool was_controlled = is_controlled;
    double kept_time    = time();
    archive("is controlled", was_controlled);
    archive("time", kept_time);
    archive("failures", n_failures);
    if (was_controlled != is_controlled)
      {
        n_failures = 0;
        fixed.start_at(kept_time);
        controlled.start_at(kept_time);
      }
    else if (is_controlled)
      archive("controller", controlled);
    else
      archive("controller", fixed);
  }
} // namespace ACF
