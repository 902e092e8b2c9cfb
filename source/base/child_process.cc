// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/child_process.h>
#include <acf/base/exceptions.h>

#include <deal.II/base/utilities.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <new>
#include <string>
#include <system_error>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

namespace ACF
{
  namespace
  {
    // What a child sends: one of these, and then its bytes.
    enum class Outcome : char
    {
      result      = 'r',
      input_error = 'i',
      no_memory   = 'm',
      error       = 'e'
    };



    [[noreturn]] void
    throw_system_error(const char *const what)
    {
      throw std::system_error(errno, std::generic_category(), what);
    }



    // Whether all of it could be written.
    bool
    write_all(const int file, const char *data, std::size_t n_bytes)
    {
      while (n_bytes > 0)
        {
          const ssize_t n = ::write(file, data, n_bytes);
          if (n < 0 && errno == EINTR)
            continue;
          if (n <= 0)
            return false;
          data += n;
          n_bytes -= n;
        }
      return true;
    }



    std::vector<char>
    read_all(const int file)
    {
      std::vector<char> content;
      std::array<char, 65536> block;
      while (true)
        {
          const ssize_t n = ::read(file, block.data(), block.size());
          if (n < 0 && errno == EINTR)
            continue;
          if (n <= 0)
            return content;
          content.insert(content.end(), block.begin(), block.begin() + n);
        }
    }



    std::vector<char>
    to_bytes(const std::string &text)
    {
      return {text.begin(), text.end()};
    }



    [[noreturn]] void
    be_child(const std::function<std::vector<char>()> &task,
             const int pipe,
             const pid_t parent)
    {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent)
        _exit(EXIT_FAILURE);
      // What libraries say when they crash is in nobody's words.
      const int nothing = open("/dev/null", O_WRONLY);
      dup2(nothing, STDOUT_FILENO);
      dup2(nothing, STDERR_FILENO);
      // Whoever calls exit() does not run what the parent has registered.
      std::atexit([]() { _exit(EXIT_SUCCESS); });

      Outcome outcome = Outcome::result;
      std::vector<char> content;
      try
        {
          content = task();
        }
      catch (const InputError &error)
        {
          outcome = Outcome::input_error;
          content =
            to_bytes(error.section + '\0' + error.entry + '\0' + error.what());
        }
      catch (const std::bad_alloc &)
        {
          outcome = Outcome::no_memory;
        }
      catch (const std::exception &error)
        {
          outcome = Outcome::error;
          content = to_bytes(error.what());
        }
      const char first   = static_cast<char>(outcome);
      const bool is_sent = write_all(pipe, &first, 1) &&
                           write_all(pipe, content.data(), content.size());
      _exit(is_sent ? EXIT_SUCCESS : EXIT_FAILURE);
    }



    // The hard limit stays, so that this one can be taken back.
    void
    set_processor_time(const rlim_t seconds)
    {
      rlimit limit;
      if (getrlimit(RLIMIT_CPU, &limit) != 0)
        throw_system_error("The limit of computing time cannot be read");
      limit.rlim_cur = std::min(seconds, limit.rlim_max);
      if (setrlimit(RLIMIT_CPU, &limit) != 0)
        throw_system_error("The computing time cannot be limited");
    }



    InputError
    received_input_error(const std::string &content)
    {
      const std::size_t first  = content.find('\0');
      const std::size_t second = content.find('\0', first + 1);
      InputError error(content.substr(second + 1));
      error.section = content.substr(0, first);
      error.entry   = content.substr(first + 1, second - first - 1);
      return error;
    }
  } // namespace



  std::vector<char>
  run_in_child_process(const std::function<std::vector<char>()> &task)
  {
    std::array<int, 2> ends;
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
      throw_system_error("No pipe to a process can be made");
    // so that the copy has nothing left to write
    std::cout.flush();
    std::fflush(nullptr);
    const pid_t parent = getpid();
    const pid_t child  = fork();
    if (child == 0)
      {
        close(ends[0]);
        be_child(task, ends[1], parent);
      }
    close(ends[1]);
    if (child < 0)
      {
        close(ends[0]);
        throw_system_error("No process can be started");
      }
    std::vector<char> content = read_all(ends[0]);
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
      ;

    if (WIFSIGNALED(status))
      throw ChildProcessEnded("was ended by signal " +
                              std::to_string(WTERMSIG(status)) + " (" +
                              strsignal(WTERMSIG(status)) + ")");
    if (content.empty() || WEXITSTATUS(status) != EXIT_SUCCESS)
      throw ChildProcessEnded("ended with exit status " +
                              std::to_string(WEXITSTATUS(status)) +
                              " before it was done");
    const auto outcome = static_cast<Outcome>(content.front());
    content.erase(content.begin());
    const std::string text(content.begin(), content.end());
    switch (outcome)
      {
        case Outcome::result:
          return content;
        case Outcome::input_error:
          throw received_input_error(text);
        case Outcome::no_memory:
          throw std::bad_alloc();
        default:
          throw std::runtime_error(text);
      }
  }



  ProcessorTimeLimit::ProcessorTimeLimit(const unsigned int seconds)
  {
    set_processor_time(seconds);
  }



  ProcessorTimeLimit::~ProcessorTimeLimit()
  {
    try
      {
        set_processor_time(RLIM_INFINITY);
      }
    catch (const std::system_error &)
      {} // then the limit stays
  }
} // namespace ACF
