// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parameter_patterns.h>

#include <deal.II/base/types.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <regex>

namespace ACF
{
  using namespace dealii;

  namespace
  {
    unsigned int
    edit_distance(const std::string &first, const std::string &second)
    {
      std::vector<unsigned int> row(second.size() + 1);
      std::iota(row.begin(), row.end(), 0u);
      for (std::size_t i = 0; i < first.size(); ++i)
        {
          unsigned int diagonal = row[0]++;
          for (std::size_t j = 0; j < second.size(); ++j)
            {
              const bool equal =
                std::tolower(static_cast<unsigned char>(first[i])) ==
                std::tolower(static_cast<unsigned char>(second[j]));
              const unsigned int replaced = diagonal + (equal ? 0 : 1);
              diagonal                    = row[j + 1];
              row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
            }
        }
      return row.back();
    }

    struct ListPattern
    {
      std::string element, min, max, separator;
    };

    std::optional<ListPattern>
    parse_list_pattern(const std::string &description)
    {
      static const std::regex list(
        R"(\[List of <(.*)> of length (\d+)\.\.\.(\d+) \(inclusive\))"
        R"((?: separated by <(.*)>)?\])");
      std::smatch match;
      if (!std::regex_match(description, match, list))
        return {};
      return ListPattern{match[1],
                         match[2],
                         match[3],
                         match[4].matched ? match[4].str() : ","};
    }

    /** "a number in [0, 1]" from the bounds; an empty bound is none. */
    std::string
    range(const std::string &kind,
          const std::string &lower,
          const std::string &upper,
          const bool open_at_zero)
    {
      if (lower.empty() && upper.empty())
        return kind;
      if (upper.empty())
        return kind + (open_at_zero ? " > " : " >= ") + lower;
      if (lower.empty())
        return kind + " <= " + upper;
      return kind + " in " + (open_at_zero ? "(" : "[") + lower + ", " + upper +
             "]";
    }

    std::string
    describe_number(const std::string &description, const bool plural)
    {
      static const std::regex bounds(
        R"(\[\w+ (?:range )?(\S+?)\.\.\.(\S+) \(inclusive\)\])");
      const bool integer     = description.rfind("[Integer", 0) == 0;
      const std::string kind = integer ? (plural ? "integers" : "an integer")
                                       : (plural ? "numbers" : "a number");
      std::smatch match;
      if (!std::regex_match(description, match, bounds))
        // the pattern of unsigned integers has no bounds
        return integer ? kind + " >= 0" : kind;

      std::string lower = match[1], upper = match[2];
      if (lower == "-MAX_DOUBLE" || lower == "-2147483648")
        lower.clear();
      if (upper == "MAX_DOUBLE" || upper == "2147483647")
        upper.clear();
      // the smallest positive number is the usual way to say: positive
      const bool positive = lower == "2.22507e-308";
      return range(kind, positive ? "0" : lower, upper, positive);
    }

    std::string
    describe_list(const ListPattern &list, const bool plural)
    {
      const bool unbounded = list.max == "4294967295";
      std::string length   = list.min + " to " + list.max + " ";
      if (list.min == list.max)
        length = list.min + " ";
      else if (unbounded)
        length = list.min == "0" ? "" : list.min + " or more ";
      return (plural ? "lists of " : "a list of ") + length +
             allowed_values(list.element, true) + " separated by " +
             in_quotes(list.separator);
    }
  } // namespace

  std::string
  shorten(const std::string &text)
  {
    // a shortened text within another one is not shortened again
    constexpr std::size_t longest = 1000, shortened = 900;
    if (text.size() <= longest)
      return text;
    std::size_t end = shortened;
    while ((text[end] & 0xc0) == 0x80) // within a character of UTF-8
      --end;
    return text.substr(0, end) + "... (" + std::to_string(text.size()) +
           " characters)";
  }

  std::string
  in_quotes(const std::string &text)
  {
    return "'" + shorten(text) + "'";
  }

  std::vector<std::string>
  split(const std::string &text, const std::string &separator)
  {
    std::vector<std::string> elements;
    std::size_t begin = 0, end = 0;
    for (; (end = text.find(separator, begin)) != std::string::npos;
         begin = end + separator.size())
      elements.push_back(Utilities::trim(text.substr(begin, end - begin)));
    elements.push_back(Utilities::trim(text.substr(begin)));
    return elements;
  }

  std::string
  list_words(const std::vector<std::string> &words, const std::string &mark)
  {
    std::string list;
    for (const std::string &word : words)
      list += (list.empty() ? "" : ", ") + mark + word + mark;
    return list;
  }

  bool
  is_moderate(const std::string &value, const std::string &description)
  {
    if (const auto list = parse_list_pattern(description))
      {
        const auto elements = split(value, list->separator);
        return std::all_of(elements.begin(),
                           elements.end(),
                           [&list](const std::string &element) {
                             return is_moderate(element, list->element);
                           });
      }
    if (description.rfind("[Double", 0) != 0)
      return true;
    double number     = 0;
    const char *begin = value.data(), *end = begin + value.size();
    if (begin != end && *begin == '+')
      ++begin;
    std::from_chars(begin, end, number);
    // the pattern decides about what is not finite
    return !std::isfinite(number) || std::abs(number) <= 1e100;
  }

  bool
  strictly_matches(const std::string &value, const std::string &description)
  {
    if (const auto list = parse_list_pattern(description))
      {
        const auto elements = split(value, list->separator);
        return value.empty() ||
               std::all_of(elements.begin(),
                           elements.end(),
                           [&list](const std::string &element) {
                             return !element.empty() &&
                                    strictly_matches(element, list->element);
                           });
      }
    if (description.rfind("[MultipleSelection", 0) == 0)
      return value.empty() || value.back() != ',';
    // would be read into an unsigned integer, modulo 2^32
    if (description == "[Integer]")
      return value.rfind('-', 0) != 0;
    if (description.rfind("[Double", 0) == 0)
      {
        double number;
        const char *begin = value.data(), *end = begin + value.size();
        if (begin != end && *begin == '+')
          ++begin;
        return std::from_chars(begin, end, number).ec !=
               std::errc::result_out_of_range;
      }
    return true;
  }

  std::string
  allowed_values(const std::string &description, const bool plural)
  {
    const auto starts_with = [&description](const std::string &start) {
      return description.rfind(start, 0) == 0;
    };
    if (starts_with("[Double") || starts_with("[Integer"))
      return describe_number(description, plural);
    if (starts_with("[Bool"))
      return plural ? "values true or false" : "true or false";
    if (starts_with("[Anything"))
      return plural ? "texts" : "any text";
    if (starts_with("[FileName"))
      return plural ? "file names" : "a file name";
    if (starts_with("[DirectoryName"))
      return plural ? "directory names" : "a directory name";
    if (const auto list = parse_list_pattern(description))
      return describe_list(*list, plural);

    std::smatch match;
    static const std::regex selection(R"(\[(Multiple)?Selection (.*) \])");
    if (std::regex_match(description, match, selection))
      {
        const std::string words = list_words(split(match[2], "|"), "");
        return match[1].matched
                 ? "a list of words out of " + words + " separated by ','"
               : plural ? "words out of " + words
                        : "one of " + words;
      }
    static const std::regex tuple(
      R"(\[Tuple of <\d+> elements <(.*?)>(?: separated by <([^<>]*)>)?\])");
    if (std::regex_match(description, match, tuple))
      {
        std::vector<std::string> elements = split(match[1], ">, <");
        for (std::string &element : elements)
          element = allowed_values(element);
        return (plural ? "tuples of " : "a tuple of ") +
               list_words(elements, "") + " separated by " +
               in_quotes(match[2].matched ? match[2].str() : ":");
      }
    return description;
  }

  std::string
  nearest(const std::string &word, const std::vector<std::string> &candidates)
  {
    // longer ones are no misspelt names, and take their time
    constexpr std::size_t longest_word = 100;

    std::string result;
    unsigned int smallest = numbers::invalid_unsigned_int;
    if (word.size() > longest_word)
      return result;
    for (const std::string &candidate : candidates)
      {
        // an abbreviation is as near as one wrong letter
        const unsigned int distance =
          word.size() > 2 && candidate.rfind(word, 0) == 0
            ? 1
            : edit_distance(word, candidate);
        // two changes in five letters are a misspelling, more another word
        if (distance < smallest &&
            5 * distance <= 2 * std::max(word.size(), candidate.size()))
          {
            smallest = distance;
            result   = candidate;
          }
      }
    return result;
  }

  std::string
  suggestion(const std::string &word,
             const std::vector<std::string> &candidates)
  {
    const std::string meant = nearest(word, candidates);
    return meant.empty() ? "" : " (did you mean " + in_quotes(meant) + "?)";
  }
} // namespace ACF
