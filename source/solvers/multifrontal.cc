// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/parallel.h>
#include <acf/solvers/multifrontal.h>
#include <acf/solvers/tree_partition.h>

#include <deal.II/base/multithread_info.h>

#include <deal.II/lac/lapack_templates.h>

#include <algorithm>
#include <cmath>
#include <complex>

extern "C" void
openblas_set_num_threads(int n_threads);

namespace ACF
{
  namespace
  {
    // The dense symmetric matrix of a supernode's columns and rows, of which
    // the columns are eliminated. Only the lower triangle is used.
    template <typename Number>
    class Front
    {
    public:
      void
      reinit(const std::size_t size)
      {
        n = size;
        if (entries.size() < n * n)
          entries.resize(n * n);
        for (std::size_t j = 0; j < n; ++j)
          std::fill(column(j) + j, column(j) + n, Number());
      }

      Number *
      column(const std::size_t j)
      {
        return entries.data() + j * n;
      }

      const Number *
      column(const std::size_t j) const
      {
        return entries.data() + j * n;
      }

      std::size_t
      size() const
      {
        return n;
      }

      /** Eliminates the first columns. */
      void
      eliminate(const std::size_t n_columns)
      {
        eliminate(0, n_columns);
        update(0, n_columns, n_columns, n);
      }

    private:
      // Columns from begin to end, all rows: halves first, so that most of the
      // work is products of matrices.
      void
      eliminate(const std::size_t begin, const std::size_t end)
      {
        if (end - begin <= narrow)
          {
            eliminate_narrow(begin, end);
            return;
          }
        const std::size_t middle = begin + (end - begin) / 2;
        eliminate(begin, middle);
        update(begin, middle, middle, end);
        eliminate(middle, end);
      }

      void
      eliminate_narrow(const std::size_t begin, const std::size_t end)
      {
        for (std::size_t j = begin; j < end; ++j)
          {
            Number *const L = column(j);
            if (!(std::abs(L[j]) > 0) || !std::isfinite(std::abs(L[j])))
              throw SimulationError(
                "The shifted matrix of a body is singular.");
            const Number inverse = 1. / L[j];
            for (std::size_t k = j + 1; k < end; ++k)
              {
                const Number factor = L[k] * inverse;
                Number *const C     = column(k);
                for (std::size_t i = k; i < n; ++i)
                  C[i] -= factor * L[i];
              }
            for (std::size_t i = j + 1; i < n; ++i)
              L[i] *= inverse;
          }
      }

      // C <- C - L D L^T with the columns from begin to end of L, for the
      // columns of C from first to last
      void
      update(const std::size_t begin,
             const std::size_t end,
             const std::size_t first,
             const std::size_t last)
      {
        const types::blas_int ld = n, k = end - begin;
        const Number minus_one = -1, one = 1;
        for (std::size_t j = first; j < last; j += update_width)
          {
            const types::blas_int width = std::min(update_width, last - j);
            const types::blas_int m     = n - j;
            scaled.resize(width * k);
            for (types::blas_int c = 0; c < k; ++c)
              {
                const Number D        = column(begin + c)[begin + c];
                const Number *const L = column(begin + c) + j;
                for (types::blas_int i = 0; i < width; ++i)
                  scaled[c * width + i] = D * L[i];
              }
            gemm("N",
                 "T",
                 &m,
                 &width,
                 &k,
                 &minus_one,
                 column(begin) + j,
                 &ld,
                 scaled.data(),
                 &width,
                 &one,
                 column(j) + j,
                 &ld);
          }
      }

      static constexpr std::size_t narrow       = 12;
      static constexpr std::size_t update_width = 96;

      std::size_t n = 0;
      std::vector<Number> entries;
      std::vector<Number> scaled;
    };



    // Unknowns of a front for which threads of the BLAS pay.
    constexpr std::size_t large_front = 1000;



    // Factorises the supernodes of a tree, those of one branch one after the
    // other.
    template <typename Number>
    class Multifrontal
    {
    public:
      Multifrontal(const EliminationTree &tree,
                   const TreePartition &partition,
                   const ShiftedMatrix<Number> &matrix,
                   const SupernodeSink<Number> &sink)
        : tree(tree)
        , partition(partition)
        , matrix(matrix)
        , sink(sink)
        , children(tree.supernodes().size())
        , for_top(tree.supernodes().size())
      {
        for (unsigned int s = 0; s < tree.supernodes().size(); ++s)
          if (tree.supernodes()[s].parent != EliminationTree::none)
            children[tree.supernodes()[s].parent].push_back(s);
      }

      /** All of a branch, or the top after the branches. */
      void
      factorize(const std::vector<unsigned int> &supernodes)
      {
        Front<Number> front;
        // what is left of the fronts that their parents have not taken yet
        std::vector<Number> stack;
        std::size_t stack_size = 0;
        for (const unsigned int s : supernodes)
          {
            const EliminationTree::Supernode &supernode = tree.supernodes()[s];
            const std::size_t k = dim * supernode.n_columns;
            const std::size_t m = dim * supernode.rows.size();
            front.reinit(k + m);
            add_matrix(supernode, front);
            // the last child is on top of the stack
            for (auto child = children[s].rbegin(); child != children[s].rend();
                 ++child)
              if (partition.is_top[s])
                {
                  add_update(*child, for_top[*child].data(), supernode, front);
                  std::vector<Number>().swap(for_top[*child]);
                }
              else
                {
                  const std::size_t size =
                    dim * tree.supernodes()[*child].rows.size();
                  stack_size -= size * size;
                  add_update(*child,
                             stack.data() + stack_size,
                             supernode,
                             front);
                }
            const bool threads_help =
              partition.is_top[s] && front.size() >= large_front;
            if (threads_help)
              openblas_set_num_threads(MultithreadInfo::n_threads());
            front.eliminate(k);
            if (threads_help)
              openblas_set_num_threads(1);
            sink(s, front.column(0), front.size());

            const unsigned int parent = supernode.parent;
            const bool to_top =
              parent == EliminationTree::none || partition.is_top[parent];
            if (to_top)
              for_top[s].resize(m * m);
            else if (stack.size() < stack_size + m * m)
              stack.resize(std::max(stack_size + m * m, 3 * stack.size() / 2));
            Number *const update =
              to_top ? for_top[s].data() : stack.data() + stack_size;
            for (std::size_t j = 0; j < m; ++j)
              std::copy_n(front.column(k + j) + k + j,
                          m - j,
                          update + j * m + j);
            stack_size += (to_top ? 0 : m * m);
          }
      }

    private:
      // Rows of the front where the first unknowns of these places are.
      std::vector<std::size_t>
      local_rows(const EliminationTree::Supernode &supernode,
                 const std::vector<unsigned int> &places) const
      {
        std::vector<std::size_t> rows;
        auto position          = supernode.rows.begin();
        const unsigned int end = supernode.first + supernode.n_columns;
        for (const unsigned int place : places)
          if (place < end)
            rows.push_back(dim * (place - supernode.first));
          else
            {
              position =
                std::lower_bound(position, supernode.rows.end(), place);
              rows.push_back(dim * (supernode.n_columns +
                                    (position - supernode.rows.begin())));
            }
        return rows;
      }

      void
      add_matrix(const EliminationTree::Supernode &supernode,
                 Front<Number> &front) const
      {
        const NodeGraph &graph = matrix.stiffness.graph();
        std::vector<std::pair<unsigned int, unsigned int>> entries;
        std::vector<unsigned int> places;
        for (unsigned int c = 0; c < supernode.n_columns; ++c)
          {
            const unsigned int place = supernode.first + c;
            const unsigned int node  = tree.node()[place];
            entries.clear();
            places.clear();
            for (std::size_t e = graph.row_start[node];
                 e < graph.row_start[node + 1];
                 ++e)
              if (tree.place()[graph.column[e]] >= place)
                entries.emplace_back(tree.place()[graph.column[e]],
                                     graph.column[e]);
            std::sort(entries.begin(), entries.end());
            for (const auto &entry : entries)
              places.push_back(entry.first);
            const std::vector<std::size_t> rows = local_rows(supernode, places);
            for (unsigned int q = 0; q < entries.size(); ++q)
              add_block(entries[q].second, node, rows[q], dim * c, front);
          }
      }

      void
      add_block(const unsigned int row_node,
                const unsigned int column_node,
                const std::size_t row,
                const std::size_t column,
                Front<Number> &front) const
      {
        const NodeBlock block = matrix.stiffness.block(row_node, column_node);
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int i = 0; i < dim; ++i)
            front.column(column + j)[row + i] += block(i, j);
        const Number mass =
          matrix.shift * matrix.mass.value(row_node, column_node);
        for (unsigned int j = 0; j < dim; ++j)
          front.column(column + j)[row + j] += mass;
      }

      void
      add_update(const unsigned int child,
                 const Number *const update,
                 const EliminationTree::Supernode &supernode,
                 Front<Number> &front) const
      {
        const std::vector<std::size_t> rows =
          local_rows(supernode, tree.supernodes()[child].rows);
        const std::size_t m = dim * rows.size();
        for (unsigned int q = 0; q < rows.size(); ++q)
          for (unsigned int j = 0; j < dim; ++j)
            {
              Number *const target       = front.column(rows[q] + j);
              const Number *const source = update + (dim * q + j) * m;
              for (unsigned int i = j; i < dim; ++i)
                target[rows[q] + i] += source[dim * q + i];
              for (unsigned int p = q + 1; p < rows.size(); ++p)
                for (unsigned int i = 0; i < dim; ++i)
                  target[rows[p] + i] += source[dim * p + i];
            }
      }

      const EliminationTree &tree;
      const TreePartition &partition;
      const ShiftedMatrix<Number> &matrix;
      const SupernodeSink<Number> &sink;

      std::vector<std::vector<unsigned int>> children;

      /** What is left of the fronts of children of the top. */
      std::vector<std::vector<Number>> for_top;
    };
  } // namespace



  template <typename Number>
  void
  factorize_multifrontal(const EliminationTree &tree,
                         const ShiftedMatrix<Number> &matrix,
                         const SupernodeSink<Number> &sink)
  {
    const unsigned int n_threads  = MultithreadInfo::n_threads();
    const TreePartition partition = divide_tree(tree, n_threads);
    Multifrontal<Number> multifrontal(tree, partition, matrix, sink);
    // Threads of the BLAS wait for each other in every product, long if the
    // machine has other work: only for large fronts above the branches.
    openblas_set_num_threads(1);
    std::vector<std::string> failures(partition.branches.size());
    run_tasks(partition.branches.size(), [&](const unsigned int branch) {
      try
        {
          multifrontal.factorize(partition.branches[branch]);
        }
      catch (const SimulationError &error)
        {
          failures[branch] = error.what();
        }
    });
    for (const std::string &failure : failures)
      if (!failure.empty())
        throw SimulationError(failure);
    multifrontal.factorize(partition.top);
  }



  template void
  factorize_multifrontal(const EliminationTree &,
                         const ShiftedMatrix<double> &,
                         const SupernodeSink<double> &);

  template void
  factorize_multifrontal(const EliminationTree &,
                         const ShiftedMatrix<std::complex<double>> &,
                         const SupernodeSink<std::complex<double>> &);
} // namespace ACF
