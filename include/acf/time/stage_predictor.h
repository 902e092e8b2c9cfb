// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_stage_predictor_h
#define acf_time_stage_predictor_h

#include <acf/time/stage_history.h>

namespace ACF
{
  /**
   * Predicts the increments and the multipliers of the stages of a step from
   * the accepted ones.
   *
   * The accelerations of the stages of the last step, a polynomial of degree
   * s - 1, are extrapolated:
   * $Z = \tau^2 A_{RK}^2 E A_{RK}^{-2} \bar Z / \bar\tau^2$ where E takes
   * values at $\bar c_j \bar\tau$ to $\bar\tau + c_i \tau$. What this misses,
   * $d_n = Z_n - Z$, varies smoothly from step to step as long as their size
   * stays, or turns with the body, or vibrates. So it is predicted, too, for
   * each body: $d_{n+1} = \sum_j a_j d_{n-j}$ with up to three coefficients
   * that fit the last up to three steps in the sense of least squares (linear
   * prediction, as Prony's method). Where the fit leaves more than half of
   * them, nothing is added.
   *
   * Multipliers are extrapolated as the accelerations are,
   * $\Lambda = E \bar\Lambda$, and what this misses is predicted likewise.
   * See theory (11.4), theory (11.5).
   */
  class StagePredictor
  {
  public:
    StagePredictor(const MultibodySystem &system,
                   const ButcherTableau &tableau);

    /**
     * The step that predict() is about.
     * @param history at least one step
     */
    void
    start_step(const StageHistory &history, const double step_size);

    /** $Z_i$ of a body. */
    void
    predict(const StageHistory &history,
            const unsigned int body,
            StageVector &increments) const;

    /** $\Lambda_i$ */
    void
    predict(const StageHistory &history, StageConstraints &multipliers) const;

    /** Takes note of an accepted step: of the multipliers, and then of each
     * body, possibly in parallel.
     * @param history the steps before it */
    void
    accept(const StageHistory &history, const StageConstraints &multipliers);

    void
    accept(const StageHistory &history,
           const unsigned int body,
           const StageVector &increments);

    /** Saves or loads what steps leave. */
    void
    exchange(Archive &archive);

  private:
    static constexpr unsigned int max_terms   = 3;
    static constexpr unsigned int max_targets = 3;

    /** Adds extrapolated multipliers. */
    void
    extrapolate(const StageHistory &history,
                const double factor,
                StageConstraints &multipliers) const;

    /** $a_j$ from the scalar products of the defects. */
    static Eigen::VectorXd
    coefficients(const Eigen::MatrixXd &products);

    const MultibodySystem &system;
    const ButcherTableau &tableau;
    const Eigen::MatrixXd A_squared;
    const Eigen::MatrixXd A_squared_inverse;

    double step_size = 0;

    /** E, and $\tau^2 A_{RK}^2 E A_{RK}^{-2} / \bar\tau^2$ */
    Eigen::MatrixXd E;
    Eigen::MatrixXd extrapolation;

    /** What the last extrapolations of steps of the same size have missed. */
    struct Defect
    {
      StageVector increments;
      StageConstraints multipliers;

      void
      exchange(Archive &archive);
    };

    /** $d_n$ to $d_{n-3}$. */
    std::deque<Defect> defects;

    /** $d_{n-j} \cdot d_{n-k}$ for each body and for the multipliers, up to
     * $d_{n-5}$; 0 for $|j - k| > 3$, which nothing needs. */
    std::vector<Eigen::MatrixXd> products;
    Eigen::MatrixXd multiplier_products;
  };
} // namespace ACF

#endif
