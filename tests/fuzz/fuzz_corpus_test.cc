// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The inputs in which fuzzing found something (corpus), what fuzzing starts
// from (seeds) and the models that come with the program, through the functions
// that the fuzzers call.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include <fuzz/fuzz_targets.h>

using namespace ACF::Testing;

namespace
{
  // In a folder of its own, as inputs are written to the current one.
  class FuzzInputs : public testing::Test
  {
  protected:
    void
    SetUp() override
    {
      const std::filesystem::path folder = "fuzz_corpus_test_files";
      std::filesystem::create_directory(folder);
      former = std::filesystem::current_path();
      std::filesystem::current_path(folder);
      prepare_fuzzing();
    }

    void
    TearDown() override
    {
      std::filesystem::current_path(former);
    }

    std::filesystem::path former;
  };



  std::vector<std::filesystem::path>
  files_below(const std::string &folder)
  {
    std::vector<std::filesystem::path> files;
    for (const auto &file :
         std::filesystem::recursive_directory_iterator(folder))
      if (file.is_regular_file())
        files.push_back(file.path());
    std::sort(files.begin(), files.end());
    return files;
  }



  // Any exception, a crash, or what takes the time limit of the test fails it.
  std::vector<Outcome>
  outcomes(const std::string &folder,
           const std::string &extension,
           const std::function<Outcome(const std::string &)> &read)
  {
    std::vector<Outcome> result;
    for (const std::filesystem::path &file : files_below(folder))
      {
        if (!extension.empty() && file.extension() != extension)
          continue;
        SCOPED_TRACE(file.string());
        std::ostringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        EXPECT_NO_THROW(result.push_back(read(text.str())));
      }
    return result;
  }
} // namespace



TEST_F(FuzzInputs, Findings)
{
  outcomes(ACF_FUZZ "/corpus/model", "", fuzz_model);
  outcomes(ACF_FUZZ "/corpus/mesh", "", fuzz_mesh);
}



TEST_F(FuzzInputs, SeedsAreValid)
{
  const auto models = outcomes(ACF_FUZZ "/seeds/model", "", fuzz_model);
  EXPECT_GT(models.size(), 3);
  for (const Outcome outcome : models)
    EXPECT_EQ(outcome, Outcome::accepted);
  const auto meshes = outcomes(ACF_FUZZ "/seeds/mesh", "", fuzz_mesh);
  EXPECT_GT(meshes.size(), 5);
  for (const Outcome outcome : meshes)
    EXPECT_EQ(outcome, Outcome::accepted);
}



TEST_F(FuzzInputs, ModelsOfTheProgramAreValid)
{
  const auto models = outcomes(ACF_PRM, ".prm", fuzz_model);
  EXPECT_GT(models.size(), 10);
  EXPECT_EQ(std::count(models.begin(), models.end(), Outcome::rejected), 0);
}
