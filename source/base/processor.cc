// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/processor.h>

namespace ACF
{
  Processor
  present_processor()
  {
#if defined(__x86_64__)
    static const Processor processor =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
          __builtin_cpu_supports("fma")
        ? Processor::avx512
      : __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
        ? Processor::avx2
        : Processor::any;
    return processor;
#else
    return Processor::any;
#endif
  }
} // namespace ACF
