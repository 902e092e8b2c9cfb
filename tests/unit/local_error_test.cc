// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The estimate of the local error against exact ones.

#include <acf/time/local_error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <iostream>

namespace
{
  using namespace ACF;

  // Steps of x'' = -x, and what they add to the error.
  struct Oscillator
  {
    explicit Oscillator(const unsigned int n_stages)
      : tableau(radau_iia(n_stages))
    {}

    // Z of a step from (x, v)
    Eigen::VectorXd
    step(const double tau)
    {
      const unsigned int s            = tableau.n_stages();
      const Eigen::MatrixXd A_inverse = tableau.A.inverse();
      const Eigen::MatrixXd matrix =
        A_inverse * A_inverse / (tau * tau) + Eigen::MatrixXd::Identity(s, s);
      const Eigen::VectorXd Z =
        matrix.lu().solve((-(x + tau * v * tableau.c.array())).matrix());
      const double exact = x * std::cos(tau) + v * std::sin(tau);
      x += tau * v + Z(s - 1);
      v += (A_inverse * Z)(s - 1) / tau;
      local_error = std::abs(x - exact);
      return Z;
    }

    const ButcherTableau tableau;
    double x = 1, v = 0.5, local_error = 0;
  };



  double
  estimate(const std::vector<Eigen::VectorXd> &weights,
           const std::vector<Eigen::VectorXd> &newest_first)
  {
    double sum = 0;
    for (unsigned int k = 0; k < weights.size(); ++k)
      sum += weights[k].dot(newest_first[k]);
    return std::abs(sum);
  }
} // namespace



// Measured: the estimate differs from the error by at most 5 % with one and two
// stages, by 20 % with three where the step has changed.
TEST(LocalError, IsThatOfAStepOfAnOscillator)
{
  for (const unsigned int s : {1U, 2U, 3U})
    for (const double ratio : {1., 0.5, std::sqrt(2.)})
      {
        std::vector<double> deviations;
        for (const double tau : {0.16, 0.08, 0.04})
          {
            Oscillator oscillator(s);
            std::vector<Eigen::VectorXd> steps;
            std::vector<double> sizes{0};
            for (const double size : {tau, tau, tau, ratio * tau})
              {
                steps.insert(steps.begin(), oscillator.step(size));
                sizes.insert(sizes.begin(), size);
              }
            const double error =
              estimate(local_error_weights(oscillator.tableau, sizes), steps);
            deviations.push_back(std::abs(error / oscillator.local_error - 1));
          }
        std::cout << s << " stages, ratio " << ratio
                  << ": deviation of the estimate " << deviations[0] << ' '
                  << deviations[1] << ' ' << deviations[2] << std::endl;
        for (const double deviation : deviations)
          EXPECT_LT(deviation, s < 3 ? 0.1 : 0.3);
      }
}



// Without enough earlier steps the estimate is one of a lower order, and
// larger.
TEST(LocalError, IsConservativeAtTheStart)
{
  for (const unsigned int s : {2U, 3U})
    {
      Oscillator oscillator(s);
      const double tau             = 0.1;
      const Eigen::VectorXd first  = oscillator.step(tau);
      const double start           = oscillator.local_error;
      const Eigen::VectorXd second = oscillator.step(tau);
      const double error0 =
        estimate(local_error_weights(oscillator.tableau, {tau, 0}), {first});
      const double error1 =
        estimate(local_error_weights(oscillator.tableau, {tau, tau, 0}),
                 {second, first});
      std::cout << s << " stages: " << error0 << " for " << start
                << " in the first step, " << error1 << " for "
                << oscillator.local_error << " in the second" << std::endl;
      EXPECT_GT(error0, start);
      EXPECT_GT(error1, 0.7 * oscillator.local_error);
      EXPECT_LT(error1, 10 * oscillator.local_error);
    }
}



// Steps of a motion that constraints prescribe: exact positions in the stages,
// velocities of the method, which have the order s only.
TEST(LocalError, HasTheOrderOfTheMethodForPrescribedMotions)
{
  for (const unsigned int s : {2U, 3U})
    {
      const ButcherTableau tableau = radau_iia(s);
      std::vector<double> errors;
      for (const double tau : {0.2, 0.1})
        {
          std::vector<Eigen::VectorXd> steps;
          double v = -std::sin(0.3);
          for (unsigned int k = 0; k < 5; ++k)
            {
              Eigen::VectorXd u(s);
              for (unsigned int i = 0; i < s; ++i)
                u(i) = std::cos(0.3 + (k + tableau.c(i)) * tau) -
                       std::cos(0.3 + k * tau);
              steps.insert(steps.begin(), u - tau * v * tableau.c);
              v = (tableau.A.inverse() * u)(s - 1) / tau;
            }
          errors.push_back(
            estimate(local_error_weights(tableau, {tau, tau, tau, tau}),
                     steps));
        }
      const double order = std::log2(errors[0] / errors[1]);
      std::cout << s << " stages: order " << order << std::endl;
      EXPECT_NEAR(order, 2 * s, 0.5);
    }
}
