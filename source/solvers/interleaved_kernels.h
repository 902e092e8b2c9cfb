// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_interleaved_kernels_h
#define acf_solvers_interleaved_kernels_h

#include <acf/base/lanes.h>

#include "supernodal_kernels.h"

/*
 * The loops of SupernodalFactor for as many right-hand sides as a vector has
 * lanes. Their numbers are side by side, [unknown][plane][right-hand side], so
 * that a number of L meets all of them in one product: nothing is summed over
 * lanes, and rows of a supernode stay where they are.
 */

namespace ACF
{
  namespace Kernels
  {
    /** Numbers of a node of all right-hand sides. */
    template <unsigned int n_planes>
    constexpr unsigned int interleaved_node = dim *n_planes *lanes;

    /** Where the right-hand sides of a supernode are. */
    template <typename Real>
    struct InterleavedRows
    {
      /** Its own nodes, one after the other. */
      Real *own;

      /** All nodes by their places, for the first rows below, */
      Real *first;
      unsigned int n_first;

      /** and for the others. */
      Real *others;

      /** Of the nodes below. */
      const unsigned int *places;
      unsigned int n_below;
    };



    // Of as many right-hand sides as a vector of the instruction set has lanes.
    template <typename Real,
              unsigned int n_planes,
              unsigned int n_bytes,
              unsigned int width>
    struct InterleavedPanel
    {
      using Vector  = typename Vectors<Real, n_bytes>::type;
      using Columns = PanelColumns<Real, n_planes, width, Vector>;
      static constexpr unsigned int node_size = interleaved_node<n_planes>;

      /** @param j its first column */
      ACF_INLINE
      InterleavedPanel(const Real *const values, const unsigned int j)
        : triangle(values)
        , below(values + triangle_size(width, n_planes))
        , first_column(j)
      {}

      ACF_INLINE void
      read(const Real *const own, Columns &columns) const
      {
        ACF_UNROLL
        for (unsigned int c = 0; c < width; ++c)
          {
            ACF_UNROLL
            for (unsigned int p = 0; p < n_planes; ++p)
              columns.x[c][p] = load_lanes<Vector>(
                own + ((first_column + c) * n_planes + p) * lanes);
          }
      }

      ACF_INLINE void
      write(const Columns &columns, Real *const own) const
      {
        ACF_UNROLL
        for (unsigned int c = 0; c < width; ++c)
          {
            ACF_UNROLL
            for (unsigned int p = 0; p < n_planes; ++p)
              store_lanes(columns.x[c][p],
                          own + ((first_column + c) * n_planes + p) * lanes);
          }
      }

      // Numbers of a row of L, at [column and plane * lanes].
      ACF_INLINE const Real *
      row_of_factor(const unsigned int row) const
      {
        const unsigned int vector =
          (row - first_vector_row(first_column, width)) / lanes;
        return below + vector * (width * n_planes * lanes) + row % lanes;
      }

      // Its number in column c.
      ACF_INLINE static void
      load_entry(const Real *const entries,
                 const unsigned int c,
                 Real (&b)[n_planes])
      {
        ACF_UNROLL
        for (unsigned int p = 0; p < n_planes; ++p)
          b[p] = entries[(c * n_planes + p) * lanes];
      }

      // Component i of a node.
      ACF_INLINE static void
      load(const Real *const node, const unsigned int i, Vector (&x)[n_planes])
      {
        ACF_UNROLL
        for (unsigned int p = 0; p < n_planes; ++p)
          x[p] = load_lanes<Vector>(node + (i * n_planes + p) * lanes);
      }

      // x -= L columns for the rows of a node
      ACF_INLINE void
      subtract(const Columns &columns,
               const unsigned int row,
               Real *const node) const
      {
        ACF_UNROLL
        for (unsigned int i = 0; i < dim; ++i)
          {
            const Real *const entries = row_of_factor(row + i);
            Vector x[n_planes];
            load(node, i, x);
            ACF_UNROLL
            for (unsigned int c = 0; c < width; ++c)
              {
                Real b[n_planes];
                load_entry(entries, c, b);
                multiply_add<-1, n_planes>(x, b, columns.x[c]);
              }
            ACF_UNROLL
            for (unsigned int p = 0; p < n_planes; ++p)
              store_lanes(x[p], node + (i * n_planes + p) * lanes);
          }
      }

      // sums += L^T x for the rows of a node
      ACF_INLINE void
      add_transposed(const unsigned int row,
                     const Real *const node,
                     Columns &sums) const
      {
        ACF_UNROLL
        for (unsigned int k = 1; k <= dim; ++k)
          {
            const unsigned int i      = dim - k;
            const Real *const entries = row_of_factor(row + i);
            Vector x[n_planes];
            load(node, i, x);
            ACF_UNROLL
            for (unsigned int c = 0; c < width; ++c)
              {
                Real b[n_planes];
                load_entry(entries, c, b);
                multiply_add<1, n_planes>(sums.x[c], b, x);
              }
          }
      }

      ACF_INLINE void
      forward(const unsigned int n_columns,
              const InterleavedRows<Real> &rows) const
      {
        Columns columns;
        read(rows.own, columns);
        columns.solve(triangle);
        write(columns, rows.own);
        unsigned int row = first_column + width;
        for (; row < n_columns; row += dim)
          subtract(columns, row, rows.own + row / dim * node_size);
        for (unsigned int k = 0; k < rows.n_first; ++k, row += dim)
          subtract(columns, row, rows.first + rows.places[k] * node_size);
        for (unsigned int k = rows.n_first; k < rows.n_below; ++k, row += dim)
          subtract(columns, row, rows.others + rows.places[k] * node_size);
      }

      // From the last row to the first, as the panels are.
      ACF_INLINE void
      backward(const unsigned int n_columns,
               const InterleavedRows<Real> &rows) const
      {
        Columns sums = {};
        for (unsigned int k = rows.n_below; k-- > 0;)
          add_transposed(n_columns + dim * k,
                         rows.first + rows.places[k] * node_size,
                         sums);
        for (unsigned int row = n_columns; row > first_column + width;)
          {
            row -= dim;
            add_transposed(row, rows.own + row / dim * node_size, sums);
          }
        Columns columns;
        read(rows.own, columns);
        ACF_UNROLL
        for (unsigned int c = 0; c < width; ++c)
          {
            Vector total[n_planes];
            ACF_UNROLL
            for (unsigned int p = 0; p < n_planes; ++p)
              total[p] = -sums.x[c][p];
            // 1 / D
            multiply_add<1, n_planes>(total,
                                      triangle + c * n_planes,
                                      columns.x[c]);
            ACF_UNROLL
            for (unsigned int p = 0; p < n_planes; ++p)
              columns.x[c][p] = total[p];
          }
        columns.solve_transposed(triangle);
        write(columns, rows.own);
      }

      const Real *const triangle;
      const Real *const below;
      const unsigned int first_column;
    };



    /** Some of the right-hand sides, from one on. */
    template <typename Real>
    ACF_INLINE InterleavedRows<Real>
    starting_at(const InterleavedRows<Real> &rows, const unsigned int vector)
    {
      InterleavedRows<Real> result = rows;
      result.own += vector;
      result.first += vector;
      result.others += vector;
      return result;
    }



    /** As forward() with Work. */
    template <typename Real, unsigned int n_planes, unsigned int n_bytes>
    ACF_INLINE void
    forward(const SupernodeView<Real> &s, const InterleavedRows<Real> &rows)
    {
      constexpr unsigned int n_at_once = Vectors<Real, n_bytes>::width;
      const Real *values               = s.values;
      unsigned int j                   = 0;
      for (; j + panel_width <= s.n_columns; j += panel_width)
        {
          ACF_UNROLL
          for (unsigned int v = 0; v < lanes; v += n_at_once)
            InterleavedPanel<Real, n_planes, n_bytes, panel_width>(values, j)
              .forward(s.n_columns, starting_at(rows, v));
          values += panel_size(j, panel_width, s.n_rows, n_planes);
        }
      if (j < s.n_columns)
        {
          ACF_UNROLL
          for (unsigned int v = 0; v < lanes; v += n_at_once)
            InterleavedPanel<Real, n_planes, n_bytes, panel_width / 2>(values,
                                                                       j)
              .forward(s.n_columns, starting_at(rows, v));
        }
    }



    /** As backward() with Work; all rows below are in the first array. */
    template <typename Real, unsigned int n_planes, unsigned int n_bytes>
    ACF_INLINE void
    backward(const SupernodeView<Real> &s, const InterleavedRows<Real> &rows)
    {
      constexpr unsigned int n_at_once = Vectors<Real, n_bytes>::width;
      const Real *values               = s.values + s.n_values;
      unsigned int j                   = s.n_columns;
      if (j % panel_width != 0)
        {
          j -= panel_width / 2;
          values -= panel_size(j, panel_width / 2, s.n_rows, n_planes);
          ACF_UNROLL
          for (unsigned int v = 0; v < lanes; v += n_at_once)
            InterleavedPanel<Real, n_planes, n_bytes, panel_width / 2>(values,
                                                                       j)
              .backward(s.n_columns, starting_at(rows, v));
        }
      while (j > 0)
        {
          j -= panel_width;
          values -= panel_size(j, panel_width, s.n_rows, n_planes);
          ACF_UNROLL
          for (unsigned int v = 0; v < lanes; v += n_at_once)
            InterleavedPanel<Real, n_planes, n_bytes, panel_width>(values, j)
              .backward(s.n_columns, starting_at(rows, v));
        }
    }
  } // namespace Kernels
} // namespace ACF

#endif
