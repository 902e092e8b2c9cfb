// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/input_file.h>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <thread>

namespace ACF
{
  namespace
  {
    // For the first bytes of a pipe, and between two parts of them.
    constexpr auto patience = std::chrono::seconds(5);



    std::filesystem::file_status
    status_of_file(const std::filesystem::path &file)
    {
      std::error_code error;
      const std::filesystem::file_status status =
        std::filesystem::status(file, error);
      if (!std::filesystem::exists(status))
        throw UnreadableFile("no such file");
      if (std::filesystem::is_directory(status))
        throw UnreadableFile("a directory");
      if (!std::filesystem::is_regular_file(status) &&
          !std::filesystem::is_fifo(status))
        throw UnreadableFile("a device");
      return status;
    }



    // Closes it at the end of its life.
    class FileDescriptor
    {
    public:
      explicit FileDescriptor(const std::filesystem::path &file)
        // opening a pipe must not wait for somebody who writes
        : number(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC))
      {
        if (number < 0)
          throw UnreadableFile("a file that cannot be read");
      }

      ~FileDescriptor()
      {
        close(number);
      }

      FileDescriptor(const FileDescriptor &) = delete;
      FileDescriptor &
      operator=(const FileDescriptor &) = delete;

      const int number;
    };



    // Until a pipe has bytes or its writers have gone.
    void
    wait_for_bytes(const FileDescriptor &pipe)
    {
      pollfd request = {pipe.number, POLLIN, 0};
      const auto milliseconds =
        std::chrono::duration_cast<std::chrono::milliseconds>(patience);
      if (poll(&request, 1, milliseconds.count()) == 0)
        throw UnreadableFile("a pipe into which nothing is written");
    }
  } // namespace



  void
  require_regular_file(const std::filesystem::path &file)
  {
    if (std::filesystem::is_fifo(status_of_file(file)))
      throw UnreadableFile("a pipe");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
      throw UnreadableFile("a file that cannot be read");
    if (stream.peek() == std::ifstream::traits_type::eof())
      throw UnreadableFile("an empty file");
  }



  std::string
  read_input_file(const std::filesystem::path &file, const std::size_t max_size)
  {
    const bool is_pipe = std::filesystem::is_fifo(status_of_file(file));
    const FileDescriptor descriptor(file);
    const auto start = std::chrono::steady_clock::now();
    std::string text;
    std::array<char, 65536> buffer;
    while (true)
      {
        const ssize_t n = read(descriptor.number, buffer.data(), buffer.size());
        if (n > 0)
          text.append(buffer.data(), n);
        else if (n < 0 && errno == EAGAIN)
          wait_for_bytes(descriptor);
        else if (n < 0 && errno != EINTR)
          throw UnreadableFile("a file that cannot be read");
        else if (n == 0 && (!is_pipe || !text.empty()))
          return text;
        else if (std::chrono::steady_clock::now() - start > patience)
          throw UnreadableFile("a pipe into which nothing is written");
        else if (n == 0) // nobody has opened the other end so far
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (text.size() > max_size)
          throw UnreadableFile("a file of more than " + format_bytes(max_size));
      }
  }



  std::size_t
  find_non_text(const std::string &text)
  {
    unsigned int n_continuation_bytes = 0;
    for (std::size_t i = 0; i < text.size(); ++i)
      {
        const unsigned char byte = text[i];
        const bool line_end =
          byte == '\n' ||
          (byte == '\r' && (i + 1 == text.size() || text[i + 1] == '\n'));
        const bool control =
          (byte < 0x20 && byte != '\t' && !line_end) || byte == 0x7f;
        const bool continues = (byte & 0xc0) == 0x80;
        if (control || continues != (n_continuation_bytes > 0) ||
            byte == 0xc0 || byte == 0xc1 || byte > 0xf4)
          return i;
        n_continuation_bytes = continues      ? n_continuation_bytes - 1
                               : byte >= 0xf0 ? 3
                               : byte >= 0xe0 ? 2
                               : byte >= 0xc0 ? 1
                                              : 0;
      }
    return n_continuation_bytes > 0 ? text.size() - 1 : std::string::npos;
  }
} // namespace ACF
