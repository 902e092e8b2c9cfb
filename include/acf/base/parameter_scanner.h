// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_parameter_scanner_h
#define acf_base_parameter_scanner_h

#include <acf/base/input_problems.h>

#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

namespace ACF
{
  /** An opened subsection or a set entry of a model file. */
  struct ParameterStatement
  {
    /** Path of the section. */
    std::string section;

    /** Name of the entry; empty for the opening of a subsection. */
    std::string entry;

    std::string value;

    /** Index of its file, and where it begins there; a line of zero is an
     * override of the command line. */
    unsigned int file = 0;
    unsigned int line = 0;

    /** Lines before it in all files, which orders messages. */
    std::size_t place = 0;
  };

  /** A path "Bodies/pendulum" from that of the section and a name in it. */
  std::string
  join_path(const std::string &section, const std::string &name);



  /**
   * Turns the text of model files into statements. The syntax is described at
   * ParameterFile; the text of an included file takes the place of the line
   * that includes it.
   */
  class ParameterScanner
  {
  public:
    /** @param problems where everything goes that is wrong with the text */
    explicit ParameterScanner(InputProblems &problems);

    /** @throws InputError if the file cannot be read */
    void
    scan_file(const std::filesystem::path &file);

    /** @param file the name for messages */
    void
    scan_text(const std::string &text, const std::filesystem::path &file);

    /** Whether the sections of the statements are certain: false if an 'end' is
     * missing, for example. */
    bool
    is_complete() const
    {
      return complete;
    }

    /** As messages name them. */
    std::vector<std::string> files;

    std::vector<ParameterStatement> statements;

    /** Lines in all files so far. */
    std::size_t n_lines = 0;

  private:
    /** Where a problem or a statement is. */
    struct Place
    {
      unsigned int file;
      unsigned int line;
      std::size_t place;
    };

    /** A subsection that has no 'end' so far. */
    struct OpenSection
    {
      std::string path;
      Place place;
    };

    void
    scan_lines(const std::string &text, const unsigned int file);

    void
    scan_statement(const std::string &text, const Place &place);

    void
    open_section(const std::string &name, const Place &place);

    void
    include(const std::string &name, const Place &place);

    void
    add_statement(const ParameterStatement &statement);

    void
    add_problem(const Place &place,
                const std::string &entry,
                const std::string &found,
                const std::string &allowed);

    /** @throws UnreadableFile, also if there are too many bytes in all files */
    std::string
    read(const std::filesystem::path &file);

    InputProblems &problems;

    /** The top level, and the sections around the present line. */
    std::vector<OpenSection> open_sections;

    /** Sections that were open where the present file begins. */
    std::size_t n_outer_sections = 1;

    /** The present file and those that include it, resolved. */
    std::vector<std::filesystem::path> including;

    /** First statement of each path. */
    std::unordered_map<std::string, std::size_t> first_statements;

    std::size_t n_bytes = 0;
    bool complete       = true;

    /** Nothing of the rest can be understood. */
    bool stopped = false;
  };
} // namespace ACF

#endif
