// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/statistics.h>

#include <sys/resource.h>

namespace ACF
{
  std::size_t
  peak_memory()
  {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024 * static_cast<std::size_t>(usage.ru_maxrss);
  }
} // namespace ACF
