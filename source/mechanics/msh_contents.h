// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_msh_contents_h
#define acf_mechanics_msh_contents_h

#include <acf/mechanics/mesh_data.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string>

namespace ACF
{
  /** Takes lines and numbers from the contents of a mesh file, never beyond
   * their end. */
  class MshContents
  {
  public:
    MshContents(const std::string &text, const MeshSource &source)
      : text(text)
      , source(source)
    {}

    /** Whether number() reads the memory of numbers, not their digits. */
    bool is_binary = false;

    /** The rest of the line, without spaces around it. */
    std::string
    line();

    /** Whether nothing but spaces is left; skips spaces. */
    bool
    at_end();

    /**
     * @param what for the message: "the number of a node"
     * @throws InputError if there is no such number
     */
    template <typename Number>
    Number
    number(const char *const what);

    /** The same in digits, whatever the kind of the file. */
    template <typename Number>
    Number
    number_in_digits(const char *const what);

    /** Skip what is there up to a line that begins so. */
    void
    skip_to(const std::string &start_of_line);

    /** Stop if the rest cannot hold @p n things of @p n_numbers each. */
    void
    check_count(const std::size_t n,
                const std::size_t n_numbers,
                const std::string &what) const;

    /** Throw an InputError with the place of what was taken last. */
    [[noreturn]] void
    fail(const std::string &found,
         const std::string &allowed =
           "a complete mesh file of gmsh, format 2.2 or 4.1") const;

    /** A text from the file as far as it is short and of letters. */
    static std::string
    quoted(const std::string &text);

  private:
    static constexpr char spaces[] = " \t\r\n\v\f";

    const std::string &text;
    const MeshSource &source;
    std::size_t position = 0;

    /** Where that begins what was taken last. */
    std::size_t last_place = 0;
  };



  inline std::string
  MshContents::line()
  {
    const std::size_t end = std::min(text.find('\n', position), text.size());
    last_place            = position;
    std::string result;
    const std::size_t first = text.find_first_not_of(spaces, position);
    if (first < end)
      result =
        text.substr(first, text.find_last_not_of(spaces, end - 1) + 1 - first);
    position = std::min(end + 1, text.size());
    return result;
  }

  inline bool
  MshContents::at_end()
  {
    position = std::min(text.find_first_not_of(spaces, position), text.size());
    last_place = position;
    return position == text.size();
  }

  template <typename Number>
  Number
  MshContents::number(const char *const what)
  {
    if (!is_binary)
      return number_in_digits<Number>(what);
    last_place = position;
    if (text.size() - position < sizeof(Number))
      fail(std::string("the end of the file instead of ") + what +
           ", the file is truncated");
    Number result;
    std::memcpy(&result, text.data() + position, sizeof(Number));
    position += sizeof(Number);
    return result;
  }

  template <typename Number>
  Number
  MshContents::number_in_digits(const char *const what)
  {
    if (at_end())
      fail(std::string("the end of the file instead of ") + what +
           ", the file is truncated");
    const std::size_t end =
      std::min(text.find_first_of(spaces, position), text.size());
    const char *const first  = text.data() + position + (text[position] == '+');
    const char *const last   = text.data() + end;
    Number result            = 0;
    const auto [stop, error] = std::from_chars(first, last, result);
    if (error != std::errc() || stop != last)
      fail(quoted(text.substr(position, end - position)) + " instead of " +
           what);
    position = end;
    return result;
  }

  inline void
  MshContents::skip_to(const std::string &start_of_line)
  {
    const std::size_t found = text.find("\n" + start_of_line, position - 1);
    if (found == std::string::npos)
      fail("no line " + quoted(start_of_line) + ", the file is truncated");
    position = found + 1;
  }

  inline void
  MshContents::check_count(const std::size_t n,
                           const std::size_t n_numbers,
                           const std::string &what) const
  {
    // at least a digit and a space, or four bytes
    const std::size_t n_bytes = n_numbers * (is_binary ? 4 : 2);
    if (n > (text.size() - position) / n_bytes + 1)
      fail(std::to_string(n) + " " + what +
           ", more than the file can hold, which is wrong or truncated");
  }

  inline void
  MshContents::fail(const std::string &found, const std::string &allowed) const
  {
    const std::string place =
      is_binary
        ? "byte " + std::to_string(last_place + 1)
        : "line " +
            std::to_string(
              1 + std::count(text.begin(), text.begin() + last_place, '\n'));
    throw source.error(place + ": " + found, allowed);
  }

  inline std::string
  MshContents::quoted(const std::string &text)
  {
    constexpr std::size_t enough = 40;
    std::string letters          = text.substr(0, enough);
    std::replace_if(
      letters.begin(),
      letters.end(),
      [](const char c) { return c < 0x20 || c > 0x7e; },
      '?');
    return "'" + letters + "'";
  }
} // namespace ACF

#endif
