// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/huge_pages.h>
#include <acf/base/lanes.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/mechanics/node_matrix.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>

namespace ACF
{
  namespace
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
          for (; reach <= rows.graph.last_column(a); ++reach)
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



    // Rows of the matrix, whose products reach the nodes from begin to reach.
    struct Part
    {
      std::size_t begin, end, reach;
      AlignedVector<double> y;
    };

    std::vector<Part>
    divide(const NodeGraph &graph)
    {
      const std::size_t n_nodes  = graph.n_nodes();
      const unsigned int n_parts = n_ranges(n_nodes);
      std::vector<Part> parts(n_parts);
      for (unsigned int p = 0; p < n_parts; ++p)
        {
          parts[p].begin = n_nodes * p / n_parts;
          parts[p].end   = n_nodes * (p + 1) / n_parts;
          parts[p].reach = graph.reach(parts[p].begin, parts[p].end);
        }
      return parts;
    }



    template <unsigned int n, typename Entry>
    void
    multiply(const NodeGraph &graph,
             const double *const values,
             NodeLanes &y,
             const NodeLanes &x)
    {
      constexpr unsigned int distance = 4 * n;
      if (n_ranges(graph.n_nodes()) == 1)
        {
          multiply_rows<n, Entry>({graph,
                                   values,
                                   {0, graph.n_nodes(), 0},
                                   all_bits,
                                   x.data(),
                                   y.data()});
          return;
        }
      std::vector<Part> parts = divide(graph);
      run_tasks(parts.size(), [&](const unsigned int p) {
        Part &part = parts[p];
        part.y.resize_fast(distance * (part.reach - part.begin));
        multiply_rows<n, Entry>({graph,
                                 values,
                                 {part.begin, part.end, part.begin},
                                 all_bits,
                                 x.data(),
                                 part.y.data() - distance * part.begin});
      });

      // of the part that has the row and of those before which reach it
      run_tasks(parts.size(), [&](const unsigned int p) {
        for (unsigned int q = p + 1; q-- > 0;)
          {
            const Part &part      = parts[q];
            const std::size_t end = std::min(parts[p].end, part.reach);
            for (std::size_t k = distance * parts[p].begin; k < distance * end;
                 ++k)
              y.data()[k] =
                (q == p ? 0 : y.data()[k]) + part.y[k - distance * part.begin];
          }
      });
    }



    template <typename Entry>
    void
    multiply(const NodeGraph &graph,
             const double *const values,
             NodeLanes &y,
             const NodeLanes &x)
    {
      AssertDimension(x.n_nodes(), graph.n_nodes());
      y.resize(x.n_nodes(), x.n_vectors());
      switch (x.n_vectors())
        {
          case 1:
            return multiply<1, Entry>(graph, values, y, x);
          case 2:
            return multiply<2, Entry>(graph, values, y, x);
          default:
            return multiply<3, Entry>(graph, values, y, x);
        }
    }



    template <typename Entry>
    void
    add_rows(const NodeGraph &graph,
             const double *const values,
             const RowRange &range,
             NodeLanes &y,
             const NodeLanes &x)
    {
      Assert((x.n_nodes() & (x.n_nodes() - 1)) == 0, ExcInternalError());
      AssertDimension(x.n_nodes(), y.n_nodes());
      AssertDimension(x.n_vectors(), y.n_vectors());
      const Rows rows{
        graph, values, range, x.n_nodes() - 1, x.data(), y.data()};
      if (x.n_vectors() == 1)
        multiply_rows<1, Entry>(rows);
      else if (x.n_vectors() == 2)
        multiply_rows<2, Entry>(rows);
      else
        multiply_rows<3, Entry>(rows);
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

    template <typename Entry>
    double
    quadratic_form(const NodeGraph &graph,
                   const double *const values,
                   const NodalVector &x)
    {
      AssertDimension(x.size(), dim * graph.n_nodes());
      return sum_ranges<double>(
        graph.n_nodes(), [&](const std::size_t begin, const std::size_t end) {
          double result;
          run_vectorized(
            QuadraticForm<Entry>{graph, values, x.begin(), begin, end, result});
          return result;
        });
    }



    // Two or three vectors at once.
    template <typename Entry>
    void
    multiply(const NodeGraph &graph,
             const double *const values,
             const std::vector<NodalVector *> &y,
             const std::vector<const NodalVector *> &x)
    {
      AssertDimension(y.size(), x.size());
      NodeLanes source, product;
      for (unsigned int v = 0; v < x.size();)
        {
          const unsigned int left = x.size() - v;
          const unsigned int n    = left % 3 == 0 ? 3 : std::min(left, 2U);
          source.resize(graph.n_nodes(), n);
          source.read(&x[v]);
          multiply<Entry>(graph, values, product, source);
          product.write(&y[v]);
          v += n;
        }
    }
  } // namespace



  NodeGraph::NodeGraph(std::vector<std::size_t> new_row_start,
                       std::vector<unsigned int> new_column)
    : row_start(std::move(new_row_start))
    , column(std::move(new_column))
    , upper_start(row_start.size(), 0)
  {
    unsigned int largest_reach = 0;
    for (unsigned int a = 0; a < n_nodes(); ++a)
      {
        const auto begin = column.begin() + row_start[a];
        const auto end   = column.begin() + row_start[a + 1];
        upper_start[a + 1] =
          upper_start[a] + (end - std::lower_bound(begin, end, a));
        largest_reach = std::max(largest_reach, last_column(a) + 1);
        bandwidth     = std::max(bandwidth, largest_reach - a);
      }
  }



  std::size_t
  NodeGraph::reach(const std::size_t begin, const std::size_t end) const
  {
    std::size_t result = end;
    for (std::size_t a = begin; a < end; ++a)
      result = std::max<std::size_t>(result, last_column(a) + 1);
    return result;
  }



  std::size_t
  NodeGraph::upper_entry(const unsigned int row, const unsigned int col) const
  {
    Assert(row <= col, ExcInternalError());
    const auto end   = column.begin() + row_start[row + 1];
    const auto begin = end - n_upper(row);
    const auto it    = std::lower_bound(begin, end, col);
    Assert(it != end && *it == col, ExcMessage("No such entry."));
    return upper_start[row] + (it - begin);
  }



  std::size_t
  NodeGraph::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(row_start) +
           MemoryConsumption::memory_consumption(upper_start) +
           MemoryConsumption::memory_consumption(column);
  }



  ScalarNodeMatrix::ScalarNodeMatrix(
    const std::shared_ptr<const NodeGraph> &graph)
    : node_graph(graph)
    , values(graph->upper_start.back())
  {}



  void
  ScalarNodeMatrix::add(const unsigned int row,
                        const unsigned int col,
                        const double value)
  {
    if (row <= col)
      values[node_graph->upper_entry(row, col)] += value;
  }



  void
  ScalarNodeMatrix::vmult(NodalVector &y, const NodalVector &x) const
  {
    vmult(std::vector<NodalVector *>{&y}, {&x});
  }



  void
  ScalarNodeMatrix::vmult(const std::vector<NodalVector *> &y,
                          const std::vector<const NodalVector *> &x) const
  {
    multiply<Scalar>(*node_graph, values.data(), y, x);
  }



  void
  ScalarNodeMatrix::add_rows(const RowRange &rows,
                             NodeLanes &y,
                             const NodeLanes &x) const
  {
    ACF::add_rows<Scalar>(*node_graph, values.data(), rows, y, x);
  }



  double
  ScalarNodeMatrix::quadratic_form(const NodalVector &x) const
  {
    return ACF::quadratic_form<Scalar>(*node_graph, values.data(), x);
  }



  std::vector<double>
  ScalarNodeMatrix::row_sums() const
  {
    std::vector<double> sums(node_graph->n_nodes());
    for (unsigned int a = 0; a < sums.size(); ++a)
      {
        const double *const m            = &values[node_graph->upper_start[a]];
        const unsigned int *const column = node_graph->upper_columns(a);
        sums[a] += m[0];
        for (std::size_t e = 1; e < node_graph->n_upper(a); ++e)
          {
            sums[a] += m[e];
            sums[column[e]] += m[e];
          }
      }
    return sums;
  }



  std::size_t
  ScalarNodeMatrix::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(values);
  }



  // products read four numbers from any of a block on
  BlockNodeMatrix::BlockNodeMatrix(
    const std::shared_ptr<const NodeGraph> &graph)
    : node_graph(graph)
  {
    resize_in_huge_pages(values, 9 * graph->upper_start.back() + 1);
  }



  BlockNodeMatrix &
  BlockNodeMatrix::operator=(const double value)
  {
    std::fill(values.begin(), values.end(), value);
    return *this;
  }



  void
  BlockNodeMatrix::add(const unsigned int row,
                       const unsigned int col,
                       const Matrix3 &block)
  {
    if (row > col)
      return;
    double *const entry = &values[9 * node_graph->upper_entry(row, col)];
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        entry[3 * i + j] += block[i][j];
  }



  void
  BlockNodeMatrix::vmult(NodalVector &y, const NodalVector &x) const
  {
    vmult(std::vector<NodalVector *>{&y}, {&x});
  }



  void
  BlockNodeMatrix::vmult(const std::vector<NodalVector *> &y,
                         const std::vector<const NodalVector *> &x) const
  {
    multiply<Block>(*node_graph, values.data(), y, x);
  }



  double
  BlockNodeMatrix::quadratic_form(const NodalVector &x) const
  {
    return ACF::quadratic_form<Block>(*node_graph, values.data(), x);
  }



  void
  BlockNodeMatrix::add_rows(const RowRange &rows,
                            NodeLanes &y,
                            const NodeLanes &x) const
  {
    ACF::add_rows<Block>(*node_graph, values.data(), rows, y, x);
  }



  std::size_t
  BlockNodeMatrix::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(values);
  }



  void
  BlockNodeMatrix::exchange(Archive &archive)
  {
    std::vector<double> entries(values.begin(), values.end());
    archive("values", entries);
    AssertDimension(entries.size(), values.size());
    std::copy(entries.begin(), entries.end(), values.begin());
  }
} // namespace ACF
