// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_node_matrix_kernels_h
#define acf_mechanics_node_matrix_kernels_h

#include <acf/base/lanes.h>
#include <acf/base/processor.h>
#include <acf/mechanics/node_matrix.h>

/*
 * The loops of ScalarNodeMatrix and BlockNodeMatrix over the rows of a product
 * and of a quadratic form. Four lanes are the components of a node and one
 * more, eight those of two vectors.
 */

namespace ACF
{
  namespace Kernels
  {
    // Row i of the block at p for each vector.
    ACF_INLINE Four
    block_row(const double *const p, const unsigned int i, Four)
    {
      return load_lanes<Four>(p + 3 * i);
    }

    ACF_INLINE Eight
    block_row(const double *const p, const unsigned int i, Eight)
    {
      const Four row = load_lanes<Four>(p + 3 * i);
      return __builtin_shufflevector(row, row, 0, 1, 2, 3, 0, 1, 2, 3);
    }



    // Component i is the sum over the lanes of s[i].
    ACF_INLINE Four
    sums_of_lanes(const Four (&s)[3])
    {
      const Four zero = {};
      const Four s01  = __builtin_shufflevector(s[0], s[1], 0, 4, 2, 6) +
                       __builtin_shufflevector(s[0], s[1], 1, 5, 3, 7);
      const Four s2 = __builtin_shufflevector(s[2], zero, 0, 4, 2, 6) +
                      __builtin_shufflevector(s[2], zero, 1, 5, 3, 7);
      return __builtin_shufflevector(s01, s2, 0, 1, 4, 5) +
             __builtin_shufflevector(s01, s2, 2, 3, 6, 7);
    }

    ACF_INLINE Eight
    sums_of_lanes(const Eight (&s)[3])
    {
      const Four low[3]  = {__builtin_shufflevector(s[0], s[0], 0, 1, 2, 3),
                            __builtin_shufflevector(s[1], s[1], 0, 1, 2, 3),
                            __builtin_shufflevector(s[2], s[2], 0, 1, 2, 3)};
      const Four high[3] = {__builtin_shufflevector(s[0], s[0], 4, 5, 6, 7),
                            __builtin_shufflevector(s[1], s[1], 4, 5, 6, 7),
                            __builtin_shufflevector(s[2], s[2], 4, 5, 6, 7)};
      return __builtin_shufflevector(
        sums_of_lanes(low), sums_of_lanes(high), 0, 1, 2, 3, 4, 5, 6, 7);
    }



    // The kinds of entries. A row of a product is the sum of those with the
    // entries on and above the diagonal, and of those with the transposed
    // entries above it, y_b += A_ab^T x_a.
    struct Block
    {
      static constexpr unsigned int size = 9;

      template <typename Lanes>
      struct Row
      {
        explicit ACF_INLINE
        Row(const Lanes &x)
          : x{splat<0>(x), splat<1>(x), splat<2>(x)}
        {}

        // adds the product with an entry, from the left
        ACF_INLINE void
        add(const double *const p, const Lanes &x_b)
        {
          ACF_UNROLL
          for (unsigned int i = 0; i < 3; ++i)
            sums[i] += block_row(p, i, Lanes()) * x_b;
        }

        ACF_INLINE Lanes
        transposed(const double *const p) const
        {
          return block_row(p, 0, Lanes()) * x[0] +
                 block_row(p, 1, Lanes()) * x[1] +
                 block_row(p, 2, Lanes()) * x[2];
        }

        // the fourth of four lanes, where x is zero, is a number of another
        // row
        ACF_INLINE Lanes
        sum() const
        {
          return sums_of_lanes(sums);
        }

        ACF_INLINE void
        scale(const double factor)
        {
          ACF_UNROLL
          for (unsigned int i = 0; i < 3; ++i)
            sums[i] *= factor;
        }

        // components of x at all places
        Lanes x[3];
        // lanes of row i
        Lanes sums[3] = {};
      };
    };

    struct Scalar
    {
      static constexpr unsigned int size = 1;

      template <typename Lanes>
      struct Row
      {
        explicit ACF_INLINE
        Row(const Lanes &x)
          : x(x)
        {}

        ACF_INLINE void
        add(const double *const p, const Lanes &x_b)
        {
          total += *p * x_b;
        }

        ACF_INLINE Lanes
        transposed(const double *const p) const
        {
          return *p * x;
        }

        ACF_INLINE Lanes
        sum() const
        {
          return total;
        }

        ACF_INLINE void
        scale(const double factor)
        {
          total *= factor;
        }

        Lanes x;
        Lanes total = {};
      };
    };



    // Some rows of a product.
    struct Rows
    {
      const NodeGraph &graph;
      const double *values;
      RowRange range;

      // a node is at the bits of its number that this has
      std::size_t mask;
      const double *x;
      double *y;
    };

    constexpr std::size_t all_bits = -1;



    // Row a of n vectors, for those that are at the shift.
    template <unsigned int n, typename Entry, typename Lanes>
    ACF_INLINE void
    multiply_row(const Rows &rows, const std::size_t a, const std::size_t shift)
    {
      constexpr unsigned int distance  = 4 * n;
      const NodeGraph &graph           = rows.graph;
      const std::size_t n_entries      = graph.n_upper(a);
      const unsigned int *const column = graph.upper_columns(a);
      const double *const entries =
        rows.values + Entry::size * graph.upper_start[a];
      const std::size_t mask = rows.mask;
      const double *const x  = rows.x + shift;
      double *const y        = rows.y + shift;
      const std::size_t own  = distance * (a & mask);
      const Lanes x_a        = load_lanes<Lanes>(x + own);
      typename Entry::template Row<Lanes> row(x_a);
      row.add(entries, x_a);
      for (std::size_t e = 1; e < n_entries; ++e)
        {
          const double *const A_ab = entries + Entry::size * e;
          const std::size_t b      = distance * (column[e] & mask);
          row.add(A_ab, load_lanes<Lanes>(x + b));
          add_lanes(row.transposed(A_ab), y + b);
        }
      add_lanes(row.sum(), y + own);
    }



    // y needs no values: it becomes zero node by node, when it is reached. Two
    // vectors are taken at once where there are registers for them.
    template <unsigned int n, typename Entry, unsigned int n_bytes>
    ACF_INLINE void
    multiply_entries(const Rows &rows)
    {
      std::size_t reach = rows.range.reach;
      for (std::size_t a = rows.range.begin; a < rows.range.end; ++a)
        {
          for (; reach < rows.graph.reach[a]; ++reach)
            {
              ACF_UNROLL
              for (unsigned int v = 0; v < n; ++v)
                store_lanes(Four{}, rows.y + 4 * (n * (reach & rows.mask) + v));
            }
          constexpr bool in_pairs     = n_bytes >= sizeof(Eight);
          constexpr unsigned int done = in_pairs ? n / 2 * 2 : 0;
          if constexpr (done > 0)
            multiply_row<n, Entry, Eight>(rows, a, 0);
          ACF_UNROLL
          for (unsigned int v = done; v < n; ++v)
            multiply_row<n, Entry, Four>(rows, a, 4 * v);
        }
    }



    // One function per instruction set.
#define ACF_PRODUCTS(name, attributes)              \
  template <unsigned int n, typename Entry>         \
  attributes void multiply_##name(const Rows &rows) \
  {                                                 \
    multiply_entries<n, Entry, name##_bytes>(rows); \
  }

    ACF_PRODUCTS(any, )
#if defined(__x86_64__)
    ACF_PRODUCTS(avx2, ACF_AVX2)
    ACF_PRODUCTS(avx512, ACF_AVX512)
#endif
#undef ACF_PRODUCTS

    template <unsigned int n, typename Entry>
    void
    multiply_rows(const Rows &rows)
    {
#if defined(__x86_64__)
      if (present_processor() == Processor::avx512)
        return multiply_avx512<n, Entry>(rows);
      if (present_processor() == Processor::avx2)
        return multiply_avx2<n, Entry>(rows);
#endif
      multiply_any<n, Entry>(rows);
    }



    // The sum over some rows of x_a (A_aa x_a + 2 sum_b>a A_ab x_b).
    template <typename Entry>
    struct QuadraticForm
    {
      ACF_INLINE void
      operator()() const
      {
        Four sum = {};
        for (std::size_t a = begin; a < end; ++a)
          {
            const std::size_t n_entries      = graph.n_upper(a);
            const unsigned int *const column = graph.upper_columns(a);
            const double *const entries =
              values + Entry::size * graph.upper_start[a];
            const Four x_a = load_three(x + 3 * a);
            typename Entry::template Row<Four> row(x_a);
            for (std::size_t e = 1; e < n_entries; ++e)
              row.add(entries + Entry::size * e,
                      load_three(x + 3 * std::size_t(column[e])));
            row.scale(2);
            row.add(entries, x_a);
            sum += x_a * row.sum();
          }
        result = sum[0] + sum[1] + sum[2];
      }

      const NodeGraph &graph;
      const double *values;
      const double *x;
      std::size_t begin, end;
      double &result;
    };
  } // namespace Kernels
} // namespace ACF

#endif
