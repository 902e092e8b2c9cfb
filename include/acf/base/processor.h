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

  /** The best one of the processor which runs the program, up to the limit. */
  Processor
  present_processor();

  /** Uses no better one from now on: for tests of all of them. */
  void
  limit_processor(const Processor best);

  /**
   * Calls loop(), which is compiled once for each instruction set. It is a
   * class whose operator() and all that this calls are ACF_INLINE.
   */
  template <typename Loop>
  void
  run_vectorized(const Loop &loop);

  /**
   * The same for loops over numbers that may be taken in vectors of any length:
   * calls loop.run<Lanes>() with the longest vectors that the instruction set
   * has registers for. (Longer ones compilers take apart: GCC 12 number by
   * number, through memory, which takes ten times as long.)
   */
  template <typename Loop>
  void
  run_in_lanes(const Loop &loop);



  /** Bytes of the registers. */
  constexpr unsigned int avx512_bytes = 64, avx2_bytes = 32, any_bytes = 16;

  namespace internal
  {
    template <unsigned int n_bytes>
    struct Lanes
    {
      typedef double type __attribute__((vector_size(n_bytes)));
    };

#if defined(__x86_64__)
    template <typename Loop>
    ACF_AVX512 void
    run_in_lanes_avx512(const Loop &loop)
    {
      loop.template run<Lanes<avx512_bytes>::type>();
    }

    template <typename Loop>
    ACF_AVX2 void
    run_in_lanes_avx2(const Loop &loop)
    {
      loop.template run<Lanes<avx2_bytes>::type>();
    }

    template <typename Loop>
    ACF_AVX512 void
    run_avx512(const Loop &loop)
    {
      loop();
    }

    template <typename Loop>
    ACF_AVX2 void
    run_avx2(const Loop &loop)
    {
      loop();
    }
#endif
  } // namespace internal



  template <typename Loop>
  void
  run_vectorized(const Loop &loop)
  {
#if defined(__x86_64__)
    if (present_processor() == Processor::avx512)
      return internal::run_avx512(loop);
    if (present_processor() == Processor::avx2)
      return internal::run_avx2(loop);
#endif
    loop();
  }



  template <typename Loop>
  void
  run_in_lanes(const Loop &loop)
  {
#if defined(__x86_64__)
    if (present_processor() == Processor::avx512)
      return internal::run_in_lanes_avx512(loop);
    if (present_processor() == Processor::avx2)
      return internal::run_in_lanes_avx2(loop);
#endif
    loop.template run<typename internal::Lanes<any_bytes>::type>();
  }
} // namespace ACF

#endif
