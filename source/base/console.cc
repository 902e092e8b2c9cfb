// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iomanip>
#include <ostream>
#include <sstream>

#include <sys/ioctl.h>

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



    // Of a part between 0 and 1: "[#####               ]".
    std::string
    bar(const double part)
    {
      constexpr unsigned int length = 20;
      const auto n_done =
        static_cast<unsigned int>(length * std::min(1., std::max(0., part)));
      return "[" + std::string(n_done, '#') +
             std::string(length - n_done, ' ') + "]";
    }



    // Characters that fit into a line, without the last column, after which
    // some terminals begin a new line.
    std::size_t
    terminal_width()
    {
      winsize size;
      if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2)
        return std::string::npos;
      return size.ws_col - 1;
    }



    constexpr const char *red    = "\033[31m";
    constexpr const char *yellow = "\033[33m";

    // For standard error.
    std::string
    in_colour(const std::string &text, const char *const colour)
    {
      const char *const terminal = std::getenv("TERM");
      const char *const refusal  = std::getenv("NO_COLOR");
      if (!isatty(STDERR_FILENO) || terminal == nullptr ||
          std::string(terminal) == "dumb" ||
          (refusal != nullptr && *refusal != '\0'))
        return text;
      return colour + text + "\033[0m";
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

    const double elapsed   = std::chrono::duration<double>(now - start).count();
    const double left      = std::max(0.,
                                 elapsed * (end_time - time) /
                                   std::max(time - start_time, 1e-300));
    const double simulated = time - start_time;
    std::ostringstream line;
    line << bar(time / end_time) << ' ' << format_number(time) << " of "
         << format_number(end_time) << " s, step " << n_steps << " ("
         << format_number(step_size) << " s, "
         << counted(iterations, "iteration") << "), "
         << (finished ? "took " + format_duration(elapsed)
                      : format_duration(left) + " left");
    if (simulated > 0)
      line << ", " << format_duration(elapsed / simulated) << " per s";
    stream << "\r\033[K" << line.str().substr(0, terminal_width())
           << std::flush;
    line_open = true;
  }



  void
  print_warning(std::ostream &stream, const std::string &message)
  {
    if (isatty(STDOUT_FILENO) && isatty(STDERR_FILENO))
      stream << "\r\033[K";
    stream << in_colour("acf-dealii: warning:", yellow) << " " << message << "."
           << std::endl;
  }



  void
  print_error(std::ostream &stream, const std::string &message)
  {
    stream << in_colour("acf-dealii:", red) << " " << message << std::endl;
  }



  bool
  standard_output_is_terminal()
  {
    return isatty(STDOUT_FILENO);
  }
} // namespace ACF
