// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_mesh_picture_h
#define acf_io_mesh_picture_h

#include <acf/mechanics/mesh_survey.h>

#include <filesystem>

namespace ACF
{
  /** Names of the files in the folder of an inspection. */
  constexpr char surface_picture_file[] = "inspection-surfaces.vtu";
  constexpr char mesh_picture_file[]    = "inspection-mesh.vtu";

  /**
   * Writes the faces of the boundary for ParaView. Values of faces: `surface`,
   * the number of the surface in the survey, counted from one (0: none; of
   * several surfaces the first one), and `surface_name`, all names.
   * @throws SimulationError if the file cannot be written
   */
  void
  write_surface_picture(const BodyMesh &mesh,
                        const MeshSurvey &survey,
                        const std::filesystem::path &file);

  /**
   * Writes the cells for ParaView, with straight edges. Values of cells:
   * `quality` (see cell_shape_quality()), `region` and `region_name` as for the
   * surfaces.
   * @throws SimulationError if the file cannot be written
   */
  void
  write_mesh_picture(const BodyMesh &mesh,
                     const MeshSurvey &survey,
                     const std::filesystem::path &file);
} // namespace ACF

#endif
