// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/time/step_controller.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  StepController::StepController(const double base_step_size,
                                 const unsigned int max_halvings)
    : base_step_size(base_step_size)
    , max_halvings(max_halvings)
  {
    Assert(max_halvings <= finest, ExcIndexRange(max_halvings, 0, finest + 1));
  }



  double
  StepController::time() const
  {
    return start +
           (base_steps + std::ldexp(fraction, -finest)) * base_step_size;
  }



  double
  StepController::step_size() const
  {
    return std::ldexp(base_step_size, -static_cast<int>(n_halvings));
  }



  void
  StepController::accept()
  {
    const std::uint64_t one = 1;
    fraction += one << (finest - n_halvings);
    if (fraction == one << finest)
      {
        ++base_steps;
        fraction = 0;
      }
    just_doubled = false;
    ++n_successes;

    if (n_halvings > 0 && n_successes >= needed_successes &&
        fraction % (one << (finest - n_halvings + 1)) == 0)
      {
        --n_halvings;
        n_successes  = 0;
        just_doubled = true;
      }
    if (n_halvings == 0 && n_successes >= needed_successes)
      needed_successes = 2;
  }



  bool
  StepController::halve()
  {
    if (n_halvings >= max_halvings)
      return false;
    if (just_doubled)
      needed_successes = std::min(1024U, 2 * needed_successes);
    just_doubled = false;
    n_successes  = 0;
    ++n_halvings;
    return true;
  }



  void
  StepController::start_at(const double time)
  {
    start      = time;
    base_steps = fraction = 0;
    n_halvings = n_successes = 0;
    needed_successes         = 2;
    just_doubled             = false;
  }



  void
  StepController::exchange(Archive &archive)
  {
    double kept_step_size = base_step_size;
    archive("base step size", kept_step_size);
    archive("start", start);
    archive("base steps", base_steps);
    archive("fraction", fraction);
    archive("halvings", n_halvings);
    archive("successes", n_successes);
    archive("needed successes", needed_successes);
    archive("just doubled", just_doubled);
    if (kept_step_size != base_step_size)
      start_at(start +
               (base_steps + std::ldexp(fraction, -finest)) * kept_step_size);
  }
} // namespace ACF
