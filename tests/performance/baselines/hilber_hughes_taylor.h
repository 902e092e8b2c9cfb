// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_baselines_hilber_hughes_taylor_h
#define acf_tests_baselines_hilber_hughes_taylor_h

#include "performance/baselines/method.h"
#include "performance/baselines/saddle_point_matrix.h"

namespace Baselines
{
  /**
   * The conventional nonlinear solution: the strain of Green and Lagrange, the
   * method of Hilber, Hughes and Taylor, constraints for positions (index 3),
   * \f[ \tfrac{1}{1+\alpha} M a_{n+1} + b_{n+1}
   *     - \tfrac{\alpha}{1+\alpha} b_n = 0, \quad \Phi(x_{n+1}, t_{n+1}) = 0,
   *     \quad b = f(x) - p + S^T D^T \lambda, \f]
   * \f[ x_{n+1} = x_n + h v_n + h^2 ((\tfrac12 - \beta) a_n + \beta a_{n+1}),
   *     \quad v_{n+1} = v_n + h ((1 - \gamma) a_n + \gamma a_{n+1}), \f]
   * \f$\beta = (1 - \alpha)^2 / 4\f$, \f$\gamma = 1/2 - \alpha\f$,
   * \f$-1/3 \le \alpha \le 0\f$; zero is the trapezoidal rule. Source: Negrut,
   * Rampalli, Ottarsson, Sajdak, On an implementation of the Hilber-Hughes-
   * Taylor method in the context of index 3 differential-algebraic equations of
   * multibody dynamics, J. Comput. Nonlinear Dyn. 2 (2007).
   *
   * Full Newton: each iteration assembles and factorises the exact tangent.
   * It starts from the accelerations and multipliers of the last step, and ends
   * when the next correction, which quadratic convergence predicts as
   * \f$|d_{k+1}| = C |d_k|^2\f$ with the last C that was seen, is below the
   * tolerance, in the norm of the program's own iteration, but not before a
   * number of iterations: usual tests of convergence need the second one.
   */
  class HilberHughesTaylor : public Method
  {
  public:
    /**
     * @param least_iterations at least 1
     * @throws SimulationError unless all bodies have this strain
     */
    HilberHughesTaylor(const MultibodySystem &system,
                       const double alpha,
                       const unsigned int least_iterations,
                       const TimeParameters &parameters,
                       Statistics &statistics);

    void
    start(SystemState &state) override;

    void
    step(SystemState &state, const double step_size) override;

  private:
    /** Root mean square over the nodes of a body, divided by its length; the
     * largest of all bodies. */
    double
    norm(const SystemVector &x) const;

    /** Solves with the tangent at a state; corrections replace r and g. */
    void
    solve(const SystemState &state,
          const double shift,
          SystemVector &r,
          Eigen::VectorXd &g);

    const MultibodySystem &system;
    const double alpha;
    const double beta;
    const double gamma;
    const unsigned int least_iterations;
    const TimeParameters parameters;
    Statistics &statistics;

    SaddlePointMatrix tangent;
    SystemVector accelerations;

    /** b */
    SystemVector forces;

    /** C */
    double newton_constant;
  };
} // namespace Baselines

#endif
