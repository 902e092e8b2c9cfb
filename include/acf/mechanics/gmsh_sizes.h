// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_gmsh_sizes_h
#define acf_mechanics_gmsh_sizes_h

#include <acf/mechanics/mesh_surfaces.h>

#include <string>
#include <utility>
#include <vector>

namespace ACF
{
  /**
   * Limit the sizes of elements at surfaces of gmsh's current model. With the
   * distance from a surface the limit grows by a third of it. What the model
   * prescribes by other means is kept, but for a background field of a script,
   * which is replaced. Meshes of the model are not valid any more.
   *
   * @param sizes m, by names of physical groups of surfaces (of all surfaces,
   *   if there is no such group), or of @p selections
   * @param selections a geometric surface belongs to a selection if all nodes
   *   of a coarse mesh on it do
   * @param scale metres per unit of length of the model
   * @pre a GmshSession with a model
   * @throws InputError if there is no such surface, or a size leads to too many
   *   elements
   */
  void
  set_surface_sizes(const std::vector<std::pair<std::string, double>> &sizes,
                    const std::vector<SurfaceSelection> &selections,
                    const double scale,
                    const MeshSource &source);
} // namespace ACF

#endif
