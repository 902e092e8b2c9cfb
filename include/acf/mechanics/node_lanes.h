// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_node_lanes_h
#define acf_mechanics_node_lanes_h

#include <acf/base/lanes.h>
#include <acf/base/types.h>

#include <deal.II/base/aligned_vector.h>

namespace ACF
{
  /**
   * Nodal values of a few vectors, node by node and four numbers each: three
   * components and a zero. Instructions take a value at once, and products with
   * node matrices read the values of a node from one place.
   */
  class NodeLanes
  {
  public:
    /** At most so many vectors, as there are stages. */
    static constexpr unsigned int max_vectors = 3;

    /** Values are not set. */
    void
    resize(const std::size_t n_nodes, const unsigned int n_vectors);

    std::size_t
    n_nodes() const
    {
      return size;
    }

    unsigned int
    n_vectors() const
    {
      return vectors;
    }

    /** Value of vector v at node a: data()[4 (n_vectors() a + v)] and the
     * following ones. */
    double *
    data()
    {
      return values.data();
    }

    const double *
    data() const
    {
      return values.data();
    }

    /** Copies vectors of size 3 n_nodes(). */
    void
    read(const NodalVector *const *const vectors);

    void
    write(NodalVector *const *const vectors) const;

  private:
    std::size_t size     = 0;
    unsigned int vectors = 0;
    AlignedVector<double> values;
  };



  /** Three numbers and a zero. */
  ACF_INLINE Four
  load_three(const double *const p)
  {
    return Four{p[0], p[1], p[2], 0};
  }

  ACF_INLINE void
  store_three(const Four &x, double *const p)
  {
    p[0] = x[0];
    p[1] = x[1];
    p[2] = x[2];
  }

  /** Component j at its first three places and the last one. */
  template <int j>
  ACF_INLINE Four
  splat(const Four &x)
  {
    return __builtin_shufflevector(x, x, j, j, j, j);
  }

  /** The same for both halves. */
  template <int j>
  ACF_INLINE Eight
  splat(const Eight &x)
  {
    return __builtin_shufflevector(
      x, x, j, j, j, j, 4 + j, 4 + j, 4 + j, 4 + j);
  }
} // namespace ACF

#endif
