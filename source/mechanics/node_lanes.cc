// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/huge_pages.h>
#include <acf/base/parallel.h>
#include <acf/mechanics/node_lanes.h>

namespace ACF
{
  namespace
  {
    // The nodes from begin to end of one of n vectors.
    struct ReadVector
    {
      ACF_INLINE void
      operator()() const
      {
        for (std::size_t a = begin; a < end; ++a)
          store_lanes(load_three(vector + dim * a), lanes + 4 * n * a);
      }

      const double *vector;
      double *lanes;
      unsigned int n;
      std::size_t begin, end;
    };



    struct WriteVector
    {
      ACF_INLINE void
      operator()() const
      {
        for (std::size_t a = begin; a < end; ++a)
          store_three(load_lanes<Four>(lanes + 4 * n * a), vector + dim * a);
      }

      double *vector;
      const double *lanes;
      unsigned int n;
      std::size_t begin, end;
    };
  } // namespace



  void
  NodeLanes::resize(const std::size_t n_nodes, const unsigned int n_vectors)
  {
    Assert(n_vectors >= 1 && n_vectors <= max_vectors, ExcInternalError());
    const std::size_t n = 4 * n_vectors * n_nodes;
    size                = n_nodes;
    vectors             = n_vectors;
    if (n == values.size())
      return;
    values.reserve(n);
    advise_huge_pages(values.data(), n * sizeof(double));
    values.resize_fast(n);
  }



  void
  NodeLanes::read(const NodalVector *const *const x)
  {
    for (unsigned int v = 0; v < vectors; ++v)
      AssertDimension(x[v]->size(), dim * size);
    run_ranges(size, [&](const std::size_t begin, const std::size_t end) {
      for (unsigned int v = 0; v < vectors; ++v)
        run_vectorized(ReadVector{
          x[v]->begin(), values.data() + 4 * v, vectors, begin, end});
    });
  }



  void
  NodeLanes::write(NodalVector *const *const y) const
  {
    for (unsigned int v = 0; v < vectors; ++v)
      AssertDimension(y[v]->size(), dim * size);
    run_ranges(size, [&](const std::size_t begin, const std::size_t end) {
      for (unsigned int v = 0; v < vectors; ++v)
        run_vectorized(WriteVector{
          y[v]->begin(), values.data() + 4 * v, vectors, begin, end});
    });
  }
} // namespace ACF
