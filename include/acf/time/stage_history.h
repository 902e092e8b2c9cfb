// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_stage_history_h
#define acf_time_stage_history_h

#include <acf/base/linear_combination.h>
#include <acf/solvers/stage_solver.h>

#include <deque>

namespace ACF
{
  class Archive;

  /** Root mean square of a nodal vector over the nodes of a body, divided by
   * the length of the body. */
  double
  relative_norm(const Body &body, const NodalVector &vector);

  /** That of a linear combination. */
  double
  relative_norm(const Body &body, const std::vector<ScaledVector> &terms);



  /** The last accepted steps, the newest one first. */
  struct StageHistory
  {
    struct Step
    {
      /** $\tau$, and that of the step before; 0: there was none. s */
      double size;
      double size_before;

      /** Z, m */
      StageVector increments;

      /** $\Lambda$ */
      StageConstraints multipliers;

      void
      exchange(Archive &archive);
    };

    /** Keeps at most two.
     * @param increments are taken; what is left are others of the same sizes */
    void
    push(const double step_size,
         StageVector &increments,
         const StageConstraints &multipliers);

    /** Saves or loads. */
    void
    exchange(Archive &archive);

    std::deque<Step> steps;
  };
} // namespace ACF

#endif
