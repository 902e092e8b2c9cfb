// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/node_matrix.h>

#include <deal.II/base/memory_consumption.h>
#include <deal.II/base/parallel.h>

#include <algorithm>

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
    AssertDimension(x.size(), 3 * node_graph->n_nodes());
    AssertDimension(y.size(), x.size());
    const double *const source = x.begin();
    double *const destination  = y.begin();

    for_all_rows(node_graph->n_nodes(),
                 [&](const unsigned int begin, const unsigned int end) {
                   for (unsigned int a = begin; a < end; ++a)
                     {
                       double sum[3] = {0, 0, 0};
                       for (std::size_t e = node_graph->row_start[a];
                            e < node_graph->row_start[a + 1];
                            ++e)
                         {
                           const double *const x_b =
                             source + 3 * node_graph->column[e];
                           const double m_ab = values[e];
                           sum[0] += m_ab * x_b[0];
                           sum[1] += m_ab * x_b[1];
                           sum[2] += m_ab * x_b[2];
                         }
                       std::copy_n(sum, 3, destination + 3 * a);
                     }
                 });
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
    AssertDimension(x.size(), 3 * node_graph->n_nodes());
    AssertDimension(y.size(), x.size());
    const double *const source = x.begin();
    double *const destination  = y.begin();

    for_all_rows(node_graph->n_nodes(),
                 [&](const unsigned int begin, const unsigned int end) {
                   for (unsigned int a = begin; a < end; ++a)
                     {
                       double sum[3] = {0, 0, 0};
                       const double *A_ab =
                         &values[9 * node_graph->row_start[a]];
                       for (std::size_t e = node_graph->row_start[a];
                            e < node_graph->row_start[a + 1];
                            ++e, A_ab += 9)
                         {
                           const double *const x_b =
                             source + 3 * node_graph->column[e];
                           for (unsigned int i = 0; i < 3; ++i)
                             sum[i] += A_ab[3 * i] * x_b[0] +
                                       A_ab[3 * i + 1] * x_b[1] +
                                       A_ab[3 * i + 2] * x_b[2];
                         }
                       std::copy_n(sum, 3, destination + 3 * a);
                     }
                 });
  }



  std::size_t
  BlockNodeMatrix::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(values);
  }
} // namespace ACF
