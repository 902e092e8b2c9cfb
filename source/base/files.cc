// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/files.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include <sys/stat.h>

namespace ACF
{
  namespace
  {
    [[noreturn]] void
    fail_to_write(const std::filesystem::path &file, const int error)
    {
      throw SimulationError(
        "The file '" + file.string() +
        "' cannot be written: " + std::generic_category().message(error) + ".");
    }



    // Writes everything; returns zero or what went wrong.
    int
    write_all(const int descriptor, const std::string &text)
    {
      for (std::size_t n_written = 0; n_written < text.size();)
        {
          const ssize_t n = ::write(descriptor,
                                    text.data() + n_written,
                                    text.size() - n_written);
          if (n < 0 && errno == EINTR)
            continue;
          if (n <= 0)
            return n == 0 ? EIO : errno;
          n_written += n;
        }
      return 0;
    }



    // The name of a new file is on the disk when its folder is. Some file
    // systems cannot do that, which is no reason to give up.
    void
    synchronize_directory(const std::filesystem::path &directory)
    {
      const int descriptor = ::open(directory.empty() ? "." : directory.c_str(),
                                    O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      if (descriptor < 0)
        return;
      ::fsync(descriptor);
      ::close(descriptor);
    }
  } // namespace



  void
  write_file(const std::filesystem::path &file,
             const std::string &content,
             const bool synchronized)
  {
    const std::filesystem::path temporary = file.string() + ".tmp";
    const int descriptor =
      ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0)
      fail_to_write(file, errno);
    int error = write_all(descriptor, content);
    if (error == 0 && synchronized && ::fsync(descriptor) != 0)
      error = errno;
    if (::close(descriptor) != 0 && error == 0)
      error = errno;
    if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0)
      error = errno;
    if (error != 0)
      {
        ::unlink(temporary.c_str());
        fail_to_write(file, error);
      }
    if (synchronized)
      synchronize_directory(file.parent_path());
  }



  std::string
  read_file(const std::filesystem::path &file)
  {
    const auto refuse = [&](const std::string &reason) {
      throw InputError(file.string() + ": cannot be read: " + reason);
    };
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
      refuse("it does not exist");
    if (!std::filesystem::is_regular_file(status))
      refuse("it is no file");
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    errno = 0;
    if (stream && stream.peek() != std::ifstream::traits_type::eof())
      content << stream.rdbuf();
    if (!stream.is_open() || stream.bad() || content.fail())
      refuse(std::generic_category().message(errno != 0 ? errno : EIO));
    return content.str();
  }



  void
  check_writable(const std::filesystem::path &directory)
  {
    // the folder itself or the one in which it has to be made
    std::error_code error;
    std::filesystem::path existing = std::filesystem::absolute(directory);
    while (!std::filesystem::exists(existing, error) &&
           existing.has_relative_path())
      existing = existing.parent_path();
    int reason = 0;
    if (!std::filesystem::is_directory(existing, error))
      reason = ENOTDIR;
    else if (::access(existing.c_str(), W_OK | X_OK) != 0)
      reason = errno;
    if (reason != 0)
      throw SimulationError(
        "Nothing can be written into the output directory " +
        directory.string() + ": " + std::generic_category().message(reason) +
        ".");
  }



  LogFile::LogFile(const std::filesystem::path &file,
                   const std::uintmax_t n_kept)
    : file(file)
    , descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666))
    , n_bytes(n_kept)
  {
    if (descriptor < 0)
      fail(errno);
    if (::ftruncate(descriptor, n_bytes) != 0 ||
        ::lseek(descriptor, n_bytes, SEEK_SET) < 0)
      {
        const int error = errno;
        ::close(descriptor);
        fail(error);
      }
  }



  LogFile::~LogFile()
  {
    ::close(descriptor);
  }



  void
  LogFile::append(const std::string &text)
  {
    struct stat status;
    int error = 0;
    if (::fstat(descriptor, &status) != 0)
      error = errno;
    else if (status.st_nlink == 0) // deleted: nobody would see what is written
      error = ENOENT;
    else
      error = write_all(descriptor, text);
    if (error != 0)
      {
        // a part of the text may be there
        if (::ftruncate(descriptor, n_bytes) == 0)
          ::lseek(descriptor, n_bytes, SEEK_SET);
        fail(error);
      }
    n_bytes += text.size();
  }



  void
  LogFile::synchronize() const
  {
    if (::fsync(descriptor) != 0)
      fail(errno);
  }



  void
  LogFile::fail(const int error) const
  {
    fail_to_write(file, error);
  }
} // namespace ACF
