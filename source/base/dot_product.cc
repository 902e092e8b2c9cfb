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
    struct AddProduct
    {
      template <typename Lanes>
      ACF_INLINE void
      run() const
      {
        constexpr unsigned int n = n_lanes<Lanes>;
        Lanes sums[4]            = {};
        std::size_t i            = begin;
        for (; i + 4 * n <= end; i += 4 * n)
          {
            ACF_UNROLL
            for (unsigned int k = 0; k < 4; ++k)
              sums[k] += load_lanes<Lanes>(x + i + n * k) *
                         load_lanes<Lanes>(y + i + n * k);
          }
        sum += sum_of_lanes((sums[0] + sums[1]) + (sums[2] + sums[3]));
        for (; i < end; ++i)
          sum += x[i] * y[i];
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
        run_in_lanes(AddProduct{x.begin(), y.begin(), begin, end, sum});
        return sum;
      });
  }
} // namespace ACF
