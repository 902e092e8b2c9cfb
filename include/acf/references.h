// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_references_h
#define acf_references_h

#include <acf/model.h>

namespace ACF
{
  /**
   * Bodies, joints and surfaces that joints, loads and probes name must exist,
   * as far as that is known without a mesh: parts of bodies by their number,
   * surfaces of built-in shapes.
   */
  void
  check_references(const Model &model,
                   const ParameterFile &file,
                   InputProblems &problems);
} // namespace ACF

#endif
