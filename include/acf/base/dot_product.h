// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_dot_product_h
#define acf_base_dot_product_h

#include <acf/base/types.h>

namespace ACF
{
  /**
   * $x \cdot y = \sum_k x_k y_k$, by parts of the vectors and in an order that
   * depends on nothing but their size and the number of threads.
   * @param x,y of the same size
   */
  double
  dot_product(const NodalVector &x, const NodalVector &y);
} // namespace ACF

#endif
