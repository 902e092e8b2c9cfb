// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/huge_pages.h>

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include <sys/mman.h>
#include <sys/resource.h>
#if defined(__GLIBC__)
#  include <malloc.h>
#endif

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



  void
  keep_heap_in_huge_pages()
  {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
    constexpr std::size_t most = std::size_t(1) << 30;
    std::size_t memory =
      static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
    for (const auto resource : {RLIMIT_AS, RLIMIT_DATA})
      {
        rlimit limit;
        if (getrlimit(resource, &limit) == 0 && limit.rlim_cur < memory)
          memory = limit.rlim_cur;
      }
    const std::size_t size = std::min(most, memory / 8);

    // What is larger than this has pages of its own, and is advised by those
    // who allocate it. What is freed stays with the heap.
    constexpr int largest_in_heap = 1 << 25;
    mallopt(M_MMAP_THRESHOLD, largest_in_heap);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());

    // The heap grows by more than is asked for, this once, when what was free
    // in it does not suffice any more.
    constexpr int usual_growth      = 1 << 17;
    constexpr std::size_t some_size = 1 << 24;
    void *some[64]                  = {};
    char *const old_end             = static_cast<char *>(sbrk(0));
    mallopt(M_TOP_PAD, static_cast<int>(size));
    for (void *&block : some)
      if (sbrk(0) == old_end)
        block = std::malloc(some_size);
    mallopt(M_TOP_PAD, usual_growth);
    char *const new_end = static_cast<char *>(sbrk(0));
    for (void *const block : some)
      std::free(block);
    if (new_end > old_end)
      advise_huge_pages(old_end, new_end - old_end);
#endif
  }
} // namespace ACF
