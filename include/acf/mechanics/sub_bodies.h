// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_sub_bodies_h
#define acf_mechanics_sub_bodies_h

#include <acf/mechanics/joints.h>

namespace ACF
{
  /**
   * The bodies of a system, with parts in place of those that are cut. A part
   * is a body of its own, with its own rotation and the small strain in its
   * frame, so that the deformation within each part only must be small. It is
   * placed and moves at the start as the whole body would.
   */
  struct SystemBodies
  {
    /** What the bodies share. */
    std::vector<std::shared_ptr<ReferenceBody>> references;

    /** In the order of the model, parts in the place of their body. */
    std::vector<Body> bodies;

    /**
     * Fixed joints between neighbouring parts, called "NAME 1 + NAME 2": on
     * their common surface mean positions and mean rotations are the same.
     */
    std::vector<JointParameters> joints;
  };

  /**
   * Make meshes and operators once for identical bodies, and divide bodies as
   * their entry 'Cut' says, see divide_mesh(). Parts are called "NAME 1" or
   * "NAME VOLUME".
   * See theory (6.1).
   * @param directory where relative mesh file names start
   * @throws InputError if a mesh is wrong, or parts have the name of a body
   */
  SystemBodies
  make_bodies(const std::vector<BodyParameters> &parameters,
              const std::filesystem::path &directory);
} // namespace ACF

#endif
