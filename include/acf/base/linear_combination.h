// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_linear_combination_h
#define acf_base_linear_combination_h

#include <acf/base/types.h>

namespace ACF
{
  /** A vector and its coefficient. */
  struct ScaledVector
  {
    double factor;
    const NodalVector *vector;
  };

  /**
   * $y = \sum_k c_k x_k$, which reads and writes each number once.
   * @param terms at least one; all vectors have the same size
   * @param[out] y may be the vector of the first term, but of no other; is
   * resized
   */
  void
  linear_combination(const std::vector<ScaledVector> &terms, NodalVector &y);

  /**
   * The same, and products with it in the same sweep.
   * @param z up to three vectors, not y
   * @return $y \cdot y, y \cdot z_0, ...$
   */
  std::vector<double>
  linear_combination(const std::vector<ScaledVector> &terms,
                     const std::vector<const NodalVector *> &z,
                     NodalVector &y);

  /** $|\sum_k c_k x_k|^2$, without making the sum. */
  double
  square_of_combination(const std::vector<ScaledVector> &terms);
} // namespace ACF

#endif
