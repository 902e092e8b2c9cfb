// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_supernodal_solution_h
#define acf_solvers_supernodal_solution_h

#include <acf/base/lanes.h>
#include <acf/solvers/supernodal_factor.h>

#include <algorithm>
#include <array>
#include <limits>

#include "interleaved_kernels.h"

/*
 * Right-hand sides of SupernodalFactor while it solves, in the order of
 * elimination. In single precision they are scaled to one.
 */

namespace ACF
{
  namespace
  {
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
#define ACF_SOLVES(name, attributes)                                       \
  template <typename Real, unsigned int planes, unsigned int n_vectors>    \
  attributes void forward_##name(const Kernels::SupernodeView<Real> &s,    \
                                 const Kernels::Work<Real> &t)             \
  {                                                                        \
    Kernels::forward<Real, planes, n_vectors, name##_bytes>(s, t);         \
  }                                                                        \
  template <typename Real, unsigned int planes, unsigned int n_vectors>    \
  attributes void backward_##name(const Kernels::SupernodeView<Real> &s,   \
                                  const Kernels::Work<Real> &t)            \
  {                                                                        \
    Kernels::backward<Real, planes, n_vectors, name##_bytes>(s, t);        \
  }                                                                        \
  template <typename Real, unsigned int planes>                            \
  attributes void forward_##name(const Kernels::SupernodeView<Real> &s,    \
                                 const Kernels::InterleavedRows<Real> &t)  \
  {                                                                        \
    Kernels::forward<Real, planes, name##_bytes>(s, t);                    \
  }                                                                        \
  template <typename Real, unsigned int planes>                            \
  attributes void backward_##name(const Kernels::SupernodeView<Real> &s,   \
                                  const Kernels::InterleavedRows<Real> &t) \
  {                                                                        \
    Kernels::backward<Real, planes, name##_bytes>(s, t);                   \
  }

    ACF_SOLVES(any, )
#if defined(__x86_64__)
    ACF_SOLVES(avx2, ACF_AVX2)
    ACF_SOLVES(avx512, ACF_AVX512)
#endif
#undef ACF_SOLVES

    // Rows: Kernels::Work or InterleavedRows
    template <typename Real, typename Rows>
    using Solve = void (*)(const Kernels::SupernodeView<Real> &, const Rows &);

    template <typename Real, typename Rows, unsigned int... sizes>
    Solve<Real, Rows>
    choose_solve(const bool forward)
    {
      Solve<Real, Rows> forwards  = forward_any<Real, sizes...>;
      Solve<Real, Rows> backwards = backward_any<Real, sizes...>;
#if defined(__x86_64__)
      if (present_processor() == Processor::avx512)
        {
          forwards  = forward_avx512<Real, sizes...>;
          backwards = backward_avx512<Real, sizes...>;
        }
      else if (present_processor() == Processor::avx2)
        {
          forwards  = forward_avx2<Real, sizes...>;
          backwards = backward_avx2<Real, sizes...>;
        }
#endif
      return forward ? forwards : backwards;
    }



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
      template <typename Lanes>
      ACF_INLINE void
      run() const
      {
        constexpr unsigned int width = n_lanes<Lanes>;
        Lanes largest                = {};
        std::size_t k                = 0;
        for (; k + width <= n; k += width)
          {
            const Lanes value = load_lanes<Lanes>(x + k);
            const Lanes size  = value < Lanes{} ? -value : value;
            largest           = size > largest ? size : largest;
          }
        for (unsigned int i = 0; i < width; ++i)
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



    // What right-hand sides are divided by: in single precision none is too
    // small then.
    template <typename Real, typename Number>
    double
    scale_of(Number *const vector, const std::size_t n)
    {
      double size = 0;
      if (std::is_same<Real, float>::value)
        run_in_lanes(
          LargestValue{&plane(vector[0], 0), n_planes<Number> * n, size});
      // the inverse of what is too small would be infinite
      return size >= std::numeric_limits<double>::min() ? size : 1;
    }
  } // namespace



  /**
   * Solves with some right-hand sides at once, which it keeps in the order of
   * elimination: x[place][vector and plane][component], with four numbers for
   * the three components, so that a node is copied by few instructions.
   */
  template <typename Number, typename Real>
  template <unsigned int n_vectors>
  class SupernodalFactor<Number, Real>::Solution
  {
  public:
    static constexpr unsigned int planes    = n_planes<Number>;
    static constexpr unsigned int n_x       = planes * n_vectors;
    static constexpr unsigned int node_size = quad * n_x;

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
          scales[v]                  = scale_of<Real>(vectors + v * n, n);
          const double inverse_scale = 1 / scales[v];
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

    /** @param sums takes what belongs to rows above the branches */
    void
    forward(const std::vector<unsigned int> &supernodes, Real *const sums)
    {
      const auto solve =
        choose_solve<Real, Kernels::Work<Real>, planes, n_vectors>(true);
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
          solve(factor.view(s), {rows, distance});
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
      const auto solve =
        choose_solve<Real, Kernels::Work<Real>, planes, n_vectors>(false);
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
          solve(factor.view(s), {rows, distance});
          for (unsigned int k = 0; k < block.n_nodes; ++k)
            write_node(rows + dim * k, distance, own + k * node_size);
        }
    }

    /** In the order of elimination. */
    dealii::AlignedVector<Real> x;

  private:
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

    const SupernodalFactor &factor;
    const EliminationTree &tree;
    const std::size_t longest;
    std::array<double, n_vectors> scales;
  };


  /**
   * Solves with as many right-hand sides as vectors have lanes, in the order of
   * elimination and side by side: x[place][component][plane][vector].
   */
  template <typename Number, typename Real>
  class SupernodalFactor<Number, Real>::InterleavedSolution
  {
  public:
    static constexpr unsigned int planes    = n_planes<Number>;
    static constexpr unsigned int n_vectors = Kernels::lanes;
    static constexpr unsigned int node_size = Kernels::interleaved_node<planes>;

    explicit InterleavedSolution(const SupernodalFactor &factor)
      : factor(factor)
      , tree(*factor.tree)
    {
      x.resize_fast(node_size * (tree.n_unknowns() / dim));
    }

    void
    read(Number *const vectors)
    {
      const std::size_t n = tree.n_unknowns();
      std::array<double, n_vectors> inverse_scales;
      for (unsigned int v = 0; v < n_vectors; ++v)
        {
          scales[v]         = scale_of<Real>(vectors + v * n, n);
          inverse_scales[v] = 1 / scales[v];
        }
      for (std::size_t place = 0; place < n / dim; ++place)
        {
          Number *const value = vectors + dim * tree.node()[place];
          Real *const node    = x.data() + place * node_size;
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int p = 0; p < planes; ++p)
              for (unsigned int v = 0; v < n_vectors; ++v)
                node[(i * planes + p) * n_vectors + v] =
                  plane(value[v * n + i], p) * inverse_scales[v];
        }
    }

    void
    write(Number *const vectors)
    {
      const std::size_t n = tree.n_unknowns();
      for (std::size_t place = 0; place < n / dim; ++place)
        {
          Number *const value    = vectors + dim * tree.node()[place];
          const Real *const node = x.data() + place * node_size;
          for (unsigned int v = 0; v < n_vectors; ++v)
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int p = 0; p < planes; ++p)
                plane(value[v * n + i], p) =
                  scales[v] * node[(i * planes + p) * n_vectors + v];
        }
    }

    /** @param sums takes what belongs to rows above the branches */
    void
    forward(const std::vector<unsigned int> &supernodes, Real *const sums)
    {
      const auto solve =
        choose_solve<Real, Kernels::InterleavedRows<Real>, planes>(true);
      for (const unsigned int s : supernodes)
        solve(factor.view(s), rows(factor.blocks[s], sums));
    }

    void
    backward(const std::vector<unsigned int> &supernodes)
    {
      const auto solve =
        choose_solve<Real, Kernels::InterleavedRows<Real>, planes>(false);
      for (unsigned int l = supernodes.size(); l-- > 0;)
        solve(factor.view(supernodes[l]),
              rows(factor.blocks[supernodes[l]], x.data()));
    }

    /** In the order of elimination. */
    dealii::AlignedVector<Real> x;

  private:
    Kernels::InterleavedRows<Real>
    rows(const Block &block, Real *const sums)
    {
      return {x.data() + block.first_place * node_size,
              x.data(),
              block.n_own_below,
              sums,
              factor.places_below.data() + block.offset_below,
              block.n_below};
    }

    const SupernodalFactor &factor;
    const EliminationTree &tree;
    std::array<double, n_vectors> scales;
  };
} // namespace ACF

#endif
