// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/time/local_error.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  namespace
  {
    // t^m / m!
    double
    monomial(const double t, const unsigned int m)
    {
      double value = 1;
      for (unsigned int k = 1; k <= m; ++k)
        value *= t / k;
      return value;
    }



    // The increments of steps of the motion x = t^(m + 2) / (m + 2)!, t = 0 at
    // the start of the newest step, whose size is the unit of time.
    class Motion
    {
    public:
      Motion(const ButcherTableau &tableau,
             const std::vector<double> &step_sizes,
             const unsigned int n_steps)
        : tableau(tableau)
        , A_squared(tableau.A * tableau.A)
        , velocity_shape(tableau.A.inverse().bottomRows(1))
        , n_steps(n_steps)
      {
        double start = 0;
        for (unsigned int k = 0; k <= n_steps; ++k)
          {
            sizes.push_back(step_sizes[k] / step_sizes[0]);
            start -= (k == 0 ? 0 : sizes[k]);
            starts.push_back(start);
          }
      }

      // where the stages have the accelerations of x
      Eigen::RowVectorXd
      with_exact_accelerations(const unsigned int m) const
      {
        Eigen::RowVectorXd row(n_steps * tableau.n_stages());
        for (unsigned int k = 0; k < n_steps; ++k)
          {
            Eigen::VectorXd a(tableau.n_stages());
            for (unsigned int i = 0; i < a.size(); ++i)
              a(i) = monomial(starts[k] + tableau.c(i) * sizes[k], m);
            row.segment(k * a.size(), a.size()) =
              (sizes[k] * sizes[k] * A_squared * a).transpose();
          }
        return row;
      }

      // where they have its positions
      Eigen::RowVectorXd
      with_exact_positions(const unsigned int m) const
      {
        const unsigned int s = tableau.n_stages();
        Eigen::RowVectorXd row(n_steps * s);
        for (unsigned int k = 0; k < n_steps; ++k)
          {
            const double v =
              sizes[k + 1] > 0
                ? (velocity_shape * displacements(k + 1, m))(0) / sizes[k + 1]
                : monomial(starts[k], m + 1);
            row.segment(k * s, s) =
              (displacements(k, m) - v * sizes[k] * tableau.c).transpose();
          }
        return row;
      }

    private:
      Eigen::VectorXd
      displacements(const unsigned int k, const unsigned int m) const
      {
        Eigen::VectorXd u(tableau.n_stages());
        for (unsigned int i = 0; i < u.size(); ++i)
          u(i) = monomial(starts[k] + tableau.c(i) * sizes[k], m + 2) -
                 monomial(starts[k], m + 2);
        return u;
      }

      const ButcherTableau &tableau;
      const Eigen::MatrixXd A_squared;
      const Eigen::RowVectorXd velocity_shape;
      const unsigned int n_steps;
      std::vector<double> sizes, starts;
    };
  } // namespace



  std::vector<Eigen::VectorXd>
  local_error_weights(const ButcherTableau &tableau,
                      const std::vector<double> &step_sizes)
  {
    const unsigned int s = tableau.n_stages();
    const unsigned int n_steps =
      std::min<unsigned int>(s, step_sizes.size() - 1);
    // the derivative of x'' that is estimated, and its coefficient: with too
    // few steps a lower one, with that of a method of lower order
    const bool complete         = n_steps == s || (s == 3 && n_steps == 2);
    const unsigned int degree   = complete ? 2 * s - 2 : s - 1;
    constexpr double constant[] = {1. / 2, 1. / 72, 1. / 7200};
    const double coefficient =
      complete || s < 3 ? constant[s - 1] : 10 * constant[s - 1];

    const Motion motion(tableau, step_sizes, n_steps);
    std::vector<Eigen::RowVectorXd> rows;
    for (unsigned int m = 0; m < degree; ++m)
      {
        rows.push_back(motion.with_exact_accelerations(m));
        // up to m = s - 2 both are the same
        if (m + 1 >= s && m + 3 <= s + n_steps)
          rows.push_back(motion.with_exact_positions(m));
      }
    rows.push_back(motion.with_exact_accelerations(degree));

    Eigen::MatrixXd matrix(rows.size(), n_steps * s);
    for (unsigned int r = 0; r < rows.size(); ++r)
      matrix.row(r) = rows[r];
    Eigen::VectorXd rhs  = Eigen::VectorXd::Zero(rows.size());
    rhs(rows.size() - 1) = coefficient;
    // the smallest ones, if several fit
    const Eigen::VectorXd w =
      matrix.completeOrthogonalDecomposition().solve(rhs);
    std::vector<Eigen::VectorXd> weights;
    for (unsigned int k = 0; k < n_steps; ++k)
      weights.emplace_back(w.segment(k * s, s));
    return weights;
  }



  LocalError::LocalError(const MultibodySystem &system,
                         const ButcherTableau &tableau)
    : system(system)
    , tableau(tableau)
  {}



  double
  LocalError::estimate(const StageVector &increments,
                       const double step_size,
                       const StageHistory &history)
  {
    std::vector<double> sizes{step_size};
    for (const StageHistory::Step &step : history.steps)
      sizes.push_back(step.size);
    sizes.push_back(history.steps.empty() ? 0
                                          : history.steps.back().size_before);
    if (sizes != step_sizes)
      {
        step_sizes = sizes;
        weights    = local_error_weights(tableau, sizes);
      }

    std::vector<double> errors(system.bodies().size());
    run_tasks(errors.size(), [&](const unsigned int b) {
      std::vector<ScaledVector> terms;
      for (unsigned int k = 0; k < weights.size(); ++k)
        for (unsigned int i = 0; i < increments.size(); ++i)
          terms.push_back({weights[k](i),
                           k == 0 ? &increments[i][b]
                                  : &history.steps[k - 1].increments[i][b]});
      errors[b] = relative_norm(system.bodies()[b], terms);
    });
    double largest = 0;
    for (const double error : errors)
      largest = std::max(largest, error);
    return largest;
  }
} // namespace ACF
