// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_curvature_h
#define acf_mechanics_mesh_curvature_h

#include <acf/mechanics/mesh_data.h>

namespace ACF
{
  /** The part of check_cells() for cells with curved edges. */
  void
  check_curved_cells(const MeshData &data, const MeshSource &source);
} // namespace ACF

#endif
