// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/io/result_directory.h>

#include <algorithm>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

namespace ACF
{
  namespace
  {
    void
    check(const std::error_code &error,
          const std::string &action,
          const std::filesystem::path &path)
    {
      if (error)
        throw SimulationError(action + " '" + path.string() +
                              "' failed: " + error.message() + ".");
    }



    // Nothing else in the folder is ever touched.
    std::vector<std::filesystem::path>
    results_in(const std::filesystem::path &directory,
               const ResultKind kind,
               const bool unfinished)
    {
      static const std::regex inspection(
        "inspection-(mesh|surfaces)\\.vtu(\\.tmp)?");
      static const std::regex run(
        "(probes\\.csv|statistics\\.json|used_parameters\\.prm|"
        "solution\\.(pvd|xdmf)|solution-[0-9]+\\.(vtu|h5)|solution-mesh\\.h5|"
        "modes\\.csv|modes\\.pvd|mode-[0-9]+\\.vtu|"
        "checkpoint(-previous|-new)?\\.h5)(\\.tmp)?");
      std::vector<std::filesystem::path> files;
      std::error_code error;
      for (std::filesystem::directory_iterator file(directory, error), end;
           !error && file != end;
           file.increment(error))
        if (std::regex_match(file->path().filename().string(),
                             kind == ResultKind::run ? run : inspection) &&
            (file->path().extension() == ".tmp") == unfinished)
          files.push_back(file->path());
      check(error, "Reading the folder", directory);
      // Nobody shall go on from a checkpoint when some of the files that belong
      // to it are gone already.
      std::partition(files.begin(), files.end(), [](const auto &file) {
        return file.filename().string().rfind("checkpoint", 0) == 0;
      });
      return files;
    }



    void
    remove(const std::vector<std::filesystem::path> &files)
    {
      for (const auto &file : files)
        {
          std::error_code error;
          std::filesystem::remove(file, error);
          check(error, "Removing the file", file);
        }
    }



    std::filesystem::path
    set_aside(const std::vector<std::filesystem::path> &files,
              const std::filesystem::path &directory)
    {
      std::error_code error;
      std::filesystem::path aside;
      for (unsigned int k = 1; aside.empty(); ++k)
        {
          const auto candidate = directory / ("earlier-" + std::to_string(k));
          if (std::filesystem::create_directory(candidate, error))
            aside = candidate;
          check(error, "Making the folder", candidate);
        }
      for (const auto &file : files)
        {
          std::filesystem::rename(file, aside / file.filename(), error);
          check(error, "Moving the file", file);
        }
      return aside;
    }
  } // namespace



  std::filesystem::path
  prepare_result_directory(const std::filesystem::path &directory,
                           const EarlierResults earlier,
                           const ResultKind kind)
  {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error || !std::filesystem::is_directory(directory))
      throw SimulationError("Cannot make the output directory " +
                            directory.string() + ": " + error.message() + ".");
    remove(results_in(directory, kind, true));
    if (earlier == EarlierResults::keep)
      return {};
    const auto files = results_in(directory, kind, false);
    if (files.empty())
      return {};
    if (earlier == EarlierResults::set_aside)
      return set_aside(files, directory);
    remove(files);
    return {};
  }
} // namespace ACF
