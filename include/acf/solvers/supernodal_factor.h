// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_supernodal_factor_h
#define acf_solvers_supernodal_factor_h

#include <acf/solvers/tree_partition.h>

#include <deal.II/base/aligned_vector.h>

#include <complex>
#include <memory>

namespace ACF
{
  namespace Kernels
  {
    template <typename Real>
    struct SupernodeView;
  }

  /**
   * The factor $L D L^T$ of a symmetric matrix, laid out for solves, which are
   * bound by the bandwidth of the memory: each solve reads L twice, in one
   * stream from its first to its last byte and in one back, for one to four
   * right-hand sides or for eight.
   *
   * The columns of a supernode are cut into panels of a few columns, these into
   * blocks of eight rows, with real and imaginary parts apart, so that the
   * inner loops are products of vectors of eight numbers: rows, or right-hand
   * sides if there are eight, which takes fewer instructions. Independent
   * branches of the tree are solved in parallel; sums do not depend on which
   * thread is faster, only on their number.
   *
   * @tparam Number double or std::complex<double>, of vectors
   * @tparam Real double or float, in which L is kept and solves are done
   */
  template <typename Number, typename Real>
  class SupernodalFactor
  {
  public:
    /** n_bytes() of the factor with a tree, without making it. */
    static std::size_t
    n_bytes(const EliminationTree &tree);

    /** @param n_threads that solve() uses */
    SupernodalFactor(const std::shared_ptr<const EliminationTree> &tree,
                     const unsigned int n_threads);

    /** Stores the columns of a supernode, see SupernodeSink. */
    void
    store(const unsigned int supernode,
          const Number *columns,
          const std::size_t leading_dimension);

    /**
     * Replaces right-hand sides by solutions.
     * @param vectors @p n_vectors vectors of all unknowns, ordered as the nodes
     * of the graph, one after the other
     */
    void
    solve(Number *vectors, const unsigned int n_vectors) const;

    /** Bytes that a solve reads twice. */
    std::size_t
    n_bytes() const
    {
      return values.size() * sizeof(Real);
    }

  private:
    /** Where the numbers of a supernode are, and how to loop over its rows. */
    struct Block
    {
      /** In @p values. */
      std::size_t offset;

      /** In @p places_below. */
      std::size_t offset_below;

      /** Its nodes, from this place on. */
      unsigned int first_place;

      unsigned int n_nodes;

      /** Nodes of the rows below, */
      unsigned int n_below;

      /** those that are in its own branch of the tree. */
      unsigned int n_own_below;

      /** Unknowns of its nodes. */
      unsigned int n_columns;

      /** Unknowns of its nodes and of the rows below. */
      unsigned int n_rows;
    };

    template <unsigned int n_vectors>
    class Solution;

    class InterleavedSolution;

    Kernels::SupernodeView<Real>
    view(const unsigned int supernode) const;

    template <typename SomeSolution>
    void
    solve_together(Number *vectors) const;

    std::shared_ptr<const EliminationTree> tree;
    const unsigned int n_threads;
    std::vector<Block> blocks;

    /** The rows below of all supernodes in one array, which is read in order.
     */
    std::vector<unsigned int> places_below;

    TreePartition partition;
    unsigned int longest_block = 0;
    dealii::AlignedVector<Real> values;
  };
} // namespace ACF

#endif
