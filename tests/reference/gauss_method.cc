// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The unknowns are the accelerations of the stages,
//
//   Q_i = Q + c_i h V + h^2 sum_j (A^2)_ij Q''_j,
//   V_i = V + h sum_j A_ij Q''_j,
//
// and the matrix of the simplified Newton iteration keeps the mass and the
// stiffness, which is all that becomes large with stiff modes.

#include "reference/gauss_method.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace Reference
{
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  using Index = Eigen::Index;

  MatrixXd
  EquationsOfMotion::mass_matrix(const double time, const VectorXd &Q) const
  {
    const VectorXd zero  = VectorXd::Zero(Q.size());
    const VectorXd force = residual(time, Q, zero, zero);
    MatrixXd result(Q.size(), Q.size());
    for (Index i = 0; i < Q.size(); ++i)
      result.col(i) =
        residual(time, Q, zero, VectorXd::Unit(Q.size(), i)) - force;
    return result;
  }

  VectorXd
  EquationsOfMotion::acceleration(const double time,
                                  const VectorXd &Q,
                                  const VectorXd &V) const
  {
    return mass_matrix(time, Q).partialPivLu().solve(
      -residual(time, Q, V, VectorXd::Zero(Q.size())));
  }

  GaussMethod::GaussMethod(const EquationsOfMotion &equations,
                           const VectorXd &position,
                           const VectorXd &velocity,
                           const double scale)
    : equations(equations)
    , scale(scale)
    , Q(position)
    , V(velocity)
    , stage_accelerations(MatrixXd::Zero(position.size(), n_stages))
  {
    const double root  = 2 * std::sqrt(10. / 7);
    const double inner = std::sqrt(5 - root) / 6;
    const double outer = std::sqrt(5 + root) / 6;
    nodes << 0.5 - outer, 0.5 - inner, 0.5, 0.5 + inner, 0.5 + outer;
    // Collocation: sum_j A_ij c_j^k = c_i^(k+1) / (k+1), and the same for
    // the weights with 1 instead of c_i.
    StageMatrix powers;
    Eigen::Matrix<double, n_stages, n_stages + 1> integrals;
    for (Index k = 0; k < n_stages; ++k)
      {
        powers.row(k) = nodes.array().pow(k);
        integrals.row(k) << nodes.array().pow(k + 1).transpose(), 1;
        integrals.row(k) /= k + 1.;
      }
    integrals    = powers.fullPivLu().solve(integrals).eval();
    coefficients = integrals.leftCols<n_stages>().transpose();
    weights      = integrals.col(n_stages);
  }

  void
  GaussMethod::factorize(const double step_size)
  {
    const Index n    = Q.size();
    const MatrixXd M = equations.mass_matrix(now, Q);
    const StageMatrix factor =
      step_size * step_size * coefficients * coefficients;
    MatrixXd matrix(n_stages * n, n_stages * n);
    for (Index i = 0; i < n_stages; ++i)
      for (Index j = 0; j < n_stages; ++j)
        matrix.block(i * n, j * n, n, n) =
          factor(i, j) * equations.stiffness() + (i == j ? 1. : 0.) * M;
    factors.compute(matrix);
    factorized_step = step_size;
  }

  void
  GaussMethod::step(const double step_size)
  {
    // Steps in equal intervals differ by rounding only.
    if (std::abs(step_size - factorized_step) > 1e-10 * step_size || slow)
      factorize(step_size);
    const double h            = step_size;
    const StageMatrix squared = coefficients * coefficients;
    double increment          = std::numeric_limits<double>::infinity();
    unsigned int n_iterations = 0;
    while (!(increment <= 1e-14))
      {
        if (++n_iterations > 50)
          throw std::runtime_error("The Newton iteration does not converge.");
        MatrixXd residual(Q.size(), n_stages);
        for (Index i = 0; i < n_stages; ++i)
          residual.col(i) = equations.residual(
            now + nodes(i) * h,
            Q + nodes(i) * h * V +
              h * h * stage_accelerations * squared.row(i).transpose(),
            V + h * stage_accelerations * coefficients.row(i).transpose(),
            stage_accelerations.col(i));
        const VectorXd correction = factors.solve(residual.reshaped());
        stage_accelerations -= correction.reshaped(Q.size(), n_stages);
        increment = h * h * correction.lpNorm<Eigen::Infinity>() /
                    std::max(scale, Q.lpNorm<Eigen::Infinity>());
      }
    slow = n_iterations > 8;
    Q += h * V +
         h * h * stage_accelerations * (coefficients.transpose() * weights);
    V += h * stage_accelerations * weights;
    now += h;
  }

  void
  GaussMethod::advance(const double end_time, const double step_size)
  {
    if (!(end_time >= now))
      throw std::invalid_argument("The times must not decrease.");
    const double start = now;
    // The factor keeps rounding from adding a step.
    const double n_steps =
      std::ceil((end_time - start) / step_size * (1 - 1e-10));
    for (double i = 0; i < n_steps; ++i)
      {
        now = start + (end_time - start) * (i / n_steps);
        step((end_time - start) / n_steps);
      }
    now = end_time;
  }

  double
  GaussMethod::time() const
  {
    return now;
  }

  const VectorXd &
  GaussMethod::position() const
  {
    return Q;
  }

  const VectorXd &
  GaussMethod::velocity() const
  {
    return V;
  }
} // namespace Reference
