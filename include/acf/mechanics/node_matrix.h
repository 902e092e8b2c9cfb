// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_node_matrix_h
#define acf_mechanics_node_matrix_h

#include <acf/base/types.h>

#include <memory>

namespace ACF
{
  /**
   * Which nodes of a body are coupled: compressed rows of sorted node numbers,
   * the diagonal included. Structurally symmetric.
   */
  struct NodeGraph
  {
    /** Start of each row in @p column; size n_nodes + 1. */
    std::vector<std::size_t> row_start;

    /** Node numbers, ascending in each row. */
    std::vector<unsigned int> column;

    unsigned int
    n_nodes() const
    {
      return row_start.size() - 1;
    }

    /**
     * Position of an entry in @p column.
     * @pre the entry exists
     */
    std::size_t
    entry(const unsigned int row, const unsigned int col) const;

    /** Bytes held. */
    std::size_t
    memory_consumption() const;
  };



  /**
   * A symmetric matrix $m_{ab}$ that acts on each component alike:
   * $y_a = \sum_b m_{ab} x_b$ with $x_b \in R^3$, that is $m \otimes I_3$.
   * The mass matrix of a body.
   */
  class ScalarNodeMatrix
  {
  public:
    explicit ScalarNodeMatrix(const std::shared_ptr<const NodeGraph> &graph);

    void
    add(const unsigned int row, const unsigned int col, const double value);

    /** $y = (m \otimes I_3) x$, vectors of size 3 n_nodes. */
    void
    vmult(NodalVector &y, const NodalVector &x) const;

    /** The same for several vectors, for which the matrix is read once. */
    void
    vmult(std::vector<NodalVector> &y, const std::vector<NodalVector> &x) const;

    /** Row sums $\sum_b m_{ab}$, size n_nodes. */
    std::vector<double>
    row_sums() const;

    const NodeGraph &
    graph() const
    {
      return *node_graph;
    }

    /** Entry at a position of the graph. */
    double
    value(const std::size_t position) const
    {
      return values[position];
    }

    std::size_t
    memory_consumption() const;

  private:
    std::shared_ptr<const NodeGraph> node_graph;
    std::vector<double> values;
  };



  /**
   * A symmetric matrix of 3x3 blocks, $y_a = \sum_b A_{ab} x_b$. The stiffness
   * matrix of a body.
   */
  class BlockNodeMatrix
  {
  public:
    explicit BlockNodeMatrix(const std::shared_ptr<const NodeGraph> &graph);

    /** Sets all entries to a number. */
    BlockNodeMatrix &
    operator=(const double value);

    void
    add(const unsigned int row, const unsigned int col, const Matrix3 &block);

    /** $y = A x$, vectors of size 3 n_nodes. */
    void
    vmult(NodalVector &y, const NodalVector &x) const;

    /** The same for several vectors, for which the matrix is read once. */
    void
    vmult(std::vector<NodalVector> &y, const std::vector<NodalVector> &x) const;

    const NodeGraph &
    graph() const
    {
      return *node_graph;
    }

    /** The nine entries, row by row, of the block at a position of the graph.
     */
    const double *
    block(const std::size_t position) const
    {
      return &values[9 * position];
    }

    std::size_t
    memory_consumption() const;

  private:
    std::shared_ptr<const NodeGraph> node_graph;
    std::vector<double> values;
  };
} // namespace ACF

#endif
