// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// How close solves with a cached factor come to the bandwidth of the memory, as
// comma-separated values. A solve reads the factor twice, forward and backward;
// nothing else is of its size. The streaming bandwidth is that of the sum of an
// array that is larger than any cache, measured before each solve. Factors that
// fit into a cache may pass it. Bodies: the blade of the pendulum
// (prm/pendulum) and a cube, tetrahedra; the complex matrix of two stages for
// steps of 1 ms. Figures are medians.
//
// Usage: solve_bandwidth [--quick | THREADS]

#include <acf/base/huge_pages.h>
#include <acf/model.h>

#include <deal.II/base/multithread_info.h>

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <thread>

#include "pendulum_model.h"

namespace
{
  using namespace ACF;

  double
  seconds(const std::function<void()> &work)
  {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                         start)
      .count();
  }



  double
  median(std::vector<double> values)
  {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }



  // The sum of part of an array, with the widest registers of the machine.
  __attribute__((target_clones("avx512f", "avx2", "default"),
                 optimize("O3"))) double
  sum(const double *const begin, const std::size_t n)
  {
    constexpr unsigned int width = 32;
    double sums[width]           = {};
    for (std::size_t k = 0; k + width <= n; k += width)
      for (unsigned int i = 0; i < width; ++i)
        sums[i] += begin[k + i];
    double total = 0;
    for (const double part : sums)
      total += part;
    return total;
  }



  class StreamingBandwidth
  {
  public:
    StreamingBandwidth(const std::size_t n_bytes, const unsigned int n_threads)
      : n_threads(n_threads)
    {
      resize_in_huge_pages(values, n_bytes / sizeof(double));
      values.fill(1.);
    }

    /** Bytes per second. */
    double
    measure() const
    {
      std::vector<double> sums(n_threads);
      const double time = seconds([&]() {
        std::vector<std::thread> threads;
        const std::size_t n = values.size() / n_threads;
        for (unsigned int t = 0; t < n_threads; ++t)
          threads.emplace_back(
            [&, t]() { sums[t] = sum(values.data() + t * n, n); });
        for (std::thread &thread : threads)
          thread.join();
      });
      for (const double part : sums)
        AssertThrow(part > 0, ExcInternalError()); // the sum is needed
      return values.size() * sizeof(double) / time;
    }

  private:
    AlignedVector<double> values;
    const unsigned int n_threads;
  };



  std::string
  model_text(const std::string &kind, const std::string &cells)
  {
    const std::string text = Tests::pendulum_model("tetrahedron", cells);
    if (kind == "slender")
      return text;
    const std::string from = "-0.00125, 0, -0.025";
    const std::string to   = "0.00125, 1,  0.025";
    std::string cube       = text;
    cube.replace(cube.find(from), from.size(), "-0.05, 0, -0.05");
    cube.replace(cube.find(to), to.size(), "0.05, 0.1, 0.05");
    cube.replace(cube.find("0, 0.5, 0"), 9, "0, 0.05, 0");
    return cube;
  }



  void
  measure(const std::string &kind,
          const std::string &cells,
          const unsigned int n_solves,
          const StreamingBandwidth &streaming)
  {
    const Model model =
      read_model(ParameterFile::from_text(model_text(kind, cells)));
    const MultibodySystem system(model.system, model.directory);
    const Body &body = system.bodies()[0];
    const std::complex<double> shift(2e6, 4e6 * std::sqrt(2.));
    for (const auto precision :
         {FactorPrecision::double_precision, FactorPrecision::single_precision})
      {
        Statistics statistics;
        FactorizationCache cache(statistics, precision);
        auto &factor = cache.get(body, shift).factorization();
        std::vector<std::complex<double>> x(body.operators().n_unknowns());
        std::vector<double> times, bandwidths, shares;
        for (unsigned int k = 0; k < n_solves; ++k)
          {
            // in turn, as other users of the machine's memory come and go
            bandwidths.push_back(streaming.measure());
            std::fill(x.begin(), x.end(), 1.);
            times.push_back(seconds([&]() { factor.solve(x.data()); }));
            shares.push_back(2. * statistics.factor_bytes / times.back() /
                             bandwidths.back());
          }
        std::cout << kind << ',' << x.size() << ','
                  << MultithreadInfo::n_threads() << ','
                  << (precision == FactorPrecision::double_precision ? "double"
                                                                     : "single")
                  << ',' << statistics.factor_bytes << ',' << median(times)
                  << ',' << 2e-9 * statistics.factor_bytes / median(times)
                  << ',' << 1e-9 * median(bandwidths) << ',' << median(shares)
                  << std::endl;
      }
  }
} // namespace



int
main(int argc, char **argv)
{
  const bool quick = (argc > 1 && std::string(argv[1]) == "--quick");
  if (argc > 1 && !quick)
    MultithreadInfo::set_thread_limit(std::stoi(argv[1]));
  ACF::keep_heap_in_huge_pages();
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);

  // several times the largest last-level caches
  StreamingBandwidth streaming(quick ? 1u << 24 : 1u << 30,
                               MultithreadInfo::n_threads());
  std::cout << "body,unknowns,threads,precision,factor memory [B],solve [s],"
               "read [GB/s],streaming [GB/s],share"
            << std::endl;
  if (quick)
    measure("slender", "1, 8, 1", 3, streaming);
  else
    {
      for (const std::string cells :
           {"1, 40, 2", "1, 80, 4", "1, 112, 5", "1, 152, 8"})
        measure("slender", cells, 21, streaming);
      for (const std::string cells : {"4, 4, 4", "6, 6, 6", "8, 8, 8"})
        measure("bulky", cells, 21, streaming);
    }
  MPI_Finalize();
  return 0;
}
