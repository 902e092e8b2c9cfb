// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_division_h
#define acf_mechanics_mesh_division_h

#include <acf/mechanics/mesh_data.h>

#include <string>
#include <utility>
#include <vector>

namespace ACF
{
  /** How the mesh of a body is divided into parts: the entry 'Cut'. */
  struct MeshCut
  {
    enum class Kind
    {
      /** not at all */
      none,
      /** at given planes */
      planes,
      /** into slices of equal thickness */
      slices,
      /** one part per region, a volume of the mesh file */
      volumes
    };

    Kind kind = Kind::none;

    /** Coordinate along which planes and slices follow each other. */
    unsigned int axis = 0;

    /** Ascending coordinates of planes, m. */
    std::vector<double> planes;

    /** Number of slices, at least 2. */
    unsigned int n_slices = 0;
  };

  /**
   * Read "y: 0.25, 0.5", "4 along y", "volumes" or nothing.
   * @param section path of the body's subsection, for errors
   * @throws InputError if the text has another form
   */
  MeshCut
  parse_cut(const std::string &text, const std::string &section);



  /** The parts of a mesh. */
  struct DividedMesh
  {
    /** "1", "2", ..., or the names of the volumes. */
    std::vector<std::string> names;

    /** Surfaces that a part shares with another one are called
     * common_surface(). Coordinates are those of the whole mesh. */
    std::vector<MeshData> parts;

    /** Pairs (p, q), p < q, of parts with common faces, in ascending order. */
    std::vector<std::pair<unsigned int, unsigned int>> neighbors;
  };

  /** Name of the surface of a part towards its neighbour: "cut to NEIGHBOR". */
  std::string
  common_surface(const std::string &neighbor);

  /**
   * Divide a mesh. A cell belongs to the slice in which its centre lies (on a
   * plane: to the slice beyond it), or to its region. Surfaces keep their
   * names, in each part that has some of their faces.
   * @pre the cut is not MeshCut::Kind::none
   * @throws InputError if the mesh is not one piece, a slice has no cells, a
   *   cell is in several volumes, there is one volume only, a name of a volume
   *   does not fit into that of a body, or a surface has the name of a common
   *   surface
   */
  DividedMesh
  divide_mesh(MeshData mesh, const MeshCut &cut, const MeshSource &source);
} // namespace ACF

#endif
