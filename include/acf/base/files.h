// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_files_h
#define acf_base_files_h

#include <cstdint>
#include <filesystem>
#include <string>

namespace ACF
{
  /**
   * Writes a file that appears under its name complete or not at all: its
   * content is collected in NAME.tmp, which gets the name at the end. A file of
   * that name is replaced.
   *
   * @param synchronized whether the content is on the disk when the file gets
   * its name, so that it also survives a failure of the system
   * @throws SimulationError with the reason of the system; NAME.tmp is removed
   * then
   */
  void
  write_file(const std::filesystem::path &file,
             const std::string &content,
             const bool synchronized = false);

  /** The content of a file. @throws InputError with the reason of the system */
  std::string
  read_file(const std::filesystem::path &file);

  /**
   * @throws SimulationError if nothing can be written into a folder, or if it
   * does not exist and cannot be made; makes nothing
   */
  void
  check_writable(const std::filesystem::path &directory);



  /**
   * A file to which lines are appended. Each is with the system when append()
   * returns, so that it survives whatever happens to the program; what cannot
   * be written completely is not written at all.
   */
  class LogFile
  {
  public:
    /**
     * Opens a file.
     * @param n_kept bytes at its beginning that are kept; the rest is cut off
     * @pre the file has that many bytes
     * @throws SimulationError as the other functions, with the reason of the
     * system
     */
    LogFile(const std::filesystem::path &file, const std::uintmax_t n_kept);

    ~LogFile();

    LogFile(const LogFile &) = delete;
    LogFile &
    operator=(const LogFile &) = delete;

    void
    append(const std::string &text);

    /** Waits until the file is on the disk. */
    void
    synchronize() const;

    /** Bytes. */
    std::uintmax_t
    size() const
    {
      return n_bytes;
    }

  private:
    [[noreturn]] void
    fail(const int error) const;

    std::filesystem::path file;
    int descriptor;
    std::uintmax_t n_bytes;
  };
} // namespace ACF

#endif
