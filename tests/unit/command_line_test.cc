// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/command_line.h>

#include <gtest/gtest.h>

using namespace ACF;
using Action = CommandLine::Action;

namespace
{
  std::string
  error_of(const std::vector<std::string> &arguments)
  {
    try
      {
        parse_command_line(arguments);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "no error";
  }
} // namespace



TEST(CommandLine, HasDefaults)
{
  const CommandLine result = parse_command_line({"m.prm"});
  EXPECT_EQ(result.action, Action::run);
  EXPECT_EQ(result.model, "m.prm");
  EXPECT_TRUE(result.overrides.empty());
  EXPECT_FALSE(result.output_directory.has_value());
  EXPECT_FALSE(result.restart.has_value());
  EXPECT_FALSE(result.overwrite);
  EXPECT_EQ(result.n_threads, 0);
  EXPECT_FALSE(result.quiet);
}

TEST(CommandLine, ReadsOptionsOfRuns)
{
  EXPECT_EQ(parse_command_line({"--restart=a/checkpoint.h5", "m.prm"}).restart,
            std::filesystem::path("a/checkpoint.h5"));
  EXPECT_TRUE(parse_command_line({"--overwrite", "m.prm"}).overwrite);
  EXPECT_EQ(error_of({"--overwrite", "--restart=a", "m.prm"}),
            "command line: found --restart and --overwrite; allowed: one of "
            "them");
  EXPECT_EQ(error_of({"--validate", "--restart=a", "m.prm"}),
            "command line: found --restart with --validate; allowed: one of "
            "them");
  EXPECT_EQ(error_of({"--restart", "--quiet", "m.prm"}),
            "command line: found --restart without a value; allowed: --restart "
            "CHECKPOINT");
}

TEST(CommandLine, ReadsAllOptions)
{
  const CommandLine result = parse_command_line({"--set",
                                                 "A/b=1",
                                                 "--quiet",
                                                 "--output-directory",
                                                 "out",
                                                 "m.prm",
                                                 "--threads=3",
                                                 "--set=c=-2 = d",
                                                 "--validate"});
  EXPECT_EQ(result.action, Action::validate);
  EXPECT_EQ(result.model, "m.prm");
  EXPECT_EQ(result.overrides, (std::vector<std::string>{"A/b=1", "c=-2 = d"}));
  EXPECT_EQ(result.output_directory, std::filesystem::path("out"));
  EXPECT_EQ(result.n_threads, 3);
  EXPECT_TRUE(result.quiet);
}

TEST(CommandLine, ReadsEstimates)
{
  const CommandLine result = parse_command_line({"--estimate", "m.prm"});
  EXPECT_EQ(result.action, Action::estimate);
  EXPECT_EQ(result.model, "m.prm");
  const auto error = [](const std::string &options) {
    return "command line: found " + options + "; allowed: one of them";
  };
  EXPECT_EQ(error_of({"--estimate", "--validate", "m.prm"}),
            error("--validate with --estimate"));
  EXPECT_EQ(error_of({"--restart=a", "--estimate", "m.prm"}),
            error("--restart with --estimate"));
  EXPECT_EQ(error_of({"--overwrite", "--estimate", "m.prm"}),
            error("--overwrite with --estimate"));
  EXPECT_EQ(error_of({"--inspect=a", "--estimate"}),
            error("--estimate with --inspect"));
}

TEST(CommandLine, ReadsOptionsOfInspections)
{
  const CommandLine part = parse_command_line({"--inspect", "a.step"});
  EXPECT_EQ(part.action, Action::inspect);
  EXPECT_EQ(part.part, "a.step");
  EXPECT_TRUE(part.model.empty());
  EXPECT_EQ(part.scale, 1);
  EXPECT_EQ(part.density, 0);
  EXPECT_EQ(part.mesh_size, 0);
  const CommandLine all = parse_command_line({"--density=7850",
                                              "--scale",
                                              "1e-3",
                                              "--inspect=a.brep",
                                              "--mesh-size",
                                              "0.5",
                                              "--overwrite"});
  EXPECT_EQ(all.scale, 1e-3);
  EXPECT_EQ(all.density, 7850);
  EXPECT_EQ(all.mesh_size, 0.5);
  EXPECT_TRUE(all.overwrite);
  for (const std::string wrong : {"", "0", "-1", "1 mm", "nan", "inf", "2e100"})
    EXPECT_EQ(
      error_of({"--inspect=a", "--scale=" + wrong}),
      wrong.empty()
        ? "command line: found --scale without a value; allowed: --scale "
          "FACTOR"
        : "command line: found --scale '" + wrong +
            "'; allowed: a positive number, at most 1e100");
  EXPECT_EQ(error_of({"--mesh-size=1", "m.prm"}),
            "command line: found --mesh-size without --inspect; allowed: it "
            "with --inspect PART");
  EXPECT_EQ(error_of({"--inspect=a", "--restart=b"}),
            "command line: found --restart with --inspect; allowed: one of "
            "them");
  EXPECT_EQ(error_of({"--inspect=a", "b.prm"}),
            "command line: found 'b.prm' beside --inspect; allowed: --inspect "
            "PART alone");
}

TEST(CommandLine, TakesAWordWithDashesAfterTheEndOfOptions)
{
  const CommandLine result = parse_command_line({"--quiet", "--", "--m.prm"});
  EXPECT_EQ(result.model, "--m.prm");
  EXPECT_TRUE(result.quiet);
  EXPECT_EQ(
    *parse_command_line({"--output-directory=--x", "m"}).output_directory,
    "--x");
}

TEST(CommandLine, ReadsActionsWithoutAModel)
{
  EXPECT_EQ(parse_command_line({"--help"}).action, Action::help);
  EXPECT_EQ(parse_command_line({"--version"}).action, Action::version);
  EXPECT_EQ(parse_command_line({"--print-parameters"}).action,
            Action::print_parameters);
  const auto error = [](const std::string &name) {
    return "command line: found other arguments beside " + name +
           "; allowed: " + name + " alone";
  };
  EXPECT_EQ(error_of({"--help", "m.prm"}), error("--help"));
  EXPECT_EQ(error_of({"--set", "a=1", "--print-parameters"}),
            error("--print-parameters"));
  EXPECT_EQ(error_of({"--version", "--help"}), error("--help"));
  EXPECT_EQ(error_of({"--version", "--validate", "m.prm"}), error("--version"));
}

TEST(CommandLine, WantsOneModel)
{
  const std::string none =
    "command line: found no model file; allowed: one "
    "model file (see --help)";
  EXPECT_EQ(error_of({}), none);
  EXPECT_EQ(error_of({"--validate"}), none);
  EXPECT_EQ(error_of({"--"}), none);
  EXPECT_EQ(error_of({"a.prm", "--quiet", "b.prm"}),
            "command line: found the model files 'a.prm' and 'b.prm'; allowed: "
            "one model file");
  EXPECT_EQ(error_of({""}),
            "command line: found a model file with an empty name; allowed: one "
            "model file");
}

TEST(CommandLine, RejectsUnknownOptions)
{
  const std::string allowed =
    "; allowed: --help, --version, --print-parameters, --validate, --estimate, "
    "--inspect, --scale, --density, --mesh-size, --set, --output-directory, "
    "--restart, "
    "--overwrite, --threads, --quiet";
  EXPECT_EQ(error_of({"m.prm", "--thread", "2"}),
            "command line: found the unknown option '--thread'" + allowed +
              " (did you mean '--threads'?)");
  EXPECT_EQ(error_of({"--out=x", "m.prm"}),
            "command line: found the unknown option '--out'" + allowed +
              " (did you mean '--output-directory'?)");
  EXPECT_EQ(error_of({"--foo", "m.prm"}),
            "command line: found the unknown option '--foo'" + allowed);
  EXPECT_EQ(error_of({"-j", "m.prm"}),
            "command line: found the unknown option '-j'" + allowed);
}

TEST(CommandLine, RejectsMissingAndSuperfluousValues)
{
  const std::string error =
    "command line: found --output-directory without a "
    "value; allowed: --output-directory DIR";
  EXPECT_EQ(error_of({"m.prm", "--output-directory"}), error);
  EXPECT_EQ(error_of({"m.prm", "--output-directory="}), error);
  EXPECT_EQ(error_of({"--output-directory", "", "m.prm"}), error);
  EXPECT_EQ(error_of({"--output-directory", "--quiet", "m.prm"}), error);
  EXPECT_EQ(error_of({"m.prm", "--set"}),
            "command line: found --set without a value; allowed: --set "
            "'Section/Entry=value'");
  EXPECT_EQ(error_of({"m.prm", "--quiet=no"}),
            "command line: found '--quiet=no'; allowed: --quiet without a "
            "value");
}

TEST(CommandLine, RejectsRepetitions)
{
  EXPECT_EQ(error_of({"m.prm", "--threads", "1", "--threads=2"}),
            "command line: found --threads a second time; allowed: --threads "
            "once");
}

TEST(CommandLine, ChecksNumbersOfThreads)
{
  for (const std::string value :
       {"0", "-1", "abc", "2x", "1.5", "+1", " 1", "99999999999"})
    EXPECT_EQ(error_of({"m.prm", "--threads", value}),
              "command line: found --threads '" + value +
                "'; allowed: an integer >= 1");
}

TEST(CommandLine, HelpNamesEveryOption)
{
  const std::string text = help_text();
  for (const std::string option : {"--help",
                                   "--version",
                                   "--print-parameters",
                                   "--validate",
                                   "--set 'Section/Entry=value'",
                                   "--output-directory DIR",
                                   "--threads N",
                                   "--quiet"})
    EXPECT_NE(text.find("\n  " + option + "  "), std::string::npos) << option;
}
