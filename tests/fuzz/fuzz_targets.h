// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_fuzz_targets_h
#define acf_tests_fuzz_targets_h

#include <string>

namespace ACF::Testing
{
  /** What becomes of an input. */
  enum class Outcome
  {
    accepted,
    /** Too large to be built for a fuzzer, but read. */
    read,
    /** By an InputError that names the file. */
    rejected
  };

  /**
   * Copy the meshes that models of the seeds name to the current folder, where
   * also the inputs are written.
   */
  void
  prepare_fuzzing();

  /**
   * Read a model file and, if its bodies are small and no program of gmsh has
   * to run, validate it like the program does.
   * @throws what the program should not: everything but an InputError, and an
   *   std::logic_error if the message does not name the file
   */
  Outcome
  fuzz_model(const std::string &text);

  /**
   * Read a mesh file, as tetrahedra or hexahedra, also mirrored and cut, and
   * assemble the body if it is small. Throws like fuzz_model().
   */
  Outcome
  fuzz_mesh(const std::string &contents);
} // namespace ACF::Testing

#endif
