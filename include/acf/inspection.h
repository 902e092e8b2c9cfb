// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_inspection_h
#define acf_inspection_h

#include <acf/command_line.h>

#include <iosfwd>

namespace ACF
{
  /**
   * Reads or meshes the file of a part and shows what a model sees of it: its
   * size, volumes and surfaces, the quality of its mesh, and lines to copy into
   * a model file. Writes pictures of the surfaces and of the mesh into the
   * output directory, without one into the folder `PART-inspection`.
   *
   * @param stream where the tables go
   * @param warnings where warnings go, also those of a quiet inspection
   * @throws InputError, SimulationError
   */
  void
  inspect(const CommandLine &command_line,
          std::ostream &stream,
          std::ostream &warnings);
} // namespace ACF

#endif
