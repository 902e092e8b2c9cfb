// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_factor_estimate_h
#define acf_solvers_factor_estimate_h

#include <acf/mechanics/body.h>
#include <acf/solvers/elimination_tree.h>

namespace ACF
{
  /** What a JointedFactorization will need, from the elimination tree. */
  struct FactorEstimate
  {
    /** Entries of the triangular factor, including the diagonal. */
    std::size_t n_entries = 0;

    /** Bytes that a solve reads twice. */
    std::size_t n_bytes = 0;

    /** Of the columns of joints. */
    std::size_t column_bytes = 0;

    /** Of the fronts while it is factorised, by one thread. */
    std::size_t work_bytes = 0;

    /** Right-hand sides that are solved for joints and checks. */
    unsigned int n_setup_solves = 0;

    /** Operations with real numbers of the factorisation. */
    double n_operations = 0;
  };

  /**
   * @param tree of the body's graph
   * @param is_real numbers of the matrix, otherwise complex ones
   * @param single whether it is kept in single precision
   */
  FactorEstimate
  estimate_factor(const ReferenceBody &body,
                  const EliminationTree &tree,
                  const bool is_real,
                  const bool single);
} // namespace ACF

#endif
