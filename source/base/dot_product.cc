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



    struct AddProduct
    {
      ACF_INLINE void
      operator()() const
      {
        sum += multiply_and_add(x, y, begin, end);
      }

      const double *x;
      const double *y;
      std::size_t begin, end;
      double &sum;
    };
  } // namespace



  double
  dot_product(const NodalVector &x, const NodalVector &y)
  {
    AssertDimension(x.size(), y.size());
    return sum_ranges<double>(
      x.size(), [&](const std::size_t begin, const std::size_t end) {
        double sum = 0;
        run_vectorized(AddProduct{x.begin(), y.begin(), begin, end, sum});
        return sum;
      });
  }
} // namespace ACF
