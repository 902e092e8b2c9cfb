// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parameter_file.h>
#include <acf/base/parameter_patterns.h>

#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

namespace ACF
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    std::string
    join(const std::string &section, const std::string &name)
    {
      return section.empty() ? name : section + "/" + name;
    }

    std::string
    read_file(const std::filesystem::path &file)
    {
      const auto fail = [&file](const std::string &found) {
        throw InputError("found " + found + "; allowed: a model file")
          .located(file.string(), 0);
      };
      std::error_code error;
      const std::filesystem::file_status status =
        std::filesystem::status(file, error);
      if (!std::filesystem::exists(status))
        fail("no such file");
      if (std::filesystem::is_directory(status))
        fail("a directory");
      if (!std::filesystem::is_regular_file(status) &&
          !std::filesystem::is_fifo(status))
        fail("a device");

      std::ifstream stream(file, std::ios::binary);
      std::ostringstream text;
      // an empty file sets the fail bit of text, not that of stream
      if (stream)
        text << stream.rdbuf();
      if (!stream)
        fail("a file that cannot be read");
      return text.str();
    }

    /** Position of the first byte that is not text in UTF-8, or npos. */
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

    bool
    is_suitable_name(const std::string &name)
    {
      const std::string letters_and_digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
      return letters_and_digits.find(name[0]) != std::string::npos &&
             name.find_first_not_of(letters_and_digits + " _-+") ==
               std::string::npos;
    }

    /** All declarations of a handler; only this gives access to their tree. */
    Json
    declarations(const ParameterHandler &prm)
    {
      std::stringstream stream;
      prm.print_parameters(stream,
                           static_cast<ParameterHandler::OutputStyle>(
                             ParameterHandler::JSON |
                             ParameterHandler::KeepDeclarationOrder));
      return Json::parse(stream);
    }

    bool
    is_entry(const Json &node)
    {
      return node.contains("pattern_description") &&
             node["pattern_description"].is_string();
    }

    /** Names of the entries of a section, or of its subsections. */
    std::vector<std::string>
    declared_names(const Json &section, const bool entries)
    {
      std::vector<std::string> names;
      // a section without any content is a string
      if (section.is_object())
        for (const auto &[name, node] : section.items())
          if (is_entry(node) == entries)
            names.push_back(name);
      return names;
    }

    const Json &
    declared_section(const Json &tree, const std::string &path)
    {
      const Json *section = &tree;
      std::string parent;
      for (const std::string &name : Utilities::split_string_list(path, '/'))
        {
          const auto names = declared_names(*section, false);
          if (std::find(names.begin(), names.end(), name) == names.end())
            throw InputError(parent,
                             "",
                             "the unknown subsection " + in_quotes(name),
                             names.empty() ? "no subsection"
                                           : list_words(names, "'") +
                                               suggestion(name, names));
          section = &(*section)[name];
          parent  = join(parent, name);
        }
      return *section;
    }

    /** Enters a subsection and leaves it at the end of its life. */
    class InSection
    {
    public:
      InSection(ParameterHandler &prm, const std::string &path)
        : prm(prm)
        , names(Utilities::split_string_list(path, '/'))
      {
        for (const std::string &name : names)
          prm.enter_subsection(name);
      }

      ~InSection()
      {
        for (std::size_t i = 0; i < names.size(); ++i)
          prm.leave_subsection();
      }

      InSection(const InSection &) = delete;
      InSection &
      operator=(const InSection &) = delete;

    private:
      ParameterHandler &prm;
      const std::vector<std::string> names;
    };

    void
    set_entry(ParameterHandler &prm,
              const Json &declared,
              const std::string &section,
              const std::string &entry,
              const std::string &value)
    {
      const auto names = declared_names(declared, true);
      if (std::find(names.begin(), names.end(), entry) == names.end())
        throw InputError(section,
                         entry,
                         "an unknown entry",
                         names.empty()
                           ? "no entry"
                           : list_words(names, "'") + suggestion(entry, names));

      const std::string pattern = declared[entry]["pattern_description"];
      const InputError mismatch(section,
                                entry,
                                in_quotes(value),
                                allowed_values(pattern));
      if (!strictly_matches(value, pattern))
        throw mismatch;

      const InSection in_section(prm, section);
      try
        {
          prm.set(entry, value);
        }
      catch (const ExceptionBase &)
        {
          throw mismatch;
        }
    }

    std::string
    print(const ParameterHandler &prm, const int style)
    {
      std::ostringstream stream;
      prm.print_parameters(stream,
                           static_cast<ParameterHandler::OutputStyle>(
                             style | ParameterHandler::KeepDeclarationOrder));
      return stream.str();
    }
  } // namespace



  /** Mirrors the line syntax of ParameterHandler and collects all problems. */
  class ParameterFile::Scanner
  {
  public:
    void
    scan(const std::string &text);

    std::vector<Statement> statements;

    /** By line, so that a later report of all is in the order of the file. */
    std::multimap<unsigned int, InputError> problems;

  private:
    void
    scan_statement(const std::string &text, const unsigned int line);

    void
    add_statement(const Statement &statement);

    void
    add_problem(const unsigned int line,
                const std::string &entry,
                const std::string &found,
                const std::string &allowed);

    /** Paths and lines. */
    std::vector<Statement> open_sections = {{"", "", "", 0}};
  };

  void
  ParameterFile::Scanner::add_problem(const unsigned int line,
                                      const std::string &entry,
                                      const std::string &found,
                                      const std::string &allowed)
  {
    const std::string &section = open_sections.back().section;
    problems.emplace(line, InputError(section, entry, found, allowed));
  }

  void
  ParameterFile::Scanner::scan(const std::string &text)
  {
    std::istringstream stream(text);
    std::string line, statement;
    unsigned int first_line = 1;
    bool continued          = false;
    for (unsigned int line_n = 1; std::getline(stream, line); ++line_n)
      {
        line      = Utilities::trim(line);
        continued = !line.empty() && line.back() == '\\';
        if (continued)
          line.pop_back();
        statement += line;
        if (continued && statement.find('#') != std::string::npos)
          add_problem(line_n,
                      "",
                      "a comment that swallows the next line",
                      "comments without '\\' at the end");
        if (continued)
          continue;
        scan_statement(statement, first_line);
        statement.clear();
        first_line = line_n + 1;
      }
    if (continued)
      scan_statement(statement, first_line);

    for (; open_sections.size() > 1; open_sections.pop_back())
      add_problem(open_sections.back().line,
                  "",
                  "no 'end' of the subsection opened here",
                  "one 'end' for each subsection");
  }

  void
  ParameterFile::Scanner::scan_statement(const std::string &text,
                                         const unsigned int line)
  {
    std::string statement = text.substr(0, text.find('#'));
    std::replace(statement.begin(), statement.end(), '\t', ' ');
    statement = Utilities::trim(statement);
    if (statement.empty())
      return;

    const std::string keyword = statement.substr(0, statement.find(' '));
    const std::string rest = Utilities::trim(statement.substr(keyword.size()));
    const std::size_t equals  = rest.find('=');
    const std::string name    = Utilities::trim(rest.substr(0, equals));
    const std::string section = open_sections.back().section;
    const auto is             = [&](const char *lower, const char *upper) {
      return keyword == lower || keyword == upper;
    };
    if (is("subsection", "SUBSECTION") && !rest.empty())
      {
        add_statement({join(section, rest), "", "", line});
        if (rest.find('/') != std::string::npos)
          add_problem(line, "", in_quotes(statement), "names without '/'");
        open_sections.push_back(statements.back());
      }
    else if (is("set", "SET") && equals != std::string::npos && !name.empty())
      add_statement(
        {section, name, Utilities::trim(rest.substr(equals + 1)), line});
    else if (is("end", "END") && rest.empty() && open_sections.size() > 1)
      open_sections.pop_back();
    else if (is("end", "END") && rest.empty())
      add_problem(line,
                  "",
                  "'end' without an open subsection",
                  "one 'end' for each subsection");
    else if (is("include", "INCLUDE"))
      add_problem(line,
                  "",
                  in_quotes(statement),
                  "one file for a model, without 'include'");
    else
      add_problem(line,
                  "",
                  in_quotes(statement),
                  "'set NAME = VALUE', 'subsection NAME', 'end', comments "
                  "after '#'");
  }

  void
  ParameterFile::Scanner::add_statement(const Statement &statement)
  {
    const auto first =
      std::find_if(statements.begin(),
                   statements.end(),
                   [&statement](const Statement &other) {
                     return other.section == statement.section &&
                            other.entry == statement.entry;
                   });
    if (first != statements.end())
      {
        const std::string in_line = std::to_string(first->line);
        if (statement.entry.empty())
          add_problem(statement.line,
                      "",
                      "the subsection '" + statement.section +
                        "' a second time (first in line " + in_line + ")",
                      "each subsection once");
        else
          add_problem(statement.line,
                      statement.entry,
                      "the entry a second time (first in line " + in_line + ")",
                      "each entry once");
      }
    if (!statement.value.empty() && statement.value.back() == '\\')
      add_problem(statement.line,
                  statement.entry,
                  in_quotes(statement.value),
                  "'\\' only as the last character of a continued line");
    statements.push_back(statement);
  }



  ParameterFile::ParameterFile(const std::filesystem::path &file,
                               const std::vector<std::string> &overrides)
    : file(file)
  {
    read(read_file(file), overrides);
  }

  ParameterFile
  ParameterFile::from_text(const std::string &text,
                           const std::vector<std::string> &overrides,
                           const std::filesystem::path &file)
  {
    ParameterFile result;
    result.file = file;
    result.read(text, overrides);
    return result;
  }

  void
  ParameterFile::read(const std::string &text,
                      const std::vector<std::string> &overrides)
  {
    const std::size_t non_text = find_non_text(text);
    if (non_text != std::string::npos)
      throw InputError(
        "found bytes that are not text; allowed: a text file "
        "in UTF-8")
        .located(file.string(),
                 1 + std::count(text.begin(), text.begin() + non_text, '\n'));

    Scanner scanner;
    const std::string_view byte_order_mark = "\xef\xbb\xbf";
    scanner.scan(text.substr(
      text.rfind(byte_order_mark, 0) == 0 ? byte_order_mark.size() : 0));
    if (!scanner.problems.empty())
      {
        const auto &[line, problem] = *scanner.problems.begin();
        throw problem.located(file.string(), line);
      }
    statements = scanner.statements;
    if (statements.empty())
      throw InputError("found a file without any entry; allowed: a model file")
        .located(file.string(), 0);

    for (const std::string &override_text : overrides)
      add_override(override_text);
  }

  void
  ParameterFile::add_override(const std::string &text)
  {
    const auto fail = [](const std::string &found) {
      throw InputError("command line: found --set " + found +
                       "; allowed: --set 'Section/Entry=value'");
    };
    const std::size_t equals       = text.find('=');
    std::vector<std::string> names = split(text.substr(0, equals), "/");
    if (equals == std::string::npos ||
        std::find(names.begin(), names.end(), "") != names.end())
      fail(in_quotes(text));

    Statement entry{"",
                    names.back(),
                    Utilities::trim(text.substr(equals + 1)),
                    0};
    names.pop_back();
    for (const std::string &name : names)
      entry.section = join(entry.section, name);

    // what no line of a file could set could not be echoed to one either
    const std::string &value = entry.value;
    if (find_non_text(text) != std::string::npos ||
        text.find_first_of("\t\r\n#") != std::string::npos ||
        (!value.empty() && value.back() == '\\'))
      throw located(InputError(entry.section,
                               entry.entry,
                               in_quotes(value),
                               "one line of UTF-8 text without '#' and "
                               "without '\\' at the end"),
                    entry);
    const Statement *const first = find(entry.section, entry.entry);
    if (first != nullptr && first->line == 0)
      throw located(InputError(entry.section,
                               entry.entry,
                               "a second override (the first is " +
                                 in_quotes(first->value) + ")",
                               "each entry once"),
                    entry);
    statements.push_back(entry);
  }

  std::vector<std::string>
  ParameterFile::names(const std::string &section) const
  {
    const Statement *const set = find(section, "Names");
    std::vector<std::string> names;
    if (set != nullptr && !set->value.empty())
      names = split(set->value, ",");

    for (auto name = names.begin(); name != names.end(); ++name)
      {
        const auto fail = [&](const std::string &found,
                              const std::string &allowed) {
          throw located(InputError(section, "Names", found, allowed), *set);
        };
        if (name->empty())
          fail("an empty name in " + in_quotes(set->value),
               "names separated by ','");
        if (!is_suitable_name(*name))
          fail("the name " + in_quotes(*name),
               "letters, digits, spaces, '_', '-' and '+', beginning with a "
               "letter or a digit");
        if (*name == "Names")
          fail("the name 'Names'", "names other than that of the entry");
        if (std::find(names.begin(), name, *name) != name)
          fail("the name " + in_quotes(*name) + " twice", "each name once");
      }

    std::vector<std::string> subsections;
    for (const Statement &statement : statements)
      {
        const std::size_t slash = statement.section.rfind('/');
        if (slash == std::string::npos ||
            statement.section.substr(0, slash) != section)
          continue;
        subsections.push_back(statement.section.substr(slash + 1));
        if (std::find(names.begin(), names.end(), subsections.back()) ==
            names.end())
          throw located(InputError("section " + in_quotes(section) +
                                   " has a subsection " +
                                   in_quotes(subsections.back()) +
                                   " that is not in its Names (" +
                                   list_words(names, "") + ")"),
                        statement);
      }
    for (const std::string &name : names)
      if (std::find(subsections.begin(), subsections.end(), name) ==
          subsections.end())
        throw located(InputError("section " + in_quotes(section) +
                                 " has no subsection for the name " +
                                 in_quotes(name) + " in its Names"),
                      *set);
    return names;
  }

  void
  ParameterFile::parse(ParameterHandler &prm) const
  {
    const Json tree = declarations(prm);
    for (const Statement &statement : statements)
      try
        {
          const Json &section = declared_section(tree, statement.section);
          if (!statement.entry.empty())
            set_entry(prm,
                      section,
                      statement.section,
                      statement.entry,
                      statement.value);
        }
      catch (const InputError &error)
        {
          throw located(error, statement);
        }
  }

  InputError
  ParameterFile::locate(const InputError &error) const
  {
    const std::string message = error.what();
    if ((error.section.empty() && error.entry.empty()) ||
        message.rfind("command line: ", 0) == 0 ||
        message.rfind(file.string() + ":", 0) == 0)
      return error;
    if (const Statement *const statement = find(error.section, error.entry))
      return located(error, *statement);
    if (const Statement *const statement = find(error.section, ""))
      return located(error, *statement);
    return error.located(file.string(), 0);
  }

  const std::filesystem::path &
  ParameterFile::path() const
  {
    return file;
  }

  const ParameterFile::Statement *
  ParameterFile::find(const std::string &section,
                      const std::string &entry) const
  {
    const auto statement = std::find_if(statements.rbegin(),
                                        statements.rend(),
                                        [&](const Statement &candidate) {
                                          return candidate.section == section &&
                                                 candidate.entry == entry;
                                        });
    return statement == statements.rend() ? nullptr : &*statement;
  }

  InputError
  ParameterFile::located(const InputError &error,
                         const Statement &statement) const
  {
    if (statement.line > 0)
      return error.located(file.string(), statement.line);
    return error.located("command line: --set " +
                           in_quotes(join(statement.section, statement.entry) +
                                     "=" + statement.value),
                         0);
  }



  std::string
  used_parameters(const ParameterHandler &prm)
  {
    return print(prm, ParameterHandler::ShortPRM);
  }

  std::string
  documented_parameters(const ParameterHandler &prm)
  {
    return print(prm, ParameterHandler::PRM);
  }

} // namespace ACF
