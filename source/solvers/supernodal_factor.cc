// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/huge_pages.h>
#include <acf/base/parallel.h>
#include <acf/solvers/supernodal_factor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "supernodal_kernels.h"

namespace ACF
{
  namespace
  {
    // Factors smaller than this (bytes) are not worth the threads.
    constexpr std::size_t smallest_parallel_factor = 1 << 20;



    template <typename Number>
    constexpr unsigned int n_planes = sizeof(Number) / sizeof(double);



    // Real or imaginary part of a number.
    double &
    plane(double &x, const unsigned int)
    {
      return x;
    }

    double &
    plane(std::complex<double> &x, const unsigned int p)
    {
      return reinterpret_cast<double(&)[2]>(x)[p];
    }



    // One function per direction and instruction set.
#define ACF_SOLVES(name, attributes)                                     \
  template <typename Real, unsigned int planes, unsigned int n_vectors>  \
  attributes void forward_##name(const Kernels::SupernodeView<Real> &s,  \
                                 const Kernels::Work<Real> &t)           \
  {                                                                      \
    Kernels::forward<Real, planes, n_vectors>(s, t);                     \
  }                                                                      \
  template <typename Real, unsigned int planes, unsigned int n_vectors>  \
  attributes void backward_##name(const Kernels::SupernodeView<Real> &s, \
                                  const Kernels::Work<Real> &t)          \
  {                                                                      \
    Kernels::backward<Real, planes, n_vectors>(s, t);                    \
  }

    ACF_SOLVES(any, )
#if defined(__x86_64__)
    ACF_SOLVES(avx2, ACF_AVX2)
    ACF_SOLVES(avx512, ACF_AVX512)
#endif
#undef ACF_SOLVES

    template <typename Real>
    using Solve = void (*)(const Kernels::SupernodeView<Real> &,
                           const Kernels::Work<Real> &);

    template <typename Real, unsigned int planes, unsigned int n_vectors>
    Solve<Real>
    choose_solve(const bool forward)
    {
#if defined(__x86_64__)
      if (present_processor() == Processor::avx512)
        return forward ? forward_avx512<Real, planes, n_vectors>
                       : backward_avx512<Real, planes, n_vectors>;
      if (present_processor() == Processor::avx2)
        return forward ? forward_avx2<Real, planes, n_vectors>
                       : backward_avx2<Real, planes, n_vectors>;
#endif
      return forward ? forward_any<Real, planes, n_vectors>
                     : backward_any<Real, planes, n_vectors>;
    }
  } // namespace



  namespace
  {
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
  {
    std::size_t n = 0;
    for (const EliminationTree::Supernode &supernode : tree->supernodes())
      {
        Block block;
        block.offset    = n;
        block.n_columns = dim * supernode.n_columns;
        block.n_rows    = block.n_columns + dim * supernode.rows.size();
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
        blocks[s].n_own_rows = n_own;
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



  /**
   * Solves with some right-hand sides at once, which it keeps in the order of
   * elimination: x[place][component][vector and plane]. In single precision
   * they are scaled to one, so that none is too small for it.
   */
  template <typename Number, typename Real>
  template <unsigned int n_vectors>
  class SupernodalFactor<Number, Real>::Solution
  {
  public:
    explicit Solution(const SupernodalFactor &factor)
      : factor(factor)
      , tree(*factor.tree)
      , longest(Kernels::round_up(factor.longest_block))
      , x(n_x * tree.n_unknowns())
    {}

    void
    read(Number *const vectors)
    {
      const std::size_t n = tree.n_unknowns();
      for (unsigned int v = 0; v < n_vectors; ++v)
        {
          scales[v] = 1;
          if (std::is_same<Real, float>::value)
            {
              double size = 0;
              for (std::size_t k = 0; k < n; ++k)
                for (unsigned int p = 0; p < planes; ++p)
                  size = std::max(size, std::abs(plane(vectors[v * n + k], p)));
              if (size > 0)
                scales[v] = size;
            }
          for (std::size_t place = 0; place < n / dim; ++place)
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int p = 0; p < planes; ++p)
                x[(dim * place + i) * n_x + v * planes + p] =
                  plane(vectors[v * n + dim * tree.node()[place] + i], p) /
                  scales[v];
        }
    }

    void
    write(Number *const vectors)
    {
      const std::size_t n = tree.n_unknowns();
      for (unsigned int v = 0; v < n_vectors; ++v)
        for (std::size_t place = 0; place < n / dim; ++place)
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int p = 0; p < planes; ++p)
              plane(vectors[v * n + dim * tree.node()[place] + i], p) =
                scales[v] * x[(dim * place + i) * n_x + v * planes + p];
    }

    void
    solve()
    {
      const TreePartition &partition = factor.partition;
      const unsigned int n_branches  = partition.branches.size();
      // what branches but the first subtract above themselves
      std::vector<std::vector<Real>> sums(n_branches);
      run_tasks(n_branches, [&](const unsigned int branch) {
        if (branch > 0)
          sums[branch].resize(x.size());
        forward(partition.branches[branch],
                branch > 0 ? sums[branch].data() : x.data());
      });
      for (const unsigned int s : partition.top)
        for (unsigned int branch = 1; branch < n_branches; ++branch)
          {
            const std::size_t begin = dim * tree.supernodes()[s].first * n_x;
            for (unsigned int k = 0; k < factor.blocks[s].n_columns * n_x; ++k)
              x[begin + k] += sums[branch][begin + k];
          }
      forward(partition.top, x.data());
      backward(partition.top);
      run_tasks(n_branches, [&](const unsigned int branch) {
        backward(partition.branches[branch]);
      });
    }

  private:
    static constexpr unsigned int planes = n_planes<Number>;
    static constexpr unsigned int n_x    = planes * n_vectors;

    /** Rows are at [vector and plane][row] with the given distance. */
    static void
    read_node(const Real *x, Real *rows, const std::size_t distance)
    {
      for (unsigned int k = 0; k < n_x; ++k)
        for (unsigned int i = 0; i < dim; ++i)
          rows[k * distance + i] = x[i * n_x + k];
    }

    static void
    write_node(const Real *rows, const std::size_t distance, Real *x)
    {
      for (unsigned int k = 0; k < n_x; ++k)
        for (unsigned int i = 0; i < dim; ++i)
          x[i * n_x + k] = rows[k * distance + i];
    }

    static void
    add_node(const Real *rows, const std::size_t distance, Real *x)
    {
      for (unsigned int k = 0; k < n_x; ++k)
        for (unsigned int i = 0; i < dim; ++i)
          x[i * n_x + k] += rows[k * distance + i];
    }

    Kernels::SupernodeView<Real>
    view(const unsigned int s) const
    {
      const auto &blocks = factor.blocks;
      const std::size_t end =
        s + 1 < blocks.size() ? blocks[s + 1].offset : factor.values.size();
      return {factor.values.data() + blocks[s].offset,
              blocks[s].n_columns,
              blocks[s].n_rows,
              end - blocks[s].offset};
    }

    /** @param sums takes what belongs to rows above the branches */
    void
    forward(const std::vector<unsigned int> &supernodes, Real *const sums)
    {
      const Solve<Real> solve = choose_solve<Real, planes, n_vectors>(true);
      dealii::AlignedVector<Real> work(longest * n_x);
      for (const unsigned int s : supernodes)
        {
          const auto &supernode      = tree.supernodes()[s];
          const Block &block         = factor.blocks[s];
          const std::size_t distance = Kernels::round_up(block.n_rows);
          Real *const rows           = work.data();
          Real *const below          = rows + block.n_columns;
          Real *const own            = x.data() + dim * supernode.first * n_x;
          for (unsigned int k = 0; k < supernode.n_columns; ++k)
            read_node(own + dim * k * n_x, rows + dim * k, distance);
          for (unsigned int k = 0; k < n_x; ++k)
            std::fill(below + k * distance, rows + (k + 1) * distance, Real(0));
          solve(view(s), {rows, distance});
          for (unsigned int k = 0; k < supernode.n_columns; ++k)
            write_node(rows + dim * k, distance, own + dim * k * n_x);
          for (unsigned int k = 0; k < supernode.rows.size(); ++k)
            add_node(below + dim * k,
                     distance,
                     (k < block.n_own_rows ? x.data() : sums) +
                       dim * supernode.rows[k] * n_x);
        }
    }

    void
    backward(const std::vector<unsigned int> &supernodes)
    {
      const Solve<Real> solve = choose_solve<Real, planes, n_vectors>(false);
      dealii::AlignedVector<Real> work(longest * n_x);
      for (unsigned int l = supernodes.size(); l-- > 0;)
        {
          const unsigned int s       = supernodes[l];
          const auto &supernode      = tree.supernodes()[s];
          const Block &block         = factor.blocks[s];
          const std::size_t distance = Kernels::round_up(block.n_rows);
          Real *const rows           = work.data();
          Real *const own            = x.data() + dim * supernode.first * n_x;
          for (unsigned int k = 0; k < supernode.n_columns; ++k)
            read_node(own + dim * k * n_x, rows + dim * k, distance);
          for (unsigned int k = 0; k < supernode.rows.size(); ++k)
            read_node(x.data() + dim * supernode.rows[k] * n_x,
                      rows + block.n_columns + dim * k,
                      distance);
          for (unsigned int k = 0; k < n_x; ++k)
            std::fill(rows + k * distance + block.n_rows,
                      rows + (k + 1) * distance,
                      Real(0));
          solve(view(s), {rows, distance});
          for (unsigned int k = 0; k < supernode.n_columns; ++k)
            write_node(rows + dim * k, distance, own + dim * k * n_x);
        }
    }

    const SupernodalFactor &factor;
    const EliminationTree &tree;
    const std::size_t longest;
    std::vector<Real> x;
    std::array<double, n_vectors> scales;
  };



  template <typename Number, typename Real>
  template <unsigned int n_vectors>
  void
  SupernodalFactor<Number, Real>::solve_together(Number *vectors) const
  {
    Solution<n_vectors> solution(*this);
    solution.read(vectors);
    solution.solve();
    solution.write(vectors);
  }



  template <typename Number, typename Real>
  void
  SupernodalFactor<Number, Real>::solve(Number *vectors,
                                        const unsigned int n_vectors) const
  {
    // four at a time; small factors have no branches for threads
    constexpr unsigned int largest = 4;
    const std::size_t n            = tree->n_unknowns();
    const auto solve_some          = [&](const unsigned int block) {
      const unsigned int first = largest * block;
      Number *const some       = vectors + first * n;
      switch (std::min(largest, n_vectors - first))
        {
          case 4:
            return solve_together<4>(some);
          case 3:
            return solve_together<3>(some);
          case 2:
            return solve_together<2>(some);
          default:
            return solve_together<1>(some);
        }
    };
    const unsigned int n_blocks = (n_vectors + largest - 1) / largest;
    if (partition.branches.size() == 1)
      run_tasks(n_blocks, solve_some);
    else
      for (unsigned int block = 0; block < n_blocks; ++block)
        solve_some(block);
  }



  template class SupernodalFactor<double, double>;
  template class SupernodalFactor<double, float>;
  template class SupernodalFactor<std::complex<double>, double>;
  template class SupernodalFactor<std::complex<double>, float>;
} // namespace ACF
