// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_msh_file_h
#define acf_mechanics_msh_file_h

#include <acf/mechanics/gmsh_model.h>

#include <istream>

namespace ACF
{
  /**
   * Read a .msh file of gmsh, format 2.2 or 4.1, text or binary: nodes,
   * elements, entities and physical groups; other sections are left out.
   * Nothing is believed that the file announces: counts that the rest of the
   * file cannot hold, unknown types of elements, and coordinates that are no
   * numbers are errors. gmsh's own reader trusts them, and ends the program
   * with a signal where they are wrong.
   *
   * @pre a GmshSession, for the types of elements
   * @throws InputError with the line, or with the byte of a binary file
   */
  GmshMesh
  read_msh_file(std::istream &stream, const MeshSource &source);
} // namespace ACF

#endif
