// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>

#include <unistd.h>

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace ACF
{
  namespace
  {
    std::string
    with_unit(const double value, const char *unit)
    {
      std::ostringstream text;
      text << std::setprecision(3) << value << ' ' << unit;
      return text.str();
    }
  } // namespace



  std::string
  format_duration(const double seconds)
  {
    if (seconds < 60)
      return with_unit(seconds, "s");
    if (seconds < 3600)
      return with_unit(seconds / 60, "min");
    return with_unit(seconds / 3600, "h");
  }



  std::string
  format_bytes(const double bytes)
  {
    if (bytes < 1e6)
      return with_unit(bytes / 1e3, "kB");
    if (bytes < 1e9)
      return with_unit(bytes / 1e6, "MB");
    return with_unit(bytes / 1e9, "GB");
  }



  std::string
  format_number(const double value)
  {
    std::ostringstream text;
    text << std::setprecision(6) << value;
    return text.str();
  }



  std::string
  counted(const unsigned long n, const std::string &noun)
  {
    return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
  }



  Progress::Progress(std::ostream &stream,
                     const bool enabled,
                     const double end_time,
                     const double start_time)
    : stream(stream)
    , enabled(enabled)
    , end_time(end_time)
    , start_time(start_time)
    , start(Clock::now())
    , last_update(start - std::chrono::hours(1))
  {}



  Progress::~Progress()
  {
    if (line_open)
      stream << std::endl;
  }



  void
  Progress::update(const double time,
                   const double step_size,
                   const unsigned int iterations,
                   const unsigned long n_steps)
  {
    if (!enabled)
      return;
    const auto now      = Clock::now();
    const bool finished = time >= end_time;
    if (!finished && now - last_update < std::chrono::milliseconds(200))
      return;
    last_update = now;

    const double elapsed = std::chrono::duration<double>(now - start).count();
    const double left    = std::max(0.,
                                 elapsed * (end_time - time) /
                                   std::max(time - start_time, 1e-300));
    std::ostringstream line;
    line << "t = " << format_number(time) << " of " << format_number(end_time)
         << " s, step " << n_steps << " (" << format_number(step_size) << " s, "
         << iterations << (iterations == 1 ? " iteration" : " iterations")
         << "), "
         << (finished ? "took " + format_duration(elapsed)
                      : format_duration(left) + " left");
    stream << "\r\033[K" << line.str() << std::flush;
    line_open = true;
  }



  void
  print_warning(std::ostream &stream, const std::string &message)
  {
    if (isatty(STDOUT_FILENO) && isatty(STDERR_FILENO))
      stream << "\r\033[K";
    stream << "acf-dealii: warning: " << message << "." << std::endl;
  }



  bool
  standard_output_is_terminal()
  {
    return isatty(STDOUT_FILENO);
  }
} // namespace ACF
