// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_file.h>
#include <acf/base/parameter_patterns.h>
#include <acf/base/parameter_scanner.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <sstream>

namespace ACF
{
  using namespace dealii;

  namespace
  {
    // Limits that no model needs, but files that are no models.
    constexpr std::size_t max_bytes     = 20000000;
    constexpr std::size_t max_depth     = 16;
    constexpr std::size_t max_inclusion = 16;
    constexpr std::size_t max_files     = 1000;
  } // namespace



  std::string
  join_path(const std::string &section, const std::string &name)
  {
    return section.empty() ? name : section + "/" + name;
  }



  ParameterScanner::ParameterScanner(InputProblems &problems)
    : problems(problems)
    , open_sections{{"", {0, 0, 0}}}
  {}



  std::string
  ParameterScanner::read(const std::filesystem::path &file)
  {
    std::string text = read_input_file(file, max_bytes);
    n_bytes += text.size();
    if (n_bytes > max_bytes)
      throw UnreadableFile("more than " + std::to_string(max_bytes / 1000000) +
                           " MB in all files");
    return text;
  }



  void
  ParameterScanner::scan_file(const std::filesystem::path &file)
  {
    std::string text;
    try
      {
        text = read(file);
      }
    catch (const UnreadableFile &error)
      {
        throw InputError("found " + std::string(error.what()) +
                         "; allowed: a model file")
          .located(file.string(), 0);
      }
    scan_text(text, file);
  }



  void
  ParameterScanner::scan_text(const std::string &text,
                              const std::filesystem::path &file)
  {
    files.push_back(file.string());
    const std::size_t non_text = find_non_text(text);
    if (non_text != std::string::npos)
      {
        const auto line =
          1 + std::count(text.begin(), text.begin() + non_text, '\n');
        problems.add(InputError("found bytes that are not text; allowed: a "
                                "text file in UTF-8")
                       .located(files.back(), line),
                     n_lines);
        complete = false;
        return;
      }

    std::error_code error;
    including.push_back(std::filesystem::weakly_canonical(file, error));
    const std::string_view byte_order_mark = "\xef\xbb\xbf";
    scan_lines(text.substr(text.rfind(byte_order_mark, 0) == 0
                             ? byte_order_mark.size()
                             : 0),
               files.size() - 1);
    including.pop_back();
  }



  void
  ParameterScanner::scan_lines(const std::string &text, const unsigned int file)
  {
    const std::size_t outer = n_outer_sections;
    n_outer_sections        = open_sections.size();

    std::istringstream stream(text);
    std::string line, statement;
    Place first    = {file, 1, n_lines};
    bool continued = false;
    for (unsigned int line_n = 1; !stopped && std::getline(stream, line);
         ++line_n)
      {
        const Place here = {file, line_n, n_lines++};
        line             = Utilities::trim(line);
        continued        = !line.empty() && line.back() == '\\';
        if (continued)
          line.pop_back();
        statement += line;
        if (continued && statement.find('#') != std::string::npos)
          add_problem(here,
                      "",
                      "a comment that swallows the next line",
                      "comments without '\\' at the end");
        if (continued)
          continue;
        scan_statement(statement, first);
        statement.clear();
        first = {file, line_n + 1, n_lines};
      }
    if (continued)
      scan_statement(statement, first);

    for (; !stopped && open_sections.size() > n_outer_sections;
         open_sections.pop_back())
      {
        add_problem(open_sections.back().place,
                    "",
                    "no 'end' of the subsection opened here",
                    "one 'end' for each subsection");
        complete = false;
      }
    n_outer_sections = outer;
  }



  void
  ParameterScanner::add_problem(const Place &place,
                                const std::string &entry,
                                const std::string &found,
                                const std::string &allowed)
  {
    problems.add(InputError(open_sections.back().path, entry, found, allowed)
                   .located(files[place.file], place.line),
                 place.place);
  }



  void
  ParameterScanner::scan_statement(const std::string &text, const Place &place)
  {
    std::string statement = text.substr(0, text.find('#'));
    std::replace(statement.begin(), statement.end(), '\t', ' ');
    statement = Utilities::trim(statement);
    if (statement.empty())
      return;

    const std::string keyword = statement.substr(0, statement.find(' '));
    const std::string rest = Utilities::trim(statement.substr(keyword.size()));
    const std::size_t equals   = rest.find('=');
    const std::string name     = Utilities::trim(rest.substr(0, equals));
    const std::string &section = open_sections.back().path;
    const auto is              = [&](const char *lower, const char *upper) {
      return keyword == lower || keyword == upper;
    };
    if (is("subsection", "SUBSECTION") && !rest.empty())
      open_section(rest, place);
    else if (is("set", "SET") && equals != std::string::npos && !name.empty())
      add_statement({section,
                     name,
                     Utilities::trim(rest.substr(equals + 1)),
                     place.file,
                     place.line,
                     place.place});
    else if (is("end", "END") && rest.empty() &&
             open_sections.size() > n_outer_sections)
      open_sections.pop_back();
    else if (is("end", "END") && rest.empty())
      {
        add_problem(place,
                    "",
                    "'end' without an open subsection",
                    "one 'end' for each subsection");
        complete = false;
      }
    else if (is("include", "INCLUDE") && !rest.empty())
      include(rest, place);
    else
      add_problem(place,
                  "",
                  in_quotes(statement),
                  "'set NAME = VALUE', 'subsection NAME', 'end', 'include "
                  "FILE', comments after '#'");
  }



  void
  ParameterScanner::open_section(const std::string &name, const Place &place)
  {
    add_statement({join_path(open_sections.back().path, name),
                   "",
                   "",
                   place.file,
                   place.line,
                   place.place});
    if (name.find('/') != std::string::npos)
      {
        add_problem(place,
                    "",
                    in_quotes("subsection " + name),
                    "names without '/'");
        problems.doubt(statements.back().section);
      }
    open_sections.push_back({statements.back().section, place});
    if (open_sections.size() > max_depth + 1)
      {
        open_sections.pop_back();
        add_problem(place,
                    "",
                    "more than " + std::to_string(max_depth) +
                      " subsections in each other",
                    "what '--print-parameters' prints");
        complete = false;
        stopped  = true;
      }
  }



  void
  ParameterScanner::include(const std::string &name, const Place &place)
  {
    const auto refuse = [&](const std::string &found,
                            const std::string &allowed) {
      add_problem(place, "", in_quotes("include " + name) + found, allowed);
      // what is missing without the file is no mistake
      complete = false;
    };
    const std::filesystem::path file =
      std::filesystem::path(files[place.file]).parent_path() / name;
    std::error_code error;
    if (std::find(including.begin(),
                  including.end(),
                  std::filesystem::weakly_canonical(file, error)) !=
        including.end())
      return refuse(", which includes this file",
                    "files that do not include each other");
    if (including.size() > max_inclusion)
      return refuse(" in a file that is included by " +
                      std::to_string(max_inclusion) + " others in turn",
                    "at most " + std::to_string(max_inclusion));
    if (files.size() > max_files)
      return refuse(" after " + std::to_string(max_files) + " other files",
                    "at most " + std::to_string(max_files));
    std::string text;
    try
      {
        text = read(file);
      }
    catch (const UnreadableFile &unreadable)
      {
        return refuse(": " + std::string(unreadable.what()),
                      "the name of a text file, relative to the folder of "
                      "this one");
      }
    scan_text(text, file);
  }



  void
  ParameterScanner::add_statement(const ParameterStatement &statement)
  {
    const Place place = {statement.file, statement.line, statement.place};
    const auto [entry, is_new] =
      first_statements.try_emplace(statement.section + "\n" + statement.entry,
                                   statements.size());
    if (!is_new)
      {
        const ParameterStatement &first = statements[entry->second];
        const std::string in_line =
          " a second time (first in line " + std::to_string(first.line) +
          (first.file == statement.file ? "" : " of " + files[first.file]) +
          ")";
        if (statement.entry.empty())
          add_problem(place,
                      "",
                      "the subsection '" + statement.section + "'" + in_line,
                      "each subsection once");
        else
          {
            add_problem(place,
                        statement.entry,
                        "the entry" + in_line,
                        "each entry once");
            return;
          }
      }
    if (!statement.value.empty() && statement.value.back() == '\\')
      add_problem(place,
                  statement.entry,
                  in_quotes(statement.value),
                  "'\\' only as the last character of a continued line");
    statements.push_back(statement);
  }
} // namespace ACF
