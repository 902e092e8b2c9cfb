// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/huge_pages.h>

#include <cstdint>

#include <sys/mman.h>

namespace ACF
{
  void
  advise_huge_pages(void *const begin, const std::size_t size)
  {
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t page = std::uintptr_t(1) << 21;
    const auto address            = reinterpret_cast<std::uintptr_t>(begin);
    const std::uintptr_t first    = (address + page - 1) / page * page;
    const std::uintptr_t last     = (address + size) / page * page;
    // no more than advice: a refusal changes nothing
    if (last > first)
      madvise(reinterpret_cast<void *>(first), last - first, MADV_HUGEPAGE);
#else
    static_cast<void>(begin);
    static_cast<void>(size);
#endif
  }
} // namespace ACF
