// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/parameter_patterns.h>
#include <acf/command_line.h>

#include <algorithm>
#include <charconv>

namespace ACF
{
  namespace
  {
    struct Option
    {
      std::string name;
      /** What stands for the value in the help; empty: takes none. */
      std::string value;
      std::string documentation;
    };

    const std::vector<Option> &
    options()
    {
      static const std::vector<Option> list = {
        {"--help", "", "print this text"},
        {"--version", "", "print the version"},
        {"--print-parameters", "", "print all entries with their defaults"},
        {"--validate", "", "read and check the model, run nothing"},
        {"--estimate", "", "show what a run would need, run nothing"},
        {"--inspect", "PART", "show what a mesh or a geometry contains"},
        {"--scale", "FACTOR", "of the coordinates of the part"},
        {"--density", "DENSITY", "of the part, kg/m^3, for its mass"},
        {"--mesh-size", "SIZE", "largest element size of the part, m"},
        {"--set", "'Section/Entry=value'", "override an entry; repeatable"},
        {"--output-directory", "DIR", "override the output directory"},
        {"--restart", "CHECKPOINT", "go on from a checkpoint of the model"},
        {"--overwrite", "", "delete earlier results instead of moving them"},
        {"--threads", "N", "use at most N threads; default: one per core"},
        {"--quiet", "", "print nothing but errors and warnings"}};
      return list;
    }

    [[noreturn]] void
    fail(const std::string &found, const std::string &allowed)
    {
      throw InputError("command line: found " + found +
                       "; allowed: " + allowed);
    }

    const Option &
    find_option(const std::string &name)
    {
      std::vector<std::string> names;
      std::string list;
      for (const Option &option : options())
        {
          if (option.name == name)
            return option;
          names.push_back(option.name);
          list += (list.empty() ? "" : ", ") + option.name;
        }
      fail("the unknown option '" + name + "'", list + suggestion(name, names));
    }

    unsigned int
    parse_n_threads(const std::string &text)
    {
      unsigned int n_threads   = 0;
      const char *const end    = text.data() + text.size();
      const auto [rest, error] = std::from_chars(text.data(), end, n_threads);
      if (error != std::errc() || rest != end || n_threads == 0)
        fail("--threads '" + text + "'", "an integer >= 1");
      return n_threads;
    }

    double
    parse_positive(const Option &option, const std::string &text)
    {
      double value             = 0;
      const char *const end    = text.data() + text.size();
      const auto [rest, error] = std::from_chars(text.data(), end, value);
      if (error != std::errc() || rest != end || !(value > 0) ||
          !(value <= 1e100))
        fail(option.name + " '" + text + "'",
             "a positive number, at most 1e100");
      return value;
    }

    void
    apply(const Option &option, const std::string &value, CommandLine &result)
    {
      using Action = CommandLine::Action;
      if (option.name == "--help")
        result.action = Action::help;
      else if (option.name == "--version")
        result.action = Action::version;
      else if (option.name == "--print-parameters")
        result.action = Action::print_parameters;
      else if (option.name == "--validate")
        result.action = Action::validate;
      else if (option.name == "--estimate")
        result.action = Action::estimate;
      else if (option.name == "--inspect")
        {
          result.action = Action::inspect;
          result.part   = value;
        }
      else if (option.name == "--scale")
        result.scale = parse_positive(option, value);
      else if (option.name == "--density")
        result.density = parse_positive(option, value);
      else if (option.name == "--mesh-size")
        result.mesh_size = parse_positive(option, value);
      else if (option.name == "--set")
        result.overrides.push_back(value);
      else if (option.name == "--output-directory")
        result.output_directory = value;
      else if (option.name == "--restart")
        result.restart = value;
      else if (option.name == "--overwrite")
        result.overwrite = true;
      else if (option.name == "--threads")
        result.n_threads = parse_n_threads(value);
      else
        result.quiet = true;
    }

    /** Takes the option, and its value, from the front of the arguments. */
    void
    parse_option(std::vector<std::string>::const_iterator &argument,
                 const std::vector<std::string>::const_iterator end,
                 std::vector<std::string> &seen,
                 CommandLine &result)
    {
      const std::size_t equals = argument->find('=');
      const Option &option     = find_option(argument->substr(0, equals));
      const bool alone         = equals == std::string::npos;
      std::string value        = alone ? "" : argument->substr(equals + 1);

      if (option.value.empty() && !alone)
        fail("'" + *argument + "'", option.name + " without a value");
      // a word with two dashes is rather the next option than a value
      if (!option.value.empty() && alone && argument + 1 != end &&
          (argument + 1)->rfind("--", 0) != 0)
        value = *++argument;
      if (!option.value.empty() && value.empty())
        fail(option.name + " without a value",
             option.name + " " + option.value);
      if (option.name != "--set" &&
          std::find(seen.begin(), seen.end(), option.name) != seen.end())
        fail(option.name + " a second time", option.name + " once");

      seen.push_back(option.name);
      apply(option, value, result);
    }

    /** Options that need no model have to be alone. */
    void
    check_actions(const std::vector<std::string> &seen,
                  const std::size_t n_arguments)
    {
      for (const std::string name :
           {"--help", "--version", "--print-parameters"})
        if (n_arguments > 1 &&
            std::find(seen.begin(), seen.end(), name) != seen.end())
          fail("other arguments beside " + name, name + " alone");
    }

    // Options that exclude each other, or belong to others.
    void
    check_combination(const std::vector<std::string> &seen)
    {
      const auto has = [&](const std::string &name) {
        return std::find(seen.begin(), seen.end(), name) != seen.end();
      };
      const auto exclude = [&](const std::vector<std::string> &names,
                               const std::vector<std::string> &others) {
        for (const std::string &name : names)
          for (const std::string &other : others)
            if (name != other && has(name) && has(other))
              fail(name +
                     (name == "--restart" && other == "--overwrite"
                        ? " and "
                        : " with ") +
                     other,
                   "one of them");
      };
      exclude({"--restart"}, {"--overwrite"});
      exclude({"--restart"}, {"--validate", "--estimate", "--inspect"});
      exclude({"--overwrite"}, {"--validate", "--estimate"});
      exclude({"--validate", "--estimate", "--set"}, {"--inspect"});
      exclude({"--validate"}, {"--estimate"});
      for (const std::string name : {"--scale", "--density", "--mesh-size"})
        if (has(name) && !has("--inspect"))
          fail(name + " without --inspect", "it with --inspect PART");
    }

    void
    check_models(const std::vector<std::string> &models)
    {
      if (models.empty())
        fail("no model file", "one model file (see --help)");
      if (models.size() > 1)
        fail("the model files '" + models[0] + "' and '" + models[1] + "'",
             "one model file");
      if (models[0].empty())
        fail("a model file with an empty name", "one model file");
    }
  } // namespace

  CommandLine
  parse_command_line(const std::vector<std::string> &arguments)
  {
    CommandLine result;
    std::vector<std::string> models, seen;
    bool options_ended = false;
    for (auto argument = arguments.begin(); argument != arguments.end();
         ++argument)
      if (!options_ended && *argument == "--")
        options_ended = true;
      else if (!options_ended && argument->rfind('-', 0) == 0)
        parse_option(argument, arguments.end(), seen, result);
      else
        models.push_back(*argument);

    check_actions(seen, arguments.size());
    check_combination(seen);
    using Action = CommandLine::Action;
    if (result.action == Action::run || result.action == Action::validate ||
        result.action == Action::estimate)
      {
        check_models(models);
        result.model = models[0];
      }
    else if (!models.empty())
      fail("'" + models[0] + "' beside --inspect", "--inspect PART alone");
    return result;
  }

  std::string
  help_text()
  {
    std::string text =
      "Usage: acf-dealii [options] MODEL.prm\n"
      "       acf-dealii [options] --inspect PART\n"
      "\n"
      "Simulate a flexible multibody system of 3D solids with the absolute\n"
      "coordinate formulation.\n"
      "\n"
      "Options:\n";
    for (const Option &option : options())
      {
        std::string usage = "  " + option.name;
        if (!option.value.empty())
          usage += " " + option.value;
        // the options' descriptions begin in one column
        usage.resize(std::max<std::size_t>(usage.size() + 2, 32), ' ');
        text += usage + option.documentation + "\n";
      }
    return text +
           "  --                            end of the options\n"
           "\n"
           "Exit status: 0 done, 1 the simulation failed, 2 the input is "
           "wrong.\n";
  }
} // namespace ACF
