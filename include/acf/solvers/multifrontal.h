// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_multifrontal_h
#define acf_solvers_multifrontal_h

#include <acf/mechanics/node_matrix.h>
#include <acf/solvers/elimination_tree.h>

#include <functional>

namespace ACF
{
  /** The matrix $\sigma\, m \otimes I_3 + A$ of a body. */
  template <typename Number>
  struct ShiftedMatrix
  {
    const ScalarNodeMatrix &mass;
    const BlockNodeMatrix &stiffness;

    /** $\sigma$, 1/s^2 */
    Number shift;
  };

  /**
   * Takes the finished columns of a supernode: k columns of the unit lower
   * triangular L, with D on the diagonal, in column-major order. Rows are those
   * of the supernode, first the k of its diagonal block.
   */
  template <typename Number>
  using SupernodeSink =
    std::function<void(const unsigned int supernode,
                       const Number *columns,
                       const std::size_t leading_dimension)>;

  /**
   * Factorises $K = L D L^T$ (without conjugation) by the multifrontal method
   * (Duff and Reid, ACM Trans. Math. Softw. 9, 1983) with dense products of the
   * BLAS, without pivoting. Branches of the tree are factorised in parallel.
   * @param sink is called by several threads, for different supernodes
   * @throws SimulationError if a pivot is zero or not finite
   */
  template <typename Number>
  void
  factorize_multifrontal(const EliminationTree &tree,
                         const ShiftedMatrix<Number> &matrix,
                         const SupernodeSink<Number> &sink);
} // namespace ACF

#endif
