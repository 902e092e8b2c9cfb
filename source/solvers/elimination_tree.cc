// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/solvers/elimination_tree.h>

#include <algorithm>

#include <suitesparse/cholmod.h>

namespace ACF
{
  namespace
  {
    // Merging a supernode with its parent stores zeros, but saves a gather, a
    // scatter and short loops in each solve. Limits on the part of zeros, for
    // blocks of up to so many columns.
    struct MergeLimit
    {
      unsigned int n_columns;
      double zeros;
    };

    constexpr MergeLimit merge_limits[]  = {{2, 0.5}, {6, 0.2}, {16, 0.1}};
    constexpr double largest_merge_zeros = 0.03;



    double
    allowed_zeros(const unsigned int n_columns)
    {
      for (const MergeLimit &limit : merge_limits)
        if (n_columns <= limit.n_columns)
          return limit.zeros;
      return largest_merge_zeros;
    }



    // The session of the library, and its view of the graph.
    class Cholmod
    {
    public:
      explicit Cholmod(const NodeGraph &graph)
        : n(graph.n_nodes())
      {
        cholmod_start(&common);
        common.supernodal = CHOLMOD_SIMPLICIAL;
        common.postorder  = 1;
        common.print      = 0;

        std::size_t n_upper = 0;
        for (unsigned int a = 0; a < n; ++a)
          for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1];
               ++e)
            n_upper += (graph.column[e] <= a ? 1 : 0);
        matrix = cholmod_allocate_sparse(
          n, n, n_upper, 1, 1, 1, CHOLMOD_PATTERN, &common);
        require(matrix != nullptr);
        // column a of the upper triangle
        int *const start = static_cast<int *>(matrix->p);
        int *const row   = static_cast<int *>(matrix->i);
        int entry        = 0;
        for (unsigned int a = 0; a < n; ++a)
          {
            start[a] = entry;
            for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1];
                 ++e)
              if (graph.column[e] <= a)
                row[entry++] = graph.column[e];
          }
        start[n] = entry;
      }

      ~Cholmod()
      {
        cholmod_free_factor(&factor, &common);
        cholmod_free_sparse(&matrix, &common);
        cholmod_finish(&common);
      }

      Cholmod(const Cholmod &) = delete;
      Cholmod &
      operator=(const Cholmod &) = delete;

      // Minimum degree is fast, and best for slender bodies; nested dissection
      // is worth its time where columns are long.
      void
      analyze()
      {
        factor                        = analyze_with(CHOLMOD_AMD);
        const double n_minimum_degree = common.lnz;
        if (common.fl < 150 * n_minimum_degree)
          return;
        cholmod_factor *dissected = analyze_with(CHOLMOD_NESDIS);
        if (common.lnz < n_minimum_degree)
          std::swap(factor, dissected);
        cholmod_free_factor(&dissected, &common);
      }

      // The node at each place, and the rows of each column of L.
      std::vector<unsigned int>
      order() const
      {
        const int *const p = static_cast<const int *>(factor->Perm);
        return std::vector<unsigned int>(p, p + n);
      }

      std::vector<unsigned int>
      column_counts() const
      {
        const int *const p = static_cast<const int *>(factor->ColCount);
        return std::vector<unsigned int>(p, p + n);
      }

    private:
      cholmod_factor *
      analyze_with(const int ordering)
      {
        common.nmethods              = 1;
        common.method[0].ordering    = ordering;
        cholmod_factor *const result = cholmod_analyze(matrix, &common);
        require(result != nullptr);
        return result;
      }

      void
      require(const bool condition) const
      {
        if (!condition)
          throw SimulationError(
            "Not enough memory to analyse the matrix of a "
            "body with " +
            std::to_string(3 * n) + " unknowns.");
      }

      const unsigned int n;
      cholmod_common common;
      cholmod_sparse *matrix = nullptr;
      cholmod_factor *factor = nullptr;
    };
  } // namespace



  std::size_t
  n_entries(const EliminationTree::Supernode &supernode)
  {
    const std::size_t k = 3 * supernode.n_columns;
    return k * (k + 1) / 2 + k * 3 * supernode.rows.size();
  }



  EliminationTree::EliminationTree(const NodeGraph &graph)
  {
    Cholmod cholmod(graph);
    cholmod.analyze();
    node_at = cholmod.order();
    place_of.resize(node_at.size());
    for (unsigned int k = 0; k < node_at.size(); ++k)
      place_of[node_at[k]] = k;

    // Liu's algorithm with compressed paths: the parent of a column is the
    // first row below its diagonal
    std::vector<unsigned int> parent(node_at.size(), none);
    std::vector<unsigned int> ancestor(node_at.size(), none);
    for (unsigned int k = 0; k < node_at.size(); ++k)
      for (std::size_t e = graph.row_start[node_at[k]];
           e < graph.row_start[node_at[k] + 1];
           ++e)
        for (unsigned int j = place_of[graph.column[e]], next; j < k; j = next)
          {
            next        = ancestor[j];
            ancestor[j] = k;
            if (next == none)
              {
                parent[j] = k;
                break;
              }
          }

    find_supernodes(parent, cholmod.column_counts());
    find_rows(graph);
  }



  void
  EliminationTree::find_supernodes(const std::vector<unsigned int> &parent,
                                   const std::vector<unsigned int> &n_rows)
  {
    // A block under construction: consecutive columns, the rows of its first
    // column if it were dense, and the zeros that this stores.
    struct Block
    {
      unsigned int first, n_columns;
      std::size_t height;
      double zeros;
    };

    const auto size = [](const double columns, const double height) {
      return columns * height - columns * (columns - 1) / 2;
    };
    std::vector<Block> blocks;
    for (unsigned int k = 0; k < parent.size(); ++k)
      {
        // fundamental: the same rows as the column before
        if (k > 0 && parent[k - 1] == k && n_rows[k - 1] == n_rows[k] + 1)
          ++blocks.back().n_columns;
        else
          blocks.push_back({k, 1, n_rows[k], 0.});
        // is the block complete?
        const bool complete = k + 1 == parent.size() || parent[k] != k + 1 ||
                              n_rows[k] != n_rows[k + 1] + 1;
        // merge with the child before, which ends where this one begins
        while (complete && blocks.size() > 1)
          {
            const Block &child   = blocks[blocks.size() - 2];
            const Block &present = blocks.back();
            if (parent[present.first - 1] != present.first)
              break;
            const unsigned int columns = child.n_columns + present.n_columns;
            const std::size_t height   = child.n_columns + present.height;
            const double all           = size(columns, height);
            const double zeros         = present.zeros + child.zeros + all -
                                 size(child.n_columns, child.height) -
                                 size(present.n_columns, present.height);
            if (zeros > allowed_zeros(columns) * all)
              break;
            const Block merged = {child.first, columns, height, zeros};
            blocks.pop_back();
            blocks.back() = merged;
          }
      }

    supernode_of.resize(node_at.size());
    for (const Block &block : blocks)
      {
        for (unsigned int k = 0; k < block.n_columns; ++k)
          supernode_of[block.first + k] = tree.size();
        tree.push_back({block.first, block.n_columns, {}, none});
      }
  }



  void
  EliminationTree::find_rows(const NodeGraph &graph)
  {
    std::vector<std::vector<unsigned int>> children(tree.size());
    std::vector<unsigned int> mark(node_at.size(), none);
    for (unsigned int s = 0; s < tree.size(); ++s)
      {
        Supernode &supernode   = tree[s];
        const unsigned int end = supernode.first + supernode.n_columns;
        const auto add         = [&](const unsigned int place) {
          if (place >= end && mark[place] != s)
            {
              mark[place] = s;
              supernode.rows.push_back(place);
            }
        };
        for (unsigned int k = supernode.first; k < end; ++k)
          for (std::size_t e = graph.row_start[node_at[k]];
               e < graph.row_start[node_at[k] + 1];
               ++e)
            add(place_of[graph.column[e]]);
        for (const unsigned int child : children[s])
          for (const unsigned int row : tree[child].rows)
            add(row);
        std::sort(supernode.rows.begin(), supernode.rows.end());
        if (!supernode.rows.empty())
          {
            supernode.parent = supernode_of[supernode.rows[0]];
            children[supernode.parent].push_back(s);
          }
      }
  }



  std::size_t
  EliminationTree::n_entries() const
  {
    std::size_t n = 0;
    for (const Supernode &supernode : tree)
      n += ACF::n_entries(supernode);
    return n;
  }
} // namespace ACF
