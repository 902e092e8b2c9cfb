// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/lanes.h>
#include <acf/base/linear_combination.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    // Numbers that stay in the first-level cache.
    constexpr std::size_t block_size = 512;



    // y = c_1 x_1 + c_2 x_2, or with another number of terms.
    template <unsigned int n>
    ACF_INLINE void
    combine(const double *const c,
            const double *const *const x,
            const std::size_t begin,
            const std::size_t end,
            double *const y)
    {
      std::size_t i = begin;
      for (; i + 8 <= end; i += 8)
        {
          Eight sum = c[0] * load_lanes<Eight>(x[0] + i);
          for (unsigned int k = 1; k < n; ++k)
            sum += c[k] * load_lanes<Eight>(x[k] + i);
          store_lanes(sum, y + i);
        }
      for (; i < end; ++i)
        {
          double sum = c[0] * x[0][i];
          for (unsigned int k = 1; k < n; ++k)
            sum += c[k] * x[k][i];
          y[i] = sum;
        }
    }



    // Three terms at once, the sum of those before being one of them.
    ACF_INLINE void
    combine_all(const unsigned int n_terms,
                const double *const c,
                const double *const *const x,
                const std::size_t begin,
                const std::size_t end,
                double *const y)
    {
      for (std::size_t first = begin; first < end; first += block_size)
        {
          const std::size_t last = std::min(first + block_size, end);
          unsigned int done      = std::min(n_terms, 3U);
          if (done == 1)
            combine<1>(c, x, first, last, y);
          else if (done == 2)
            combine<2>(c, x, first, last, y);
          else
            combine<3>(c, x, first, last, y);
          while (done < n_terms)
            {
              const bool two           = done + 1 < n_terms;
              const double factors[3]  = {1, c[done], two ? c[done + 1] : 0};
              const double *vectors[3] = {y, x[done], two ? x[done + 1] : y};
              if (two)
                combine<3>(factors, vectors, first, last, y);
              else
                combine<2>(factors, vectors, first, last, y);
              done += two ? 2 : 1;
            }
        }
    }



    // One function per instruction set.
#define ACF_COMBINATIONS(name, attributes)                     \
  attributes void combine_##name(const unsigned int n_terms,   \
                                 const double *const c,        \
                                 const double *const *const x, \
                                 const std::size_t begin,      \
                                 const std::size_t end,        \
                                 double *const y)              \
  {                                                            \
    combine_all(n_terms, c, x, begin, end, y);                 \
  }

    ACF_COMBINATIONS(any, )
#if defined(__x86_64__)
    ACF_COMBINATIONS(avx2, ACF_AVX2)
    ACF_COMBINATIONS(avx512, ACF_AVX512)
#endif
#undef ACF_COMBINATIONS
  } // namespace



  void
  linear_combination(const std::vector<ScaledVector> &terms, NodalVector &y)
  {
    const std::size_t n = terms.front().vector->size();
    if (y.size() != n)
      y.reinit(n, true);
    double *const result = y.begin();
    std::vector<double> c;
    std::vector<const double *> x;
    for (const ScaledVector &term : terms)
      {
        AssertDimension(term.vector->size(), n);
        c.push_back(term.factor);
        x.push_back(term.vector->begin());
      }
    run_ranges(n, [&](const std::size_t begin, const std::size_t end) {
#if defined(__x86_64__)
      if (present_processor() == Processor::avx512)
        return combine_avx512(c.size(), c.data(), x.data(), begin, end, result);
      if (present_processor() == Processor::avx2)
        return combine_avx2(c.size(), c.data(), x.data(), begin, end, result);
#endif
      combine_any(c.size(), c.data(), x.data(), begin, end, result);
    });
  }
} // namespace ACF
