// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_node_rotations_h
#define acf_mechanics_node_rotations_h

#include <acf/mechanics/functionals.h>

#include <cstddef>
#include <vector>

namespace ACF
{
  /**
   * Rotations $R_a$ of frames in which the equations of a body are solved: one
   * for all nodes, or one for each.
   */
  class NodeRotations
  {
  public:
    /** The same frame at all nodes. */
    NodeRotations(const Matrix3 &rotation = unit_symmetric_tensor<dim>())
      : common(rotation)
    {}

    /** A frame for each node. */
    explicit NodeRotations(std::vector<Matrix3> rotations)
      : nodes(std::move(rotations))
    {}

    const Matrix3 &
    operator[](const unsigned int node) const
    {
      return nodes.empty() ? common : nodes[node];
    }

    bool
    is_uniform() const
    {
      return nodes.empty();
    }

    /** $y_a = R_a x_a$ for vectors of n nodes; they may be the same. */
    template <typename Source, typename Target>
    void
    to_world(const Source &x, const std::size_t n, Target &&y) const
    {
      for (std::size_t a = 0; a < n; ++a)
        store((*this)[a] * load(x, a), a, y);
    }

    /** $y_a = R_a^T x_a$ */
    template <typename Source, typename Target>
    void
    to_body(const Source &x, const std::size_t n, Target &&y) const
    {
      for (std::size_t a = 0; a < n; ++a)
        store(load(x, a) * (*this)[a], a, y);
    }

  private:
    template <typename Source>
    static Vector3
    load(const Source &x, const std::size_t a)
    {
      return Vector3({x[dim * a], x[dim * a + 1], x[dim * a + 2]});
    }

    template <typename Target>
    static void
    store(const Vector3 &value, const std::size_t a, Target &y)
    {
      for (unsigned int i = 0; i < dim; ++i)
        y[dim * a + i] = value[i];
    }

    Matrix3 common;
    std::vector<Matrix3> nodes;
  };



  /** Sets of nodes; no node is in two of them. */
  using NodeSets = std::vector<std::vector<unsigned int>>;

  /**
   * The nodes of functionals; those of functionals that share a node are in one
   * set.
   */
  NodeSets
  connected_nodes(const std::vector<const NodalFunctional *> &functionals);

  /**
   * The rotations of the material at the nodes, those of the polar
   * decompositions of deformation gradients $F_a$. The nodes of a set turn
   * together, by the rotation of the mean of their gradients, so that
   * functionals which weigh only these see one frame.
   *
   * @param fallback where a gradient has no rotation
   */
  NodeRotations
  material_rotations(const std::vector<Matrix3> &gradients,
                     const NodeSets &sets,
                     const Matrix3 &fallback);
} // namespace ACF

#endif
