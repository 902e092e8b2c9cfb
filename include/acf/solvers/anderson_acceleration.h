// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_anderson_acceleration_h
#define acf_solvers_anderson_acceleration_h

#include <acf/solvers/stage_solver.h>

#include <deque>

namespace ACF
{
  /**
   * Anderson's acceleration of a fixed-point iteration
   * \f$x_{k+1} = x_k + f_k\f$: with the differences
   * \f$\Delta x_j = x_{j+1} - x_j\f$, \f$\Delta f_j = f_{j+1} - f_j\f$
   * \f[ x_{k+1} = x_k + f_k - \sum_j \gamma_j (\Delta x_j + \Delta f_j), \qquad
   *     \Big| f_k - \sum_j \gamma_j \Delta f_j \Big| \to \min. \f]
   * For a linear f these are the iterates of GMRES (Walker and Ni, SIAM J.
   * Numer. Anal. 49, 2011), so that slow modes of the iteration, if they are
   * few, disappear after as many iterations. Linear constraints that all x
   * satisfy remain satisfied.
   *
   * The norm is the sum over bodies and stages of the mean squares of the
   * nodes' increments relative to the length of the body. Multipliers follow
   * with the same coefficients.
   * See theory (13.5).
   */
  class AndersonAcceleration
  {
  public:
    /** @param depth largest number of differences */
    AndersonAcceleration(const MultibodySystem &system,
                         const unsigned int depth);

    /** Forgets all iterations. */
    void
    reset();

    /** Whether there is no iteration yet. */
    bool
    empty() const
    {
      return last_f.bodies.empty();
    }

    /**
     * @param[in,out] increments $f_k$, replaced by $x_{k+1} - x_k$
     * @param[in,out] multipliers increments that belong to them
     */
    void
    accelerate(StageVector &increments, StageConstraints &multipliers);

  private:
    struct Vectors
    {
      StageVector bodies;
      StageConstraints multipliers;
    };

    /** Removes the oldest difference. */
    void
    forget_oldest();

    double
    product(const StageVector &a, const StageVector &b) const;

    const MultibodySystem &system;
    const unsigned int depth;

    /** $f_{k-1}$ and $x_k - x_{k-1}$. */
    Vectors last_f, last_step;

    /** Of the last iterations, the oldest ones first. */
    std::deque<Vectors> steps, differences;

    /** Products of the differences with each other. */
    Eigen::MatrixXd gram;
  };
} // namespace ACF

#endif
