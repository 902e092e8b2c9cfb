// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/lanes.h>
#include <acf/base/parallel.h>
#include <acf/base/processor.h>
#include <acf/mechanics/node_matrix.h>

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/memory_consumption.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    // How n vectors are kept for a product: node by node, n_groups times Lanes.
    template <unsigned int n>
    struct Layout
    {
      // values of two vectors
      using Lanes                            = Eight;
      static constexpr unsigned int n_groups = (n + 1) / 2;
      static constexpr unsigned int n_lanes  = 8 * n_groups;
    };

    template <>
    struct Layout<1>
    {
      // of one, padded
      using Lanes                            = Four;
      static constexpr unsigned int n_groups = 1;
      static constexpr unsigned int n_lanes  = 4;
    };

    // Component j of each vector at its three places.
    template <int j>
    ACF_INLINE Four
    splat(const Four &x)
    {
      return __builtin_shufflevector(x, x, j, j, j, j);
    }

    template <int j>
    ACF_INLINE Eight
    splat(const Eight &x)
    {
      return __builtin_shufflevector(
        x, x, j, j, j, j, 4 + j, 4 + j, 4 + j, 4 + j);
    }

    // Column j of the block at p for each vector.
    ACF_INLINE Four
    block_column(const double *const p, const unsigned int j, Four)
    {
      return Four{p[j], p[3 + j], p[6 + j], 0};
    }

    ACF_INLINE Eight
    block_column(const double *const p, const unsigned int j, Eight)
    {
      const Eight A = load_lanes<Eight>(p + j);
      return __builtin_shufflevector(A, A, 0, 3, 6, 6, 0, 3, 6, 6);
    }

    // Row i.
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



    // The kinds of entries: y_a += A_ab x_b and y_b += A_ab^T x_a for an entry
    // at p.
    struct Block
    {
      static constexpr unsigned int size = 9;

      template <typename Lanes>
      ACF_INLINE static Lanes
      product(const double *const p, const Lanes &x)
      {
        return block_column(p, 0, Lanes()) * splat<0>(x) +
               block_column(p, 1, Lanes()) * splat<1>(x) +
               block_column(p, 2, Lanes()) * splat<2>(x);
      }

      template <typename Lanes>
      ACF_INLINE static Lanes
      transposed_product(const double *const p, const Lanes &x)
      {
        return block_row(p, 0, Lanes()) * splat<0>(x) +
               block_row(p, 1, Lanes()) * splat<1>(x) +
               block_row(p, 2, Lanes()) * splat<2>(x);
      }
    };

    struct Scalar
    {
      static constexpr unsigned int size = 1;

      template <typename Lanes>
      ACF_INLINE static Lanes
      product(const double *const p, const Lanes &x)
      {
        return *p * x;
      }

      template <typename Lanes>
      ACF_INLINE static Lanes
      transposed_product(const double *const p, const Lanes &x)
      {
        return *p * x;
      }
    };



    // Some rows of a product.
    struct Rows
    {
      const NodeGraph &graph;
      const double *values;
      std::size_t begin, end;
      const double *x;

      // of the nodes from begin on
      double *y;
    };



    template <unsigned int n, typename Entry>
    ACF_INLINE void
    multiply_entries(const Rows &rows)
    {
      using Lanes                     = typename Layout<n>::Lanes;
      constexpr unsigned int n_groups = Layout<n>::n_groups;
      constexpr unsigned int n_lanes  = Layout<n>::n_lanes;
      constexpr unsigned int width    = n_lanes / n_groups;
      const NodeGraph &graph          = rows.graph;
      double *const y                 = rows.y - n_lanes * rows.begin;
      for (std::size_t a = rows.begin; a < rows.end; ++a)
        {
          const std::size_t n_entries      = graph.n_upper(a);
          const unsigned int *const column = graph.upper_columns(a);
          const double *const entries =
            rows.values + Entry::size * graph.upper_start[a];
          for (unsigned int g = 0; g < n_groups; ++g)
            {
              const std::size_t shift = g * width;
              const Lanes x_a = load_lanes<Lanes>(rows.x + n_lanes * a + shift);
              Lanes sum       = Entry::product(entries, x_a);
              for (std::size_t e = 1; e < n_entries; ++e)
                {
                  const double *const A_ab = entries + Entry::size * e;
                  const std::size_t b      = n_lanes * column[e] + shift;
                  sum += Entry::product(A_ab, load_lanes<Lanes>(rows.x + b));
                  add_lanes(Entry::transposed_product(A_ab, x_a), y + b);
                }
              add_lanes(sum, y + n_lanes * a + shift);
            }
        }
    }



    // One function per instruction set.
#define ACF_PRODUCTS(name, attributes)              \
  template <unsigned int n, typename Entry>         \
  attributes void multiply_##name(const Rows &rows) \
  {                                                 \
    multiply_entries<n, Entry>(rows);               \
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
          parts[p].reach = parts[p].end;
          for (std::size_t a = parts[p].begin; a < parts[p].end; ++a)
            parts[p].reach = std::max<std::size_t>(
              parts[p].reach, graph.column[graph.row_start[a + 1] - 1] + 1);
        }
      return parts;
    }



    template <unsigned int n, typename Entry>
    void
    multiply(const NodeGraph &graph,
             const std::vector<double> &values,
             NodalVector *const *const y,
             const NodalVector *const *const x)
    {
      constexpr unsigned int n_lanes = Layout<n>::n_lanes;
      const std::size_t n_nodes      = graph.n_nodes();
      for (unsigned int v = 0; v < n; ++v)
        {
          AssertDimension(x[v]->size(), 3 * n_nodes);
          AssertDimension(y[v]->size(), x[v]->size());
        }

      AlignedVector<double> lanes;
      lanes.resize_fast(n_lanes * n_nodes);
      run_ranges(n_nodes, [&](const std::size_t begin, const std::size_t end) {
        for (std::size_t a = begin; a < end; ++a)
          for (unsigned int v = 0; v < n_lanes / 4; ++v)
            for (unsigned int i = 0; i < 4; ++i)
              lanes[n_lanes * a + 4 * v + i] =
                v < n && i < 3 ? x[v]->begin()[3 * a + i] : 0;
      });

      std::vector<Part> parts = divide(graph);
      run_tasks(parts.size(), [&](const unsigned int p) {
        Part &part = parts[p];
        part.y.resize(n_lanes * (part.reach - part.begin));
        multiply_rows<n, Entry>({graph,
                                 values.data(),
                                 part.begin,
                                 part.end,
                                 lanes.data(),
                                 part.y.data()});
      });

      // of the part that has the row and of those before which reach it
      run_tasks(parts.size(), [&](const unsigned int p) {
        for (unsigned int q = p + 1; q-- > 0;)
          {
            const Part &part      = parts[q];
            const std::size_t end = std::min(parts[p].end, part.reach);
            for (std::size_t a = parts[p].begin; a < end; ++a)
              for (unsigned int v = 0; v < n; ++v)
                for (unsigned int i = 0; i < 3; ++i)
                  {
                    double &entry = y[v]->begin()[3 * a + i];
                    entry         = (q == p ? 0 : entry) +
                            part.y[n_lanes * (a - part.begin) + 4 * v + i];
                  }
          }
      });
    }



    // Two or three vectors at once, as there are stages.
    template <typename Entry>
    void
    multiply(const NodeGraph &graph,
             const std::vector<double> &values,
             const std::vector<NodalVector *> &y,
             const std::vector<const NodalVector *> &x)
    {
      AssertDimension(y.size(), x.size());
      unsigned int v = 0;
      if (x.size() % 3 == 0)
        for (; v < x.size(); v += 3)
          multiply<3, Entry>(graph, values, &y[v], &x[v]);
      for (; v + 2 <= x.size(); v += 2)
        multiply<2, Entry>(graph, values, &y[v], &x[v]);
      if (v < x.size())
        multiply<1, Entry>(graph, values, &y[v], &x[v]);
    }
  } // namespace



  NodeGraph::NodeGraph(std::vector<std::size_t> new_row_start,
                       std::vector<unsigned int> new_column)
    : row_start(std::move(new_row_start))
    , column(std::move(new_column))
    , upper_start(row_start.size(), 0)
  {
    for (unsigned int a = 0; a < n_nodes(); ++a)
      {
        const auto begin = column.begin() + row_start[a];
        const auto end   = column.begin() + row_start[a + 1];
        upper_start[a + 1] =
          upper_start[a] + (end - std::lower_bound(begin, end, a));
      }
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
    multiply<Scalar>(*node_graph, values, {&y}, {&x});
  }



  void
  ScalarNodeMatrix::vmult(const std::vector<NodalVector *> &y,
                          const std::vector<const NodalVector *> &x) const
  {
    multiply<Scalar>(*node_graph, values, y, x);
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



  // products read up to eight numbers from any of a block on
  BlockNodeMatrix::BlockNodeMatrix(
    const std::shared_ptr<const NodeGraph> &graph)
    : node_graph(graph)
    , values(9 * graph->upper_start.back() + 8)
  {}



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
    multiply<Block>(*node_graph, values, {&y}, {&x});
  }



  void
  BlockNodeMatrix::vmult(const std::vector<NodalVector *> &y,
                         const std::vector<const NodalVector *> &x) const
  {
    multiply<Block>(*node_graph, values, y, x);
  }



  std::size_t
  BlockNodeMatrix::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(values);
  }



  void
  BlockNodeMatrix::exchange(Archive &archive)
  {
    archive("values", values);
  }
} // namespace ACF
