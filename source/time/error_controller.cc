// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/time/error_controller.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ACF
{
  ErrorController::ErrorController(const double first_step,
                                   const double largest_step,
                                   const double rate,
                                   const unsigned int order)
    : first_step(first_step)
    , largest_step(largest_step)
    , rate(rate)
    , exponent(1. / (order - 1))
  {}



  double
  ErrorController::lattice_size(const int k) const
  {
    // the same number whenever the level is the same
    const int half = (k >= 0 ? k / 2 : -((1 - k) / 2));
    return std::ldexp(k == 2 * half ? first_step : first_step * std::sqrt(2.),
                      half);
  }



  double
  ErrorController::allowed_factor(const double epsilon) const
  {
    constexpr double safety = 0.9, largest = 10;
    // a vanishing error allows any step
    if (epsilon <= std::pow(safety / largest, 1 / exponent))
      return largest;
    const double factor = safety * std::pow(epsilon, -exponent);
    if (previous > 0 && previous < epsilon)
      return factor * std::pow(previous / epsilon, 0.4 * exponent);
    return factor;
  }



  bool
  ErrorController::is_too_hard(const StepWork &work)
  {
    const double cost = work.n_solves / step_size();
    costs[level]      = cost;
    const auto below = costs.find(level - 1), above = costs.find(level + 1);
    return work.is_hard && !(below != costs.end() && below->second >= cost) &&
           !(above != costs.end() && above->second <= cost);
  }



  void
  ErrorController::accept(const double error,
                          const std::function<bool(double)> &has_factors,
                          const StepWork &work)
  {
    const bool too_hard = is_too_hard(work);

    // summation by Kahan
    const double summand = step_size() - rest;
    const double sum     = end + summand;
    rest                 = (sum - end) - summand;
    end                  = sum;

    const double epsilon = error / (rate * step_size());
    const double factor  = allowed_factor(epsilon);
    previous             = epsilon;
    rejections           = 0;
    ++since_rise;
    if (since_rise > 20)
      patience = 1;
    const auto allows_level = [&](const int points) {
      return factor >= std::pow(2., 0.5 * points) &&
             lattice_size(level + points) <= largest_step * (1 + 1e-12);
    };
    allowed_one = allows_level(1) ? allowed_one + 1 : 0;
    allowed_two = allows_level(2) ? allowed_two + 1 : 0;
    if (blocked > 0)
      --blocked;
    if (!work.is_hard && level >= hard_level)
      hard_wait = 1;
    const auto is_due = [&](const int points, const unsigned int n_allowed) {
      if (blocked > 0 && level + points >= hard_level)
        return false;
      const unsigned int needed =
        has_factors(lattice_size(level + points)) ? 2 : (points == 2 ? 3 : 8);
      return n_allowed >= needed * patience;
    };

    int points = 0;
    if (too_hard)
      {
        hard_level = level;
        blocked    = 8 * hard_wait;
        hard_wait  = std::min(64U, 2 * hard_wait);
        decrease(1);
      }
    else if (is_due(2, allowed_two))
      points = 2;
    else if (is_due(1, allowed_one))
      points = 1;
    else if (factor < 1)
      decrease(1);
    if (points > 0)
      {
        level += points;
        since_rise  = 0;
        allowed_one = allowed_two = 0;
        previous                  = 0;
      }
  }



  void
  ErrorController::decrease(const int points)
  {
    if (since_rise < 3)
      patience = std::min(64U, 2 * patience);
    level -= points;
    allowed_one = allowed_two = 0;
    previous                  = 0;
  }



  void
  ErrorController::reject(const double error)
  {
    ++rejections;
    const double epsilon = error / (rate * step_size());
    const double factor  = 0.9 * std::pow(epsilon, -exponent);
    // by a factor of four at most: a large error says little about its order
    const int points = std::ceil(-2 * std::log2(factor));
    decrease(std::min(4, std::max(1, points)));
  }



  void
  ErrorController::fail()
  {
    ++rejections;
    decrease(2);
  }



  void
  ErrorController::start_at(const double time)
  {
    end         = time;
    rest        = 0;
    level       = 0;
    previous    = 0;
    allowed_one = allowed_two = 0;
    patience                  = 1;
    since_rise                = 1000;
    rejections                = 0;
    costs.clear();
    hard_level = 0;
    blocked    = 0;
    hard_wait  = 1;
  }



  void
  ErrorController::exchange(Archive &archive)
  {
    double kept_first_step = first_step;
    archive("first step", kept_first_step);
    archive("level", level);
    archive("time", end);
    archive("rest of the time", rest);
    archive("previous error", previous);
    archive("one point allowed", allowed_one);
    archive("two points allowed", allowed_two);
    archive("patience", patience);
    archive("steps since the last rise", since_rise);
    archive("rejections", rejections);
    archive("hard level", hard_level);
    archive("steps without a hard one", blocked);
    archive("wait for a hard one", hard_wait);
    std::vector<int> levels;
    std::vector<double> level_costs;
    for (const auto &[key, cost] : costs)
      {
        levels.push_back(key);
        level_costs.push_back(cost);
      }
    archive("levels", levels);
    archive("costs of levels", level_costs);
    costs.clear();
    for (unsigned int k = 0; k < levels.size(); ++k)
      costs[levels[k]] = level_costs[k];
    if (kept_first_step != first_step)
      start_at(end);
  }
} // namespace ACF
