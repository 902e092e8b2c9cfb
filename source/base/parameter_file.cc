// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_file.h>
#include <acf/base/parameter_file.h>
#include <acf/base/parameter_patterns.h>

#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace ACF
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    // The declarations of a body take 300 kB.
    constexpr std::size_t max_names = 10000;

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
    declared_section(const Json &tree,
                     const std::string &path,
                     InputProblems &problems)
    {
      const Json *section = &tree;
      std::string parent;
      for (const std::string &name : Utilities::split_string_list(path, '/'))
        {
          if (!section->is_object() || !section->contains(name) ||
              is_entry((*section)[name]))
            {
              const auto names        = declared_names(*section, false);
              const std::string meant = nearest(name, names);
              if (!meant.empty())
                problems.doubt(join_path(parent, meant));
              throw InputError(parent,
                               "",
                               "the unknown subsection " + in_quotes(name),
                               names.empty() ? "no subsection"
                                             : list_words(names, "'") +
                                                 suggestion(name, names));
            }
          section = &(*section)[name];
          parent  = join_path(parent, name);
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
              const ParameterStatement &statement,
              InputProblems &problems)
    {
      const std::string &section = statement.section;
      const std::string &entry   = statement.entry;
      const std::string &value   = statement.value;
      if (!declared.is_object() || !declared.contains(entry) ||
          !is_entry(declared[entry]))
        {
          const auto names        = declared_names(declared, true);
          const std::string meant = nearest(entry, names);
          if (!meant.empty())
            problems.doubt(section, meant);
          throw InputError(section,
                           entry,
                           "an unknown entry",
                           names.empty() ? "no entry"
                                         : list_words(names, "'") +
                                             suggestion(entry, names));
        }

      const std::string pattern = declared[entry]["pattern_description"];
      const InputError mismatch(section,
                                entry,
                                in_quotes(value),
                                allowed_values(pattern));
      if (!strictly_matches(value, pattern))
        throw mismatch;
      if (!is_moderate(value, pattern))
        throw InputError(section,
                         entry,
                         in_quotes(value),
                         allowed_values(pattern) +
                           ", none larger than 1e100 in size");

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



  ParameterFile::ParameterFile(const std::filesystem::path &file,
                               const std::vector<std::string> &overrides)
    : file(file)
  {
    ParameterScanner scanner(text_problems);
    scanner.scan_file(file);
    read(scanner, overrides);
  }

  ParameterFile
  ParameterFile::from_text(const std::string &text,
                           const std::vector<std::string> &overrides,
                           const std::filesystem::path &file)
  {
    ParameterFile result;
    result.file = file;
    ParameterScanner scanner(result.text_problems);
    scanner.scan_text(text, file);
    result.read(scanner, overrides);
    return result;
  }

  void
  ParameterFile::read(ParameterScanner &scanner,
                      const std::vector<std::string> &overrides)
  {
    // what follows would be about sections that nobody has meant
    if (!scanner.is_complete())
      text_problems.throw_all();
    files = std::move(scanner.files);
    for (const Statement &statement : scanner.statements)
      add_statement(statement);
    if (statements.empty())
      {
        text_problems.throw_all();
        throw InputError(
          "found a file without any entry; allowed: a model file")
          .located(file.string(), 0);
      }
    for (const std::string &override_text : overrides)
      try
        {
          add_override(override_text);
        }
      catch (const InputError &error)
        {
          text_problems.add(error, InputProblems::last_place);
        }
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

    Statement entry;
    entry.entry = names.back();
    entry.value = Utilities::trim(text.substr(equals + 1));
    entry.place = InputProblems::last_place;
    names.pop_back();
    for (const std::string &name : names)
      entry.section = join_path(entry.section, name);

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
    add_statement(entry);
  }

  void
  ParameterFile::add_statement(const Statement &statement)
  {
    last_statements[statement.section + "\n" + statement.entry] =
      statements.size();
    statements.push_back(statement);
  }

  std::vector<std::string>
  ParameterFile::names(const std::string &section) const
  {
    InputProblems problems;
    const std::vector<std::string> result = names(section, problems);
    problems.throw_all();
    return result;
  }

  std::vector<std::string>
  ParameterFile::names(const std::string &section,
                       InputProblems &problems) const
  {
    const Statement *const set = find(section, "Names");
    std::vector<std::string> list;
    if (set != nullptr && !set->value.empty())
      list = split(set->value, ",");
    if (list.size() > max_names)
      {
        problems.doubt(section);
        problems.add(located(InputError(section,
                                        "Names",
                                        std::to_string(list.size()) + " names",
                                        "at most " + std::to_string(max_names)),
                             *set),
                     set->place);
        return {};
      }

    std::vector<std::string> result;
    std::set<std::string> known;
    for (const std::string &name : list)
      {
        const auto fail = [&](const std::string &found,
                              const std::string &allowed) {
          problems.doubt(section, "Names");
          problems.add(located(InputError(section, "Names", found, allowed),
                               *set),
                       set->place);
        };
        if (name.empty())
          fail("an empty name in " + in_quotes(set->value),
               "names separated by ','");
        else if (!is_suitable_name(name))
          fail("the name " + in_quotes(name),
               "letters, digits, spaces, '_', '-' and '+', beginning with a "
               "letter or a digit");
        else if (name == "Names")
          fail("the name 'Names'", "names other than that of the entry");
        else if (!known.insert(name).second)
          fail("the name " + in_quotes(name) + " twice", "each name once");
        else
          result.push_back(name);
      }
    check_subsections(section, result, set, problems);
    return result;
  }

  void
  ParameterFile::check_subsections(const std::string &section,
                                   const std::vector<std::string> &names,
                                   const Statement *const set,
                                   InputProblems &problems) const
  {
    const std::set<std::string> known(names.begin(), names.end());
    // subsections without a name, or the other way round, may be a consequence
    const bool names_are_wrong = problems.is_doubtful(section, "Names");
    bool has_stray             = false;
    std::set<std::string> subsections;
    for (const Statement &statement : statements)
      {
        const std::size_t slash = statement.section.rfind('/');
        if (slash == std::string::npos ||
            statement.section.compare(0, slash, section) != 0)
          continue;
        const std::string name = statement.section.substr(slash + 1);
        if (!subsections.insert(name).second || known.count(name) > 0)
          continue;
        has_stray = true;
        problems.doubt(statement.section);
        problems.doubt(section, "Names");
        if (!names_are_wrong)
          problems.add(located(InputError("section " + in_quotes(section) +
                                          " has a subsection " +
                                          in_quotes(name) +
                                          " that is not in its Names (" +
                                          shorten(list_words(names, "")) + ")"),
                               statement),
                       statement.place);
      }
    for (const std::string &name : names)
      if (subsections.count(name) == 0)
        {
          problems.doubt(join_path(section, name));
          if (!names_are_wrong && !has_stray)
            problems.add(located(InputError("section " + in_quotes(section) +
                                            " has no subsection for the name " +
                                            in_quotes(name) + " in its Names"),
                                 *set),
                         set->place);
        }
  }

  void
  ParameterFile::parse(ParameterHandler &prm) const
  {
    InputProblems problems = text_problems;
    parse(prm, problems);
    problems.throw_all();
  }

  void
  ParameterFile::parse(ParameterHandler &prm, InputProblems &problems) const
  {
    const Json tree = declarations(prm);
    std::map<std::string, const Json *> sections;
    for (const Statement &statement : statements)
      try
        {
          // wrong names have been reported
          if (problems.is_doubtful(statement.section) ||
              (statement.entry == "Names" &&
               problems.is_doubtful(statement.section, "Names")))
            continue;
          const Json *&section = sections[statement.section];
          if (section == nullptr)
            section = &declared_section(tree, statement.section, problems);
          if (!statement.entry.empty())
            set_entry(prm, *section, statement, problems);
        }
      catch (const InputError &error)
        {
          problems.add(located(error, statement), statement.place);
          if (sections[statement.section] == nullptr)
            problems.doubt(statement.section);
          else
            problems.doubt(statement.section, statement.entry);
        }
  }

  const InputProblems &
  ParameterFile::problems() const
  {
    return text_problems;
  }

  void
  ParameterFile::check(const std::function<void()> &function,
                       InputProblems &problems) const
  {
    InputProblems found;
    found.attempt(function);
    for (const InputError &error : found.errors())
      if (!problems.is_doubtful(error.section, error.entry))
        {
          const Statement *const statement = find_place(error);
          problems.add(locate(error),
                       statement == nullptr ? InputProblems::last_place
                                            : statement->place);
        }
  }

  InputError
  ParameterFile::locate(const InputError &error) const
  {
    const std::string message = error.what();
    const auto is_located     = [&message](const std::string &name) {
      return message.rfind(name + ":", 0) == 0;
    };
    if ((error.section.empty() && error.entry.empty()) ||
        is_located("command line") ||
        std::any_of(files.begin(), files.end(), is_located))
      return error;
    if (const Statement *const statement = find_place(error))
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
    const auto statement = last_statements.find(section + "\n" + entry);
    return statement == last_statements.end() ? nullptr
                                              : &statements[statement->second];
  }

  const ParameterFile::Statement *
  ParameterFile::find_place(const InputError &error) const
  {
    const Statement *const statement = find(error.section, error.entry);
    return statement != nullptr ? statement : find(error.section, "");
  }

  InputError
  ParameterFile::located(const InputError &error,
                         const Statement &statement) const
  {
    if (statement.line > 0)
      return error.located(files[statement.file], statement.line);
    return error.located("command line: --set " +
                           in_quotes(
                             join_path(statement.section, statement.entry) +
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
