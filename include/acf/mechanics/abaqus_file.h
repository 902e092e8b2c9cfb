// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_abaqus_file_h
#define acf_mechanics_abaqus_file_h

#include <acf/mechanics/gmsh_model.h>

#include <istream>

namespace ACF
{
  /**
   * Read the mesh of an input file of Abaqus: nodes, solid elements, sets of
   * nodes and elements, and surfaces. Sets of elements become physical groups
   * of volumes; surfaces, sets of surface elements, and sets of nodes that have
   * all nodes of some faces on the boundary become physical groups of surfaces.
   * What else stands in the file is left out, which GmshMesh::notes says.
   * Keywords that move or generate nodes are errors, and so is everything that
   * is not what the format allows; nothing is believed.
   *
   * @pre a GmshSession, for the types of elements
   * @throws InputError with the line
   */
  GmshMesh
  read_abaqus_file(std::istream &stream, const MeshSource &source);
} // namespace ACF

#endif
