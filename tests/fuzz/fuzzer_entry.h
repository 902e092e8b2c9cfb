// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The entry points that libFuzzer calls, for the function ACF_FUZZ_TARGET and
// the seeds in the folder ACF_FUZZ_SEEDS.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fuzz/fuzz_targets.h>
#include <fuzz/mutations.h>

namespace
{
  // libFuzzer begins with the inputs of earlier runs, which are not counted
  // again.
  bool is_mutating = false;

  // One letter for the start and one for the end of each input, in a file that
  // survives a crash.
  void
  record(const char letter)
  {
    if (!is_mutating)
      return;
    static const int file =
      open("outcomes", O_WRONLY | O_CREAT | O_APPEND, 0644);
    if (write(file, &letter, 1) != 1)
      std::abort();
  }

  std::vector<std::string> seeds;
} // namespace

extern "C" int
LLVMFuzzerInitialize(int *, char ***)
{
  ACF::Testing::prepare_fuzzing();
  for (const auto &file : std::filesystem::directory_iterator(ACF_FUZZ_SEEDS))
    {
      std::ostringstream text;
      text << std::ifstream(file.path(), std::ios::binary).rdbuf();
      seeds.push_back(text.str());
    }
  std::sort(seeds.begin(), seeds.end());
  return 0;
}

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *const data, const std::size_t size)
{
  record('i');
  try
    {
      const ACF::Testing::Outcome outcome = ACF::Testing::ACF_FUZZ_TARGET(
        std::string(reinterpret_cast<const char *>(data), size));
      record(outcome == ACF::Testing::Outcome::rejected   ? 'r'
             : outcome == ACF::Testing::Outcome::accepted ? 'a'
                                                          : 'l');
    }
  catch (const std::exception &error)
    {
      std::cerr << "not an InputError: " << error.what() << std::endl;
      std::abort();
    }
  return 0;
}

// What libFuzzer finds interesting is mostly wrong already. To get further,
// half of the inputs are seeds with one to three changes.
extern "C" std::size_t
LLVMFuzzerCustomMutator(std::uint8_t *const data,
                        const std::size_t size,
                        const std::size_t max_size,
                        const unsigned int seed)
{
  is_mutating = true;
  if (seed % 8 == 0)
    return LLVMFuzzerMutate(data, size, max_size);
  ACF::Testing::TextMutation mutate(seed);
  std::string text(reinterpret_cast<const char *>(data), size);
  unsigned int n_changes = 1;
  if (seed % 2 == 1)
    {
      text      = seeds[seed / 2 % seeds.size()];
      n_changes = 1 + seed / 64 % 3;
    }
  for (unsigned int i = 0; i < n_changes; ++i)
    text = mutate(text);
  const std::size_t new_size = std::min(text.size(), max_size);
  std::memcpy(data, text.data(), new_size);
  return new_size;
}
