// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/node_matrix.h>

#include <deal.II/base/memory_consumption.h>
#include <deal.II/base/parallel.h>

#include <algorithm>
#include <array>

namespace ACF
{
  namespace
  {
    // Rows that one task of the matrix-vector products takes at least.
    constexpr unsigned int grain_size = 512;

    template <typename RowRange>
    void
    for_all_rows(const unsigned int n_rows, const RowRange &range)
    {
      parallel::apply_to_subranges(0U, n_rows, range, grain_size);
    }



    // Some rows of a product with n vectors.
    struct ScalarRows
    {
      const NodeGraph &graph;
      const std::vector<double> &values;

      template <std::size_t n>
      void
      multiply_row(const unsigned int a,
                   const std::array<const double *, n> &x,
                   double (&sum)[n][3]) const
      {
        for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1];
             ++e)
          {
            const std::size_t b = 3 * graph.column[e];
            const double m_ab   = values[e];
            for (unsigned int v = 0; v < n; ++v)
              for (unsigned int i = 0; i < 3; ++i)
                sum[v][i] += m_ab * x[v][b + i];
          }
      }
    };



    struct BlockRows
    {
      const NodeGraph &graph;
      const std::vector<double> &values;

      template <std::size_t n>
      void
      multiply_row(const unsigned int a,
                   const std::array<const double *, n> &x,
                   double (&sum)[n][3]) const
      {
        const double *A_ab = &values[9 * graph.row_start[a]];
        for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1];
             ++e, A_ab += 9)
          {
            const std::size_t b = 3 * graph.column[e];
            for (unsigned int v = 0; v < n; ++v)
              for (unsigned int i = 0; i < 3; ++i)
                sum[v][i] += A_ab[3 * i] * x[v][b] +
                             A_ab[3 * i + 1] * x[v][b + 1] +
                             A_ab[3 * i + 2] * x[v][b + 2];
          }
      }
    };



    template <std::size_t n, typename Rows>
    void
    multiply(const unsigned int n_nodes,
             const Rows &rows,
             const std::array<double *, n> &y,
             const std::array<const double *, n> &x)
    {
      for_all_rows(n_nodes,
                   [&](const unsigned int begin, const unsigned int end) {
                     for (unsigned int a = begin; a < end; ++a)
                       {
                         double sum[n][3] = {};
                         rows.template multiply_row<n>(a, x, sum);
                         for (unsigned int v = 0; v < n; ++v)
                           std::copy_n(sum[v], 3, y[v] + 3 * a);
                       }
                   });
    }



    template <typename Rows>
    void
    multiply(const unsigned int n_nodes,
             const Rows &rows,
             NodalVector &y,
             const NodalVector &x)
    {
      AssertDimension(x.size(), 3 * n_nodes);
      AssertDimension(y.size(), x.size());
      multiply<1>(n_nodes, rows, {{y.begin()}}, {{x.begin()}});
    }



    // Two or three at once, as there are stages.
    template <typename Rows>
    void
    multiply(const unsigned int n_nodes,
             const Rows &rows,
             std::vector<NodalVector> &y,
             const std::vector<NodalVector> &x)
    {
      AssertDimension(y.size(), x.size());
      for (unsigned int v = 0; v < x.size(); ++v)
        {
          AssertDimension(x[v].size(), 3 * n_nodes);
          AssertDimension(y[v].size(), x[v].size());
        }
      unsigned int v = 0;
      if (x.size() % 3 == 0)
        for (; v < x.size(); v += 3)
          multiply<3>(n_nodes,
                      rows,
                      {{y[v].begin(), y[v + 1].begin(), y[v + 2].begin()}},
                      {{x[v].begin(), x[v + 1].begin(), x[v + 2].begin()}});
      for (; v + 2 <= x.size(); v += 2)
        multiply<2>(n_nodes,
                    rows,
                    {{y[v].begin(), y[v + 1].begin()}},
                    {{x[v].begin(), x[v + 1].begin()}});
      if (v < x.size())
        multiply(n_nodes, rows, y[v], x[v]);
    }
  } // namespace



  std::size_t
  NodeGraph::entry(const unsigned int row, const unsigned int col) const
  {
    const auto begin = column.begin() + row_start[row];
    const auto end   = column.begin() + row_start[row + 1];
    const auto it    = std::lower_bound(begin, end, col);
    Assert(it != end && *it == col, ExcMessage("No such entry."));
    return it - column.begin();
  }



  std::size_t
  NodeGraph::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(row_start) +
           MemoryConsumption::memory_consumption(column);
  }



  ScalarNodeMatrix::ScalarNodeMatrix(
    const std::shared_ptr<const NodeGraph> &graph)
    : node_graph(graph)
    , values(graph->column.size())
  {}



  void
  ScalarNodeMatrix::add(const unsigned int row,
                        const unsigned int col,
                        const double value)
  {
    values[node_graph->entry(row, col)] += value;
  }



  void
  ScalarNodeMatrix::vmult(NodalVector &y, const NodalVector &x) const
  {
    multiply(node_graph->n_nodes(), ScalarRows{*node_graph, values}, y, x);
  }



  void
  ScalarNodeMatrix::vmult(std::vector<NodalVector> &y,
                          const std::vector<NodalVector> &x) const
  {
    multiply(node_graph->n_nodes(), ScalarRows{*node_graph, values}, y, x);
  }



  std::vector<double>
  ScalarNodeMatrix::row_sums() const
  {
    std::vector<double> sums(node_graph->n_nodes());
    for (unsigned int a = 0; a < sums.size(); ++a)
      for (std::size_t e = node_graph->row_start[a];
           e < node_graph->row_start[a + 1];
           ++e)
        sums[a] += values[e];
    return sums;
  }



  std::size_t
  ScalarNodeMatrix::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(values);
  }



  BlockNodeMatrix::BlockNodeMatrix(
    const std::shared_ptr<const NodeGraph> &graph)
    : node_graph(graph)
    , values(9 * graph->column.size())
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
    double *const entry = &values[9 * node_graph->entry(row, col)];
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        entry[3 * i + j] += block[i][j];
  }



  void
  BlockNodeMatrix::vmult(NodalVector &y, const NodalVector &x) const
  {
    multiply(node_graph->n_nodes(), BlockRows{*node_graph, values}, y, x);
  }



  void
  BlockNodeMatrix::vmult(std::vector<NodalVector> &y,
                         const std::vector<NodalVector> &x) const
  {
    multiply(node_graph->n_nodes(), BlockRows{*node_graph, values}, y, x);
  }



  std::size_t
  BlockNodeMatrix::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(values);
  }
} // namespace ACF
