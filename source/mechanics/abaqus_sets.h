// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_abaqus_sets_h
#define acf_mechanics_abaqus_sets_h

#include <acf/mechanics/gmsh_model.h>

#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

// What an input file of Abaqus contains, and the mesh that it makes.

namespace ACF::Abaqus
{
  /** A type of element whose nodes and faces are known. */
  struct SolidType
  {
    std::string name;

    /** gmsh's number of the type with the same nodes. */
    int gmsh_type;

    unsigned int n_corners;

    bool is_solid;

    /** For each of gmsh's nodes the number of Abaqus's, from 0. */
    std::vector<unsigned int> order;

    /** Corners of the faces S1, S2, ..., of solid elements. */
    std::vector<std::vector<unsigned int>> faces;

    /** For each node in the middle of an edge, in gmsh's order, the corners. */
    std::vector<std::array<unsigned int, 2>> edges;
  };

  /** Null if it is not known. @param name in capital letters */
  const SolidType *
  find_type(const std::string &name);

  /** First number, last number, step; and the line where it stands. */
  using Members = std::map<std::array<std::size_t, 3>, unsigned int>;

  struct Set
  {
    std::string name;
    Members members;

    /** Of use to other sets and surfaces only. */
    bool is_internal = false;
  };

  struct Surface
  {
    struct Part
    {
      Members members;

      /** 1 to 6; 0: those on the boundary. Of no meaning for nodes. */
      unsigned int face = 0;

      unsigned int line = 0;
    };

    std::string name;
    bool of_nodes = false;
    std::vector<Part> parts;
  };

  struct Element
  {
    const SolidType *type = nullptr;

    /** In gmsh's order. */
    std::vector<std::size_t> nodes;

    unsigned int line = 0;
  };

  /** Sets and surfaces by their names in capital letters. */
  struct Contents
  {
    std::unordered_map<std::size_t, Point<dim>> nodes;
    std::map<std::size_t, Element> elements;

    /** Elements of other types, which sets may have. */
    std::unordered_set<std::size_t> left_out_elements;
    std::map<std::string, Set> node_sets;
    std::map<std::string, Set> element_sets;
    std::map<std::string, Surface> surfaces;
    std::vector<std::string> notes;
  };

  /**
   * Combine the sets that an element, or a face, belongs to into entities.
   * @throws InputError with the line if members of sets do not exist
   */
  GmshMesh
  make_mesh(const Contents &contents, const MeshSource &source);
} // namespace ACF::Abaqus

#endif
