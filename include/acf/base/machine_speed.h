// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_machine_speed_h
#define acf_base_machine_speed_h

#include <cstddef>

namespace ACF
{
  /**
   * Bytes per second of reading an array of this size again and again with all
   * threads: of the memory, or of a cache that holds it. Takes some tenths of a
   * second.
   * @param n_bytes at most 512 MB are used
   */
  double
  streaming_bandwidth(const std::size_t n_bytes);

  /**
   * Floating point operations per second of products of dense matrices in
   * double precision, one product per thread. Takes some tenths of a second.
   */
  double
  matrix_product_speed();
} // namespace ACF

#endif
