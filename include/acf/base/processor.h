// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_processor_h
#define acf_base_processor_h

// Inlined into functions for several instruction sets; so without lambdas.
#define ACF_INLINE inline __attribute__((always_inline))

// For loops with few and known rounds, so that their arrays stay in registers.
#if defined(__clang__)
#  define ACF_UNROLL _Pragma("unroll")
#else
#  define ACF_UNROLL _Pragma("GCC unroll 16")
#endif

// Attributes of a function for an instruction set.
#if defined(__x86_64__)
#  define ACF_AVX2 __attribute__((target("avx2,fma")))
#  define ACF_AVX512 __attribute__((target("avx512f,avx512vl,fma")))
#endif

namespace ACF
{
  /** Instruction sets that the program has own functions for, best first. */
  enum class Processor
  {
    avx512,
    avx2,
    any
  };

  /** That of the processor which runs the program. */
  Processor
  present_processor();
} // namespace ACF

#endif
