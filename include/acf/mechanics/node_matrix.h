// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_node_matrix_h
#define acf_mechanics_node_matrix_h

#include <acf/mechanics/node_lanes.h>

#include <algorithm>
#include <memory>

namespace ACF
{
  class Archive;

  /**
   * Which nodes of a body are coupled: compressed rows of sorted node numbers,
   * the diagonal included. Structurally symmetric.
   */
  struct NodeGraph
  {
    NodeGraph(std::vector<std::size_t> row_start,
              std::vector<unsigned int> column);

    /** Start of each row in @p column; size n_nodes + 1. */
    std::vector<std::size_t> row_start;

    /** Node numbers, ascending in each row. */
    std::vector<unsigned int> column;

    /** How many entries on and above the diagonal the rows before have; size
     * n_nodes + 1. Those of a row are the last ones of the row. */
    std::vector<std::size_t> upper_start;

    unsigned int
    n_nodes() const
    {
      return row_start.size() - 1;
    }

    /** Entries of a row on and above the diagonal. */
    std::size_t
    n_upper(const unsigned int row) const
    {
      return upper_start[row + 1] - upper_start[row];
    }

    /**
     * Number of an entry among those on and above the diagonal.
     * @pre the entry exists, and row <= col
     */
    std::size_t
    upper_entry(const unsigned int row, const unsigned int col) const;

    /** Their columns, the row itself first. */
    const unsigned int *
    upper_columns(const unsigned int row) const
    {
      return &column[row_start[row + 1] - n_upper(row)];
    }

    /** The first node behind all that a row and those before it have entries
     * for; size n_nodes. */
    std::vector<unsigned int> reach;

    /** Nodes from a row to its reach, at most. */
    unsigned int bandwidth = 0;

    /** Bytes held. */
    std::size_t
    memory_consumption() const;
  };



  /** Rows of a product that is made from the first row to the last. */
  struct RowRange
  {
    std::size_t begin, end;

    /** That of the row before (NodeGraph); begin for the first ones. */
    std::size_t reach;
  };



  /**
   * A symmetric matrix $m_{ab}$ that acts on each component alike:
   * $y_a = \sum_b m_{ab} x_b$ with $x_b \in R^3$, that is $m \otimes I_3$.
   * The mass matrix of a body. Holds the entries with $a \le b$.
   */
  class ScalarNodeMatrix
  {
  public:
    explicit ScalarNodeMatrix(const std::shared_ptr<const NodeGraph> &graph);

    /** Adds to an entry if row <= col, as the others are not held. */
    void
    add(const unsigned int row, const unsigned int col, const double value);

    /** $y = (m \otimes I_3) x$, vectors of size 3 n_nodes. */
    void
    vmult(NodalVector &y, const NodalVector &x) const;

    /** The same for several vectors, for which the matrix is read once. */
    void
    vmult(const std::vector<NodalVector *> &y,
          const std::vector<const NodalVector *> &x) const;

    /**
     * Adds to y what the entries of some rows contribute, the transposed ones
     * included: after them all $y_a$ of these rows are complete as far as the
     * rows before belong to the same product, and those from there to the reach
     * are on the way. New nodes of y become zero when they are reached.
     *
     * x and y are windows on the nodes that are in use: node a is at its number
     * modulo their size, a power of two that is at least the number of rows
     * plus the bandwidth. The fourth numbers of y mean nothing.
     */
    void
    add_rows(const RowRange &rows, NodeLanes &y, const NodeLanes &x) const;

    /** $x^T (m \otimes I_3) x$, without the product. */
    double
    quadratic_form(const NodalVector &x) const;

    /** Row sums $\sum_b m_{ab}$, size n_nodes. */
    std::vector<double>
    row_sums() const;

    const NodeGraph &
    graph() const
    {
      return *node_graph;
    }

    /** $m_{ab}$, which must be an entry of the graph. */
    double
    value(const unsigned int a, const unsigned int b) const
    {
      return values[node_graph->upper_entry(std::min(a, b), std::max(a, b))];
    }

    std::size_t
    memory_consumption() const;

  private:
    std::shared_ptr<const NodeGraph> node_graph;
    std::vector<double> values;
  };



  /** A 3x3 block $A_{ab}$ of a BlockNodeMatrix. */
  class NodeBlock
  {
  public:
    /** @param block nine numbers row by row */
    NodeBlock(const double *block, const bool transposed)
      : block(block)
      , transposed(transposed)
    {}

    double
    operator()(const unsigned int i, const unsigned int j) const
    {
      return transposed ? block[3 * j + i] : block[3 * i + j];
    }

  private:
    const double *block;
    bool transposed;
  };



  /**
   * A symmetric matrix of 3x3 blocks, $y_a = \sum_b A_{ab} x_b$. The stiffness
   * matrix of a body. Holds the blocks with $a \le b$.
   */
  class BlockNodeMatrix
  {
  public:
    explicit BlockNodeMatrix(const std::shared_ptr<const NodeGraph> &graph);

    /** Sets all entries to a number. */
    BlockNodeMatrix &
    operator=(const double value);

    /** Adds to a block if row <= col, as the others are not held. */
    void
    add(const unsigned int row, const unsigned int col, const Matrix3 &block);

    /** $y = A x$, vectors of size 3 n_nodes. */
    void
    vmult(NodalVector &y, const NodalVector &x) const;

    /** The same for several vectors, for which the matrix is read once. */
    void
    vmult(const std::vector<NodalVector *> &y,
          const std::vector<const NodalVector *> &x) const;

    /** $x^T A x$, without the product. */
    double
    quadratic_form(const NodalVector &x) const;

    /** See ScalarNodeMatrix::add_rows(). */
    void
    add_rows(const RowRange &rows, NodeLanes &y, const NodeLanes &x) const;

    const NodeGraph &
    graph() const
    {
      return *node_graph;
    }

    /** $A_{ab}$, which must be an entry of the graph. */
    NodeBlock
    block(const unsigned int a, const unsigned int b) const
    {
      return {
        &values[9 * node_graph->upper_entry(std::min(a, b), std::max(a, b))],
        a > b};
    }

    std::size_t
    memory_consumption() const;

    /** Saves or loads the entries. */
    void
    exchange(Archive &archive);

  private:
    std::shared_ptr<const NodeGraph> node_graph;
    AlignedVector<double> values;
  };
} // namespace ACF

#endif
