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
   * A body at some times: positions $x_i = x + t_i v + z_i$ and accelerations
   * $a_i = \sum_j d_{ij} z_j$.
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
    Eigen::MatrixXd rates;

    /** Those of the $x_i$. */
    std::vector<NodalMoments> moments;

    /** Acceleration $g_i$ that acts on all masses, m/s^2. */
    std::vector<Vector3> gravity;
  };

  /** Work space of reduced_strain_residual(), for the next call. */
  struct ReducedStrainWork
  {
    NodeLanes displacements, accelerations;
    NodeLanes stiffness_products, mass_products;
  };

  /**
   * What is missing for the equilibrium of a body without damping:
   * $r_i = M (g_i - a_i) - f(x_i)$ with the force f of reduced_strain_force().
   * Reads the matrices once for all times, and vectors as seldom as their
   * dependencies let it.
   * See theory (3.2), theory (11.1).
   *
   * @param[out] residual $r_i$, N
   * @return false if a mean deformation gradient has no rotation
   */
  bool
  reduced_strain_residual(const BodyOperators &body,
                          const RotationMeasure measure,
                          const NodalMotion &motion,
                          const std::vector<NodalVector *> &residual,
                          ReducedStrainWork &work);
} // namespace ACF

#endif
