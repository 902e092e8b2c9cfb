// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_parallel_h
#define acf_base_parallel_h

#include <functional>

namespace ACF
{
  /**
   * Calls task(0), ..., task(n_tasks - 1), in parallel where there are threads.
   * What a task computes must not depend on the others, so that results do not
   * depend on which thread does what.
   */
  void
  run_tasks(const unsigned int n_tasks,
            const std::function<void(unsigned int)> &task);
} // namespace ACF

#endif
