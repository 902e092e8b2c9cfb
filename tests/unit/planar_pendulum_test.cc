// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <vector>

#include "reference/planar_pendulum.h"

namespace
{
  using namespace Reference;

  constexpr double pi = 3.14159265358979323846;

  // With steps larger than the default, which is for reference solutions
  BeamOptions
  options(const BeamTheory theory, const unsigned int n_shape_functions = 12)
  {
    BeamOptions result;
    result.theory            = theory;
    result.n_shape_functions = n_shape_functions;
    result.step_size         = 5e-4;
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

  double
  area(const PlanarBeam &beam)
  {
    return beam.height * beam.width;
  }

  double
  second_moment(const PlanarBeam &beam)
  {
    return beam.width * std::pow(beam.height, 3) / 12;
  }

  double
  shear_stiffness(const PlanarBeam &beam)
  {
    return cowper_coefficient(beam.poissons_ratio) * beam.youngs_modulus /
           (2 * (1 + beam.poissons_ratio)) * area(beam);
  }

  /** Greatest differences of two histories. */
  struct Difference
  {
    double angle      = 0;
    double deflection = 0;
  };

  Difference
  compare(const std::vector<PendulumState> &first,
          const std::vector<PendulumState> &second)
  {
    EXPECT_EQ(first.size(), second.size());
    Difference result;
    for (unsigned int i = 0; i < std::min(first.size(), second.size()); ++i)
      {
        EXPECT_EQ(first[i].time, second[i].time);
        result.angle =
          std::max(result.angle,
                   std::abs(first[i].chord_angle - second[i].chord_angle));
        result.deflection = std::max(result.deflection,
                                     std::abs(first[i].mid_span_deflection -
                                              second[i].mid_span_deflection));
      }
    return result;
  }

  double
  largest_deflection(const std::vector<PendulumState> &history)
  {
    double result = 0;
    for (const PendulumState &state : history)
      result = std::max(result, std::abs(state.mid_span_deflection));
    return result;
  }

  /**
   * The boundary condition of the free end as a determinant, which vanishes at
   * natural frequencies. From shooting with the differential equations of the
   * beam for (w, psi, bending moment, shear force):
   *   w' = psi + Q / (kappa mu A),   psi' = M / (E I),
   *   M' = -Q - rho I omega^2 psi,   Q' = -rho A omega^2 w.
   */
  double
  free_end_determinant(const PlanarBeam &beam,
                       const BeamTheory theory,
                       const bool clamped,
                       const double omega)
  {
    const bool timoshenko  = theory == BeamTheory::timoshenko;
    Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
    system(0, 1)           = 1;
    system(0, 3)           = timoshenko ? 1 / shear_stiffness(beam) : 0;
    system(1, 2)           = 1 / (beam.youngs_modulus * second_moment(beam));
    system(2, 1) =
      timoshenko ? -beam.density * second_moment(beam) * omega * omega : 0;
    system(2, 3) = -1;
    system(3, 0) = -beam.density * area(beam) * omega * omega;
    Eigen::Matrix<double, 4, 2> state = Eigen::Matrix<double, 4, 2>::Zero();
    state(clamped ? 2 : 1, 0) = 1;
    state(3, 1) = 1;
    // The Taylor polynomial of degree 8 of the exponential function
    const unsigned int n_steps        = 200;
    const Eigen::Matrix4d step_system = beam.length / n_steps * system;
    Eigen::Matrix4d transition        = Eigen::Matrix4d::Identity();
    for (unsigned int k = 8; k >= 1; --k)
      transition = Eigen::Matrix4d::Identity() + step_system * transition / k;
    for (unsigned int step = 0; step < n_steps; ++step)
      state = transition * state;
    return state.bottomRows<2>().determinant();
  }

  /**
   * The same mechanical model written down a second time, without Lagrange's
   * equations: the principle of virtual work for material points on a grid of
   * Gauss points, whose velocities and accelerations are differences, with
   * powers of x as shape functions of the same polynomial spaces; integrated
   * with the classical Runge-Kutta method.
   */
  class MaterialPoints
  {
  public:
    MaterialPoints(const PlanarBeam &beam, const BeamOptions &options)
      : beam(beam)
      , timoshenko(options.theory == BeamTheory::timoshenko)
      , n_w(options.n_shape_functions)
      , n_psi(timoshenko ? n_w + 1 : 0)
      , n_u(options.extensible ? n_w : 0)
      , position(Eigen::VectorXd::Zero(1 + n_w + n_psi + n_u))
      , velocity(position)
    {}

    void
    advance(const double end, const unsigned int n_steps)
    {
      const double h = end / n_steps;
      for (unsigned int step = 0; step < n_steps; ++step)
        {
          const Eigen::VectorXd a1 = acceleration(position, velocity);
          const Eigen::VectorXd v2 = velocity + h / 2 * a1;
          const Eigen::VectorXd a2 =
            acceleration(position + h / 2 * velocity, v2);
          const Eigen::VectorXd v3 = velocity + h / 2 * a2;
          const Eigen::VectorXd a3 = acceleration(position + h / 2 * v2, v3);
          const Eigen::VectorXd v4 = velocity + h * a3;
          const Eigen::VectorXd a4 = acceleration(position + h * v3, v4);
          position += h / 6 * (velocity + 2 * v2 + 2 * v3 + v4);
          velocity += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        }
    }

    double
    chord_angle() const
    {
      return position(0);
    }

    double
    mid_span_deflection() const
    {
      return fields(position, beam.length / 2).w;
    }

    double
    tip_distance() const
    {
      return beam.length + fields(position, beam.length).u;
    }

  private:
    struct Fields
    {
      double u, w, psi, strain, curvature, shear;
    };

    // w = sum q_k x^k (1 - x), psi = sum q_k x^k, u = sum q_k x^k, x in [0, 1]
    Fields
    fields(const Eigen::VectorXd &coordinates, const double point) const
    {
      const double L = beam.length;
      const double x = point / L;
      Fields result{0, 0, 0, 0, 0, 0};
      double slope = 0, second_derivative = 0;
      for (unsigned int k = 1; k <= n_w; ++k)
        {
          const double q = coordinates(k);
          result.w += q * std::pow(x, k) * (1 - x);
          slope +=
            q * (k * std::pow(x, k - 1.) - (k + 1.) * std::pow(x, k)) / L;
          second_derivative += q *
                               (k * (k - 1.) * std::pow(x, k - 2.) -
                                (k + 1.) * k * std::pow(x, k - 1.)) /
                               (L * L);
        }
      for (unsigned int k = 0; k < n_psi; ++k)
        {
          const double q = coordinates(1 + n_w + k);
          result.psi += q * std::pow(x, k);
          result.curvature += q * k * std::pow(x, k - 1.) / L;
        }
      for (unsigned int k = 1; k <= n_u; ++k)
        {
          const double q = coordinates(n_w + n_psi + k);
          result.u += q * std::pow(x, k);
          result.strain += q * k * std::pow(x, k - 1.) / L;
        }
      if (!timoshenko)
        result.curvature = second_derivative;
      result.shear = timoshenko ? slope - result.psi : 0;
      return result;
    }

    Eigen::Vector2d
    place(const Eigen::VectorXd &coordinates,
          const double x,
          const double zeta) const
    {
      const Fields field = fields(coordinates, x);
      return Eigen::Rotation2Dd(coordinates(0)) *
             Eigen::Vector2d(x + field.u - zeta * field.psi, field.w + zeta);
    }

    Eigen::VectorXd
    acceleration(const Eigen::VectorXd &Q, const Eigen::VectorXd &V) const
    {
      // Gauss points of degree 9, enough for three shape functions
      const std::array<double, 5> points{{-0.9061798459386640,
                                          -0.5384693101056831,
                                          0,
                                          0.5384693101056831,
                                          0.9061798459386640}};
      const std::array<double, 5> weights{{0.2369268850561891,
                                           0.4786286704993665,
                                           0.5688888888888889,
                                           0.4786286704993665,
                                           0.2369268850561891}};
      const Eigen::Index n  = Q.size();
      Eigen::MatrixXd mass  = Eigen::MatrixXd::Zero(n, n);
      Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          const double x      = beam.length / 2 * (1 + points[p]);
          const double weight = beam.length / 2 * weights[p];
          force += weight * elastic_force(Q, x);
          // A line without a height has no rotary inertia.
          for (const double side : {-1, 1})
            {
              const double zeta =
                timoshenko ? side * beam.height / std::sqrt(12.) : 0;
              const Eigen::MatrixXd J = jacobian(Q, x, zeta);
              const double h          = 2e-3;
              const Eigen::Vector2d without_acceleration =
                (16 * (place(Q + h * V, x, zeta) + place(Q - h * V, x, zeta)) -
                 place(Q + 2 * h * V, x, zeta) - place(Q - 2 * h * V, x, zeta) -
                 30 * place(Q, x, zeta)) /
                (12 * h * h);
              const double point_mass = weight * beam.density * area(beam) / 2;
              mass += point_mass * J.transpose() * J;
              force +=
                point_mass * J.transpose() *
                (without_acceleration + Eigen::Vector2d(0, beam.gravity));
            }
        }
      return -mass.ldlt().solve(force);
    }

    Eigen::MatrixXd
    jacobian(const Eigen::VectorXd &Q, const double x, const double zeta) const
    {
      Eigen::MatrixXd J(2, Q.size());
      for (Eigen::Index i = 0; i < Q.size(); ++i)
        {
          Eigen::VectorXd changed = Q;
          changed(i) += i == 0 ? pi / 2 : 1;
          J.col(i) = place(changed, x, zeta);
          if (i > 0)
            J.col(i) -= place(Q, x, zeta);
        }
      return J;
    }

    Eigen::VectorXd
    elastic_force(const Eigen::VectorXd &Q, const double x) const
    {
      const double E     = beam.youngs_modulus;
      const Fields field = fields(Q, x);
      Eigen::VectorXd result(Q.size());
      for (Eigen::Index i = 0; i < Q.size(); ++i)
        {
          const Fields unit = fields(Eigen::VectorXd::Unit(Q.size(), i), x);
          result(i) =
            E * area(beam) * field.strain * unit.strain +
            E * second_moment(beam) * field.curvature * unit.curvature +
            shear_stiffness(beam) * field.shear * unit.shear;
        }
      result(0) = 0;
      return result;
    }

    const PlanarBeam beam;
    const bool timoshenko;
    const unsigned int n_w, n_psi, n_u;
    Eigen::VectorXd position;
    Eigen::VectorXd velocity;
  };

  /** Thick and soft: every term of the equations is large. */
  void
  compare_with_material_points(const BeamTheory theory, const bool extensible)
  {
    PlanarBeam beam;
    beam.length           = 1.2;
    beam.height           = 0.25;
    beam.youngs_modulus   = 1.5e6;
    BeamOptions settings  = options(theory, 3);
    settings.extensible   = extensible;
    settings.step_size    = 1e-3;
    const double end      = 0.5;
    const auto history    = swing_pendulum(beam, settings, {end});
    const PendulumState s = history.front();
    MaterialPoints points(beam, settings);
    points.advance(end, 1000);
    EXPECT_LT(s.chord_angle, -1);
    EXPECT_GT(std::abs(s.mid_span_deflection), 1e-2);
    EXPECT_NEAR(s.chord_angle, points.chord_angle(), 1e-7);
    EXPECT_NEAR(s.mid_span_deflection, points.mid_span_deflection(), 1e-7);
    EXPECT_NEAR(std::hypot(s.tip_y, s.tip_z), points.tip_distance(), 1e-7);
    EXPECT_NEAR(std::atan2(s.tip_z, s.tip_y), s.chord_angle, 1e-12);
    EXPECT_EQ(points.tip_distance() > beam.length + 1e-2, extensible);
  }
} // namespace

TEST(PlanarPendulum, MaterialPointsOfBernoulliAndEuler)
{
  compare_with_material_points(BeamTheory::bernoulli_euler, false);
}

TEST(PlanarPendulum, MaterialPointsOfTimoshenkoWithExtension)
{
  compare_with_material_points(BeamTheory::timoshenko, true);
}

TEST(PlanarPendulum, FrequenciesOfBernoulliAndEuler)
{
  const PlanarBeam beam;
  const double factor = std::sqrt(beam.youngs_modulus * second_moment(beam) /
                                  (beam.density * area(beam)));
  const BeamOptions settings = options(BeamTheory::bernoulli_euler);
  // Roots of tan(x) = tanh(x) and of cos(x) cosh(x) = -1
  const std::array<double, 3> pinned{
    {3.926602312047919, 7.068582745628732, 10.21017612281303}};
  const std::array<double, 3> clamped{
    {1.875104068711961, 4.694091132974174, 7.854757438237613}};
  const auto pinned_free  = pinned_free_frequencies(beam, settings);
  const auto clamped_free = clamped_free_frequencies(beam, settings);
  ASSERT_EQ(pinned_free.size(), 12u);
  ASSERT_EQ(clamped_free.size(), 12u);
  for (unsigned int i = 0; i < 3; ++i)
    {
      EXPECT_NEAR(pinned_free[i] / (factor * pinned[i] * pinned[i]), 1, 1e-7);
      EXPECT_NEAR(clamped_free[i] / (factor * clamped[i] * clamped[i]),
                  1,
                  1e-7);
    }
}

TEST(PlanarPendulum, FrequenciesAreThoseOfTheDifferentialEquations)
{
  const PlanarBeam beam;
  for (const BeamTheory theory :
       {BeamTheory::bernoulli_euler, BeamTheory::timoshenko})
    for (const bool clamped : {false, true})
      {
        const auto frequencies =
          clamped ? clamped_free_frequencies(beam, options(theory))
                  : pinned_free_frequencies(beam, options(theory));
        for (unsigned int i = 0; i < 4; ++i)
          {
            const double omega = frequencies[i];
            EXPECT_LT(
              free_end_determinant(beam, theory, clamped, omega * (1 - 1e-6)) *
                free_end_determinant(beam, theory, clamped, omega * (1 + 1e-6)),
              0);
          }
      }
}

TEST(PlanarPendulum, ShearAndRotaryInertiaLowerTheFirstFrequency)
{
  const PlanarBeam beam;
  const double bernoulli_euler =
    pinned_free_frequencies(beam, options(BeamTheory::bernoulli_euler))[0];
  const double timoshenko =
    pinned_free_frequencies(beam, options(BeamTheory::timoshenko))[0];
  EXPECT_NEAR(1 - timoshenko / bernoulli_euler, 0.0065, 0.0003);
}

TEST(PlanarPendulum, StaticDeflection)
{
  const PlanarBeam beam;
  const double L       = beam.length;
  const double load    = beam.density * area(beam) * beam.gravity;
  const double bending = 5 * load * std::pow(L, 4) /
                         (384 * beam.youngs_modulus * second_moment(beam));
  BeamOptions settings = options(BeamTheory::bernoulli_euler, 4);
  EXPECT_NEAR(supported_static_deflection(beam, settings) / -bending, 1, 1e-12);
  settings.theory    = BeamTheory::timoshenko;
  const double shear = load * L * L / (8 * shear_stiffness(beam));
  EXPECT_NEAR(supported_static_deflection(beam, settings) / -(bending + shear),
              1,
              1e-12);
  settings.shear_coefficient = cowper_coefficient(beam.poissons_ratio) / 100;
  EXPECT_NEAR(supported_static_deflection(beam, settings) /
                -(bending + 100 * shear),
              1,
              1e-12);
}

TEST(PlanarPendulum, RigidPendulumIsVerticalAfterAQuarterOfItsPeriod)
{
  PlanarBeam beam;
  beam.youngs_modulus *= 1e6;
  for (const BeamTheory theory :
       {BeamTheory::bernoulli_euler, BeamTheory::timoshenko})
    {
      // A pendulum that swings by a right angle to both sides: K(sin(pi / 4)).
      // The moment of inertia m L^2 / 3 grows by the rotary one, m H^2 / 12.
      const double radius = theory == BeamTheory::timoshenko
                              ? std::pow(beam.height / beam.length, 2) / 4
                              : 0;
      const double omega =
        std::sqrt(1.5 * beam.gravity / beam.length / (1 + radius));
      const double quarter = std::comp_ellint_1(std::sqrt(0.5)) / omega;
      const auto history =
        swing_pendulum(beam, options(theory), {quarter, 2 * quarter});
      EXPECT_NEAR(history[0].chord_angle, -pi / 2, 2e-8);
      EXPECT_NEAR(history[1].chord_angle, -pi, 2e-8);
      EXPECT_NEAR(history[0].kinetic_energy,
                  beam.density * area(beam) * beam.gravity * beam.length *
                    beam.length / 2,
                  1e-7);
    }
}

TEST(PlanarPendulum, RigidPendulumFollowsItsDifferentialEquation)
{
  PlanarBeam beam;
  beam.youngs_modulus *= 1e6;
  const auto times = equidistant(1, 10);
  const auto history =
    swing_pendulum(beam, options(BeamTheory::bernoulli_euler), times);
  // theta'' = -3 g / (2 L) cos(theta), by Stoermer's rule with extrapolation
  const auto rigid_angle = [&](const double end, const unsigned int n_steps) {
    const double h          = end / n_steps;
    double angle            = 0;
    double half             = 0;
    const auto acceleration = [&](const double theta) {
      return -1.5 * beam.gravity / beam.length * std::cos(theta);
    };
    for (unsigned int step = 0; step < n_steps; ++step)
      {
        half += h / 2 * acceleration(angle);
        angle += h * half;
        half += h / 2 * acceleration(angle);
      }
    return angle;
  };
  for (unsigned int i = 1; i < times.size(); ++i)
    {
      const double angle =
        (4 * rigid_angle(times[i], 4000) - rigid_angle(times[i], 2000)) / 3;
      EXPECT_NEAR(history[i].chord_angle, angle, 2e-8);
      EXPECT_LT(std::abs(history[i].mid_span_deflection), 2e-8);
    }
}

TEST(PlanarPendulum, EnergyIsConserved)
{
  const PlanarBeam beam;
  for (const bool extensible : {false, true})
    {
      BeamOptions settings = options(BeamTheory::timoshenko);
      settings.extensible  = extensible;
      const auto history = swing_pendulum(beam, settings, equidistant(1, 100));
      EXPECT_EQ(history[0].kinetic_energy, 0);
      EXPECT_EQ(history[0].elastic_energy, 0);
      EXPECT_EQ(history[0].potential_energy, 0);
      double largest = 0;
      for (const PendulumState &state : history)
        {
          EXPECT_NEAR(state.total_energy(), 0, 1e-9);
          largest = std::max(largest, state.elastic_energy);
        }
      EXPECT_GT(largest, 1e-3);
    }
}

TEST(PlanarPendulum, ElongationByCentrifugalForceAndWeight)
{
  // Vertical, with omega^2 = 3 g / L: the integral of the tension over E A is
  // (m omega^2 L^3 / 3 + m g L^2 / 2) / (E A), in a beam that hardly bends.
  PlanarBeam beam;
  beam.youngs_modulus *= 1e4;
  BeamOptions settings = options(BeamTheory::bernoulli_euler, 4);
  settings.extensible  = true;
  const double quarter = std::comp_ellint_1(std::sqrt(0.5)) /
                         std::sqrt(1.5 * beam.gravity / beam.length);
  const auto history      = swing_pendulum(beam, settings, {quarter});
  const double elongation = 1.5 * beam.density * beam.gravity * beam.length *
                            beam.length / beam.youngs_modulus;
  EXPECT_NEAR((std::hypot(history[0].tip_y, history[0].tip_z) - beam.length) /
                elongation,
              1,
              0.01);
}

TEST(PlanarPendulum, ConvergesWithTheNumberOfShapeFunctions)
{
  const PlanarBeam beam;
  const auto times = equidistant(1, 20);
  for (const BeamTheory theory :
       {BeamTheory::bernoulli_euler, BeamTheory::timoshenko})
    {
      const auto finest = swing_pendulum(beam, options(theory, 18), times);
      std::vector<Difference> errors;
      for (const unsigned int n : {4, 8, 12})
        errors.push_back(
          compare(swing_pendulum(beam, options(theory, n), times), finest));
      EXPECT_LT(errors[1].deflection, errors[0].deflection / 10);
      EXPECT_LT(errors[2].deflection, errors[1].deflection / 4);
      EXPECT_LT(errors[2].deflection, 5e-6);
      EXPECT_LT(errors[1].angle, errors[0].angle / 10);
      EXPECT_LT(errors[2].angle, errors[1].angle / 4);
      EXPECT_LT(errors[2].angle, 5e-6);
    }
}

TEST(PlanarPendulum, ConvergesWithTheTenthOrderOfTheStepSize)
{
  const PlanarBeam beam;
  const auto times     = equidistant(0.96, 4);
  BeamOptions settings = options(BeamTheory::bernoulli_euler, 3);
  const auto finest    = swing_pendulum(beam, settings, times);
  std::vector<double> errors;
  for (const double step_size : {8e-3, 4e-3})
    {
      settings.step_size = step_size;
      errors.push_back(
        compare(swing_pendulum(beam, settings, times), finest).deflection);
    }
  EXPECT_GT(errors[1], 1e-11); // far above rounding
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 10, 0.6);
}

TEST(PlanarPendulum, DefaultStepSizeIsAccurate)
{
  const PlanarBeam beam;
  const auto times = equidistant(0.4, 8);
  for (const BeamTheory theory :
       {BeamTheory::bernoulli_euler, BeamTheory::timoshenko})
    {
      BeamOptions settings;
      settings.theory    = theory;
      const auto history = swing_pendulum(beam, settings, times);
      settings.step_size /= 2;
      const Difference error =
        compare(swing_pendulum(beam, settings, times), history);
      EXPECT_LT(error.angle, 1e-9);
      EXPECT_LT(error.deflection, 1e-9);
    }
}

TEST(PlanarPendulum, StatesDoNotDependOnTheOtherTimes)
{
  const PlanarBeam beam;
  const BeamOptions settings = options(BeamTheory::bernoulli_euler, 4);
  const auto few             = swing_pendulum(beam, settings, {0.2, 0.2});
  const auto many =
    swing_pendulum(beam, settings, {0, 0.01, 0.03 + pi / 1e3, 0.15, 0.2});
  EXPECT_EQ(many[0].chord_angle, 0);
  EXPECT_EQ(many[0].tip_y, beam.length);
  EXPECT_NEAR(few[0].chord_angle, many[4].chord_angle, 1e-11);
  EXPECT_NEAR(few[0].mid_span_deflection, many[4].mid_span_deflection, 1e-11);
  EXPECT_EQ(few[0].chord_angle, few[1].chord_angle);
}

TEST(PlanarPendulum, WrongInputIsRejected)
{
  const BeamOptions right;
  for (double PlanarBeam::*const member : {&PlanarBeam::length,
                                           &PlanarBeam::height,
                                           &PlanarBeam::width,
                                           &PlanarBeam::youngs_modulus,
                                           &PlanarBeam::density})
    for (const double value : {0., -1., std::nan("")})
      {
        PlanarBeam beam;
        beam.*member = value;
        EXPECT_THROW(swing_pendulum(beam, right, {0}), std::invalid_argument);
        EXPECT_THROW(clamped_free_frequencies(beam, right),
                     std::invalid_argument);
      }
  PlanarBeam beam;
  beam.poissons_ratio = 0.6;
  EXPECT_THROW(supported_static_deflection(beam, right), std::invalid_argument);
  beam                    = PlanarBeam();
  BeamOptions wrong       = right;
  wrong.n_shape_functions = 0;
  EXPECT_THROW(pinned_free_frequencies(beam, wrong), std::invalid_argument);
  wrong           = right;
  wrong.step_size = 0;
  EXPECT_THROW(swing_pendulum(beam, wrong, {0}), std::invalid_argument);
  wrong                   = right;
  wrong.shear_coefficient = 0;
  EXPECT_THROW(swing_pendulum(beam, wrong, {0}), std::invalid_argument);
  EXPECT_THROW(swing_pendulum(beam, right, {-1}), std::invalid_argument);
  EXPECT_THROW(swing_pendulum(beam, right, {1e-3, 0}), std::invalid_argument);
}

// Prints the figures that simulations of the pendulum of Gerstmayr and
// Schoeberl are compared with.
TEST(PlanarPendulum, PendulumOfGerstmayrAndSchoeberl)
{
  const PlanarBeam beam;
  const auto times = equidistant(1, 1000);
  BeamOptions settings;
  const auto timoshenko      = swing_pendulum(beam, settings, times);
  settings.theory            = BeamTheory::bernoulli_euler;
  const auto bernoulli_euler = swing_pendulum(beam, settings, times);
  std::printf(
    "            Bernoulli-Euler             Timoshenko\n"
    "time [s]    angle [rad] deflection [m]  angle [rad] "
    "deflection [m]\n");
  for (const unsigned int i : {100, 200, 300, 500, 700, 1000})
    std::printf("%-8.1f %14.8f %14.6e %12.8f %14.6e\n",
                times[i],
                bernoulli_euler[i].chord_angle,
                bernoulli_euler[i].mid_span_deflection,
                timoshenko[i].chord_angle,
                timoshenko[i].mid_span_deflection);
  const Difference difference = compare(bernoulli_euler, timoshenko);
  const double largest        = largest_deflection(bernoulli_euler);
  std::printf(
    "largest deflection %.6e m, %.6e m; largest differences "
    "%.6e rad, %.6e m\n",
    largest,
    largest_deflection(timoshenko),
    difference.angle,
    difference.deflection);
  EXPECT_NEAR(difference.deflection / largest, 0.1, 0.03);
  // The load m g (1 - 3 x / (2 L)) of the released rigid beam, m g / 4 on the
  // average, is there at once: about twice its static deflection.
  EXPECT_NEAR(largest / std::abs(supported_static_deflection(
                          beam, options(BeamTheory::bernoulli_euler))),
              0.5,
              0.05);
  // Extension hardly matters for the deflection.
  settings            = options(BeamTheory::timoshenko);
  settings.extensible = true;
  EXPECT_LT(
    compare(swing_pendulum(beam, settings, times), timoshenko).deflection,
    2e-3 * largest);
}
