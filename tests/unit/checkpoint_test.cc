// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Checkpoints: what is loaded is what was saved, simulations go on from it to
// the last bit, and nothing else is taken for a checkpoint.

#include <acf/base/archive.h>
#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/io/checkpoint.h>
#include <acf/io/field_output.h>
#include <acf/io/result_directory.h>

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "pendulum_model.h"
#include "recorded_run.h"
#include <sys/resource.h>

using namespace ACF;
using namespace Tests;

namespace
{
  // An empty folder of the test.
  std::filesystem::path
  empty_folder(const std::string &name)
  {
    const std::filesystem::path folder = "checkpoint_test-" + name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
  }



  struct Item
  {
    double number = 0;
    NodalVector vector;

    void
    exchange(Archive &archive)
    {
      archive("number", number);
      archive("vector", vector);
    }
  };



  // One value of each kind.
  struct Values
  {
    enum class Kind
    {
      one,
      two
    };

    double number       = 0;
    int negative        = 0;
    std::uint64_t large = 0;
    bool flag           = false;
    Kind kind           = Kind::one;
    std::string text    = "?";
    std::string no_text = "?";
    std::vector<bool> flags;
    std::vector<double> numbers;
    std::vector<unsigned int> no_numbers{1};
    std::vector<std::string> texts;
    std::deque<Item> items;
    Eigen::VectorXd vector;
    Eigen::MatrixXd matrix;
    Eigen::MatrixXd no_matrix = Eigen::MatrixXd::Ones(1, 1);

    void
    exchange(Archive &archive)
    {
      archive("number", number);
      archive("negative", negative);
      archive("large", large);
      archive("flag", flag);
      archive("kind", kind);
      archive("text", text);
      archive("no text", no_text);
      archive("flags", flags);
      archive("numbers", numbers);
      archive("no numbers", no_numbers);
      archive("texts", texts);
      archive("items", items);
      archive("vector", vector);
      archive("matrix", matrix);
      archive("no matrix", no_matrix);
    }
  };



  Values
  some_values()
  {
    Values values;
    values.number     = 0.1;
    values.negative   = -3;
    values.large      = std::uint64_t(1) << 63;
    values.flag       = true;
    values.kind       = Values::Kind::two;
    values.text       = std::string(100000, 'x') + " set A = B\n  end\n";
    values.no_text    = "";
    values.flags      = {true, false, true};
    values.numbers    = {1e-300, -0., 1. / 3};
    values.no_numbers = {};
    values.texts      = {"a", "", "b c"};
    values.items.resize(2);
    values.items[1].number = 7;
    values.items[1].vector.reinit(4);
    values.items[1].vector[3] = -1e300;
    values.vector             = Eigen::VectorXd::LinSpaced(5, 0, 1);
    values.matrix             = Eigen::MatrixXd::Random(3, 2);
    values.no_matrix.resize(0, 0);
    return values;
  }



  void
  save(const std::filesystem::path &file, Values values)
  {
    Archive::save(file, [&](Archive &archive) { archive("values", values); });
  }

  Values
  load(const std::filesystem::path &file)
  {
    Values values;
    Archive::load(file, [&](Archive &archive) { archive("values", values); });
    return values;
  }



  // The message with which loading a file is refused; empty if it is not.
  std::string
  refusal(const std::filesystem::path &file)
  {
    try
      {
        load(file);
        return "";
      }
    catch (const InputError &error)
      {
        return error.what();
      }
  }



  bool
  contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace



TEST(Archive, ReturnsWhatWasSaved)
{
  const auto file  = empty_folder("values") / "file.h5";
  const Values old = some_values();
  save(file, old);
  const Values values = load(file);
  EXPECT_EQ(values.number, old.number);
  EXPECT_EQ(values.negative, old.negative);
  EXPECT_EQ(values.large, old.large);
  EXPECT_EQ(values.flag, old.flag);
  EXPECT_EQ(values.kind, old.kind);
  EXPECT_EQ(values.text, old.text);
  EXPECT_EQ(values.no_text, "");
  EXPECT_EQ(values.flags, old.flags);
  EXPECT_EQ(values.numbers, old.numbers);
  EXPECT_TRUE(std::signbit(values.numbers[1]));
  EXPECT_TRUE(values.no_numbers.empty());
  EXPECT_EQ(values.texts, old.texts);
  ASSERT_EQ(values.items.size(), 2U);
  EXPECT_EQ(values.items[0].vector.size(), 0U);
  EXPECT_EQ(values.items[1].number, 7);
  EXPECT_EQ(values.items[1].vector, old.items[1].vector);
  EXPECT_EQ(values.vector, old.vector);
  EXPECT_EQ(values.matrix, old.matrix);
  EXPECT_EQ(values.no_matrix.size(), 0);
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".tmp"));
}



TEST(Archive, RefusesWhatIsDamaged)
{
  const auto folder = empty_folder("damaged");
  const auto file   = folder / "file.h5";
  save(file, some_values());
  const std::string whole = read_file(file);
  EXPECT_EQ(refusal(file), "");
  EXPECT_TRUE(contains(refusal(folder / "none.h5"), "does not exist"));
  EXPECT_TRUE(contains(refusal(folder), "is no file"));

  const auto refusal_of = [&](const std::string &content) {
    std::ofstream(folder / "other.h5", std::ios::binary) << content;
    return refusal(folder / "other.h5");
  };
  EXPECT_TRUE(contains(refusal_of(""), "an empty file"));
  EXPECT_TRUE(
    contains(refusal_of("time [s],angle [rad]\n0,1\n"), "something else"));
  EXPECT_TRUE(contains(refusal_of(whole.substr(512)), "something else"));
  EXPECT_TRUE(contains(refusal_of(whole + "x"), "damaged"));

  // at every block, and around the end of the text
  for (std::size_t size = 1; size < whole.size();
       size += (size < 600 ? 37 : 4096))
    EXPECT_NE(refusal_of(whole.substr(0, size)), "") << size;
  // every bit that counts
  for (std::size_t k = 512; k < whole.size(); k += 1009)
    {
      std::string damaged = whole;
      damaged[k] ^= 1 << (k % 8);
      EXPECT_TRUE(contains(refusal_of(damaged), "damaged")) << k;
    }
  std::string other = whole;
  other.replace(other.find("format 1"), 8, "format 2");
  EXPECT_TRUE(contains(refusal_of(other), "format 2"));
}



TEST(Archive, NamesWhatIsMissing)
{
  const auto file = empty_folder("missing") / "file.h5";
  double number   = 1;
  Archive::save(file, [&](Archive &archive) { archive("other", number); });
  EXPECT_TRUE(contains(refusal(file), "lacks something"));
}



TEST(Files, AreCompleteOrNotThere)
{
  const auto folder = empty_folder("files");
  write_file(folder / "a", "first");
  write_file(folder / "a", "second", true);
  EXPECT_EQ(read_file(folder / "a"), "second");
  EXPECT_THROW(write_file(folder / "none" / "a", "x"), SimulationError);
  EXPECT_THROW(read_file(folder), InputError);
  EXPECT_NO_THROW(check_writable(folder / "b" / "c"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b"));
  EXPECT_THROW(check_writable(folder / "a" / "c"), SimulationError);

  // a largest size of files stands for a full disk
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old;
  getrlimit(RLIMIT_FSIZE, &old);
  LogFile log(folder / "log", 0);
  log.append("line 1\n");
  rlimit small   = old;
  small.rlim_cur = 10;
  setrlimit(RLIMIT_FSIZE, &small);
  std::string file_error, log_error;
  try
    {
      write_file(folder / "a", std::string(100, 'x'));
    }
  catch (const SimulationError &error)
    {
      file_error = error.what();
    }
  try
    {
      log.append("line 2\n");
    }
  catch (const SimulationError &error)
    {
      log_error = error.what();
    }
  setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_TRUE(contains(file_error, "too large")) << file_error;
  EXPECT_TRUE(contains(log_error, "too large")) << log_error;
  EXPECT_EQ(read_file(folder / "a"), "second");
  EXPECT_EQ(read_file(folder / "log"), "line 1\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.tmp"));

  log.append("line 2\n");
  EXPECT_EQ(read_file(folder / "log"), "line 1\nline 2\n");
  std::filesystem::remove(folder / "log");
  EXPECT_THROW(log.append("line 3\n"), SimulationError);
}



TEST(Files, LogsAreCut)
{
  const auto folder = empty_folder("logs");
  write_file(folder / "log", "1\n2\n3\n");
  LogFile log(folder / "log", 4);
  log.append("4\n");
  log.synchronize();
  EXPECT_EQ(log.size(), 6U);
  EXPECT_EQ(read_file(folder / "log"), "1\n2\n4\n");
}



TEST(ResultDirectory, KeepsEarlierResults)
{
  const auto folder = empty_folder("results");
  const auto fill   = [&] {
    for (const char *name : {"probes.csv",
                             "solution-000001.vtu",
                             "solution-000001.h5",
                             "solution-mesh.h5",
                             "solution.xdmf",
                             "checkpoint.h5",
                             "mine.txt",
                             "solution-000002.vtu.tmp",
                             "solution-mesh.h5.tmp"})
      write_file(folder / name, name);
  };
  fill();
  EXPECT_EQ(prepare_result_directory(folder, EarlierResults::keep), "");
  EXPECT_TRUE(std::filesystem::exists(folder / "probes.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder / "solution-000002.vtu.tmp"));
  EXPECT_FALSE(std::filesystem::exists(folder / "solution-mesh.h5.tmp"));
  for (const char *name : {"earlier-1", "earlier-2"})
    {
      fill();
      EXPECT_EQ(prepare_result_directory(folder, EarlierResults::set_aside),
                folder / name);
      for (const char *moved : {"probes.csv",
                                "solution-000001.vtu",
                                "solution-000001.h5",
                                "solution-mesh.h5",
                                "solution.xdmf",
                                "checkpoint.h5"})
        {
          EXPECT_FALSE(std::filesystem::exists(folder / moved)) << moved;
          EXPECT_EQ(read_file(folder / name / moved), moved);
        }
    }
  EXPECT_EQ(prepare_result_directory(folder, EarlierResults::set_aside), "");
  fill();
  EXPECT_EQ(prepare_result_directory(folder, EarlierResults::remove), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "probes.csv"));
  EXPECT_EQ(read_file(folder / "mine.txt"), "mine.txt");
}



namespace
{
  // A run that can be saved. Probes and states are recorded in every step.
  struct SavedRun
  {
    SavedRun(const std::string &text, const std::vector<std::string> &overrides)
      : run(ParameterFile::from_text(text, overrides), 0.)
      , loop(run.system,
             run.system.initial_state(),
             run.model.time,
             {&run.recorder},
             run.statistics)
    {}

    CheckpointedModel
    model() const
    {
      return {run.system, run.model.used_parameters, run.model.time.end_time};
    }

    /** @param n_saves checkpoints, in folders named after their number */
    void
    simulate(const std::filesystem::path &folder, const unsigned int n_saves)
    {
      Checkpoints checkpoints;
      unsigned int n = 0;
      if (n_saves > 0)
        {
          checkpoints.interval = run.model.time.end_time / n_saves;
          checkpoints.save     = [&] {
            const auto place = folder / std::to_string(n++);
            std::filesystem::create_directories(place);
            save_checkpoint(place, model(), loop, run.statistics);
          };
        }
      std::ostringstream nowhere;
      Progress progress(nowhere, false, run.model.time.end_time);
      loop.run(progress, checkpoints);
    }

    unsigned int
    load(const std::filesystem::path &place)
    {
      return load_checkpoint(
        place / checkpoint_file, model(), [] {}, loop, run.statistics);
    }

    RecordedRun run;
    TimeLoop loop;
  };



  void
  expect_equal(const SystemState &a, const SystemState &b)
  {
    EXPECT_EQ(a.time, b.time);
    ASSERT_EQ(a.positions.size(), b.positions.size());
    for (unsigned int k = 0; k < a.positions.size(); ++k)
      {
        EXPECT_TRUE(a.positions[k] == b.positions[k]) << "at time " << a.time;
        EXPECT_TRUE(a.velocities[k] == b.velocities[k]) << "at time " << a.time;
      }
    EXPECT_EQ(a.multipliers, b.multipliers);
    EXPECT_EQ(a.law_values, b.law_values);
  }



  /**
   * Saves a run several times, goes on from each checkpoint in a new system,
   * and compares every step to the last bit.
   * @return the statistics of the run that was not interrupted
   */
  Statistics
  check_restarts(const std::string &name,
                 const std::string &text,
                 const std::vector<std::string> &overrides)
  {
    const auto folder = empty_folder(name);
    SavedRun whole(text, overrides);
    whole.simulate("", 0);
    SavedRun saved(text, overrides);
    saved.simulate(folder, 3);
    const auto &states = whole.run.recorder.states;
    EXPECT_EQ(states.size(), saved.run.recorder.states.size());
    expect_equal(states.back(), saved.run.recorder.states.back());
    for (const char *number : {"0", "1"})
      {
        SavedRun rest(text, overrides);
        rest.load(folder / number);
        EXPECT_GT(rest.loop.state().time, 0);
        EXPECT_LT(rest.loop.state().time, states.back().time);
        rest.simulate("", 0);
        const auto &last = rest.run.recorder.states;
        // the recorder is not kept in checkpoints: it also sees the state at
        // the restart
        for (unsigned int k = 1; k <= last.size(); ++k)
          expect_equal(states[states.size() - k], last[last.size() - k]);
        for (const auto counter : {&Statistics::steps,
                                   &Statistics::rejected_steps,
                                   &Statistics::halvings,
                                   &Statistics::newton_iterations,
                                   &Statistics::exact_tangent_steps,
                                   &Statistics::corrected_tangent_steps,
                                   &Statistics::step_size_changes,
                                   &Statistics::evicted_factors,
                                   &Statistics::constraint_corrections})
          EXPECT_EQ(rest.run.statistics.*counter,
                    whole.run.statistics.*counter);
        EXPECT_EQ(rest.run.statistics.estimated_error,
                  whole.run.statistics.estimated_error);
        EXPECT_EQ(rest.run.statistics.restarts, 1U);
      }
    return whole.run.statistics;
  }



  const std::string blade = pendulum_model("tetrahedron", "1, 6, 1");
} // namespace



TEST(Restart, FixedSteps)
{
  for (const char *stages : {"1", "2", "3"})
    check_restarts("fixed",
                   blade,
                   {"Time integration/End time=0.05",
                    std::string("Time integration/Stages=") + stages});
}



TEST(Restart, StepSizesByTheTolerance)
{
  const Statistics statistics =
    check_restarts("tolerance",
                   blade,
                   {"Time integration/End time=0.3",
                    "Time integration/Tolerance=1e-5",
                    "Time integration/Factor memory=0.2"});
  // otherwise this is no test
  EXPECT_GT(statistics.step_size_changes, 4U);
  EXPECT_GT(statistics.evicted_factors, 0U);
}



TEST(Restart, FailedSteps)
{
  const Statistics statistics =
    check_restarts("failed",
                   blade,
                   {"Time integration/End time=0.4",
                    "Time integration/Step size=0.02",
                    "Time integration/Maximal Newton iterations=2",
                    "Time integration/Newton tolerance=1e-12"});
  EXPECT_GT(statistics.halvings, 0U);
}



TEST(Restart, ExactTangents)
{
  const Statistics statistics =
    check_restarts("exact",
                   blade,
                   {"Time integration/End time=0.3",
                    "Time integration/Step size=0.02",
                    "Bodies/pendulum/Strain=Green-Lagrange",
                    "Bodies/pendulum/Young's modulus=5e5",
                    "Time integration/Maximal halvings=2"});
  EXPECT_GT(statistics.exact_tangent_steps, 0U);
}



// A file for ParaView whose list could not be written is written again, not
// twice.
TEST(Restart, FilesThatWereNotListed)
{
  const auto folder = empty_folder("lists");
  const RecordedRun run(ParameterFile::from_text(blade, {}), 0.);
  Statistics statistics;
  FieldOutputParameters parameters;
  parameters.interval = 1;
  FieldOutput output(run.system, folder, parameters, nullptr, statistics);
  std::filesystem::create_directories(folder / "solution.pvd.tmp");
  EXPECT_THROW(output.observe(run.system.initial_state()), SimulationError);
  std::filesystem::remove_all(folder / "solution.pvd.tmp");
  output.observe(run.system.initial_state());
  const std::string list = read_file(folder / "solution.pvd");
  EXPECT_TRUE(contains(list, "solution-000000.vtu"));
  EXPECT_EQ(list.find("DataSet"), list.rfind("<DataSet") + 1);
  EXPECT_FALSE(std::filesystem::exists(folder / "solution-000001.vtu"));
  EXPECT_EQ(statistics.vtu_files, 1U);
}



TEST(Restart, MayChangeWhatDoesNotChangeThePast)
{
  const auto folder = empty_folder("changes");
  const std::vector<std::string> half{"Time integration/End time=0.02"};
  SavedRun saved(blade, half);
  saved.simulate(folder, 2);
  const auto with = [&](const std::vector<std::string> &overrides) {
    return SavedRun(blade, overrides);
  };

  // a later end time is the same as having had it from the beginning
  SavedRun whole = with({"Time integration/End time=0.04"});
  whole.simulate("", 0);
  SavedRun longer = with({"Time integration/End time=0.04"});
  longer.load(folder / "1");
  longer.simulate("", 0);
  expect_equal(whole.run.last(), longer.run.last());

  // other step sizes and tolerances begin where the others end
  for (const char *change : {"Time integration/Step size=7e-4",
                             "Time integration/Tolerance=1e-5",
                             "Time integration/Newton tolerance=1e-12",
                             "Time integration/Maximal halvings=3"})
    {
      SavedRun other = with({"Time integration/End time=0.04", change});
      other.load(folder / "0");
      EXPECT_NEAR(other.loop.state().time, 0.01, 1e-9);
      other.simulate("", 0);
      EXPECT_NEAR(other.run.last().time, 0.04, 1e-9) << change;
      EXPECT_LT(nodal_difference(other.run.last().positions[0],
                                 whole.run.last().positions[0]),
                1e-6)
        << change;
    }
}



TEST(Restart, RefusesAnotherModel)
{
  const auto folder = empty_folder("model");
  SavedRun saved(blade, {"Time integration/End time=0.01"});
  saved.simulate(folder, 1);
  const auto message = [&](const std::string &text,
                           const std::string &change,
                           const std::string &end = "0.01") {
    SavedRun other(text, {"Time integration/End time=" + end, change});
    try
      {
        other.load(folder / "0");
        return std::string();
      }
    catch (const InputError &error)
      {
        return std::string(error.what());
      }
  };
  EXPECT_EQ(message(blade, "Title=Another one"), "");
  EXPECT_TRUE(contains(message(blade, "Bodies/pendulum/Density=7801"),
                       "entry 'Density': found '7801'; allowed: '7800'"));
  EXPECT_TRUE(
    contains(message(blade, "Time integration/Stages=3"), "entry 'Stages'"));
  EXPECT_TRUE(contains(message(blade, "Title=x", "0.001"), "'End time'"));
  EXPECT_TRUE(
    contains(message(blade, "Bodies/pendulum/Cells=1, 7, 1"), "'Cells'"));
  std::string more = blade;
  more.replace(more.find("Names = hinge"), 13, "Names = hinge, second");
  more.replace(more.find("  subsection hinge"),
               0,
               "  subsection second\n    set Type = spherical\n"
               "    set Between = pendulum: y max, ground\n  end\n");
  EXPECT_TRUE(contains(message(more, "Title=x"), "Joints"));
}
