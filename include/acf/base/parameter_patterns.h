// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_parameter_patterns_h
#define acf_base_parameter_patterns_h

#include <string>
#include <vector>

namespace ACF
{
  /**
   * Which values a pattern allows, in words: "a number in [0, 0.5]", "one of
   * a, b", "a list of 3 numbers separated by ','".
   * @param description of the pattern as dealii::Patterns write it; the words
   *   are those of double, integer, bool, selection, list, tuple, file name,
   *   directory name and anything, others are returned unchanged
   * @param plural for more than one value: "numbers in [0, 0.5]"
   */
  std::string
  allowed_values(const std::string &description, const bool plural = false);

  /**
   * The candidate with the smallest edit distance, upper and lower case being
   * equal; empty if none is similar.
   */
  std::string
  nearest(const std::string &word, const std::vector<std::string> &candidates);

  /** " (did you mean 'x'?)" for the nearest() one; empty if there is none. */
  std::string
  suggestion(const std::string &word,
             const std::vector<std::string> &candidates);

  /**
   * Whether a value has nothing that deal.II's pattern of this description
   * takes although it cannot be meant: numbers below the smallest double,
   * negative numbers for unsigned variables, empty elements of lists.
   */
  bool
  strictly_matches(const std::string &value, const std::string &description);

  /**
   * Whether no number of a value is larger than 1e100 in size, so that products
   * of some of them are numbers, too.
   */
  bool
  is_moderate(const std::string &value, const std::string &description);

  /** The first part of a text that is too long for a message. */
  std::string
  shorten(const std::string &text);

  /** The text, shortened, between single quotation marks. */
  std::string
  in_quotes(const std::string &text);

  /** The trimmed elements; unlike deal.II's, keeps an empty one at the end. */
  std::vector<std::string>
  split(const std::string &text, const std::string &separator);

  /** "a, b", or "'a', 'b'" if @p mark is an apostrophe. */
  std::string
  list_words(const std::vector<std::string> &words, const std::string &mark);
} // namespace ACF

#endif
