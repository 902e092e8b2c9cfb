// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/dot_product.h>
#include <acf/base/linear_combination.h>
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
    gram.resize(0, 0);
  }



  void
  AndersonAcceleration::forget_oldest()
  {
    steps.pop_front();
    differences.pop_front();
    const unsigned int n = steps.size();
    gram                 = gram.bottomRightCorner(n, n).eval();
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
          sum += dot_product(a[i][k], b[i][k]) /
                 (body.n_nodes * body.length * body.length);
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
        for (unsigned int i = 0; i < f.bodies.size(); ++i)
          {
            for (unsigned int b = 0; b < f.bodies[i].size(); ++b)
              {
                NodalVector &difference = last_f.bodies[i][b];
                linear_combination({{1, &difference}, {-1, &f.bodies[i][b]}},
                                   difference);
              }
            last_f.multipliers[i] -= f.multipliers[i];
          }
        differences.push_back(std::move(last_f));
        steps.push_back(std::move(last_step));
        const unsigned int before = gram.rows();
        gram.conservativeResize(before + 1, before + 1);
        for (unsigned int j = 0; j <= before; ++j)
          gram(j, before) = gram(before, j) =
            product(differences[j].bodies, differences[before].bodies);
        if (steps.size() > depth)
          forget_oldest();
        // columns of length one; nearly parallel ones are left out
        const unsigned int n = steps.size();
        Eigen::VectorXd scale(n), right_hand_side(n);
        for (unsigned int j = 0; j < n; ++j)
          right_hand_side(j) = product(differences[j].bodies, f.bodies);
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
        for (unsigned int i = 0; i < increments.size(); ++i)
          {
            for (unsigned int b = 0; b < increments[i].size(); ++b)
              {
                std::vector<ScaledVector> terms{{1, &increments[i][b]}};
                for (unsigned int j = 0; j < n; ++j)
                  {
                    terms.push_back({-gamma(j), &differences[j].bodies[i][b]});
                    terms.push_back({gamma(j), &steps[j].bodies[i][b]});
                  }
                linear_combination(terms, increments[i][b]);
              }
            for (unsigned int j = 0; j < n; ++j)
              multipliers[i] += gamma(j) * (steps[j].multipliers[i] -
                                            differences[j].multipliers[i]);
          }
      }
    last_f    = std::move(f);
    last_step = {increments, multipliers};
  }
} // namespace ACF
