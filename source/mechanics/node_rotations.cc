// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/node_rotations.h>
#include <acf/mechanics/rotation.h>

#include <algorithm>

namespace ACF
{
  NodeSets
  connected_nodes(const std::vector<const NodalFunctional *> &functionals)
  {
    NodeSets sets;
    for (const NodalFunctional *const functional : functionals)
      {
        // the new set takes in those that it meets
        std::vector<unsigned int> merged = functional->nodes;
        for (auto &other : sets)
          if (std::find_first_of(other.begin(),
                                 other.end(),
                                 functional->nodes.begin(),
                                 functional->nodes.end()) != other.end())
            {
              merged.insert(merged.end(), other.begin(), other.end());
              other.clear();
            }
        std::sort(merged.begin(), merged.end());
        merged.erase(std::unique(merged.begin(), merged.end()), merged.end());
        sets.erase(std::remove_if(sets.begin(),
                                  sets.end(),
                                  [](const auto &set) { return set.empty(); }),
                   sets.end());
        sets.push_back(std::move(merged));
      }
    return sets;
  }



  NodeRotations
  material_rotations(const std::vector<Matrix3> &gradients,
                     const NodeSets &sets,
                     const Matrix3 &fallback)
  {
    std::vector<Matrix3> rotations = nearest_rotations(gradients, fallback);
    for (const auto &set : sets)
      {
        Matrix3 mean;
        for (const unsigned int a : set)
          mean += gradients[a] / (1. * set.size());
        const Matrix3 rotation = nearest_rotation(mean).value_or(fallback);
        for (const unsigned int a : set)
          rotations[a] = rotation;
      }
    return NodeRotations(std::move(rotations));
  }
} // namespace ACF
