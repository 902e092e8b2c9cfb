// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_tree_partition_h
#define acf_solvers_tree_partition_h

#include <acf/solvers/elimination_tree.h>

namespace ACF
{
  /** Branches of an elimination tree for threads, and what is above them. */
  struct TreePartition
  {
    /**
     * Supernodes of one or more branches for each thread, in the order of
     * elimination. They have no rows in branches of other threads.
     */
    std::vector<std::vector<unsigned int>> branches;

    /** The others, in the order of elimination. */
    std::vector<unsigned int> top;

    /** Per supernode. */
    std::vector<bool> is_top;
  };

  /**
   * Divides a tree so that the largest share of a thread plus the top has few
   * entries.
   */
  TreePartition
  divide_tree(const EliminationTree &tree, const unsigned int n_threads);
} // namespace ACF

#endif
