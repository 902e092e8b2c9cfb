// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_parameter_file_h
#define acf_base_parameter_file_h

#include <acf/base/parameter_scanner.h>

#include <deal.II/base/parameter_handler.h>

#include <filesystem>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace ACF
{
  using namespace dealii;

  /**
   * The text of a model file and the overrides of the command line, read in
   * two passes, because the user chooses the names of some subsections:
   * @code
   *   const ParameterFile file("model.prm", overrides);
   *   for (const std::string &name : file.names("Bodies"))
   *     // declare the subsection of the body in prm
   *   file.parse(prm);
   * @endcode
   * So the first wrong section ends the reading. The functions with
   * InputProblems go on and collect all errors; they leave out what is likely
   * to follow from others:
   * @code
   *   InputProblems problems = file.problems();
   *   for (const std::string &name : file.names("Bodies", problems))
   *     // declare the subsection of the body in prm
   *   file.parse(prm, problems);
   *   file.check([&]() { body.check(); }, problems);
   *   problems.throw_all();
   * @endcode
   *
   * The syntax is the one of dealii::ParameterHandler: <tt>set A = b</tt>,
   * <tt>subsection A</tt>, <tt>end</tt>, comments from <tt>#</tt> on, lines
   * continued by a backslash at their end, and <tt>include FILE</tt>, relative
   * to the folder of the file with this line. An included file closes the
   * subsections that it opens, and no others. The patterns, conversions and
   * actions of the handler decide about a value. Stricter than the handler,
   * this class rejects entries given twice, subsections opened twice, values
   * with braces that the pattern does not match (the handler takes them
   * unchecked), numbers below the smallest double, negative numbers for
   * unsigned variables, empty elements at the end of lists, comments that
   * swallow the next line, and files that are not UTF-8 text.
   *
   * A section is named by its path, "Bodies/pendulum"; "" is the top level.
   * Names of sections and entries must not contain '/', '.' or '='.
   */
  class ParameterFile
  {
  public:
    /**
     * Read a file and find the problems that need no declarations.
     * @param file the model file; messages name it as it is written here
     * @param overrides of the form "Section/Entry=value"; each takes the place
     *   of the file's entry
     * @throws InputError if the file is no readable text or without entries, or
     *   if its sections are not certain; other problems() wait for parse()
     */
    explicit ParameterFile(const std::filesystem::path &file,
                           const std::vector<std::string> &overrides = {});

    /** The same for a text; @p file is the name for messages. */
    static ParameterFile
    from_text(const std::string &text,
              const std::vector<std::string> &overrides = {},
              const std::filesystem::path &file         = "model.prm");

    /**
     * The first pass: the entry <tt>Names</tt> of a section, whose elements
     * are the names of its subsections. Empty if the entry is not set.
     * @throws InputError unless the names are unique, consist of letters,
     *   digits, spaces, '_', '-' and '+' (so that they are fit for file names,
     *   headers of tables and references), and are those of the subsections;
     *   only a section of which all entries come from overrides may be absent
     */
    std::vector<std::string>
    names(const std::string &section) const;

    /** The names that can be used. */
    std::vector<std::string>
    names(const std::string &section, InputProblems &problems) const;

    /**
     * The second pass: set all entries of the file, then all overrides.
     * @param prm with all declarations, at its top level
     * @throws InputError for the problems() of the text, for unknown
     *   subsections and entries and for values that do not match their pattern;
     *   all in the order of the file. The values of @p prm are then
     *   meaningless.
     */
    void
    parse(ParameterHandler &prm) const;

    /** Sets what can be set. */
    void
    parse(ParameterHandler &prm, InputProblems &problems) const;

    /** What is wrong with the text and the overrides by themselves. */
    const InputProblems &
    problems() const;

    /**
     * Calls a function that checks values, and adds what it throws of
     * InputError, located; but not what is about doubtful entries.
     */
    void
    check(const std::function<void()> &function, InputProblems &problems) const;

    /**
     * The same error, preceded by where its entry has got the value: file and
     * line (the line of the subsection if the entry is not set), or the
     * override of the command line. Errors that are located already remain
     * as they are.
     */
    InputError
    locate(const InputError &error) const;

    /** The file, as given to the constructor. */
    const std::filesystem::path &
    path() const;

  private:
    using Statement = ParameterStatement;

    ParameterFile() = default;

    /** Takes what a scanner has found. */
    void
    read(ParameterScanner &scanner, const std::vector<std::string> &overrides);

    void
    add_override(const std::string &text);

    void
    add_statement(const Statement &statement);

    /** Names and subsections of a section must be the same. */
    void
    check_subsections(const std::string &section,
                      const std::vector<std::string> &names,
                      const Statement *const set,
                      InputProblems &problems) const;

    /** The statement that has the last word; null if there is none. */
    const Statement *
    find(const std::string &section, const std::string &entry) const;

    /** That of an entry, or if it is not set of its subsection; null if there
     * is neither. */
    const Statement *
    find_place(const InputError &error) const;

    InputError
    located(const InputError &error, const Statement &statement) const;

    std::filesystem::path file;

    /** As messages name them: the file and those that it includes. */
    std::vector<std::string> files;

    /** In the order of the file, then the overrides. */
    std::vector<Statement> statements;

    /** The last statement of each section and entry. */
    std::unordered_map<std::string, std::size_t> last_statements;

    InputProblems text_problems;
  };

  /**
   * All values of @p prm as a model file without comments, in the order of
   * declaration. Reading it gives the same values.
   */
  std::string
  used_parameters(const ParameterHandler &prm);

  /**
   * The same with the documentation of each entry as a comment before it;
   * with defaults in @p prm, the documented default file.
   */
  std::string
  documented_parameters(const ParameterHandler &prm);
} // namespace ACF

#endif
