// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_all_instructions_h
#define acf_tests_all_instructions_h

#include <acf/base/processor.h>

#include <gtest/gtest.h>

namespace ACF::Testing
{
  /** Calls a function for each instruction set that the processor has. */
  template <typename Function>
  void
  with_all_instructions(const Function &function)
  {
    for (const Processor best :
         {Processor::avx512, Processor::avx2, Processor::any})
      {
        limit_processor(best);
        SCOPED_TRACE("instruction set " +
                     std::to_string(static_cast<int>(present_processor())));
        function();
      }
    limit_processor(Processor::avx512);
  }
} // namespace ACF::Testing

/** TEST() with each instruction set. */
#define TEST_WITH_ALL_INSTRUCTIONS(suite, name)          \
  static void suite##_##name();                          \
  TEST(suite, name)                                      \
  {                                                      \
    ACF::Testing::with_all_instructions(suite##_##name); \
  }                                                      \
  static void suite##_##name()

#endif
