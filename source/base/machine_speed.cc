// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/machine_speed.h>
#include <acf/base/parallel.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>

#include <deal.II/lac/lapack_templates.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

extern "C" void
openblas_set_num_threads(int n_threads);

namespace ACF
{
  namespace
  {
    // Wall time of a measurement, s.
    constexpr double measured_time = 0.2;

    constexpr std::size_t largest_array = std::size_t(1) << 29;



    // The median time of work that is done again and again.
    double
    seconds(const std::function<void()> &work)
    {
      using Clock = std::chrono::steady_clock;
      std::vector<double> times;
      work(); // touches the memory
      for (const auto start = Clock::now();
           times.size() < 3 ||
           std::chrono::duration<double>(Clock::now() - start).count() <
             measured_time;)
        {
          const auto begin = Clock::now();
          work();
          times.push_back(
            std::chrono::duration<double>(Clock::now() - begin).count());
        }
      std::sort(times.begin(), times.end());
      return times[times.size() / 2];
    }



    // Of independent sums, as one would wait for its last addition.
    double
    sum(const double *const begin, const double *const end)
    {
      constexpr unsigned int width = 32;
      double sums[width]           = {};
      const double *x              = begin;
      for (; x + width <= end; x += width)
        for (unsigned int i = 0; i < width; ++i)
          sums[i] += x[i];
      double total = 0;
      for (const double part : sums)
        total += part;
      for (; x < end; ++x)
        total += *x;
      return total;
    }
  } // namespace



  double
  streaming_bandwidth(const std::size_t n_bytes)
  {
    const std::size_t n =
      std::max<std::size_t>(1 << 13,
                            std::min(n_bytes, largest_array) / sizeof(double));
    const std::vector<double> values(n, 1.);
    double total      = 0;
    const double time = seconds([&]() {
      total = sum_ranges<double>(n, [&](std::size_t begin, std::size_t end) {
        return sum(values.data() + begin, values.data() + end);
      });
    });
    AssertThrow(total == n, dealii::ExcInternalError()); // the sum is needed
    return n * sizeof(double) / time;
  }



  double
  matrix_product_speed()
  {
    constexpr dealii::types::blas_int n = 192;
    const unsigned int n_threads        = dealii::MultithreadInfo::n_threads();
    const std::vector<double> A(n * n, 1.), B(n * n, 1.);
    std::vector<std::vector<double>> C(n_threads, std::vector<double>(n * n));
    openblas_set_num_threads(1);
    constexpr unsigned int n_products = 8;
    const double time                 = seconds([&]() {
      run_tasks(n_threads, [&](const unsigned int thread) {
        for (unsigned int k = 0; k < n_products; ++k)
          {
            const double one = 1, zero = 0;
            dealii::gemm("N",
                         "T",
                         &n,
                         &n,
                         &n,
                         &one,
                         A.data(),
                         &n,
                         B.data(),
                         &n,
                         &zero,
                         C[thread].data(),
                         &n);
          }
      });
    });
    return 2. * n * n * n * n_products * n_threads / time;
  }
} // namespace ACF
