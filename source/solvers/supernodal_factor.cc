// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/huge_pages.h>
#include <acf/base/parallel.h>

#include "supernodal_solution.h"

namespace ACF
{
  namespace
  {
    // Factors smaller than this (bytes) are not worth the threads.
    constexpr std::size_t smallest_parallel_factor = 1 << 20;



    std::size_t
    n_values(const EliminationTree::Supernode &supernode,
             const unsigned int planes)
    {
      const unsigned int n_columns = dim * supernode.n_columns;
      const unsigned int n_rows    = n_columns + dim * supernode.rows.size();
      std::size_t n                = 0;
      for (unsigned int j = 0; j < n_columns; j += Kernels::panel_width)
        n += Kernels::panel_size(j,
                                 std::min(Kernels::panel_width, n_columns - j),
                                 n_rows,
                                 planes);
      return n;
    }
  } // namespace



  template <typename Number, typename Real>
  std::size_t
  SupernodalFactor<Number, Real>::n_bytes(const EliminationTree &tree)
  {
    std::size_t n = 0;
    for (const EliminationTree::Supernode &supernode : tree.supernodes())
      n += ACF::n_values(supernode, n_planes<Number>);
    return n * sizeof(Real);
  }



  template <typename Number, typename Real>
  SupernodalFactor<Number, Real>::SupernodalFactor(
    const std::shared_ptr<const EliminationTree> &tree,
    const unsigned int n_threads)
    : tree(tree)
    , n_threads(n_threads)
  {
    std::size_t n = 0;
    for (const EliminationTree::Supernode &supernode : tree->supernodes())
      {
        Block block;
        block.offset       = n;
        block.offset_below = places_below.size();
        block.first_place  = supernode.first;
        block.n_nodes      = supernode.n_columns;
        block.n_below      = supernode.rows.size();
        block.n_columns    = dim * block.n_nodes;
        block.n_rows       = block.n_columns + dim * block.n_below;
        places_below.insert(places_below.end(),
                            supernode.rows.begin(),
                            supernode.rows.end());
        n += n_values(supernode, n_planes<Number>);
        longest_block = std::max(longest_block, block.n_rows);
        blocks.push_back(block);
      }
    resize_in_huge_pages(values, n);
    partition =
      divide_tree(*tree, n_bytes() < smallest_parallel_factor ? 1 : n_threads);
    for (unsigned int s = 0; s < blocks.size(); ++s)
      {
        const auto &rows   = tree->supernodes()[s].rows;
        unsigned int n_own = rows.size();
        if (!partition.is_top[s])
          while (n_own > 0 &&
                 partition.is_top[tree->supernode_at(rows[n_own - 1])])
            --n_own;
        blocks[s].n_own_below = n_own;
      }
  }



  template <typename Number, typename Real>
  void
  SupernodalFactor<Number, Real>::store(const unsigned int supernode,
                                        const Number *columns,
                                        const std::size_t leading_dimension)
  {
    constexpr unsigned int planes = n_planes<Number>;
    const Block &block            = blocks[supernode];
    Real *value                   = values.data() + block.offset;
    const auto entry = [&](const unsigned int row, const unsigned int column) {
      return columns[column * leading_dimension + row];
    };
    for (unsigned int j = 0; j < block.n_columns;)
      {
        const unsigned int width =
          std::min(Kernels::panel_width, block.n_columns - j);
        Real *position   = value;
        const auto store = [&](Number x) {
          for (unsigned int p = 0; p < planes; ++p)
            *position++ = plane(x, p);
        };
        for (unsigned int c = 0; c < width; ++c)
          store(1. / entry(j + c, j + c));
        for (unsigned int c = 0; c < width; ++c)
          for (unsigned int r = c + 1; r < width; ++r)
            store(entry(j + r, j + c));
        position = value + Kernels::triangle_size(width, planes);
        for (unsigned int row = Kernels::first_vector_row(j, width);
             row < block.n_rows;
             row += Kernels::lanes)
          for (unsigned int c = 0; c < width; ++c)
            for (unsigned int p = 0; p < planes; ++p)
              for (unsigned int i = 0; i < Kernels::lanes; ++i, ++position)
                if (row + i >= j + width && row + i < block.n_rows)
                  {
                    Number x  = entry(row + i, j + c);
                    *position = plane(x, p);
                  }
        value += Kernels::panel_size(j, width, block.n_rows, planes);
        j += width;
      }
  }



  template <typename Number, typename Real>
  Kernels::SupernodeView<Real>
  SupernodalFactor<Number, Real>::view(const unsigned int s) const
  {
    const std::size_t end =
      s + 1 < blocks.size() ? blocks[s + 1].offset : values.size();
    return {values.data() + blocks[s].offset,
            blocks[s].n_columns,
            blocks[s].n_rows,
            end - blocks[s].offset};
  }



  template <typename Number, typename Real>
  template <typename SomeSolution>
  void
  SupernodalFactor<Number, Real>::solve_together(Number *vectors) const
  {
    SomeSolution solution(*this);
    auto &x                          = solution.x;
    constexpr unsigned int node_size = SomeSolution::node_size;
    solution.read(vectors);

    const unsigned int n_branches = partition.branches.size();
    // what branches but the first subtract above themselves
    std::vector<dealii::AlignedVector<Real>> sums(n_branches);
    run_tasks(n_branches, [&](const unsigned int branch) {
      if (branch > 0)
        sums[branch].resize(x.size());
      solution.forward(partition.branches[branch],
                       branch > 0 ? sums[branch].data() : x.data());
    });
    for (const unsigned int s : partition.top)
      for (unsigned int branch = 1; branch < n_branches; ++branch)
        {
          const std::size_t begin = blocks[s].first_place * node_size;
          for (unsigned int k = 0; k < blocks[s].n_nodes * node_size; ++k)
            x[begin + k] += sums[branch][begin + k];
        }
    solution.forward(partition.top, x.data());
    solution.backward(partition.top);
    run_tasks(n_branches, [&](const unsigned int branch) {
      solution.backward(partition.branches[branch]);
    });

    solution.write(vectors);
  }



  template <typename Number, typename Real>
  void
  SupernodalFactor<Number, Real>::solve(Number *vectors,
                                        const unsigned int n_vectors) const
  {
    const std::size_t n   = tree->n_unknowns();
    const auto solve_some = [&](const unsigned int first,
                                const unsigned int n_some) {
      Number *const some = vectors + first * n;
      switch (n_some)
        {
          case 1:
            return solve_together<Solution<1>>(some);
          case 2:
            return solve_together<Solution<2>>(some);
          case 3:
            return solve_together<Solution<3>>(some);
          case 4:
            return solve_together<Solution<4>>(some);
          default:
            return solve_together<InterleavedSolution>(some);
        }
    };

    // As many as possible together, but something for all threads of small
    // factors, which have no branches for them.
    const bool has_branches      = partition.branches.size() > 1;
    const unsigned int n_in_turn = has_branches ? 1 : n_threads;
    constexpr unsigned int many = InterleavedSolution::n_vectors, few = 4;
    const unsigned int n_by_many = n_vectors / (many * n_in_turn) * n_in_turn;
    const unsigned int n_left    = n_vectors - many * n_by_many;
    const auto solve_block       = [&](const unsigned int block) {
      if (block < n_by_many)
        return solve_some(many * block, many);
      const unsigned int first = few * (block - n_by_many);
      solve_some(many * n_by_many + first, std::min(few, n_left - first));
    };
    const unsigned int n_blocks = n_by_many + (n_left + few - 1) / few;
    if (has_branches)
      for (unsigned int block = 0; block < n_blocks; ++block)
        solve_block(block);
    else
      run_tasks(n_blocks, solve_block);
  }



  template class SupernodalFactor<double, double>;
  template class SupernodalFactor<double, float>;
  template class SupernodalFactor<std::complex<double>, double>;
  template class SupernodalFactor<std::complex<double>, float>;
} // namespace ACF
