// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/base/thread_order.h>

#include <deal.II/base/multithread_info.h>

#include <algorithm>

#include <tbb/parallel_for.h>

namespace ACF
{
  void
  run_tasks(const unsigned int n_tasks,
            const std::function<void(unsigned int)> &task)
  {
    if (n_tasks == 1 || dealii::MultithreadInfo::n_threads() == 1)
      {
        for (unsigned int i = 0; i < n_tasks; ++i)
          task(i);
        return;
      }
    const char end = 0; // its address stands for the end of the tasks
    publish_order(&task);
    tbb::parallel_for(
      0U,
      n_tasks,
      [&](const unsigned int i) {
        observe_order(&task);
        task(i);
        publish_order(&end);
      },
      tbb::simple_partitioner());
    observe_order(&end);
  }



  unsigned int
  n_ranges(const std::size_t n, const std::size_t smallest)
  {
    return std::max<std::size_t>(
      1,
      std::min<std::size_t>(n / smallest,
                            dealii::MultithreadInfo::n_threads()));
  }



  void
  run_ranges(const std::size_t n,
             const std::function<void(std::size_t, std::size_t)> &range,
             const std::size_t smallest)
  {
    const unsigned int n_parts = n_ranges(n, smallest);
    run_tasks(n_parts, [&](const unsigned int part) {
      range(n * part / n_parts, n * (part + 1) / n_parts);
    });
  }
} // namespace ACF
