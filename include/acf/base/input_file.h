// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_input_file_h
#define acf_base_input_file_h

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace ACF
{
  /** Why a file cannot be read: "no such file", "a directory". */
  class UnreadableFile : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * Makes sure that a file is one that another library can read without
   * waiting for ever: a regular file that is not empty and may be opened.
   * @throws UnreadableFile
   */
  void
  require_regular_file(const std::filesystem::path &file);

  /**
   * The contents of a regular file, or what comes through a pipe (as of the
   * shell's <tt>\<(command)</tt>). Waits for a pipe some seconds at most.
   * @throws UnreadableFile also if there are more bytes than @p max_size
   */
  std::string
  read_input_file(const std::filesystem::path &file,
                  const std::size_t max_size);

  /** Position of the first byte that is not text in UTF-8, or npos. */
  std::size_t
  find_non_text(const std::string &text);
} // namespace ACF

#endif
