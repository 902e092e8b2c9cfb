// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/dot_product.h>
#include <acf/base/lanes.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>

namespace ACF
{
  namespace
  {
    // Four sums that do not wait for each other.
    ACF_INLINE double
    multiply_and_add(const double *const x,
                     const double *const y,
                     const std::size_t begin,
                     const std::size_t end)
    {
      Eight sums[4] = {};
      std::size_t i = begin;
      for (; i + 32 <= end; i += 32)
        {
          ACF_UNROLL
          for (unsigned int k = 0; k < 4; ++k)
            sums[k] += load_lanes<Eight>(x + i + 8 * k) *
                       load_lanes<Eight>(y + i + 8 * k);
        }
      const Eight sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
      double total    = 0;
      for (unsigned int k = 0; k < 8; ++k)
        total += sum[k];
      for (; i < end; ++i)
        total += x[i] * y[i];
      return total;
    }



    // Numbers of x that stay in the first-level cache.
    constexpr std::size_t block_size = 1024;

    // Sums of the products with vectors y.
    struct AddProducts
    {
      ACF_INLINE void
      operator()() const
      {
        for (std::size_t first = begin; first < end; first += block_size)
          {
            const std::size_t last =
              first + block_size < end ? first + block_size : end;
            for (std::size_t k = 0; k < n_vectors; ++k)
              sums[k] += multiply_and_add(x, y[k], first, last);
          }
      }

      const double *x;
      const double *const *y;
      std::size_t n_vectors;
      std::size_t begin, end;
      double *sums;
    };

    // that sum_ranges() adds up
    struct Sums
    {
      Sums &
      operator+=(const Sums &other)
      {
        for (std::size_t k = 0; k < values.size(); ++k)
          values[k] += other.values[k];
        return *this;
      }

      std::vector<double> values;
    };
  } // namespace



  std::vector<double>
  dot_products(const NodalVector &x, const std::vector<const NodalVector *> &y)
  {
    std::vector<const double *> vectors;
    for (const NodalVector *const vector : y)
      {
        AssertDimension(x.size(), vector->size());
        vectors.push_back(vector->begin());
      }
    return sum_ranges<Sums>(x.size(),
                            [&](const std::size_t begin,
                                const std::size_t end) {
                              Sums sums;
                              sums.values.resize(y.size());
                              run_vectorized(AddProducts{x.begin(),
                                                         vectors.data(),
                                                         y.size(),
                                                         begin,
                                                         end,
                                                         sums.values.data()});
                              return sums;
                            })
      .values;
  }



  double
  dot_product(const NodalVector &x, const NodalVector &y)
  {
    AssertDimension(x.size(), y.size());
    return sum_ranges<double>(
      x.size(), [&](const std::size_t begin, const std::size_t end) {
        double sum           = 0;
        const double *vector = y.begin();
        run_vectorized(AddProducts{x.begin(), &vector, 1, begin, end, &sum});
        return sum;
      });
  }
} // namespace ACF
