// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_abaqus_lines_h
#define acf_mechanics_abaqus_lines_h

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

// What the lines of an input file of Abaqus are made of.

namespace ACF::Abaqus
{
  /** In capital letters, as names and keywords of either case are the same. */
  inline std::string
  upper(std::string text)
  {
    for (char &c : text)
      c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
  }

  inline std::string
  without_quotes(const std::string &text)
  {
    return text.size() > 1 && text.front() == '"' && text.back() == '"'
             ? text.substr(1, text.size() - 2)
             : text;
  }

  /** The fields between commas. Quotation marks keep commas. */
  inline std::vector<std::string>
  split_line(const std::string &line)
  {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (const char c : line)
      {
        quoted ^= (c == '"');
        if (c == ',' && !quoted)
          fields.emplace_back();
        else
          fields.back() += c;
      }
    for (std::string &field : fields)
      field = dealii::Utilities::trim(field);
    return fields;
  }

  /** A line "*NAME, PARAMETER=value, PARAMETER". */
  struct Keyword
  {
    Keyword() = default;

    explicit Keyword(const std::string &line)
    {
      const std::vector<std::string> fields = split_line(line.substr(1));
      std::istringstream words(upper(fields[0]));
      for (std::string word; words >> word;)
        name += (name.empty() ? "" : " ") + word;
      for (std::size_t i = 1; i < fields.size(); ++i)
        {
          using dealii::Utilities::trim;
          const auto equal            = fields[i].find('=');
          const std::string parameter = upper(trim(fields[i].substr(0, equal)));
          const std::string value =
            equal == std::string::npos ? "" : trim(fields[i].substr(equal + 1));
          if (!parameter.empty() &&
              !parameters.try_emplace(parameter, without_quotes(value)).second)
            repeated = parameter;
        }
    }

    bool
    has(const std::string &parameter) const
    {
      return parameters.count(parameter) > 0;
    }

    /** In capital letters, with single spaces. */
    std::string name;

    /** By their names in capital letters; without value: empty. */
    std::map<std::string, std::string> parameters;

    /** A parameter that is there more than once, if there is one. */
    std::string repeated;
  };

  /** A finite number, also with Fortran's exponent D; nothing if the field is
   * something else. */
  template <typename Number>
  std::optional<Number>
  parse_number(std::string field)
  {
    if (!field.empty() && field[0] == '+')
      field.erase(0, 1);
    std::replace(field.begin(), field.end(), 'D', 'E');
    std::replace(field.begin(), field.end(), 'd', 'e');
    Number result            = 0;
    const char *const last   = field.data() + field.size();
    const auto [stop, error] = std::from_chars(field.data(), last, result);
    if (error != std::errc() || stop != last ||
        !std::isfinite(static_cast<double>(result)))
      return {};
    return result;
  }
} // namespace ACF::Abaqus

#endif
