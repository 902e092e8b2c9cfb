// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/tree_partition.h>

#include <algorithm>
#include <limits>

namespace ACF
{
  namespace
  {
    // Cuts the largest branch again and again.
    class Division
    {
    public:
      Division(const EliminationTree &tree, const unsigned int n_threads)
        : supernodes(tree.supernodes())
        , n_threads(n_threads)
        , children(supernodes.size())
        , work(supernodes.size())
        , is_top(supernodes.size(), false)
      {
        for (unsigned int s = 0; s < supernodes.size(); ++s)
          {
            work[s] += n_entries(supernodes[s]);
            if (supernodes[s].parent == EliminationTree::none)
              roots.push_back(s);
            else
              {
                work[supernodes[s].parent] += work[s];
                children[supernodes[s].parent].push_back(s);
              }
          }
      }

      TreePartition
      best()
      {
        // a cut may not help before the next one
        constexpr unsigned int patience = 8;
        double best_time = std::numeric_limits<double>::infinity();
        TreePartition result;
        for (unsigned int n_failures = 0; n_failures < patience; ++n_failures)
          {
            const double time = share_out();
            if (time < 0.99 * best_time)
              {
                best_time  = time;
                result     = partition();
                n_failures = 0;
              }
            if (n_threads == 1 || !cut())
              break;
          }
        return result;
      }

    private:
      // Gives each branch, largest first, to the thread with the least work.
      // @return work of the largest share and the top
      double
      share_out()
      {
        std::sort(roots.begin(),
                  roots.end(),
                  [&](const unsigned int a, const unsigned int b) {
                    return work[a] > work[b] || (work[a] == work[b] && a < b);
                  });
        std::vector<double> load(n_threads);
        thread_of_root.assign(supernodes.size(), 0);
        for (const unsigned int root : roots)
          {
            const unsigned int thread =
              std::min_element(load.begin(), load.end()) - load.begin();
            load[thread] += work[root];
            thread_of_root[root] = thread;
          }
        return top_work + *std::max_element(load.begin(), load.end());
      }

      TreePartition
      partition() const
      {
        TreePartition result;
        result.branches.resize(n_threads);
        result.is_top = is_top;
        std::vector<unsigned int> thread(thread_of_root);
        for (unsigned int s = supernodes.size(); s-- > 0;)
          {
            const unsigned int parent = supernodes[s].parent;
            if (!is_top[s] && parent != EliminationTree::none &&
                !is_top[parent])
              thread[s] = thread[parent];
          }
        for (unsigned int s = 0; s < supernodes.size(); ++s)
          (is_top[s] ? result.top : result.branches[thread[s]]).push_back(s);
        return result;
      }

      // @return false if the largest branch is one supernode
      bool
      cut()
      {
        const unsigned int root = roots.front();
        if (children[root].empty())
          return false;
        is_top[root] = true;
        top_work += n_entries(supernodes[root]);
        roots.erase(roots.begin());
        roots.insert(roots.end(), children[root].begin(), children[root].end());
        return true;
      }

      const std::vector<EliminationTree::Supernode> &supernodes;
      const unsigned int n_threads;
      std::vector<std::vector<unsigned int>> children;

      /** Entries of a supernode and all below it. */
      std::vector<double> work;

      std::vector<unsigned int> roots;
      std::vector<unsigned int> thread_of_root;
      std::vector<bool> is_top;
      double top_work = 0;
    };
  } // namespace



  TreePartition
  divide_tree(const EliminationTree &tree, const unsigned int n_threads)
  {
    return Division(tree, n_threads).best();
  }
} // namespace ACF
