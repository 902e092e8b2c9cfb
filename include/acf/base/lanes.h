// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_lanes_h
#define acf_base_lanes_h

#include <acf/base/processor.h>

namespace ACF
{
  /** Numbers that instructions take at once as far as the processor can; eight
   * only where it has registers for them, see run_in_lanes(). */
  typedef double Two __attribute__((vector_size(16)));
  typedef double Four __attribute__((vector_size(32)));
  typedef double Eight __attribute__((vector_size(64)));

  template <typename Lanes>
  constexpr unsigned int n_lanes = sizeof(Lanes) / sizeof(double);

  template <typename Lanes>
  ACF_INLINE double
  sum_of_lanes(const Lanes &x)
  {
    double sum = 0;
    for (unsigned int lane = 0; lane < n_lanes<Lanes>; ++lane)
      sum += x[lane];
    return sum;
  }

  /**
   * A vector of numbers at any address of a number. (Attributes of a type that
   * is a template argument or the element of an array may be lost, so that an
   * alignment that is part of a vector's type is no way to say this.)
   */
  template <typename Vector>
  struct __attribute__((packed, may_alias)) UnalignedLanes
  {
    Vector value;
  };

  template <typename Vector, typename Number>
  ACF_INLINE Vector
  load_lanes(const Number *const p)
  {
    return reinterpret_cast<const UnalignedLanes<Vector> *>(p)->value;
  }

  template <typename Vector, typename Number>
  ACF_INLINE void
  store_lanes(const Vector &x, Number *const p)
  {
    reinterpret_cast<UnalignedLanes<Vector> *>(p)->value = x;
  }

  template <typename Vector, typename Number>
  ACF_INLINE void
  add_lanes(const Vector &x, Number *const p)
  {
    reinterpret_cast<UnalignedLanes<Vector> *>(p)->value += x;
  }
} // namespace ACF

#endif
