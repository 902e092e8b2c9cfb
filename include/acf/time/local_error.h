// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_local_error_h
#define acf_time_local_error_h

#include <acf/time/stage_history.h>

namespace ACF
{
  /**
   * Weights $w_{ki}$ of the increments of the stages of a step (k = 0) and of
   * those before it, so that $\sum_{ki} w_{ki} Z_{ki}$ is the local error of
   * the positions,
   * \f[ \tfrac12 \tau^2 x'', \qquad \tfrac1{72} \tau^4 x^{(4)}, \qquad
   *     \tfrac1{7200} \tau^6 x^{(6)} \f]
   * with one, two or three stages: the first term of $R(z) - e^z$.
   *
   * They vanish for lower derivatives of x in both of two kinds of motion:
   * where forces are smooth, so that the accelerations of the stages are those
   * of x, $Z = \tau^2 A_{RK}^2 x''(t + c \tau)$, and where constraints or
   * stiffness prescribe x, so that the positions of the stages are exact and
   * the velocities are those of the method. They need one earlier step for two
   * stages, two for three; with fewer they estimate a lower derivative,
   * conservatively.
   *
   * With two stages and equal steps the estimate is
   * $\frac1{24} (Z_2 - 9 Z_1 + 9 \bar Z_1 - \bar Z_2)$ with the increments
   * $\bar Z$ of the earlier step.
   * See theory (13.3), theory (13.4).
   *
   * @param step_sizes of the step, of the step before it, ..., and of one that
   * is not used but as the cause of the velocities after it, 0 if there was
   * none; s
   * @return [step][stage], for as many steps as it takes
   */
  std::vector<Eigen::VectorXd>
  local_error_weights(const ButcherTableau &tableau,
                      const std::vector<double> &step_sizes);

  /** The order of the local error, 2s, in the step size. */
  inline unsigned int
  local_error_order(const ButcherTableau &tableau)
  {
    return 2 * tableau.n_stages();
  }

  /**
   * Estimates the error of the positions that a step adds, without a solve.
   * Vibrations that the steps do not resolve count with about their amplitude,
   * as their phase is lost.
   * See theory (13.3), theory (13.4).
   */
  class LocalError
  {
  public:
    LocalError(const MultibodySystem &system, const ButcherTableau &tableau);

    /**
     * Of a step that follows those of a history.
     * @return the largest one of the bodies, see relative_norm()
     */
    double
    estimate(const StageVector &increments,
             const double step_size,
             const StageHistory &history);

  private:
    const MultibodySystem &system;
    const ButcherTableau &tableau;

    /** Of the last estimate. */
    std::vector<double> step_sizes;
    std::vector<Eigen::VectorXd> weights;
  };
} // namespace ACF

#endif
