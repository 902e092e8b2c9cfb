// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_eight_h
#define acf_base_eight_h

namespace ACF
{
  /**
   * Eight numbers that instructions take at once as far as the processor can;
   * at any address of a number.
   */
  typedef double Eight __attribute__((vector_size(64), aligned(8), may_alias));

  inline const Eight &
  eight_at(const double *const p)
  {
    return *reinterpret_cast<const Eight *>(p);
  }

  inline Eight &
  eight_at(double *const p)
  {
    return *reinterpret_cast<Eight *>(p);
  }
} // namespace ACF

#endif
