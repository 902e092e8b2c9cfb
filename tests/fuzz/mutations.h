// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_fuzz_mutations_h
#define acf_tests_fuzz_mutations_h

#include <cstddef>
#include <cstdint>
#include <exception>
#include <random>
#include <sstream>
#include <string>
#include <vector>

// of libFuzzer
extern "C" std::size_t
LLVMFuzzerMutate(std::uint8_t *data, std::size_t size, std::size_t max_size);

namespace ACF::Testing
{
  /** Changes a text in one place in a way that a parser may well accept: a line
   * is repeated, dropped or moved, or one of its values is replaced by another
   * of the text, a multiple of itself, or what may be trouble. */
  class TextMutation
  {
  public:
    explicit TextMutation(const unsigned int seed)
      : generator(seed)
    {}

    std::string
    operator()(const std::string &text)
    {
      std::vector<std::string> lines = split(text, '\n');
      const std::size_t kind         = random(12);
      std::string &line              = any_line(lines);
      if (kind == 0)
        line += "\n" + any_line(lines);
      else if (kind == 1)
        line.clear();
      else if (kind == 2)
        std::swap(line, any_line(lines));
      else if (kind < 5)
        line = before_value(line) + after_equals(any_line(lines));
      else
        {
          std::vector<std::string> words = split(after_equals(line), ' ');
          std::string &word              = any_word(words);
          const bool in_list             = !word.empty() && word.back() == ',';
          if (kind < 7)
            {
              auto others = split(after_equals(any_line(lines)), ' ');
              word        = any_word(others);
            }
          else if (kind < 9)
            word = trouble();
          else
            scale(word);
          if (in_list && (word.empty() || word.back() != ','))
            word += ',';
          line = before_value(line) + join(words, ' ');
        }
      return join(lines, '\n');
    }

  private:
    std::size_t
    random(const std::size_t n)
    {
      return (generator() >> 4) % n;
    }

    // One that is no comment and not empty, if chance finds one soon.
    std::string &
    any_line(std::vector<std::string> &lines)
    {
      for (unsigned int i = 0; i < 10; ++i)
        {
          std::string &line = lines[random(lines.size())];
          if (!line.empty() && line[0] != '#')
            return line;
        }
      return lines[0];
    }

    static std::string
    before_value(const std::string &line)
    {
      const std::size_t equals = line.find('=');
      return equals == std::string::npos ? "" : line.substr(0, equals + 1);
    }

    static std::string
    after_equals(const std::string &line)
    {
      return line.substr(before_value(line).size());
    }

    // One that is not empty, if chance finds one soon.
    std::string &
    any_word(std::vector<std::string> &words)
    {
      for (unsigned int i = 0; i < 10; ++i)
        {
          std::string &word = words[random(words.size())];
          if (!word.empty())
            return word;
        }
      return words[0];
    }

    std::string
    trouble()
    {
      static const std::vector<std::string> troubles = {"0",
                                                        "-1",
                                                        "1",
                                                        "2",
                                                        "3",
                                                        "1e308",
                                                        "-1e9",
                                                        "1e-300",
                                                        "1e9",
                                                        "1e16",
                                                        "-0",
                                                        "nan",
                                                        "inf",
                                                        "1e-320",
                                                        "0.5",
                                                        "4294967296",
                                                        "",
                                                        "2147483647"};
      return troubles[random(troubles.size())];
    }

    // Keeps what follows the number.
    void
    scale(std::string &word)
    {
      static const std::vector<double> factors = {
        -1, 0.5, 2, 1e3, 1e-3, 1e9, 1e-9, 1e100, 1e-100};
      try
        {
          std::size_t end    = 0;
          const double value = std::stod(word, &end);
          std::ostringstream text;
          text << value * factors[random(factors.size())] << word.substr(end);
          word = text.str();
        }
      catch (const std::exception &)
        {
          word = trouble();
        }
    }

    static std::vector<std::string>
    split(const std::string &text, const char separator)
    {
      std::vector<std::string> parts(1);
      for (const char c : text)
        if (c == separator)
          parts.emplace_back();
        else
          parts.back() += c;
      return parts;
    }

    static std::string
    join(const std::vector<std::string> &parts, const char separator)
    {
      std::string text;
      for (const std::string &part : parts)
        text += part + separator;
      text.pop_back();
      return text;
    }

    std::minstd_rand generator;
  };
} // namespace ACF::Testing

#endif
