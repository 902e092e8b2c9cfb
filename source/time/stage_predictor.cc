// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/linear_combination.h>
#include <acf/time/stage_predictor.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    // Puts the products of the newest defect with the last ones in front of
    // those of up to n - 1 defects.
    void
    prepend(const Eigen::VectorXd &row,
            const unsigned int max_size,
            Eigen::MatrixXd &products)
    {
      const unsigned int n =
        std::min<unsigned int>(products.rows() + 1, max_size);
      Eigen::MatrixXd updated = Eigen::MatrixXd::Zero(n, n);
      updated.bottomRightCorner(n - 1, n - 1) =
        products.topLeftCorner(n - 1, n - 1);
      updated.row(0).head(row.size()) = row.transpose();
      updated.col(0).head(row.size()) = row;
      products                        = updated;
    }
  } // namespace



  StagePredictor::StagePredictor(const MultibodySystem &system,
                                 const ButcherTableau &tableau)
    : system(system)
    , tableau(tableau)
    , A_squared(tableau.A * tableau.A)
    , A_squared_inverse(A_squared.inverse())
    , products(system.bodies().size())
  {}



  void
  StagePredictor::start_step(const StageHistory &history, const double tau)
  {
    step_size                = tau;
    const double ratio       = tau / history.steps[0].size;
    const Eigen::VectorXd &c = tableau.c;
    E.resize(c.size(), c.size());
    for (unsigned int i = 0; i < c.size(); ++i)
      for (unsigned int j = 0; j < c.size(); ++j)
        {
          E(i, j) = 1;
          for (unsigned int k = 0; k < c.size(); ++k)
            if (k != j)
              E(i, j) *= (1 + ratio * c(i) - c(k)) / (c(j) - c(k));
        }
    extrapolation = ratio * ratio * A_squared * E * A_squared_inverse;
  }



  void
  StagePredictor::extrapolate(const StageHistory &history,
                              const double factor,
                              StageConstraints &multipliers) const
  {
    const StageConstraints &last = history.steps[0].multipliers;
    for (unsigned int i = 0; i < multipliers.size(); ++i)
      for (unsigned int j = 0; j < multipliers.size(); ++j)
        multipliers[i] += factor * E(i, j) * last[j];
  }



  Eigen::VectorXd
  StagePredictor::coefficients(const Eigen::MatrixXd &products)
  {
    const unsigned int n         = products.rows();
    const unsigned int n_terms   = std::min(max_terms, n / 2);
    const unsigned int n_targets = std::min(max_targets, n - n_terms);
    Eigen::MatrixXd matrix       = Eigen::MatrixXd::Zero(n_terms, n_terms);
    Eigen::VectorXd rhs          = Eigen::VectorXd::Zero(n_terms);
    double size                  = 0;
    for (unsigned int k = 0; k < n_targets; ++k)
      {
        matrix += products.block(k + 1, k + 1, n_terms, n_terms);
        rhs += products.block(k + 1, k, n_terms, 1);
        size += products(k, k);
      }
    if (!(size > 0) || n_terms == 0)
      return Eigen::VectorXd::Zero(n_terms);

    // regularised, as terms may be multiples of each other up to the tolerance
    // of the iteration
    matrix.diagonal().array() += 1e-6 * matrix.diagonal().maxCoeff();
    const Eigen::VectorXd a = matrix.ldlt().solve(rhs);
    const double rest       = size - 2 * a.dot(rhs) + a.dot(matrix * a);
    const double predicted =
      a.dot(products.topLeftCorner(n_terms, n_terms) * a);
    if (rest < 0.25 * size && predicted < 4 * size)
      return a;
    return Eigen::VectorXd::Zero(n_terms);
  }



  void
  StagePredictor::predict(const StageHistory &history,
                          const unsigned int b,
                          StageVector &increments) const
  {
    Eigen::VectorXd a;
    if (!defects.empty() && step_size == history.steps[0].size)
      a = coefficients(products[b]);
    const StageVector &last = history.steps[0].increments;
    for (unsigned int i = 0; i < increments.size(); ++i)
      {
        std::vector<ScaledVector> terms;
        for (unsigned int j = 0; j < increments.size(); ++j)
          terms.push_back({extrapolation(i, j), &last[j][b]});
        for (unsigned int j = 0; j < a.size(); ++j)
          if (a(j) != 0)
            terms.push_back({a(j), &defects[j].increments[i][b]});
        linear_combination(terms, increments[i][b]);
      }
  }



  void
  StagePredictor::predict(const StageHistory &history,
                          StageConstraints &multipliers) const
  {
    for (Eigen::VectorXd &stage : multipliers)
      stage.setZero();
    extrapolate(history, 1, multipliers);
    if (defects.empty() || step_size != history.steps[0].size)
      return;
    const Eigen::VectorXd a = coefficients(multiplier_products);
    for (unsigned int j = 0; j < a.size(); ++j)
      for (unsigned int i = 0; i < multipliers.size(); ++i)
        multipliers[i] += a(j) * defects[j].multipliers[i];
  }



  void
  StagePredictor::accept(const StageHistory &history,
                         const StageConstraints &multipliers)
  {
    if (step_size != history.steps[0].size)
      {
        defects.clear();
        products.assign(products.size(), Eigen::MatrixXd());
        multiplier_products.resize(0, 0);
        return;
      }
    // in the memory of the oldest one
    Defect newest;
    if (defects.size() == max_terms + 1)
      {
        newest = std::move(defects.back());
        defects.pop_back();
      }
    if (newest.increments.empty())
      newest.increments = history.steps[0].increments; // for their sizes
    defects.push_front(std::move(newest));

    defects[0].multipliers = multipliers;
    extrapolate(history, -1, defects[0].multipliers);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(defects.size());
    for (unsigned int k = 0; k < defects.size(); ++k)
      for (unsigned int i = 0; i < multipliers.size(); ++i)
        row(k) += defects[0].multipliers[i].dot(defects[k].multipliers[i]);
    prepend(row, max_terms + max_targets, multiplier_products);
  }



  void
  StagePredictor::accept(const StageHistory &history,
                         const unsigned int b,
                         const StageVector &increments)
  {
    if (defects.empty())
      return;
    const StageVector &last = history.steps[0].increments;
    Eigen::VectorXd row     = Eigen::VectorXd::Zero(defects.size());
    for (unsigned int i = 0; i < increments.size(); ++i)
      {
        std::vector<ScaledVector> terms{{1, &increments[i][b]}};
        for (unsigned int j = 0; j < increments.size(); ++j)
          terms.push_back({-extrapolation(i, j), &last[j][b]});
        std::vector<const NodalVector *> earlier;
        for (unsigned int k = 1; k < defects.size(); ++k)
          earlier.push_back(&defects[k].increments[i][b]);
        const std::vector<double> sums =
          linear_combination(terms, earlier, defects[0].increments[i][b]);
        row += Eigen::Map<const Eigen::VectorXd>(sums.data(), sums.size());
      }
    prepend(row, max_terms + max_targets, products[b]);
  }



  void
  StagePredictor::Defect::exchange(Archive &archive)
  {
    archive("increments", increments);
    archive("multipliers", multipliers);
  }



  void
  StagePredictor::exchange(Archive &archive)
  {
    archive("defects", defects);
    archive("products", products);
    archive("products of multipliers", multiplier_products);
  }
} // namespace ACF
