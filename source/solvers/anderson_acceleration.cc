// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/anderson_acceleration.h>

namespace ACF
{
  AndersonAcceleration::AndersonAcceleration(const MultibodySystem &system,
                                             const unsigned int depth)
    : system(system)
    , depth(depth)
  {}



  void
  AndersonAcceleration::reset()
  {
    last_f = last_step = {};
    steps.clear();
    differences.clear();
  }



  void
  AndersonAcceleration::Vectors::add(const double factor, const Vectors &other)
  {
    for (unsigned int i = 0; i < bodies.size(); ++i)
      {
        for (unsigned int b = 0; b < bodies[i].size(); ++b)
          bodies[i][b].add(factor, other.bodies[i][b]);
        multipliers[i] += factor * other.multipliers[i];
      }
  }



  double
  AndersonAcceleration::product(const StageVector &a,
                                const StageVector &b) const
  {
    double sum = 0;
    for (unsigned int i = 0; i < a.size(); ++i)
      for (unsigned int k = 0; k < a[i].size(); ++k)
        {
          const BodyOperators &body = system.bodies()[k].operators();
          sum +=
            (a[i][k] * b[i][k]) / (body.n_nodes * body.length * body.length);
        }
    return sum;
  }



  void
  AndersonAcceleration::accelerate(StageVector &increments,
                                   StageConstraints &multipliers)
  {
    Vectors f{increments, multipliers};
    if (!empty())
      {
        // -(f_k - f_{k-1}), in place of what is not needed any more
        last_f.add(-1, f);
        differences.push_back(std::move(last_f));
        steps.push_back(std::move(last_step));
        if (steps.size() > depth)
          {
            steps.pop_front();
            differences.pop_front();
          }
        // columns of length one; nearly parallel ones are left out
        const unsigned int n = steps.size();
        Eigen::VectorXd scale(n), right_hand_side(n);
        Eigen::MatrixXd gram(n, n);
        for (unsigned int j = 0; j < n; ++j)
          {
            for (unsigned int k = 0; k <= j; ++k)
              gram(j, k) = gram(k, j) =
                product(differences[j].bodies, differences[k].bodies);
            right_hand_side(j) = product(differences[j].bodies, f.bodies);
          }
        for (unsigned int j = 0; j < n; ++j)
          scale(j) = gram(j, j) > 0 ? 1 / std::sqrt(gram(j, j)) : 0.;
        const Eigen::MatrixXd scaled =
          scale.asDiagonal() * gram * scale.asDiagonal();
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(n, n);
        solver.setThreshold(1e-10);
        solver.compute(scaled);
        const Eigen::VectorXd gamma =
          scale.asDiagonal() *
          solver.solve(scale.asDiagonal() * right_hand_side);
        // the differences have the other sign
        Vectors accelerated = f;
        for (unsigned int j = 0; j < n; ++j)
          {
            accelerated.add(-gamma(j), differences[j]);
            accelerated.add(gamma(j), steps[j]);
          }
        increments  = accelerated.bodies;
        multipliers = accelerated.multipliers;
      }
    last_f    = std::move(f);
    last_step = {increments, multipliers};
  }
} // namespace ACF
