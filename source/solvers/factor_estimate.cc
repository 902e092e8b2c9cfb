// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/factor_estimate.h>
#include <acf/solvers/joint_columns.h>
#include <acf/solvers/supernodal_factor.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    // Numbers of the largest front and of what is left of others below it, in
    // the order of factorize_multifrontal().
    std::size_t
    largest_work(const EliminationTree &tree)
    {
      const auto &supernodes = tree.supernodes();
      std::vector<std::size_t> of_children(supernodes.size(), 0);
      std::size_t largest_front = 0, stack = 0, largest_stack = 0;
      for (unsigned int s = 0; s < supernodes.size(); ++s)
        {
          const std::size_t k = dim * supernodes[s].n_columns;
          const std::size_t m = dim * supernodes[s].rows.size();
          largest_front       = std::max(largest_front, (k + m) * (k + m));
          stack += m * m - of_children[s];
          largest_stack = std::max(largest_stack, stack);
          if (supernodes[s].parent != EliminationTree::none)
            of_children[supernodes[s].parent] += m * m;
        }
      return largest_front + largest_stack;
    }
  } // namespace



  FactorEstimate
  estimate_factor(const ReferenceBody &body,
                  const EliminationTree &tree,
                  const bool is_real,
                  const bool single)
  {
    using Complex = std::complex<double>;

    FactorEstimate estimate;
    const std::size_t n_bytes    = is_real ? sizeof(double) : sizeof(Complex);
    const unsigned int n_columns = dim * body.functionals().size();
    estimate.n_entries           = tree.n_entries();
    const unsigned int n_rows    = body.operators().n_unknowns();
    estimate.column_bytes =
      is_real ? JointColumns<double>::n_bytes(n_rows, n_columns, single)
              : JointColumns<Complex>::n_bytes(n_rows, n_columns, single);
    estimate.work_bytes     = n_bytes * largest_work(tree);
    estimate.n_setup_solves = n_columns + (single ? 4 : 1);
    if (is_real)
      estimate.n_bytes = single
                           ? SupernodalFactor<double, float>::n_bytes(tree)
                           : SupernodalFactor<double, double>::n_bytes(tree);
    else
      estimate.n_bytes = single
                           ? SupernodalFactor<Complex, float>::n_bytes(tree)
                           : SupernodalFactor<Complex, double>::n_bytes(tree);

    // a column of n entries changes half of an n x n matrix; a product of
    // complex numbers has four of real ones
    for (const EliminationTree::Supernode &supernode : tree.supernodes())
      for (unsigned int j = 0; j < dim * supernode.n_columns; ++j)
        {
          const double n =
            dim * (supernode.n_columns + supernode.rows.size()) - j;
          estimate.n_operations += (is_real ? 1. : 4.) * n * n;
        }
    return estimate;
  }
} // namespace ACF
