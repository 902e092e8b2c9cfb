// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/huge_pages.h>
#include <acf/base/lanes.h>
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



  namespace
  {
    // The components of a node and one number more, which means nothing.
    template <typename Real>
    struct Quads;

    template <>
    struct Quads<double>
    {
      typedef double type __attribute__((vector_size(32)));
      typedef long long mask __attribute__((vector_size(32)));
    };

    template <>
    struct Quads<float>
    {
      typedef float type __attribute__((vector_size(16)));
      typedef int mask __attribute__((vector_size(16)));
    };

    constexpr unsigned int quad = 4;

    template <typename Real>
    ACF_INLINE typename Quads<Real>::type
    load_quad(const Real *const p)
    {
      return load_lanes<typename Quads<Real>::type>(p);
    }

    // With zero as fourth number.
    template <typename Real>
    ACF_INLINE typename Quads<Real>::type
    load_components(const Real *const p)
    {
      const typename Quads<Real>::mask is_component = {-1, -1, -1, 0};
      return is_component ? load_quad(p) : typename Quads<Real>::type{};
    }



    // The largest absolute value of n numbers.
    struct LargestValue
    {
      ACF_INLINE void
      operator()() const
      {
        Eight largest = {};
        std::size_t k = 0;
        for (; k + 8 <= n; k += 8)
          {
            const Eight value = load_lanes<Eight>(x + k);
            const Eight size  = value < Eight{} ? -value : value;
            largest           = size > largest ? size : largest;
          }
        for (unsigned int i = 0; i < 8; ++i)
          result = largest[i] > result ? largest[i] : result;
        for (; k < n; ++k)
          {
            const double size = x[k] < 0 ? -x[k] : x[k];
            result            = size > result ? size : result;
          }
      }

      const double *x;
      std::size_t n;
      double &result;
    };
  } // namespace



  /**
   * Solves with some right-hand sides at once, which it keeps in the order of
   * elimination: x[place][vector and plane][component], with four numbers for
   * the three components, so that a node is copied by few instructions. In
   * single precision they are scaled to one, so that none is too small for it.
   */
  template <typename Number, typename Real>
  template <unsigned int n_vectors>
  class SupernodalFactor<Number, Real>::Solution
  {
  public:
    explicit Solution(const SupernodalFactor &factor)
      : factor(factor)
      , tree(*factor.tree)
      // a node that is copied to the last rows writes one number more
      , longest(Kernels::round_up(factor.longest_block + 1))
    {
      x.resize_fast(node_size * (tree.n_unknowns() / dim));
    }

    void
    read(Number *const vectors)
    {
      const std::size_t n = tree.n_unknowns();
      for (unsigned int v = 0; v < n_vectors; ++v)
        {
          scales[v]            = 1;
          double inverse_scale = 1;
          if (std::is_same<Real, float>::value)
            {
              double size = 0;
              run_vectorized(
                LargestValue{&plane(vectors[v * n], 0), planes * n, size});
              // the inverse of what is too small would be infinite
              if (size >= std::numeric_limits<double>::min())
                {
                  scales[v]     = size;
                  inverse_scale = 1 / size;
                }
            }
          for (std::size_t place = 0; place < n / dim; ++place)
            {
              Number *const value = vectors + v * n + dim * tree.node()[place];
              Real *const node =
                x.data() + place * node_size + v * planes * quad;
              for (unsigned int p = 0; p < planes; ++p)
                {
                  for (unsigned int i = 0; i < dim; ++i)
                    node[p * quad + i] = plane(value[i], p) * inverse_scale;
                  node[p * quad + dim] = 0;
                }
            }
        }
    }

    void
    write(Number *const vectors)
    {
      // in the order of the vectors: reads from all over the memory overlap
      // more than writes
      const std::size_t n = tree.n_unknowns();
      for (unsigned int v = 0; v < n_vectors; ++v)
        for (std::size_t a = 0; a < n / dim; ++a)
          {
            Number *const value = vectors + v * n + dim * a;
            const Real *const node =
              x.data() + tree.place()[a] * node_size + v * planes * quad;
            for (unsigned int p = 0; p < planes; ++p)
              for (unsigned int i = 0; i < dim; ++i)
                plane(value[i], p) = scales[v] * node[p * quad + i];
          }
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
            const Block &block      = factor.blocks[s];
            const std::size_t begin = block.first_place * node_size;
            for (unsigned int k = 0; k < block.n_nodes * node_size; ++k)
              x[begin + k] += sums[branch][begin + k];
          }
      forward(partition.top, x.data());
      backward(partition.top);
      run_tasks(n_branches, [&](const unsigned int branch) {
        backward(partition.branches[branch]);
      });
    }

  private:
    static constexpr unsigned int planes    = n_planes<Number>;
    static constexpr unsigned int n_x       = planes * n_vectors;
    static constexpr unsigned int node_size = quad * n_x;

    /**
     * Rows are at [vector and plane][row] with the given distance. Their copy
     * writes one number behind those of the node.
     */
    ACF_INLINE static void
    read_node(const Real *x, Real *rows, const std::size_t distance)
    {
      ACF_UNROLL
      for (unsigned int k = 0; k < n_x; ++k)
        store_lanes(load_quad(x + k * quad), rows + k * distance);
    }

    ACF_INLINE static void
    write_node(const Real *rows, const std::size_t distance, Real *x)
    {
      ACF_UNROLL
      for (unsigned int k = 0; k < n_x; ++k)
        store_lanes(load_components(rows + k * distance), x + k * quad);
    }

    ACF_INLINE static void
    add_node(const Real *rows, const std::size_t distance, Real *x)
    {
      ACF_UNROLL
      for (unsigned int k = 0; k < n_x; ++k)
        add_lanes(load_components(rows + k * distance), x + k * quad);
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
          const Block &block         = factor.blocks[s];
          const std::size_t distance = Kernels::round_up(block.n_rows + 1);
          Real *const rows           = work.data();
          Real *const below          = rows + block.n_columns;
          Real *const own            = x.data() + block.first_place * node_size;
          const unsigned int *const place =
            factor.places_below.data() + block.offset_below;
          for (unsigned int k = 0; k < block.n_nodes; ++k)
            read_node(own + k * node_size, rows + dim * k, distance);
          for (unsigned int k = 0; k < n_x; ++k)
            std::fill(below + k * distance, rows + (k + 1) * distance, Real(0));
          solve(view(s), {rows, distance});
          for (unsigned int k = 0; k < block.n_nodes; ++k)
            write_node(rows + dim * k, distance, own + k * node_size);
          for (unsigned int k = 0; k < block.n_own_below; ++k)
            add_node(below + dim * k,
                     distance,
                     x.data() + place[k] * node_size);
          for (unsigned int k = block.n_own_below; k < block.n_below; ++k)
            add_node(below + dim * k, distance, sums + place[k] * node_size);
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
          const Block &block         = factor.blocks[s];
          const std::size_t distance = Kernels::round_up(block.n_rows + 1);
          Real *const rows           = work.data();
          Real *const own            = x.data() + block.first_place * node_size;
          const unsigned int *const place =
            factor.places_below.data() + block.offset_below;
          for (unsigned int k = 0; k < block.n_nodes; ++k)
            read_node(own + k * node_size, rows + dim * k, distance);
          for (unsigned int k = 0; k < block.n_below; ++k)
            read_node(x.data() + place[k] * node_size,
                      rows + block.n_columns + dim * k,
                      distance);
          for (unsigned int k = 0; k < n_x; ++k)
            std::fill(rows + k * distance + block.n_rows,
                      rows + (k + 1) * distance,
                      Real(0));
          solve(view(s), {rows, distance});
          for (unsigned int k = 0; k < block.n_nodes; ++k)
            write_node(rows + dim * k, distance, own + k * node_size);
        }
    }

    const SupernodalFactor &factor;
    const EliminationTree &tree;
    const std::size_t longest;
    dealii::AlignedVector<Real> x;
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
