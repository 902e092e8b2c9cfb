// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_reduced_strain_residual_h
#define acf_mechanics_reduced_strain_residual_h

#include <acf/mechanics/node_lanes.h>
#include <acf/mechanics/reduced_strain.h>

#include <Eigen/Core>

namespace ACF
{
  /**
   * A body at some times: positions $x_i = x + t_i v + z_i$, velocities
   * $v_i = v + \sum_j e_{ij} z_j$ and accelerations $a_i = \sum_j d_{ij} z_j$.
   */
  struct NodalMotion
  {
    /** x, m. */
    const NodalVector *position;

    /** v, m/s. */
    const NodalVector *velocity;

    /** $t_i$, s; at most NodeLanes::max_vectors. */
    std::vector<double> times;

    /** $z_i$, m. */
    std::vector<const NodalVector *> increments;

    /** d, 1/s^2. */
    Eigen::MatrixXd second_rates;

    /** Those of the $x_i$. */
    std::vector<NodalMoments> moments;

    /** Acceleration $g_i$ that acts on all masses, m/s^2. */
    std::vector<Vector3> gravity;

    /** Rayleigh damping $\alpha$, 1/s, and $\beta$, s. */
    double mass_damping      = 0;
    double stiffness_damping = 0;

    /** e, 1/s, and the moments of the $v_i$; only read with damping. */
    Eigen::MatrixXd first_rates;
    std::vector<NodalMoments> velocity_moments;

    bool
    is_damped() const
    {
      return mass_damping != 0 || stiffness_damping != 0;
    }
  };

  /**
   * What is missing for the equilibrium of a body:
   * $r_i = M (g_i - a_i) - f(x_i, v_i)$ with the force f of
   * reduced_strain_force(), or of damped_reduced_strain_force(). Reads the
   * matrices once for all times, the mass matrix twice with $\alpha$, a few
   * rows at a time, so that displacements, accelerations and their products
   * with the matrices stay in the caches until they are not needed any more.
   * Does nothing for damping that there is not.
   * See theory (3.2), theory (7.2), theory (11.1).
   *
   * @param[out] residual $r_i$, N
   * @return false if a mean deformation gradient has no rotation
   */
  bool
  reduced_strain_residual(const BodyOperators &body,
                          const RotationMeasure measure,
                          const NodalMotion &motion,
                          const std::vector<NodalVector *> &residual);
} // namespace ACF

#endif
