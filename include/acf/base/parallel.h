// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_parallel_h
#define acf_base_parallel_h

#include <cstddef>
#include <functional>
#include <vector>

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

  /** Numbers of nodes or unknowns that are worth a thread. */
  constexpr std::size_t smallest_range = 4096;

  /**
   * Calls range(begin, end) for parts of [0, n), in parallel: one for each
   * thread, fewer where n is small.
   * @param smallest what is worth a thread
   */
  void
  run_ranges(const std::size_t n,
             const std::function<void(std::size_t, std::size_t)> &range,
             const std::size_t smallest = smallest_range);

  /**
   * Sum of what sum(begin, end) returns for the parts of run_ranges(), in their
   * order: the result depends on the number of threads, but not on their
   * timing.
   */
  template <typename Value, typename Sum>
  Value
  sum_ranges(const std::size_t n, const Sum &sum);

  /** How many parts run_ranges() makes. */
  unsigned int
  n_ranges(const std::size_t n, const std::size_t smallest = smallest_range);



  template <typename Value, typename Sum>
  Value
  sum_ranges(const std::size_t n, const Sum &sum)
  {
    const unsigned int n_parts = n_ranges(n);
    if (n_parts == 1)
      return sum(std::size_t(0), n);
    std::vector<Value> parts(n_parts);
    run_tasks(n_parts, [&](const unsigned int part) {
      parts[part] = sum(n * part / n_parts, n * (part + 1) / n_parts);
    });
    Value total = parts[0];
    for (unsigned int part = 1; part < n_parts; ++part)
      total += parts[part];
    return total;
  }
} // namespace ACF

#endif
