// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_supernodal_kernels_h
#define acf_solvers_supernodal_kernels_h

#include <acf/base/processor.h>
#include <acf/solvers/elimination_tree.h>

#include <atomic>

/*
 * The loops of SupernodalFactor over the numbers of one supernode, for one or
 * more right-hand sides at once. Numbers are kept as n_planes = 1 plane (real)
 * or 2 planes (real and imaginary parts).
 *
 * A supernode is stored as panels of at most panel_width columns. A panel with
 * the columns j, ..., j + w - 1 begins with its triangle: 1 / D and then the
 * columns of L below the diagonal, one plane after the other; padded to full
 * vectors. Then follow its rows from the vector that holds row j + w on:
 * [vector of rows][column][plane][row of the vector], with zeros above.
 */

namespace ACF
{
  namespace Kernels
  {
    /** Rows of a vector. */
    constexpr unsigned int lanes = 8;

    /** Two nodes. */
    constexpr unsigned int panel_width = 6;

    /**
     * Vectors of the instruction set, of at most eight numbers: what is stored
     * as a vector of eight may be several of them.
     * @tparam n_bytes of the registers
     */
    template <typename Real, unsigned int n_bytes>
    struct Vectors
    {
      static constexpr unsigned int width =
        n_bytes / sizeof(Real) < lanes ? n_bytes / sizeof(Real) : lanes;
      typedef Real type __attribute__((vector_size(width * sizeof(Real))));
    };

    template <typename Real, unsigned int width, typename Vector>
    ACF_INLINE Real
    sum_of_lanes(const Vector &x)
    {
      if constexpr (width == 2)
        return x[0] + x[1];
      else
        {
          typedef Real Half __attribute__((vector_size(sizeof(Vector) / 2)));
          Half sum;
          if constexpr (width == 8)
            sum = __builtin_shufflevector(x, x, 0, 1, 2, 3) +
                  __builtin_shufflevector(x, x, 4, 5, 6, 7);
          else
            sum = __builtin_shufflevector(x, x, 0, 1) +
                  __builtin_shufflevector(x, x, 2, 3);
          return sum_of_lanes<Real, width / 2>(sum);
        }
    }

    constexpr std::size_t
    round_up(const std::size_t n)
    {
      return (n + lanes - 1) / lanes * lanes;
    }

    constexpr std::size_t
    triangle_size(const unsigned int width, const unsigned int n_planes)
    {
      return round_up(width * (width + 1) / 2 * n_planes);
    }

    /** First row of the vectors of a panel. */
    constexpr unsigned int
    first_vector_row(const unsigned int first_column, const unsigned int width)
    {
      return (first_column + width) / lanes * lanes;
    }

    constexpr std::size_t
    panel_size(const unsigned int first_column,
               const unsigned int width,
               const unsigned int n_rows,
               const unsigned int n_planes)
    {
      return triangle_size(width, n_planes) +
             (round_up(n_rows) - first_vector_row(first_column, width)) *
               width * n_planes;
    }

    /** A supernode and its numbers. Rows and columns are unknowns. */
    template <typename Real>
    struct SupernodeView
    {
      const Real *values;
      unsigned int n_columns;
      unsigned int n_rows;
      std::size_t n_values;
    };

    /** a += b c or a -= b c, for numbers of n_planes planes. */
    template <int sign,
              unsigned int n_planes,
              typename A,
              typename B,
              typename C>
    ACF_INLINE void
    multiply_add(A *a, const B *b, const C *c)
    {
      if constexpr (n_planes == 1)
        {
          if constexpr (sign > 0)
            a[0] += b[0] * c[0];
          else
            a[0] -= b[0] * c[0];
        }
      else if constexpr (sign > 0)
        {
          a[0] += b[0] * c[0];
          a[0] -= b[1] * c[1];
          a[1] += b[0] * c[1];
          a[1] += b[1] * c[0];
        }
      else
        {
          a[0] -= b[0] * c[0];
          a[0] += b[1] * c[1];
          a[1] -= b[0] * c[1];
          a[1] -= b[1] * c[0];
        }
    }



    /**
     * The right-hand sides of a supernode: [vector][plane][row], rows padded.
     */
    template <typename Real>
    struct Work
    {
      Real *rows;
      std::size_t n_padded;

      template <unsigned int n_planes>
      ACF_INLINE Real *
      plane(const unsigned int v, const unsigned int p) const
      {
        return rows + (v * n_planes + p) * n_padded;
      }
    };



    // The right-hand sides of the columns of a panel. X: Real, or a vector of
    // numbers of several right-hand sides.
    template <typename Real,
              unsigned int n_planes,
              unsigned int width,
              typename X = Real>
    struct PanelColumns
    {
      X x[width][n_planes];

      ACF_INLINE void
      read(const Work<Real> &t, const unsigned int v, const unsigned int j)
      {
        ACF_UNROLL
        for (unsigned int c = 0; c < width; ++c)
          {
            ACF_UNROLL
            for (unsigned int p = 0; p < n_planes; ++p)
              x[c][p] = t.template plane<n_planes>(v, p)[j + c];
          }
      }

      ACF_INLINE void
      write(const Work<Real> &t,
            const unsigned int v,
            const unsigned int j) const
      {
        ACF_UNROLL
        for (unsigned int c = 0; c < width; ++c)
          {
            ACF_UNROLL
            for (unsigned int p = 0; p < n_planes; ++p)
              t.template plane<n_planes>(v, p)[j + c] = x[c][p];
          }
      }

      // Entry (r, c) of a triangle.
      static constexpr unsigned int
      entry(const unsigned int r, const unsigned int c)
      {
        return (width + c * width - c * (c + 1) / 2 + r - c - 1) * n_planes;
      }

      // x <- L^-1 x
      ACF_INLINE void
      solve(const Real *const triangle)
      {
        ACF_UNROLL
        for (unsigned int c = 0; c < width; ++c)
          {
            ACF_UNROLL
            for (unsigned int r = c + 1; r < width; ++r)
              multiply_add<-1, n_planes>(x[r], triangle + entry(r, c), x[c]);
          }
      }

      // x <- L^-T x, by rows from the last one on: the number that was found
      // last meets all that need it at once.
      ACF_INLINE void
      solve_transposed(const Real *const triangle)
      {
        ACF_UNROLL
        for (unsigned int k = 1; k < width; ++k)
          {
            ACF_UNROLL
            for (unsigned int c = 0; c < width - k; ++c)
              multiply_add<-1, n_planes>(x[c],
                                         triangle + entry(width - k, c),
                                         x[width - k]);
          }
      }
    };



    template <typename Real,
              unsigned int n_planes,
              unsigned int n_vectors,
              unsigned int n_bytes,
              unsigned int width>
    ACF_INLINE void
    forward_panel(const Real *values,
                  const unsigned int j,
                  const unsigned int n_rows,
                  const Work<Real> &t)
    {
      using Vector = typename Vectors<Real, n_bytes>::type;
      constexpr unsigned int n_rows_at_once = Vectors<Real, n_bytes>::width;

      PanelColumns<Real, n_planes, width> columns[n_vectors];
      ACF_UNROLL
      for (unsigned int v = 0; v < n_vectors; ++v)
        {
          columns[v].read(t, v, j);
          columns[v].solve(values);
          columns[v].write(t, v, j);
        }
      const Real *L = values + triangle_size(width, n_planes);
      for (unsigned int row = first_vector_row(j, width); row < n_rows;
           row += lanes, L += width * n_planes * lanes)
        {
          ACF_UNROLL
          for (unsigned int v = 0; v < n_vectors; ++v)
            {
              ACF_UNROLL
              for (unsigned int i = 0; i < lanes; i += n_rows_at_once)
                {
                  Vector sum[n_planes];
                  for (unsigned int p = 0; p < n_planes; ++p)
                    sum[p] = *reinterpret_cast<const Vector *>(
                      t.template plane<n_planes>(v, p) + row + i);
                  ACF_UNROLL
                  for (unsigned int c = 0; c < width; ++c)
                    {
                      Vector b[n_planes];
                      ACF_UNROLL
                      for (unsigned int p = 0; p < n_planes; ++p)
                        b[p] = *reinterpret_cast<const Vector *>(
                          L + (c * n_planes + p) * lanes + i);
                      multiply_add<-1, n_planes>(sum, b, columns[v].x[c]);
                    }
                  for (unsigned int p = 0; p < n_planes; ++p)
                    *reinterpret_cast<Vector *>(
                      t.template plane<n_planes>(v, p) + row + i) = sum[p];
                }
            }
        }
    }



    template <typename Real,
              unsigned int n_planes,
              unsigned int n_vectors,
              unsigned int n_bytes,
              unsigned int width>
    ACF_INLINE void
    backward_panel(const Real *values,
                   const unsigned int j,
                   const unsigned int n_rows,
                   const Work<Real> &t)
    {
      using Vector = typename Vectors<Real, n_bytes>::type;
      constexpr unsigned int n_rows_at_once = Vectors<Real, n_bytes>::width;

      const Real *const L      = values + triangle_size(width, n_planes);
      const unsigned int first = first_vector_row(j, width);
      const unsigned int n_row_vectors = (round_up(n_rows) - first) / lanes;
      for (unsigned int v = 0; v < n_vectors; ++v)
        {
          Vector sum[width][n_planes];
          ACF_UNROLL
          for (unsigned int c = 0; c < width; ++c)
            {
              ACF_UNROLL
              for (unsigned int p = 0; p < n_planes; ++p)
                sum[c][p] = Vector{};
            }
          // From the last number to the first, as the panels are: the processor
          // fetches in advance what is read in one direction.
          for (unsigned int k = n_row_vectors; k-- > 0;)
            {
              ACF_UNROLL
              for (unsigned int i = 0; i < lanes; i += n_rows_at_once)
                {
                  const unsigned int row = first + lanes * k + i;
                  const Real *const entry =
                    L + k * width * n_planes * lanes + i;
                  Vector x[n_planes];
                  for (unsigned int p = 0; p < n_planes; ++p)
                    x[p] = *reinterpret_cast<const Vector *>(
                      t.template plane<n_planes>(v, p) + row);
                  ACF_UNROLL
                  for (unsigned int c = width; c > 0; --c)
                    {
                      Vector b[n_planes];
                      ACF_UNROLL
                      for (unsigned int p = n_planes; p > 0; --p)
                        b[p - 1] = *reinterpret_cast<const Vector *>(
                          entry + ((c - 1) * n_planes + p - 1) * lanes);
                      // or the compiler reads in another order
                      std::atomic_signal_fence(std::memory_order_acq_rel);
                      multiply_add<1, n_planes>(sum[c - 1], b, x);
                    }
                }
            }
          PanelColumns<Real, n_planes, width> columns;
          columns.read(t, v, j);
          ACF_UNROLL
          for (unsigned int c = 0; c < width; ++c)
            {
              Real total[n_planes];
              ACF_UNROLL
              for (unsigned int p = 0; p < n_planes; ++p)
                total[p] = -sum_of_lanes<Real, n_rows_at_once>(sum[c][p]);
              // 1 / D
              multiply_add<1, n_planes>(total,
                                        values + c * n_planes,
                                        columns.x[c]);
              ACF_UNROLL
              for (unsigned int p = 0; p < n_planes; ++p)
                columns.x[c][p] = total[p];
            }
          columns.solve_transposed(values);
          columns.write(t, v, j);
        }
    }



    /** t <- L^-1 t for the columns of a supernode, and t -= L t below. */
    template <typename Real,
              unsigned int n_planes,
              unsigned int n_vectors,
              unsigned int n_bytes>
    ACF_INLINE void
    forward(const SupernodeView<Real> &s, const Work<Real> &t)
    {
      const Real *values = s.values;
      unsigned int j     = 0;
      for (; j + panel_width <= s.n_columns; j += panel_width)
        {
          forward_panel<Real, n_planes, n_vectors, n_bytes, panel_width>(
            values, j, s.n_rows, t);
          values += panel_size(j, panel_width, s.n_rows, n_planes);
        }
      if (j < s.n_columns)
        forward_panel<Real, n_planes, n_vectors, n_bytes, panel_width / 2>(
          values, j, s.n_rows, t);
    }



    /** t <- L^-T (D^-1 t - L^T t) with the rows below. */
    template <typename Real,
              unsigned int n_planes,
              unsigned int n_vectors,
              unsigned int n_bytes>
    ACF_INLINE void
    backward(const SupernodeView<Real> &s, const Work<Real> &t)
    {
      const Real *values = s.values + s.n_values;
      unsigned int j     = s.n_columns;
      if (j % panel_width != 0)
        {
          j -= panel_width / 2;
          values -= panel_size(j, panel_width / 2, s.n_rows, n_planes);
          backward_panel<Real, n_planes, n_vectors, n_bytes, panel_width / 2>(
            values, j, s.n_rows, t);
        }
      while (j > 0)
        {
          j -= panel_width;
          values -= panel_size(j, panel_width, s.n_rows, n_planes);
          backward_panel<Real, n_planes, n_vectors, n_bytes, panel_width>(
            values, j, s.n_rows, t);
        }
    }
  } // namespace Kernels
} // namespace ACF

#endif
