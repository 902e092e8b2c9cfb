// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/dot_product.h>
#include <acf/time/stage_history.h>

#include <cmath>

namespace ACF
{
  double
  relative_norm(const Body &body, const NodalVector &vector)
  {
    return std::sqrt(dot_product(vector, vector) / body.operators().n_nodes) /
           body.operators().length;
  }



  double
  relative_norm(const Body &body, const std::vector<ScaledVector> &terms)
  {
    return std::sqrt(square_of_combination(terms) / body.operators().n_nodes) /
           body.operators().length;
  }



  void
  StageHistory::push(const double step_size,
                     StageVector &increments,
                     const StageConstraints &multipliers)
  {
    const double before = steps.empty() ? 0 : steps.front().size;
    if (steps.size() < 2)
      {
        steps.emplace_front();
        steps.front().increments = increments;
      }
    else
      {
        // without a new allocation
        steps.push_front(std::move(steps.back()));
        steps.pop_back();
        steps.front().increments.swap(increments);
      }
    steps.front().size        = step_size;
    steps.front().size_before = before;
    steps.front().multipliers = multipliers;
  }



  void
  StageHistory::Step::exchange(Archive &archive)
  {
    archive("size", size);
    archive("size before", size_before);
    archive("increments", increments);
    archive("multipliers", multipliers);
  }



  void
  StageHistory::exchange(Archive &archive)
  {
    archive("steps", steps);
  }
} // namespace ACF
