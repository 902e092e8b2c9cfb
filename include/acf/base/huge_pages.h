// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_huge_pages_h
#define acf_base_huge_pages_h

#include <deal.II/base/aligned_vector.h>

#include <cstddef>

namespace ACF
{
  /**
   * Asks the system to keep memory that has not been used yet in huge pages (2
   * MB instead of 4 kB), so that reading it from one end to the other does not
   * wait for addresses to be translated. The pages that are wholly inside; does
   * nothing where the system knows no such pages.
   * @param size bytes
   */
  void
  advise_huge_pages(void *begin, const std::size_t size);

  /**
   * The same for what the program allocates from now on, up to a gigabyte or an
   * eighth of the memory it may use. For the start of a program: many vectors
   * of some kilobytes, of all bodies, are in more small pages than the
   * processor knows the addresses of. Takes addresses, but no memory; does
   * nothing where the system does not have them, or with an allocator other
   * than that of the GNU C library.
   */
  void
  keep_heap_in_huge_pages();

  /** Gives an empty vector n zeros, in huge pages as far as possible. */
  template <typename Number>
  void
  resize_in_huge_pages(dealii::AlignedVector<Number> &vector,
                       const std::size_t n)
  {
    vector.reserve(n);
    advise_huge_pages(vector.data(), n * sizeof(Number));
    vector.resize(n);
  }
} // namespace ACF

#endif
