// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_equilibrium_h
#define acf_time_equilibrium_h

#include <acf/solvers/tangent_system.h>

#include <string>

namespace ACF
{
  /** What it took to find an equilibrium. */
  struct EquilibriumReport
  {
    /** Linear systems solved. */
    unsigned int iterations = 0;

    /** Largest displacement of a node, m. */
    double displacement = 0;
  };



  /**
   * Static equilibrium at the time of a state,
   * \f[ f(x) + S^T (D^T \lambda - Q) = p, \qquad \Phi(S x, t) = 0, \f]
   * with all velocities zero, by a proximal point iteration: from the anchor
   * \f$x_k\f$ Newton's method with the exact tangent solves
   * \f[ \ldots + \sigma (M + S^T M_L S)(x - x_k) = p, \f]
   * an implicit step of the motion in a very viscous fluid, whose end is the
   * next anchor. With the lowest eigenvalue \f$\omega^2\f$ of the system the
   * distance to the equilibrium contracts by
   * \f$\sigma / (\sigma + \omega^2)\f$. \f$\sigma\f$ is at first
   * slow_squared_rate(); it grows tenfold where a step would turn or deform a
   * body too far, Newton's method fails, the tangent is not positive along the
   * step, or the forces do not do work in its direction (which leads away from
   * unstable equilibria), and decreases again where the iteration is slow.
   *
   * Ends when the distance, predicted from the last contraction, is below 1e-12
   * of the length of each body (root mean square over the nodes), or does not
   * decrease any more below 1e-11.
   * See theory (16.1), theory (16.4).
   */
  class EquilibriumSolver
  {
  public:
    EquilibriumSolver(const MultibodySystem &system, Statistics &statistics);

    /**
     * @param[in,out] state start, replaced by positions and multipliers of the
     * equilibrium; keeps its velocities
     * @param n_load_steps gravity, loads and actuations are multiplied by
     * k / n in n equilibria, one after the other
     * @throws SimulationError naming a body if no equilibrium is found
     */
    EquilibriumReport
    solve(SystemState &state, const unsigned int n_load_steps);

  private:
    /** Outcome of a step from an anchor. */
    struct Step
    {
      bool success = false;

      /** Largest displacement relative to the length of the body, and that
       * without translation. */
      double size        = 0;
      double deformation = 0;

      /** By what the shift has to grow if there was no success. */
      double growth = 10;

      std::string failure;
    };

    /** Solution of a linear system. */
    struct Increment
    {
      SystemVector positions;
      Eigen::VectorXd multipliers;

      /** Increment times shifted tangent times increment, J. */
      double curvature = 0;
    };

    /** Relaxes to the equilibrium of a load factor. */
    void
    relax(SystemState &state, const double load_factor);

    Step
    try_step(const SystemState &anchor,
             SystemState &state,
             const double load_factor);

    /**
     * One Newton iteration.
     * @param increment positions need the size of the bodies
     * @return false if a body is turned inside out
     */
    bool
    solve_newton(const SystemState &anchor,
                 const SystemState &state,
                 const double load_factor,
                 Increment &increment);

    /**
     * Forces p - f - S^T (D^T lambda - Q), and Phi.
     * @return false if a body is turned inside out
     */
    bool
    forces(const SystemState &state,
           const Eigen::VectorXd &multipliers,
           const double load_factor,
           SystemVector &force) const;

    /** Work of the forces without those of joints between two states. */
    double
    relative_work(const SystemState &from,
                  const SystemState &to,
                  const double load_factor) const;

    /** Sets size and deformation, and the body that moves most. */
    void
    measure(const SystemVector &displacement, Step &step);

    /**
     * The size of a step that comes from rounding errors of the forces: of what
     * a change of the positions in their last digits makes of the forces
     * besides their derivative. For a slender body the forces are those of
     * stretched cells, and its bending stiffness is small.
     */
    double
    round_off_step(const SystemState &state, const double load_factor);

    void
    check_distance(const SystemState &state) const;

    [[noreturn]] void
    fail(const SystemState &state, const std::string &reason) const;

    const MultibodySystem &system;
    TangentSystem tangent;
    const double slow_rate;
    double shift;
    unsigned int n_iterations = 0;
    unsigned int moving_body  = 0;
    SystemVector start;
    double extent = 0;
  };
} // namespace ACF

#endif
