// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// What the sanitizers ask a program for when it starts: options, and what they
// shall not report. Each entry of a list says why it is there; none names code
// of this program.

extern "C"
{
  // gmsh frees with delete what new[] gave it, in the shape functions of prisms
  // of third order. MPI keeps memory until the end, most of it in plugins that
  // it has unloaded by then, so that such leaks have no name by which they
  // could be left out: the search for leaks is for programs without MPI, the
  // fuzzers.
  const char *
  __asan_default_options()
  {
    return "detect_stack_use_after_return=1:strict_string_checks=1:"
           "alloc_dealloc_mismatch=0:detect_leaks=0";
  }

  // gmsh keeps what it has computed of its element types, such as prisms.
  const char *
  __lsan_default_suppressions()
  {
    return "leak:libgmsh.so\n";
  }

  const char *
  __ubsan_default_options()
  {
    return "print_stacktrace=1";
  }

  // The library of TBB is not built with ThreadSanitizer, which therefore does
  // not see that a task is complete before another thread takes it. What our
  // tasks do is ordered by acf/base/thread_order.h instead; the lines below are
  // about the tasks themselves, in the headers of TBB (whose counters are
  // atomic; our code has none) and of deal.II's WorkStream, and about the
  // lambda function that parallel.cc gives to TBB. They look at the innermost
  // function only, not at those that it calls. What MPI locks is not seen, but
  // one of its plugins is seen to unlock it at the end.
  const char *
  __tsan_default_suppressions()
  {
    return "race_top:oneapi/tbb/\n"
           "race_top:bits/atomic_base.h\n"
           "race_top:source/base/parallel.cc\n"
           "race_top:deal.II/base/work_stream.h\n"
           "mutex:mca_pml_ob1.so\n"
           "called_from_lib:libmpi.so\n"
           "called_from_lib:libopen-pal.so\n";
  }

  // Libraries that are not built with it use locks that it does not know.
  const char *
  __tsan_default_options()
  {
    return "ignore_noninstrumented_modules=0:second_deadlock_stack=1";
  }
}
