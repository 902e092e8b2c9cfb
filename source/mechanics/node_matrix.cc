// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/huge_pages.h>
#include <acf/base/parallel.h>
#include <acf/mechanics/node_matrix.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>

#include "node_matrix_kernels.h"

namespace ACF
{
  namespace
  {
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
          parts[p].reach = graph.reach[parts[p].end - 1];
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
          Kernels::multiply_rows<n, Entry>({graph,
                                            values,
                                            {0, graph.n_nodes(), 0},
                                            Kernels::all_bits,
                                            x.data(),
                                            y.data()});
          return;
        }
      std::vector<Part> parts = divide(graph);
      run_tasks(parts.size(), [&](const unsigned int p) {
        Part &part = parts[p];
        part.y.resize_fast(distance * (part.reach - part.begin));
        Kernels::multiply_rows<n, Entry>(
          {graph,
           values,
           {part.begin, part.end, part.begin},
           Kernels::all_bits,
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
      const Kernels::Rows rows{
        graph, values, range, x.n_nodes() - 1, x.data(), y.data()};
      if (x.n_vectors() == 1)
        Kernels::multiply_rows<1, Entry>(rows);
      else if (x.n_vectors() == 2)
        Kernels::multiply_rows<2, Entry>(rows);
      else
        Kernels::multiply_rows<3, Entry>(rows);
    }



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
          run_vectorized(Kernels::QuadraticForm<Entry>{
            graph, values, x.begin(), begin, end, result});
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
    reach.reserve(n_nodes());
    for (unsigned int a = 0; a < n_nodes(); ++a)
      {
        const auto begin = column.begin() + row_start[a];
        const auto end   = column.begin() + row_start[a + 1];
        upper_start[a + 1] =
          upper_start[a] + (end - std::lower_bound(begin, end, a));
        reach.push_back(std::max(a == 0 ? 0 : reach.back(), *(end - 1) + 1));
        bandwidth = std::max(bandwidth, reach.back() - a);
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
           MemoryConsumption::memory_consumption(column) +
           MemoryConsumption::memory_consumption(reach);
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
    multiply<Kernels::Scalar>(*node_graph, values.data(), y, x);
  }



  void
  ScalarNodeMatrix::add_rows(const RowRange &rows,
                             NodeLanes &y,
                             const NodeLanes &x) const
  {
    ACF::add_rows<Kernels::Scalar>(*node_graph, values.data(), rows, y, x);
  }



  double
  ScalarNodeMatrix::quadratic_form(const NodalVector &x) const
  {
    return ACF::quadratic_form<Kernels::Scalar>(*node_graph, values.data(), x);
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
    multiply<Kernels::Block>(*node_graph, values.data(), y, x);
  }



  double
  BlockNodeMatrix::quadratic_form(const NodalVector &x) const
  {
    return ACF::quadratic_form<Kernels::Block>(*node_graph, values.data(), x);
  }



  void
  BlockNodeMatrix::add_rows(const RowRange &rows,
                            NodeLanes &y,
                            const NodeLanes &x) const
  {
    ACF::add_rows<Kernels::Block>(*node_graph, values.data(), rows, y, x);
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
