// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_elastic_force_h
#define acf_mechanics_elastic_force_h

#include <acf/mechanics/body.h>
#include <acf/mechanics/node_rotations.h>
#include <acf/mechanics/reduced_strain_tangent.h>

#include <memory>
#include <optional>

namespace ACF
{
  /**
   * Elastic force of a body by its measure of strain, see
   * reduced_strain_force() and GreenLagrangeOperator.
   *
   * @param positions $x_a$, m
   * @param[out] force $f_a = \partial W / \partial x_a$, N; must have the size
   * of @p positions
   * @param scratch work space; must have the size of @p positions
   * @return W, J; nothing if the body, or with the strain of Green and Lagrange
   * one of its cells, is turned inside out
   */
  std::optional<double>
  elastic_force(const Body &body,
                const NodalVector &positions,
                NodalVector &force,
                NodalVector &scratch);

  /** The energy of elastic_force(), J. */
  std::optional<double>
  elastic_energy(const Body &body, const NodalVector &positions);

  /**
   * Elastic force with Rayleigh damping, see damped_reduced_strain_force(): the
   * damping is that of the small strain in the frame of the body for either
   * measure.
   *
   * @param velocities $v_a$, m/s; not used for a body without damping
   * @return false, and no force, if the body is turned inside out
   */
  bool
  internal_force(const Body &body,
                 const NodalVector &positions,
                 const NodalVector &velocities,
                 NodalVector &force,
                 NodalVector &scratch);



  /** The exact derivative of elastic_force() at some positions. */
  class ElasticTangent
  {
  public:
    /** @return nothing if the body is turned inside out */
    static std::optional<ElasticTangent>
    at(const Body &body, const NodalVector &positions);

    /** R of the body. */
    const Matrix3 &
    rotation() const
    {
      return reduced.rotation;
    }

    /** The reduced strain's U and B; empty with that of Green and Lagrange. */
    const ReducedStrainTangent &
    reduced_tangent() const
    {
      return reduced;
    }

    /** $y = K x$, in the world frame. */
    void
    vmult(NodalVector &y, const NodalVector &x) const;

    /** $R_a^T K_{ab} R_b$ of the strain of Green and Lagrange; else nothing. */
    std::unique_ptr<const BlockNodeMatrix>
    matrix(const NodeRotations &frames) const;

  private:
    const Body *body = nullptr;
    ReducedStrainTangent reduced;

    /** Of the strain of Green and Lagrange. */
    NodalVector positions;
  };
} // namespace ACF

#endif
