// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "reference/ivp_slider_crank.h"

namespace
{
  using namespace Reference;

  IvpOptions
  options(const RodModel model, const unsigned int n_shape_functions = 10)
  {
    IvpOptions result;
    result.model             = model;
    result.n_shape_functions = n_shape_functions;
    return result;
  }

  std::vector<double>
  equidistant(const double end, const unsigned int n_intervals)
  {
    std::vector<double> times;
    for (unsigned int i = 0; i <= n_intervals; ++i)
      times.push_back(end * i / n_intervals);
    return times;
  }

  const std::array<RodModel, 4> all_models{{RodModel::published,
                                            RodModel::consistent_mass,
                                            RodModel::bernoulli_euler,
                                            RodModel::timoshenko}};

  /** Greatest differences of two histories. */
  struct Difference
  {
    double angle = 0, slider = 0, first_sine = 0, mid_span = 0;
    std::array<double, 3> multipliers{};
  };

  Difference
  compare(const std::vector<IvpSliderCrankState> &first,
          const std::vector<IvpSliderCrankState> &second)
  {
    EXPECT_EQ(first.size(), second.size());
    Difference result;
    const auto update = [](double &largest, const double a, const double b) {
      largest = std::max(largest, std::abs(a - b));
    };
    for (unsigned int i = 0; i < std::min(first.size(), second.size()); ++i)
      {
        const IvpSliderCrankState &a = first[i];
        const IvpSliderCrankState &b = second[i];
        update(result.angle, a.rod_angle, b.rod_angle);
        update(result.slider, a.slider_position, b.slider_position);
        update(result.first_sine, a.displacements[0], b.displacements[0]);
        update(result.mid_span, a.mid_span_deflection, b.mid_span_deflection);
        for (unsigned int k = 0; k < 3; ++k)
          update(result.multipliers[k], a.multipliers[k], b.multipliers[k]);
      }
    return result;
  }
} // namespace

// The reference solution and the initial accelerations and multipliers that
// come with the test set
TEST(IvpSliderCrankReference, PublishedValues)
{
  const auto history = drive_slider_crank({}, {}, {0, 0.1});

  const IvpSliderCrankState &start = history[0];
  EXPECT_NEAR(start.rod_angular_velocity, -0.749957670e2, 5e-8);
  EXPECT_NEAR(start.slider_position, 0.450016933, 5e-10);
  EXPECT_NEAR(start.slider_velocity, -0.268938672e-5, 1e-13);
  EXPECT_NEAR(start.multipliers[0], -6.397251492537153e-08, 1e-8);
  EXPECT_NEAR(start.multipliers[1], 3.824589508329281e2, 1e-6);
  EXPECT_NEAR(start.multipliers[2], -4.376060460948886e-09, 1e-9);

  // The test set has pi = 3.1415927, which alone changes q1 by 4e-11 m, and
  // only the derivatives of the constraints: its slider starts 2e-10 m off.
  const IvpSliderCrankState &end = history[1];
  EXPECT_NEAR(end.rod_angle, -0.3311734988256260, 1e-12);
  EXPECT_NEAR(end.slider_position, 0.1697373328427860, 3e-10);
  EXPECT_NEAR(end.displacements[0], 0.1893192899613509e-3, 1e-10);
  EXPECT_NEAR(end.displacements[1], 0.2375751249879174e-4, 1e-11);
  EXPECT_NEAR(end.displacements[2], -0.5323896770569702e-5, 1e-12);
  EXPECT_NEAR(end.displacements[3], -0.8363313279112129e-5, 1e-12);
  EXPECT_NEAR(end.rod_angular_velocity, 0.6025346755138369e2, 1e-8);
  EXPECT_NEAR(end.slider_velocity, -0.8753116326670527e1, 1e-9);
  EXPECT_NEAR(end.velocities[0], -0.3005541400289738e-1, 2e-7);
  EXPECT_NEAR(end.velocities[1], -0.5500431812571696e-2, 2e-8);
  EXPECT_NEAR(end.velocities[2], 0.4974111734266989e-3, 2e-9);
  EXPECT_NEAR(end.velocities[3], 0.1105560003626645e-2, 2e-9);
  EXPECT_NEAR(end.multipliers[0], -0.6232935833287916e2, 1e-5);
  EXPECT_NEAR(end.multipliers[1], -0.1637920993367306e3, 1e-5);
  EXPECT_NEAR(end.multipliers[2], 0.2529857947066878e2, 1e-5);
  EXPECT_NEAR(end.mid_span_deflection, end.displacements[0], 1e-17);
}

TEST(IvpSliderCrankReference, TorqueDoesTheWork)
{
  for (const RodModel model : all_models)
    {
      // Short intervals: Simpson's rule has to resolve the vibrations, with
      // the theory of Timoshenko up to 1e6 rad/s.
      const unsigned int n_intervals = 4000;
      const double end               = 0.005;
      const auto history             = drive_slider_crank({},
                                              options(model, 4),
                                              equidistant(end, n_intervals));
      const double h                 = end / n_intervals;
      double work                    = 0;
      for (unsigned int i = 0; i + 2 <= n_intervals; i += 2)
        work -= 150 * h / 3 *
                (history[i].multipliers[2] + 4 * history[i + 1].multipliers[2] +
                 history[i + 2].multipliers[2]);
      const auto energy = [](const IvpSliderCrankState &state) {
        return state.kinetic_energy + state.elastic_energy;
      };
      const double change = energy(history.back()) - energy(history.front());
      EXPECT_GT(std::abs(change), 30);
      // Measured: 4e-8, the error of the quadrature
      EXPECT_NEAR(work, change, 1e-6);
    }
}

TEST(IvpSliderCrankReference, MultiplierAcceleratesTheSlider)
{
  const IvpSliderCrank mechanism;
  for (const RodModel model : all_models)
    {
      const double h     = 1e-7;
      const auto history = drive_slider_crank(mechanism,
                                              options(model, 4),
                                              {0.01 - h, 0.01, 0.01 + h});
      EXPECT_NEAR(history[1].multipliers[1],
                  -mechanism.slider_mass *
                    (history[2].slider_velocity - history[0].slider_velocity) /
                    (2 * h),
                  1e-3);
    }
}

TEST(IvpSliderCrankReference, GeometryAndInitialFieldAreThoseOfTheModel)
{
  const IvpSliderCrank mechanism;
  const double L = mechanism.rod.length;
  for (const RodModel model : all_models)
    {
      const auto history =
        drive_slider_crank(mechanism, options(model, 12), {0, 0.004});
      for (unsigned int i = 0; i < 4; ++i)
        {
          EXPECT_NEAR(history[0].displacements[i],
                      mechanism.displacements[i],
                      1e-16);
          EXPECT_NEAR(history[0].velocities[i], mechanism.velocities[i], 1e-9);
        }
      const IvpSliderCrankState &s = history[1];
      const double chord           = L + s.displacements[3];
      EXPECT_NEAR(0.15 * std::sin(0.6) + chord * std::sin(s.rod_angle),
                  0,
                  1e-14);
      EXPECT_NEAR(0.15 * std::cos(0.6) + chord * std::cos(s.rod_angle),
                  s.slider_position,
                  1e-14);
    }
  const RodField middle = rod_field({{1, 2, 3, 4}}, L / 2, L);
  EXPECT_NEAR(middle.axial, 3, 1e-14);
  EXPECT_NEAR(middle.lateral, 1, 1e-14);
  const RodField quarter = rod_field({{1, 2, 3, 4}}, L / 4, L);
  EXPECT_NEAR(quarter.axial, 0.75 * 3 - 0.125 * 4, 1e-14);
  EXPECT_NEAR(quarter.lateral, std::sqrt(0.5) + 2, 1e-14);
  const RodField end = rod_field({{1, 2, 3, 4}}, L, L);
  EXPECT_NEAR(end.axial, 4, 1e-14);
  EXPECT_NEAR(end.lateral, 0, 1e-14);
}

// The forces on a nearly rigid rod from the accelerations a0 and a1 of its
// ends: moments about the end of the crank, then the sum of the forces.
TEST(IvpSliderCrankReference, MultipliersAreTheForcesOnARigidRod)
{
  IvpSliderCrank mechanism;
  const double factor = 1e5;
  mechanism.rod.youngs_modulus *= factor;
  for (unsigned int i = 0; i < 4; ++i)
    {
      mechanism.displacements[i] /= factor;
      mechanism.velocities[i] /= factor;
    }
  const double l1    = mechanism.crank_length;
  const double L     = mechanism.rod.length;
  const double omega = mechanism.angular_velocity;
  const double h     = mechanism.rod.height;
  const double mass  = mechanism.rod.density * h * h * L;
  for (const double time : {0.0013, 0.009, 0.017})
    {
      const double sine   = std::sin(omega * time);
      const double cosine = std::cos(omega * time);
      const double angle  = -std::asin(l1 / L * sine);
      const double c      = std::cos(angle);
      const double s      = std::sin(angle);
      const double rate   = -l1 / L * omega * cosine / c;
      const double rate_dot =
        (l1 / L * omega * omega * sine + s * rate * rate) / c;
      const double a0_x    = -omega * omega * l1 * cosine;
      const double a0_y    = -omega * omega * l1 * sine;
      const double a1_x    = a0_x - L * (s * rate_dot + c * rate * rate);
      const double lambda2 = -mechanism.slider_mass * a1_x;
      // c F_y - s F_x = moment / L with F = (lambda2, -lambda1) on the end
      const double moment = mass * (c * a0_y / 6 - s * (a0_x / 6 + a1_x / 3)) +
                            mass * h * h / 12 / L * rate_dot;
      const double lambda1 = -(moment + s * lambda2) / c;
      const double pin_x   = mass * (a0_x + a1_x) / 2 - lambda2;
      const double pin_y   = mass * a0_y / 2 + lambda1;
      const double torque  = l1 * (cosine * pin_y - sine * pin_x);
      const auto state     = drive_slider_crank(mechanism, {}, {time}).front();
      // Measured: 8e-11 rad and 2e-5 N
      EXPECT_NEAR(state.rod_angle, angle, 1e-9);
      EXPECT_NEAR(state.multipliers[0], lambda1, 1e-4);
      EXPECT_NEAR(state.multipliers[1], lambda2, 1e-4);
      EXPECT_NEAR(state.multipliers[2], -torque, 1e-4);
    }
}

TEST(IvpSliderCrankReference, DefaultStepSizeIsAccurate)
{
  const auto times = equidistant(0.05, 10);
  for (const RodModel model : all_models)
    {
      IvpOptions settings = options(model, 6);
      const auto history  = drive_slider_crank({}, settings, times);
      settings.step_size /= 2;
      const Difference error =
        compare(drive_slider_crank({}, settings, times), history);
      EXPECT_LT(error.angle, 1e-9);
      EXPECT_LT(error.slider, 1e-9);
      EXPECT_LT(error.mid_span, 1e-10);
      // The polynomials of high degree vibrate at frequencies that the step
      // does not resolve: measured 0.1 N, in the test set's models 2e-7 N.
      const bool sines =
        model == RodModel::published || model == RodModel::consistent_mass;
      EXPECT_LT(error.multipliers[0], sines ? 1e-6 : 1);
      EXPECT_LT(error.multipliers[1], sines ? 1e-6 : 1);
      EXPECT_LT(error.multipliers[2], sines ? 1e-6 : 0.1);
    }
}

TEST(IvpSliderCrankReference, WrongInputIsRejected)
{
  const auto reject = [](const IvpSliderCrank &mechanism,
                         const IvpOptions &settings) {
    EXPECT_THROW(drive_slider_crank(mechanism, settings, {0}),
                 std::invalid_argument);
  };
  for (const double length : {0., -0.1, 0.3, std::nan("")})
    {
      IvpSliderCrank mechanism;
      mechanism.crank_length = length;
      reject(mechanism, {});
    }
  IvpSliderCrank mechanism;
  mechanism.slider_mass = -1;
  reject(mechanism, {});
  mechanism             = IvpSliderCrank();
  mechanism.rod.gravity = 9.81;
  reject(mechanism, {});
  mechanism            = IvpSliderCrank();
  mechanism.rod.height = 0;
  reject(mechanism, {});
  reject({}, options(RodModel::timoshenko, 1));
  IvpOptions settings;
  settings.step_size = 0;
  reject({}, settings);
  EXPECT_THROW(drive_slider_crank({}, {}, {1e-3, 0}), std::invalid_argument);
}

// Prints what a rod with more freedom does differently. Its mass makes the
// initial values less smooth: the rod vibrates along its axis, which the
// multipliers show.
TEST(IvpSliderCrankReference, ModelsOfTheRod)
{
  const auto times     = equidistant(0.1, 200);
  const auto published = drive_slider_crank({}, {}, times);
  double deflection    = 0;
  for (const IvpSliderCrankState &state : published)
    deflection = std::max(deflection, std::abs(state.mid_span_deflection));
  const std::array<const char *, 4> names{
    {"", "consistent mass", "Bernoulli-Euler", "Timoshenko"}};
  std::printf(
    "largest deflection %.6e m; differences from the published model\n"
    "                 rod angle [rad]  slider [m]  sine [m]  middle "
    "[m]  multipliers [N], [N], [N m]\n",
    deflection);
  for (unsigned int i = 1; i < 4; ++i)
    {
      const Difference difference =
        compare(drive_slider_crank({}, options(all_models[i], 6), times),
                published);
      std::printf("%-16s %15.1e %11.1e %9.1e %11.1e %9.1f %.1f %.2f\n",
                  names[i],
                  difference.angle,
                  difference.slider,
                  difference.first_sine,
                  difference.mid_span,
                  difference.multipliers[0],
                  difference.multipliers[1],
                  difference.multipliers[2]);
      EXPECT_LT(difference.angle, 5e-7);
      EXPECT_LT(difference.slider, 3e-7);
      // The third sine alone is 4e-3.
      EXPECT_LT(difference.mid_span, 5e-3 * deflection);
    }
}
