// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_elimination_tree_h
#define acf_solvers_elimination_tree_h

#include <acf/mechanics/node_matrix.h>

#include <cstddef>
#include <vector>

namespace ACF
{
  /**
   * The symbolic factorisation $L D L^T$ of a symmetric matrix with the pattern
   * of a NodeGraph: in which order nodes are eliminated, and which rows of L
   * are not zero. Columns with (nearly) the same rows below them form
   * supernodes, dense blocks of L. Everything counts nodes; each stands for
   * three unknowns. (Davis, Direct Methods for Sparse Linear Systems, 2006,
   * Sec. 4; Ashcraft and Grimes, ACM Trans. Math. Softw. 15, 1989, for merging
   * supernodes that differ.)
   *
   * "Places" are numbers of nodes in the order of elimination.
   */
  class EliminationTree
  {
  public:
    /**
     * Takes the order of approximate minimum degree, or that of nested
     * dissection where it leaves fewer entries in L (both of CHOLMOD), and
     * merges supernodes. Depends on the graph only.
     * @throws SimulationError if memory runs out
     */
    explicit EliminationTree(const NodeGraph &graph);

    struct Supernode
    {
      /** Place of the first column. */
      unsigned int first;

      unsigned int n_columns;

      /** Places of the rows below the diagonal block, ascending. */
      std::vector<unsigned int> rows;

      /** The supernode with the first of these rows, or none. */
      unsigned int parent;
    };

    static constexpr unsigned int none = static_cast<unsigned int>(-1);

    /** In the order of elimination: children come before their parents. */
    const std::vector<Supernode> &
    supernodes() const
    {
      return tree;
    }

    /** The node at a place. */
    const std::vector<unsigned int> &
    node() const
    {
      return node_at;
    }

    /** The place of a node. */
    const std::vector<unsigned int> &
    place() const
    {
      return place_of;
    }

    /** The supernode with the column at a place. */
    unsigned int
    supernode_at(const unsigned int place) const
    {
      return supernode_of[place];
    }

    /** Unknowns, three per node. */
    unsigned int
    n_unknowns() const
    {
      return 3 * node_at.size();
    }

    /** Entries of L, including the diagonal and zeros in supernodes. */
    std::size_t
    n_entries() const;

  private:
    void
    find_supernodes(const std::vector<unsigned int> &parent,
                    const std::vector<unsigned int> &n_rows);

    void
    find_rows(const NodeGraph &graph);

    std::vector<unsigned int> node_at;
    std::vector<unsigned int> place_of;
    std::vector<unsigned int> supernode_of;
    std::vector<Supernode> tree;
  };

  /** Entries of a supernode's columns, for unknowns. */
  std::size_t
  n_entries(const EliminationTree::Supernode &supernode);
} // namespace ACF

#endif
