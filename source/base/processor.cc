// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/processor.h>

#include <algorithm>
#include <atomic>

namespace ACF
{
  namespace
  {
    Processor
    best_processor()
    {
#if defined(__x86_64__)
      if (__builtin_cpu_supports("avx512f") &&
          __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma"))
        return Processor::avx512;
      if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return Processor::avx2;
#endif
      return Processor::any;
    }



    std::atomic<Processor> &
    processor()
    {
      static std::atomic<Processor> present(best_processor());
      return present;
    }
  } // namespace



  Processor
  present_processor()
  {
    return processor().load(std::memory_order_relaxed);
  }



  void
  limit_processor(const Processor best)
  {
    // best first
    processor() = std::max(best, best_processor());
  }
} // namespace ACF
