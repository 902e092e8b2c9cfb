// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_thread_order_h
#define acf_base_thread_order_h

#if defined(__SANITIZE_THREAD__)
#  define ACF_THREAD_SANITIZER
#elif defined(__has_feature)
#  if __has_feature(thread_sanitizer)
#    define ACF_THREAD_SANITIZER
#  endif
#endif

#ifdef ACF_THREAD_SANITIZER
extern "C" void
__tsan_release(void *);
extern "C" void
__tsan_acquire(void *);
#endif

namespace ACF
{
  /**
   * Tell ThreadSanitizer of an order that it cannot see, because the library of
   * TBB is not built with it: what a thread did before publish_order() comes
   * before what another one does after observe_order() of the same address.
   * Only for an order that TBB guarantees: that a task begins after it was
   * started, and that the call that started tasks returns after their end.
   * Without ThreadSanitizer both do nothing.
   */
  inline void
  publish_order(const void *const address)
  {
#ifdef ACF_THREAD_SANITIZER
    __tsan_release(const_cast<void *>(address));
#else
    static_cast<void>(address);
#endif
  }

  /** See publish_order(). */
  inline void
  observe_order(const void *const address)
  {
#ifdef ACF_THREAD_SANITIZER
    __tsan_acquire(const_cast<void *>(address));
#else
    static_cast<void>(address);
#endif
  }
} // namespace ACF

#endif
