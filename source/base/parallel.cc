// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>

#include <deal.II/base/multithread_info.h>

#include <tbb/parallel_for.h>

namespace ACF
{
  void
  run_tasks(const unsigned int n_tasks,
            const std::function<void(unsigned int)> &task)
  {
    if (n_tasks == 1 || dealii::MultithreadInfo::n_threads() == 1)
      for (unsigned int i = 0; i < n_tasks; ++i)
        task(i);
    else
      tbb::parallel_for(0U, n_tasks, task, tbb::simple_partitioner());
  }
} // namespace ACF
