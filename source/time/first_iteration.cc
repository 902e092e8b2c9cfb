// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/time/first_iteration.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ACF
{
  void
  FirstIteration::start_step(const double tau, const int linearization)
  {
    if (step_size != tau || kind != linearization)
      {
        step_size     = tau;
        kind          = linearization;
        factor        = 1;
        previous_norm = 0;
        is_measured   = false;
      }
  }



  double
  FirstIteration::error(const double norm) const
  {
    constexpr unsigned int max_age  = 16;
    constexpr double growth         = 1.1;
    constexpr double largest_change = 4;
    if (!is_measured || age >= max_age || norm > largest_change * previous_norm)
      return std::max(1., factor) * norm;
    return factor * std::pow(growth, age) * norm;
  }



  void
  FirstIteration::end_step(const std::vector<double> &norms)
  {
    previous_norm = norms[0];
    ++age;
    if (norms.size() == 1)
      return;
    // the first contraction may be better than those that follow
    double largest = 0;
    for (unsigned int k = 1; k < norms.size(); ++k)
      largest = std::max(largest, norms[k] / norms[k - 1]);
    factor      = std::max(norms[1] / norms[0] / (1 - std::min(largest, 0.9)),
                      std::numeric_limits<double>::epsilon());
    age         = 0;
    is_measured = true;
  }



  void
  FirstIteration::exchange(Archive &archive)
  {
    archive("step size", step_size);
    archive("linearisation", kind);
    archive("factor", factor);
    archive("previous norm", previous_norm);
    archive("age", age);
    archive("is measured", is_measured);
  }
} // namespace ACF
