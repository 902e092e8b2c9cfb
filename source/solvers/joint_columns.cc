// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/lanes.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/solvers/joint_columns.h>

#include <algorithm>
#include <array>

namespace ACF
{
  namespace
  {
    typedef float EightSingle __attribute__((vector_size(32)));

    // Columns that are subtracted at once, and numbers of x that stay in the
    // first-level cache meanwhile.
    constexpr unsigned int group_size = 6;
    constexpr std::size_t block_size  = 1024;

    // Some columns and their factors, real and imaginary part.
    struct ColumnGroup
    {
      unsigned int n_columns = 0;
      std::array<const float *, group_size> columns;
      std::array<std::array<double, 2>, group_size> factors;
    };



    ACF_INLINE Eight
    load(const float *const p)
    {
      return __builtin_convertvector(load_lanes<EightSingle>(p), Eight);
    }



    // x -= Y F for the numbers from begin to end. Complex ones are pairs, so
    // both are even then.
    template <bool is_complex>
    ACF_INLINE void
    subtract_group(const ColumnGroup &group,
                   const std::size_t begin,
                   const std::size_t end,
                   double *const x)
    {
      std::size_t i = begin;
      for (; i + 8 <= end; i += 8)
        {
          Eight sum = load_lanes<Eight>(x + i);
          for (unsigned int k = 0; k < group.n_columns; ++k)
            {
              const Eight y   = load(group.columns[k] + i);
              const double re = group.factors[k][0];
              sum -= re * y;
              if constexpr (is_complex)
                {
                  const double im = group.factors[k][1];
                  const Eight signs{-im, im, -im, im, -im, im, -im, im};
                  sum -= signs *
                         __builtin_shufflevector(y, y, 1, 0, 3, 2, 5, 4, 7, 6);
                }
            }
          store_lanes(sum, x + i);
        }
      for (; i < end; i += (is_complex ? 2 : 1))
        for (unsigned int k = 0; k < group.n_columns; ++k)
          {
            const float *const y = group.columns[k] + i;
            const double re      = group.factors[k][0];
            x[i] -= re * y[0];
            if constexpr (is_complex)
              {
                const double im = group.factors[k][1];
                x[i] += im * y[1];
                x[i + 1] -= re * y[1] + im * y[0];
              }
          }
    }



    // One function per instruction set.
#define ACF_GROUPS(name, attributes)                              \
  template <bool is_complex>                                      \
  attributes void subtract_group_##name(const ColumnGroup &group, \
                                        const std::size_t begin,  \
                                        const std::size_t end,    \
                                        double *const x)          \
  {                                                               \
    subtract_group<is_complex>(group, begin, end, x);             \
  }

    ACF_GROUPS(any, )
#if defined(__x86_64__)
    ACF_GROUPS(avx2, ACF_AVX2)
    ACF_GROUPS(avx512, ACF_AVX512)
#endif
#undef ACF_GROUPS

    using Subtract = void (*)(const ColumnGroup &,
                              const std::size_t,
                              const std::size_t,
                              double *);

    template <bool is_complex>
    Subtract
    choose_subtract()
    {
#if defined(__x86_64__)
      if (present_processor() == Processor::avx512)
        return subtract_group_avx512<is_complex>;
      if (present_processor() == Processor::avx2)
        return subtract_group_avx2<is_complex>;
#endif
      return subtract_group_any<is_complex>;
    }
  } // namespace



  template <typename Number>
  JointColumns<Number>::JointColumns(std::vector<Number> columns,
                                     const std::size_t n_rows,
                                     const bool single)
    : n_rows(n_rows)
  {
    if (!single)
      {
        values = std::move(columns);
        return;
      }
    const double *const numbers =
      reinterpret_cast<const double *>(columns.data());
    single_values.assign(numbers,
                         numbers +
                           columns.size() * sizeof(Number) / sizeof(double));
  }



  template <typename Number>
  std::vector<Number>
  JointColumns<Number>::column(const std::size_t index) const
  {
    std::vector<Number> result(n_rows);
    if (single_values.empty())
      std::copy_n(values.begin() + index * n_rows, n_rows, result.begin());
    else
      {
        const std::size_t n = n_rows * sizeof(Number) / sizeof(double);
        std::copy_n(single_values.begin() + index * n,
                    n,
                    reinterpret_cast<double *>(result.data()));
      }
    return result;
  }



  template <typename Number>
  void
  JointColumns<Number>::subtract_product(const Vector &F, Number *const x) const
  {
    if (single_values.empty())
      {
        using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
        Eigen::Map<Vector>(x, n_rows).noalias() -=
          Eigen::Map<const Matrix>(values.data(), n_rows, F.size()) * F;
        return;
      }

    constexpr bool is_complex = sizeof(Number) > sizeof(double);
    const std::size_t n       = n_rows * sizeof(Number) / sizeof(double);
    std::vector<ColumnGroup> groups;
    for (unsigned int k = 0; k < F.size(); ++k)
      if (F(k) != Number(0))
        {
          if (groups.empty() || groups.back().n_columns == group_size)
            groups.emplace_back();
          ColumnGroup &group             = groups.back();
          group.columns[group.n_columns] = single_values.data() + k * n;
          group.factors[group.n_columns] = {{std::real(F(k)), std::imag(F(k))}};
          ++group.n_columns;
        }
    const Subtract subtract = choose_subtract<is_complex>();
    double *const numbers   = reinterpret_cast<double *>(x);
    run_ranges(n / 2, [&](const std::size_t begin, const std::size_t end) {
      // of pairs
      const std::size_t last = (end == n / 2 ? n : 2 * end);
      for (std::size_t i = 2 * begin; i < last; i += block_size)
        for (const ColumnGroup &group : groups)
          subtract(group, i, std::min(i + block_size, last), numbers);
    });
  }



  template class JointColumns<double>;
  template class JointColumns<std::complex<double>>;
} // namespace ACF
