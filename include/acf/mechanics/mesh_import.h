// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_import_h
#define acf_mechanics_mesh_import_h

#include <acf/mechanics/mesh_data.h>
#include <acf/mechanics/mesh_surfaces.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ACF
{
  /** The kinds of files that can be read, told apart by their extension. */
  enum class MeshFileKind
  {
    /** .msh: a mesh of gmsh, format 2.2 or 4.1, text or binary */
    mesh,
    /** .inp: an input file of Abaqus */
    abaqus,
    /** .geo: a script of gmsh */
    script,
    /** .step, .stp, .igs, .iges: CAD with a unit of length of its own */
    cad_with_unit,
    /** .brep: CAD in m */
    cad,
    /** any other extension */
    unknown
  };

  /** The kind of @p file by its extension, in lower or upper case. */
  MeshFileKind
  mesh_file_kind(const std::filesystem::path &file);

  /** How a file is read. */
  struct ImportOptions
  {
    /** Factor on coordinates, after the unit that CAD files have. */
    double scale = 1;

    /** Largest element size for geometries, m; 0: the geometry's. */
    double mesh_size = 0;

    /** Largest sizes at surfaces of geometries, by their names, m. */
    std::vector<std::pair<std::string, double>> surface_sizes;

    /** Surfaces by their place, whose names @p surface_sizes may use. */
    std::vector<SurfaceSelection> selections;

    /** Edges keep the curvature that nodes of second order give them, and
     * geometries are meshed with such nodes. */
    bool is_quadratic = false;
  };

  /**
   * Read "NAME: size, NAME: size".
   * @param section path of the body's subsection, for errors
   * @throws InputError if the text has another form
   */
  std::vector<std::pair<std::string, double>>
  parse_surface_sizes(const std::string &text, const std::string &section);

  /**
   * Read the file of a mesh, or let gmsh mesh the file of a geometry.
   *
   * Physical groups of dimension 3 become regions, those of dimension 2
   * surfaces; without a name they are called "volume 5" and "surface 5" after
   * their tags. If there are groups of volumes, volumes in none of them are
   * left out, which is what gmsh does when it writes a mesh. If there are no
   * groups of a dimension, all geometric entities of that dimension take their
   * place under the same kind of names.
   *
   * @throws InputError if the file cannot be read or meshed, contains no or
   *   different kinds of cells, others than @p reference_cell, curved cells
   *   without ImportOptions::is_quadratic, or empty groups
   */
  MeshData
  import_mesh(const std::filesystem::path &file,
              const ReferenceCell &reference_cell,
              const ImportOptions &options,
              const MeshSource &source);
} // namespace ACF

#endif
