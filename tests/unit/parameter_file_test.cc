// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parameter_file.h>
#include <acf/base/parameter_patterns.h>

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

using namespace ACF;

namespace
{
  /** What a small program declares: fixed sections and bodies by name. */
  struct Declarations
  {
    explicit Declarations(const std::vector<std::string> &names)
      : body_names(names)
      , bodies(names.size())
    {
      add();
    }

    struct Body
    {
      std::string element          = "tetrahedron";
      double density               = 1000;
      double poisson_ratio         = 0.25;
      double youngs_modulus        = 2.1e11;
      double angle                 = 0;
      std::vector<double> position = {0, 0, 0};
      unsigned int n_elements      = 1;
      bool is_rigid                = false;
    };

    std::string title = "untitled";
    std::vector<std::string> body_names, probes;
    std::vector<Body> bodies;
    int n_stages = 2;
    ParameterHandler prm;

  private:
    void
    add()
    {
      prm.add_parameter("Title", title, "What the model is.");
      prm.enter_subsection("Time integration");
      prm.add_parameter("Stages",
                        n_stages,
                        "Number of stages.",
                        Patterns::Integer(2, 3));
      prm.leave_subsection();
      prm.enter_subsection("Bodies");
      prm.add_parameter("Names", body_names, "Names of the bodies.");
      for (unsigned int i = 0; i < bodies.size(); ++i)
        {
          prm.enter_subsection(body_names[i]);
          add(bodies[i]);
          prm.leave_subsection();
        }
      prm.leave_subsection();
      prm.enter_subsection("Output");
      prm.add_parameter("Probes",
                        probes,
                        "Probes to write.",
                        Patterns::List(Patterns::Anything()));
      prm.leave_subsection();
    }

    void
    add(Body &body)
    {
      prm.add_parameter("Element",
                        body.element,
                        "Kind of element.",
                        Patterns::Selection("tetrahedron|hexahedron"));
      prm.add_parameter("Density",
                        body.density,
                        "Mass per volume. Units: kg/m^3.",
                        Patterns::Double(std::numeric_limits<double>::min()));
      prm.add_parameter("Poisson's ratio",
                        body.poisson_ratio,
                        "Lateral contraction.",
                        Patterns::Double(0, 0.5));
      prm.add_parameter("Young's modulus",
                        body.youngs_modulus,
                        "Stiffness. Units: Pa.",
                        Patterns::Double(0));
      prm.add_parameter("Angle", body.angle, "Units: rad.");
      prm.add_parameter("Position",
                        body.position,
                        "Units: m.",
                        Patterns::List(Patterns::Double(), 3, 3));
      prm.add_parameter("Elements", body.n_elements, "Number of elements.");
      prm.add_parameter("Rigid", body.is_rigid, "Whether it is rigid.");
    }
  };

  std::string
  message_of(const std::function<void()> &action)
  {
    try
      {
        action();
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "no error";
  }

  std::string
  error_of(const std::string &text,
           const std::vector<std::string> &overrides = {})
  {
    return message_of([&]() {
      const auto file = ParameterFile::from_text(text, overrides, "m.prm");
      InputProblems problems = file.problems();
      Declarations declared(file.names("Bodies", problems));
      file.parse(declared.prm, problems);
      problems.throw_all();
    });
  }

  /** The lines of m.prm that errors name. */
  std::vector<unsigned int>
  lines_of(const std::string &errors)
  {
    std::vector<unsigned int> lines;
    std::istringstream stream(errors);
    const std::string begin = "m.prm:";
    for (std::string line; std::getline(stream, line);)
      if (line.rfind(begin, 0) == 0)
        lines.push_back(std::stoul(line.substr(begin.size())));
    return lines;
  }

  /** A model whose entry in line 5 is the only one of its only body. */
  std::string
  body(const std::string &entry)
  {
    return "subsection Bodies\n"
           "  set Names = blade\n"
           "  subsection blade\n"
           "    # the entry\n"
           "    " +
           entry +
           "\n"
           "  end\n"
           "end\n";
  }

  const std::string in_blade = "m.prm:5: section 'Bodies/blade', entry ";

  const std::string two_bodies =
    "set Title = Two # bodies\n"
    "subsection Bodies\n"
    "  set Names = a, long name\n"
    "  subsection a\n"
    "    set Density = 7.8e3\n"
    "    set Position = 1, \\\n"
    "                   2, \\\n"
    "                   3\n"
    "    set Rigid = true\n"
    "  end\n"
    "  subsection long name\n"
    "    set Element = hexahedron\n"
    "  end\n"
    "end\n";
} // namespace



TEST(ParameterFile, ReadsValuesOfNamedSubsections)
{
  const auto file = ParameterFile::from_text(two_bodies);
  ASSERT_EQ(file.names("Bodies"), (std::vector<std::string>{"a", "long name"}));
  EXPECT_TRUE(file.names("Joints").empty());

  Declarations declared(file.names("Bodies"));
  file.parse(declared.prm);
  EXPECT_EQ(declared.title, "Two");
  EXPECT_EQ(declared.bodies[0].density, 7800);
  EXPECT_EQ(declared.bodies[0].position, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(declared.bodies[0].is_rigid);
  EXPECT_EQ(declared.bodies[0].element, "tetrahedron");
  EXPECT_EQ(declared.bodies[1].element, "hexahedron");
}

// the scanner is ours: on awkward but valid text it must agree with deal.II
TEST(ParameterFile, UnderstandsTextAsParameterHandlerDoes)
{
  const std::string text =
    "\t set Title =  a = b \\\r\n"
    " \t  and c#not this\r\n"
    "SUBSECTION Time integration # comment\r\n"
    "SET\tStages\t=\t3\r\n"
    "END\r\n"
    "\r\n"
    "# a comment\r\n"
    "subsection   Output\r\n"
    "set Probes=x y,\tz\\\r\n"
    "   , last\r\n"
    "end   \r\n"
    "subsection Bodies\r\n"
    "set Names = long name\r\n"
    "subsection long name\r\n"
    "set Density = +7.8E3\r\nend\r\nend";

  Declarations ours({"long name"}), theirs({"long name"});
  ParameterFile::from_text(text).parse(ours.prm);
  theirs.prm.parse_input_from_string(text);
  EXPECT_EQ(used_parameters(ours.prm), used_parameters(theirs.prm));
  EXPECT_EQ(ours.title, "a = b and c");
  EXPECT_EQ(ours.probes, (std::vector<std::string>{"x y", "z", "last"}));
  EXPECT_EQ(ours.bodies[0].density, 7800);
  EXPECT_EQ(ours.n_stages, 3);
}

TEST(ParameterFile, AcceptsByteOrderMarkAndContinuedLastLine)
{
  const auto file =
    ParameterFile::from_text("\xef\xbb\xbfset Title = \xc3\xa4\\");
  Declarations declared({});
  file.parse(declared.prm);
  EXPECT_EQ(declared.title, "\xc3\xa4");
}

TEST(ParameterFile, RejectsValuesAgainstTheirPattern)
{
  struct Case
  {
    std::string entry, value, allowed;
  };
  const std::vector<Case> cases = {
    {"Density", "-1", "a number > 0"},
    {"Density", "0", "a number > 0"},
    {"Density", "", "a number > 0"},
    {"Poisson's ratio", "0.6", "a number in [0, 0.5]"},
    {"Young's modulus", "-0.1", "a number >= 0"},
    {"Young's modulus", "1e-3 m", "a number >= 0"},
    {"Angle", "nan", "a number"},
    {"Angle", "inf", "a number"},
    {"Angle", "-infinity", "a number"},
    {"Angle", "1e400", "a number"},
    {"Angle", "-2e100", "a number, none larger than 1e100 in size"},
    {"Position",
     "1, 2, 1e101",
     "a list of 3 numbers separated by ',', none larger than 1e100 in size"},
    {"Angle", "-1e400", "a number"},
    {"Angle", "+1e-400", "a number"},
    {"Angle", "1,5", "a number"},
    {"Angle", "1 5", "a number"},
    {"Angle", "0x10", "a number"},
    {"Angle", "{1}", "a number"},
    {"Elements", "-1", "an integer >= 0"},
    {"Elements", "1.5", "an integer >= 0"},
    {"Elements", "99999999999", "an integer >= 0"},
    {"Element", "wedge", "one of tetrahedron, hexahedron"},
    {"Element", "{tetrahedron}", "one of tetrahedron, hexahedron"},
    {"Rigid", "yes", "true or false"},
    {"Position", "1, 2", "a list of 3 numbers separated by ','"},
    {"Position", "1 2 3", "a list of 3 numbers separated by ','"},
    {"Position", "1, 2, 3,", "a list of 3 numbers separated by ','"},
    {"Position", "1, 2, 1e-400", "a list of 3 numbers separated by ','"}};
  for (const auto &[entry, value, allowed] : cases)
    EXPECT_EQ(error_of(body("set " + entry + " = " + value)),
              in_blade + "'" + entry + "': found '" + value +
                "'; allowed: " + allowed);

  EXPECT_EQ(error_of("subsection Time integration\nset Stages = 4\nend"),
            "m.prm:2: section 'Time integration', entry 'Stages': found '4'; "
            "allowed: an integer in [2, 3]");
  EXPECT_EQ(error_of("subsection Output\nset Probes = a,,b\nend"),
            "m.prm:2: section 'Output', entry 'Probes': found 'a,,b'; allowed: "
            "a list of texts separated by ','");
}

TEST(ParameterFile, AcceptsUnusualNumbers)
{
  for (const std::string value :
       {"0", "-0.0", "+1", "1.", ".5", "1E-3", "1e-310", "0e-999"})
    EXPECT_EQ(error_of(body("set Angle = " + value)), "no error") << value;
}

TEST(ParameterFile, NamesUnknownEntriesAndTheNearest)
{
  EXPECT_EQ(error_of(body("set density = 1")),
            in_blade +
              "'density': found an unknown entry; allowed: 'Element', "
              "'Density', 'Poisson's ratio', 'Young's modulus', "
              "'Angle', 'Position', 'Elements', 'Rigid' (did you mean "
              "'Density'?)");
  EXPECT_EQ(error_of("subsection Time integration\nset Colour = 1\nend"),
            "m.prm:2: section 'Time integration', entry 'Colour': found an "
            "unknown entry; allowed: 'Stages'");
  EXPECT_EQ(error_of("set Stages = 2"),
            "m.prm:1: entry 'Stages': found an unknown entry; allowed: "
            "'Title'");
  // the name of a subsection is no entry
  EXPECT_EQ(error_of("set Output = 2"),
            "m.prm:1: entry 'Output': found an unknown entry; allowed: "
            "'Title'");
}

TEST(ParameterFile, NamesUnknownSubsectionsAndTheNearest)
{
  EXPECT_EQ(error_of("set Title = x\n\nsubsection Time inegration\nend"),
            "m.prm:3: found the unknown subsection 'Time inegration'; allowed: "
            "'Time integration', 'Bodies', 'Output' (did you mean 'Time "
            "integration'?)");
  EXPECT_EQ(error_of("subsection Output\nsubsection VTU\nend\nend"),
            "m.prm:2: section 'Output', found the unknown subsection 'VTU'; "
            "allowed: no subsection");
  // the name of an entry is no subsection
  EXPECT_EQ(error_of("subsection Title\nend"),
            "m.prm:1: found the unknown subsection 'Title'; allowed: 'Time "
            "integration', 'Bodies', 'Output'");
}

TEST(ParameterFile, CountsContinuedLines)
{
  EXPECT_EQ(error_of("set Title = one \\\n two \\\n three\n\n"
                     "subsection Bodies\n"
                     "  set Names = a\n"
                     "  subsection a\n"
                     "    set Angle = \\\n"
                     "      x\n"
                     "  end\n"
                     "end\n"),
            "m.prm:8: section 'Bodies/a', entry 'Angle': found 'x'; allowed: a "
            "number");
}

TEST(ParameterFile, RejectsWrongLines)
{
  const std::string allowed =
    "; allowed: 'set NAME = VALUE', 'subsection "
    "NAME', 'end', 'include FILE', comments after '#'";
  for (const std::string line : {"Title = 3",
                                 "include",
                                 "Set Title = 3",
                                 "set Title",
                                 "set",
                                 "set = 3",
                                 "subsection",
                                 "end of it",
                                 "// text"})
    EXPECT_EQ(error_of("\n" + line + " # comment\n"),
              "m.prm:2: found '" + line + "'" + allowed);
  EXPECT_EQ(error_of("subsection Output\nfoo\nend"),
            "m.prm:2: section 'Output', found 'foo'" + allowed);
  EXPECT_EQ(error_of("subsection a/b\nend"),
            "m.prm:1: found 'subsection a/b'; allowed: names without '/'");
  EXPECT_EQ(error_of("set Title = x\n# in C:\\\nset Title = y"),
            "m.prm:2: found a comment that swallows the next line; allowed: "
            "comments without '\\' at the end");
  EXPECT_EQ(error_of("set Title = x \\ # comment\n  y"),
            "m.prm:1: entry 'Title': found 'x \\'; allowed: '\\' only as the "
            "last character of a continued line\nm.prm:2: found 'y'" +
              allowed);
}

TEST(ParameterFile, RejectsUnbalancedSubsections)
{
  EXPECT_EQ(error_of("set Title = x\nend\n"),
            "m.prm:2: found 'end' without an open subsection; allowed: one "
            "'end' for each subsection");
  EXPECT_EQ(error_of("set Title = x\nsubsection Bodies\nsubsection a\nend\n"),
            "m.prm:2: section 'Bodies', found no 'end' of the subsection "
            "opened here; allowed: one 'end' for each subsection");
}

TEST(ParameterFile, RejectsRepetitions)
{
  EXPECT_EQ(error_of("set Title = x\nsubsection Output\n set Probes = a\n"
                     " set Probes = a\nend"),
            "m.prm:4: section 'Output', entry 'Probes': found the entry a "
            "second time (first in line 3); allowed: each entry once");
  EXPECT_EQ(error_of("subsection Bodies\nset Names = a\nsubsection a\nend\n"
                     "subsection a\nend\nend"),
            "m.prm:5: section 'Bodies', found the subsection 'Bodies/a' a "
            "second time (first in line 3); allowed: each subsection once");
}

TEST(ParameterFile, ReportsAllProblemsInTheOrderOfTheFile)
{
  EXPECT_EQ(lines_of(error_of("set Angle = 1\nset Angle = 1\nfoo\n")),
            (std::vector<unsigned int>{1, 2, 3}));
  // the missing end is known last, but belongs to line 1
  EXPECT_EQ(lines_of(error_of("subsection Output\nfoo\n")),
            (std::vector<unsigned int>{1, 2}));
  // of the text, of values, and of the command line, which is the last
  EXPECT_EQ(error_of("set Title = x\n"
                     "Subsection\n"
                     "subsection Time integration\n"
                     "  set Stages = 7\n"
                     "  set Colour = red\n"
                     "end\n"
                     "subsection Bodies\n"
                     "  set Names = a\n"
                     "  subsection a\n"
                     "    set Angle = x\n"
                     "    set Angle = 1\n"
                     "  end\n"
                     "end\n",
                     {"Bodies/a/Rigid=maybe", "Title"}),
            "m.prm:2: found 'Subsection'; allowed: 'set NAME = VALUE', "
            "'subsection NAME', 'end', 'include FILE', comments after '#'\n"
            "m.prm:4: section 'Time integration', entry 'Stages': found '7'; "
            "allowed: an integer in [2, 3]\n"
            "m.prm:5: section 'Time integration', entry 'Colour': found an "
            "unknown entry; allowed: 'Stages'\n"
            "m.prm:10: section 'Bodies/a', entry 'Angle': found 'x'; allowed: "
            "a number\n"
            "m.prm:11: section 'Bodies/a', entry 'Angle': found the entry a "
            "second time (first in line 10); allowed: each entry once\n"
            "command line: found --set 'Title'; allowed: --set "
            "'Section/Entry=value'\n"
            "command line: --set 'Bodies/a/Rigid=maybe': section 'Bodies/a', "
            "entry 'Rigid': found 'maybe'; allowed: true or false");
}

TEST(ParameterFile, LeavesOutWhatFollowsFromOtherProblems)
{
  // all that a misspelt subsection contains
  EXPECT_EQ(lines_of(error_of("subsection Time inegration\n"
                              "  set Stages = 2\n"
                              "  set Colour = red\n"
                              "end\n")),
            std::vector<unsigned int>{1});
  // a subsection without a name, and a name without a subsection
  EXPECT_EQ(lines_of(error_of("subsection Bodies\n"
                              "  set Names = b\n"
                              "  subsection a\n"
                              "    set Colour = red\n"
                              "  end\n"
                              "end\n")),
            std::vector<unsigned int>{3});

  const auto file =
    ParameterFile::from_text(body("set density = 1"), {}, "m.prm");
  InputProblems problems = file.problems();
  Declarations declared(file.names("Bodies", problems));
  file.parse(declared.prm, problems);
  const auto errors_with = [&](const std::string &entry) {
    InputProblems copy = problems;
    file.check([&]() { throw InputError("Bodies/blade", entry, "a", "b"); },
               copy);
    return copy.errors().size();
  };
  // the misspelt entry is the one that was meant
  EXPECT_EQ(errors_with("Density"), 1);
  EXPECT_EQ(errors_with("Angle"), 2);
  EXPECT_TRUE(problems.is_doubtful("Bodies/blade", "Density"));
  EXPECT_FALSE(problems.is_doubtful("Bodies/blade", "Angle"));
}

TEST(InputProblems, ThrowsOneOrAll)
{
  InputProblems problems;
  EXPECT_NO_THROW(problems.throw_all());
  problems.attempt([]() {});
  problems.attempt([]() { throw InputError("b"); });
  try
    {
      problems.throw_all();
      ADD_FAILURE();
    }
  catch (const InputErrors &)
    {
      ADD_FAILURE() << "one error is no list";
    }
  catch (const InputError &error)
    {
      EXPECT_STREQ(error.what(), "b");
    }
  problems.attempt([]() {
    throw InputErrors({InputError("c"), InputError("d")});
  });
  problems.add(InputError("e"), 2);
  problems.add(InputError("a"), 1);
  EXPECT_EQ(message_of([&]() { problems.throw_all(); }), "b\nc\nd\na\ne");

  for (unsigned int k = 0; k < 20000; ++k)
    problems.add(InputError("more"), 3);
  try
    {
      problems.throw_all();
    }
  catch (const InputErrors &errors)
    {
      EXPECT_EQ(errors.errors().size(), 51);
      EXPECT_STREQ(errors.errors().back().what(), "and 19955 more problems");
    }
}

TEST(InputProblems, DoubtsEntriesAndSections)
{
  InputProblems problems;
  problems.doubt("a/b", "x");
  problems.doubt("c");
  EXPECT_TRUE(problems.is_doubtful("a/b", "x"));
  EXPECT_FALSE(problems.is_doubtful("a/b", "y"));
  EXPECT_FALSE(problems.is_doubtful("a/b"));
  EXPECT_FALSE(problems.is_doubtful("a", "x"));
  EXPECT_TRUE(problems.is_doubtful("c", "x"));
  EXPECT_TRUE(problems.is_doubtful("c/d/e", "x"));
  EXPECT_FALSE(problems.is_doubtful("cd", "x"));
  EXPECT_FALSE(problems.is_doubtful("", "c"));
}

namespace
{
  /** Writes files into a folder of its own, which is removed at the end. */
  class Folder
  {
  public:
    Folder()
    {
      std::filesystem::create_directories(path / "inner");
    }

    ~Folder()
    {
      std::filesystem::remove_all(path);
    }

    void
    write(const std::string &name, const std::string &text) const
    {
      std::ofstream(path / name) << text;
    }

    std::string
    error(const std::string &name) const
    {
      return message_of([&]() {
        const ParameterFile file(path / name);
        Declarations declared(file.names("Bodies"));
        file.parse(declared.prm);
      });
    }

    const std::filesystem::path path = "parameter_file_test_folder";
  };
} // namespace

TEST(ParameterFile, IncludesFiles)
{
  const Folder folder;
  folder.write("m.prm",
               "include inner/title.prm # relative to this file\n"
               "subsection Bodies\n"
               "  set Names = a, b\n"
               "  subsection a\n"
               "    include inner/steel.prm\n"
               "  end\n"
               "  subsection b\n"
               "    include inner/steel.prm\n"
               "    set Angle = 2\n"
               "  end\n"
               "end\n");
  folder.write("inner/title.prm", "set Title = from \\\n a file\n");
  folder.write("inner/steel.prm", "INCLUDE density.prm\n\nset Rigid = true\n");
  folder.write("inner/density.prm", "set Density = 7850");
  const ParameterFile file(folder.path / "m.prm");
  Declarations declared(file.names("Bodies"));
  file.parse(declared.prm);
  EXPECT_EQ(declared.title, "from a file");
  for (const auto &body : declared.bodies)
    {
      EXPECT_EQ(body.density, 7850);
      EXPECT_TRUE(body.is_rigid);
    }
  EXPECT_EQ(declared.bodies[1].angle, 2);
}

TEST(ParameterFile, NamesIncludedFilesInErrors)
{
  const Folder folder;
  const std::string in = folder.path.string() + "/";
  folder.write("m.prm",
               "subsection Bodies\n"
               "  set Names = a\n"
               "  subsection a\n"
               "    set Density = 1\n"
               "    include inner/body.prm\n"
               "    set Angle = y\n"
               "  end\n"
               "end\n");
  folder.write("inner/body.prm",
               "# Density\n"
               "set Density = 2\n\n"
               "set Elements = \\\n\\\n x\n");
  EXPECT_EQ(folder.error("m.prm"),
            in +
              "inner/body.prm:2: section 'Bodies/a', entry 'Density': found "
              "the entry a second time (first in line 4 of " +
              in + "m.prm); allowed: each entry once\n" + in +
              "inner/body.prm:4: section 'Bodies/a', entry 'Elements': found "
              "'x'; allowed: an integer >= 0\n" +
              in +
              "m.prm:6: section 'Bodies/a', entry 'Angle': found 'y'; allowed: "
              "a number");
  // later errors, too
  const ParameterFile file(folder.path / "m.prm");
  EXPECT_EQ(std::string(
              file.locate(InputError("Bodies/a", "Elements", "a", "b")).what())
              .rfind(in + "inner/body.prm:4: ", 0),
            0);

  // what a file opens, it closes, and nothing else
  folder.write("inner/body.prm", "end\nsubsection b\n");
  EXPECT_EQ(folder.error("m.prm"),
            in +
              "inner/body.prm:1: section 'Bodies/a', found 'end' without an "
              "open subsection; allowed: one 'end' for each subsection\n" +
              in +
              "inner/body.prm:2: section 'Bodies/a/b', found no 'end' of the "
              "subsection opened here; allowed: one 'end' for each subsection");
  folder.write("inner/body.prm", std::string("set Angle = 1\n\0", 15));
  EXPECT_EQ(folder.error("m.prm"),
            in +
              "inner/body.prm:2: found bytes that are not text; allowed: a "
              "text file in UTF-8");
}

TEST(ParameterFile, RefusesWrongIncludes)
{
  const Folder folder;
  const std::string in = folder.path.string() + "/";
  folder.write("m.prm", "set Title = x\ninclude inner/a.prm\n");
  EXPECT_EQ(folder.error("m.prm"),
            in +
              "m.prm:2: found 'include inner/a.prm': no such file; allowed: "
              "the name of a text file, relative to the folder of this one");
  folder.write("inner/a.prm", "include ../m.prm\n");
  EXPECT_EQ(folder.error("m.prm"),
            in +
              "inner/a.prm:1: found 'include ../m.prm', which includes this "
              "file; allowed: files that do not include each other");
  folder.write("inner/a.prm", "include .\n");
  EXPECT_EQ(folder.error("m.prm"),
            in +
              "inner/a.prm:1: found 'include .': a directory; allowed: the "
              "name of a text file, relative to the folder of this one");

  for (unsigned int k = 0; k < 20; ++k)
    folder.write("inner/" + std::to_string(k) + ".prm",
                 "include " + std::to_string(k + 1) + ".prm\n");
  folder.write("m.prm", "include inner/0.prm\n");
  EXPECT_EQ(folder.error("m.prm"),
            in +
              "inner/15.prm:1: found 'include 16.prm' in a file that is "
              "included by 16 others in turn; allowed: at most 16");
}

TEST(ParameterFile, EndsWithHugeInput)
{
  // each one within a second, and with a message that fits on a page
  std::string deep, many;
  for (unsigned int k = 0; k < 100000; ++k)
    {
      deep += "subsection a\n";
      many += "set a" + std::to_string(k) + " = 1\n";
    }
  EXPECT_EQ(error_of(deep).substr(0, 9), "m.prm:17:");
  EXPECT_EQ(lines_of(error_of(many)).size(), 50);
  const std::string error =
    error_of(body("set Angle = " + std::string(5000000, '1')));
  EXPECT_LT(error.size(), 2000);
  EXPECT_NE(error.find("(5000000 characters)"), std::string::npos);
  EXPECT_LT(error_of("set " + std::string(5000000, 'x') + " = 1").size(), 3000);
}

TEST(ParameterFile, ChecksNames)
{
  const auto error = [](const std::string &names) {
    return error_of("subsection Bodies\n  set Names = " + names +
                    "\n  subsection a\n  end\nend");
  };
  const std::string begin = "m.prm:2: section 'Bodies', entry 'Names': found ";
  EXPECT_EQ(error("a"), "no error");
  EXPECT_EQ(error("a, a"),
            begin + "the name 'a' twice; allowed: each name once");
  EXPECT_EQ(error("a,"),
            begin + "an empty name in 'a,'; allowed: names separated by ','");
  EXPECT_EQ(error("Names"),
            begin +
              "the name 'Names'; allowed: names other than that of the "
              "entry");
  for (const std::string name : {"a/b", "../a", "a.b", "a:b", "a\"", "-a", "_"})
    EXPECT_EQ(error(name),
              begin + "the name '" + name +
                "'; allowed: letters, digits, spaces, '_', '-' and '+', "
                "beginning with a letter or a digit");
  EXPECT_EQ(error("b"),
            "m.prm:3: section 'Bodies' has a subsection 'a' that is not in its "
            "Names (b)");
  EXPECT_EQ(error(""),
            "m.prm:3: section 'Bodies' has a subsection 'a' that is not in its "
            "Names ()");
  EXPECT_EQ(error("a, b"),
            "m.prm:2: section 'Bodies' has no subsection for the name 'b' in "
            "its Names");
}

TEST(ParameterFile, OverridesEntries)
{
  const auto file = ParameterFile::from_text(two_bodies,
                                             {"Title=x=y",
                                              "Bodies/Names = a, long name, c",
                                              "Bodies/a/Density = 1",
                                              "Bodies/c/Rigid=true"});
  ASSERT_EQ(file.names("Bodies").size(), 3);
  Declarations declared(file.names("Bodies"));
  file.parse(declared.prm);
  EXPECT_EQ(declared.title, "x=y");
  EXPECT_EQ(declared.bodies[0].density, 1);
  EXPECT_TRUE(declared.bodies[2].is_rigid);
}

TEST(ParameterFile, RejectsWrongOverrides)
{
  const auto error = [](const std::string &override_text) {
    return error_of(body("set Density = 1"), {override_text});
  };
  EXPECT_EQ(error("Bodies/blade/Density=-1"),
            "command line: --set 'Bodies/blade/Density=-1': section "
            "'Bodies/blade', entry 'Density': found '-1'; allowed: a number > "
            "0");
  EXPECT_EQ(error("Bodies/blade/Angel=1"),
            "command line: --set 'Bodies/blade/Angel=1': section "
            "'Bodies/blade', entry 'Angel': found an unknown entry; allowed: "
            "'Element', 'Density', 'Poisson's ratio', 'Young's modulus', "
            "'Angle', 'Position', 'Elements', 'Rigid' (did you mean 'Angle'?)");
  EXPECT_EQ(error("Bodies/blades/Angle=1"),
            "command line: --set 'Bodies/blades/Angle=1': section 'Bodies' has "
            "a subsection 'blades' that is not in its Names (blade)");
  EXPECT_EQ(error("Ouput/Probes=a"),
            "command line: --set 'Ouput/Probes=a': found the unknown "
            "subsection 'Ouput'; allowed: 'Time integration', 'Bodies', "
            "'Output' (did you mean 'Output'?)");
  EXPECT_EQ(error("Bodies/Names=a/b"),
            "command line: --set 'Bodies/Names=a/b': section 'Bodies', entry "
            "'Names': found the name 'a/b'; allowed: letters, digits, spaces, "
            "'_', '-' and '+', beginning with a letter or a digit");
  for (const std::string text : {"Title", "=1", "/Title=1", "Bodies//Names=1"})
    EXPECT_EQ(error(text),
              "command line: found --set '" + text +
                "'; allowed: --set 'Section/Entry=value'");
  for (const std::string value : {"a # b", "a\\", "a\nset b = c", "\xff"})
    EXPECT_EQ(error("Title=" + value),
              "command line: --set 'Title=" + value +
                "': entry 'Title': found '" + value +
                "'; allowed: one line of UTF-8 text without '#' and without "
                "'\\' at the end");
  EXPECT_EQ(error_of("set Title = x", {"Title=y", "Title=z"}),
            "command line: --set 'Title=z': entry 'Title': found a second "
            "override (the first is 'y'); allowed: each entry once");
  // an override does not excuse a wrong value in the file
  EXPECT_EQ(error_of(body("set Angle = x"), {"Bodies/blade/Angle=1"}),
            in_blade + "'Angle': found 'x'; allowed: a number");
}

TEST(ParameterFile, LocatesErrorsFoundLater)
{
  const auto file =
    ParameterFile::from_text(two_bodies, {"Title=new"}, "dir/m.prm");
  const auto located = [&file](const InputError &error) {
    return std::string(file.locate(error).what());
  };
  EXPECT_EQ(located(InputError("Bodies/a", "Position", "'x'", "y")),
            "dir/m.prm:6: section 'Bodies/a', entry 'Position': found 'x'; "
            "allowed: y");
  EXPECT_EQ(located(InputError("Bodies/long name", "Density", "'x'", "y")),
            "dir/m.prm:11: section 'Bodies/long name', entry 'Density': found "
            "'x'; allowed: y");
  EXPECT_EQ(located(InputError("", "Title", "'new'", "y")),
            "command line: --set 'Title=new': entry 'Title': found 'new'; "
            "allowed: y");
  EXPECT_EQ(located(InputError("Output", "Probes", "''", "y")),
            "dir/m.prm: section 'Output', entry 'Probes': found ''; allowed: "
            "y");
  EXPECT_EQ(located(InputError("no entry")), "no entry");
  const InputError once =
    file.locate(InputError("Bodies/a", "Position", "'x'", "y"));
  EXPECT_STREQ(file.locate(once).what(), once.what());
  EXPECT_EQ(file.path(), "dir/m.prm");
}

TEST(ParameterFile, PassesOnErrorsOfActions)
{
  ParameterHandler prm;
  prm.declare_entry("Title", "x");
  prm.add_action("Title", [](const std::string &value) {
    if (value != "x")
      throw InputError("", "Title", "'" + value + "'", "x");
  });
  const auto file = ParameterFile::from_text("\nset Title = y", {}, "m.prm");
  EXPECT_EQ(message_of([&]() { file.parse(prm); }),
            "m.prm:2: entry 'Title': found 'y'; allowed: x");
}

TEST(ParameterFile, RejectsWhatIsNoText)
{
  const std::string allowed =
    ": found bytes that are not text; allowed: a text file in UTF-8";
  EXPECT_EQ(error_of(std::string("set Title = x\n\0", 15)),
            "m.prm:2" + allowed);
  EXPECT_EQ(error_of("set Title = Stra\xdf"
                     "e\n"),
            "m.prm:1" + allowed);
  EXPECT_EQ(error_of("set Title = x\rset Title = y\n"), "m.prm:1" + allowed);
  EXPECT_EQ(error_of("set Title = \xc3"), "m.prm:1" + allowed);
  const std::string empty =
    "m.prm: found a file without any entry; allowed: a model file";
  EXPECT_EQ(error_of(""), empty);
  EXPECT_EQ(error_of("# only a comment\n"), empty);
}

TEST(ParameterFile, ReadsFiles)
{
  const std::string name = "parameter_file_test.prm";
  const auto error       = [](const std::string &file) {
    return message_of([&file]() { ParameterFile{file}; });
  };
  std::ofstream(name) << two_bodies;
  EXPECT_EQ(ParameterFile(name).names("Bodies").size(), 2);
  EXPECT_EQ(ParameterFile(name).path(), name);

  std::ofstream(name, std::ios::trunc).close();
  EXPECT_EQ(error(name),
            name + ": found a file without any entry; allowed: a model file");
  std::filesystem::permissions(name, std::filesystem::perms::none);
  // an administrator may read everything
  if (!std::ifstream(name))
    {
      EXPECT_EQ(error(name),
                name +
                  ": found a file that cannot be read; allowed: a model "
                  "file");
    }
  std::filesystem::remove(name);
  EXPECT_EQ(error(name), name + ": found no such file; allowed: a model file");
  EXPECT_EQ(error("."), ".: found a directory; allowed: a model file");
  EXPECT_EQ(error("/dev/null"),
            "/dev/null: found a device; allowed: a model file");
}

TEST(ParameterFile, ReadsItsOutputAgain)
{
  const auto file = ParameterFile::from_text(two_bodies, {"Title=New"});
  Declarations first(file.names("Bodies"));
  const std::string defaults = used_parameters(first.prm);
  file.parse(first.prm);
  const std::string used = used_parameters(first.prm);
  EXPECT_NE(used, defaults);
  EXPECT_EQ(used.find('#'), std::string::npos);

  for (const std::string &text : {used, documented_parameters(first.prm)})
    {
      const auto again = ParameterFile::from_text(text);
      ASSERT_EQ(again.names("Bodies"), first.body_names);
      Declarations second(again.names("Bodies"));
      again.parse(second.prm);
      EXPECT_EQ(used_parameters(second.prm), used);
      EXPECT_EQ(second.title, "New");
      EXPECT_EQ(second.bodies[0].position, first.bodies[0].position);
    }
}

TEST(ParameterFile, DocumentsDefaultsInOrderOfDeclaration)
{
  Declarations declared({"blade"});
  const std::string text = documented_parameters(declared.prm);
  EXPECT_NE(text.find("    # Mass per volume. Units: kg/m^3.\n"
                      "    set Density         = 1000\n"),
            std::string::npos);
  EXPECT_LT(text.find("subsection Time integration"),
            text.find("subsection Bodies"));
  EXPECT_LT(text.find("set Element"), text.find("set Density"));
  EXPECT_EQ(error_of(text), "no error");
}

TEST(AllowedValues, DescribesPatterns)
{
  using namespace Patterns;
  const double max  = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::min();
  const auto words  = [](const PatternBase &pattern) {
    return allowed_values(pattern.description());
  };
  EXPECT_EQ(words(Double()), "a number");
  EXPECT_EQ(words(Double(1, -1)), "a number");
  EXPECT_EQ(words(Double(-max, 3)), "a number <= 3");
  EXPECT_EQ(words(Double(tiny, 1)), "a number in (0, 1]");
  EXPECT_EQ(words(Double(-1e-3, 1e9)), "a number in [-0.001, 1e+09]");
  EXPECT_EQ(words(Integer()), "an integer");
  EXPECT_EQ(words(Integer(1)), "an integer >= 1");
  EXPECT_EQ(words(Integer(-2, 5)), "an integer in [-2, 5]");
  EXPECT_EQ(words(Bool()), "true or false");
  EXPECT_EQ(words(Anything()), "any text");
  EXPECT_EQ(words(FileName()), "a file name");
  EXPECT_EQ(words(DirectoryName()), "a directory name");
  EXPECT_EQ(words(Selection("a|b c")), "one of a, b c");
  EXPECT_EQ(words(MultipleSelection("a|b")),
            "a list of words out of a, b separated by ','");
  EXPECT_EQ(words(List(Double(0), 2, 4)),
            "a list of 2 to 4 numbers >= 0 separated by ','");
  EXPECT_EQ(words(List(Integer(1), 1, List::max_int_value, ";")),
            "a list of 1 or more integers >= 1 separated by ';'");
  EXPECT_EQ(words(List(Double(), 0, 1)),
            "a list of 0 to 1 numbers separated by ','");
  EXPECT_EQ(words(List(List(Double(), 3, 3), 0, 2, ";")),
            "a list of 0 to 2 lists of 3 numbers separated by ',' separated by "
            "';'");
  EXPECT_EQ(words(Tuple(";", Double(0), Anything())),
            "a tuple of a number >= 0, any text separated by ';'");
  EXPECT_EQ(words(Tuple(":", Bool(), Integer())),
            "a tuple of true or false, an integer separated by ':'");
}

TEST(Suggestion, FindsTheNearest)
{
  const std::vector<std::string> names = {"Mesh", "Mesh size", "Bodies"};
  EXPECT_EQ(suggestion("Mesh sise", names), " (did you mean 'Mesh size'?)");
  EXPECT_EQ(suggestion("MESH", names), " (did you mean 'Mesh'?)");
  EXPECT_EQ(suggestion("Bodys", names), " (did you mean 'Bodies'?)");
  EXPECT_EQ(suggestion("Bod", names), " (did you mean 'Bodies'?)");
  EXPECT_EQ(suggestion("Gravity", names), "");
  EXPECT_EQ(suggestion("x", {"a"}), "");
  EXPECT_EQ(suggestion("", {}), "");
}
