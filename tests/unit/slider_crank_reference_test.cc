// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "reference/slider_crank.h"

namespace
{
  using namespace Reference;

  constexpr double pi = 3.14159265358979323846;

  // Gauss points of degree 9 and weights on [-1, 1]
  constexpr std::array<double, 5> points{{-0.9061798459386640,
                                          -0.5384693101056831,
                                          0,
                                          0.5384693101056831,
                                          0.9061798459386640}};
  constexpr std::array<double, 5> weights{{0.2369268850561891,
                                           0.4786286704993665,
                                           0.5688888888888889,
                                           0.4786286704993665,
                                           0.2369268850561891}};

  BeamOptions
  options(const BeamTheory theory, const unsigned int n_shape_functions)
  {
    BeamOptions result;
    result.theory            = theory;
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

  double
  area(const SliderCrank &mechanism)
  {
    return mechanism.height * mechanism.width;
  }

  double
  second_moment(const SliderCrank &mechanism)
  {
    return mechanism.width * std::pow(mechanism.height, 3) / 12;
  }

  double
  shear_stiffness(const SliderCrank &mechanism)
  {
    return cowper_coefficient(mechanism.poissons_ratio) *
           mechanism.youngs_modulus / (2 * (1 + mechanism.poissons_ratio)) *
           area(mechanism);
  }

  /** Greatest differences of two histories. */
  struct Difference
  {
    double angle      = 0;
    double deflection = 0;
  };

  Difference
  compare(const std::vector<SliderCrankState> &first,
          const std::vector<SliderCrankState> &second)
  {
    EXPECT_EQ(first.size(), second.size());
    Difference result;
    for (unsigned int i = 0; i < std::min(first.size(), second.size()); ++i)
      {
        const SliderCrankState &a = first[i];
        const SliderCrankState &b = second[i];
        EXPECT_EQ(a.time, b.time);
        result.angle = std::max({result.angle,
                                 std::abs(a.crank_angle - b.crank_angle),
                                 std::abs(a.rod_angle - b.rod_angle)});
        result.deflection =
          std::max({result.deflection,
                    std::abs(a.crank_deflection - b.crank_deflection),
                    std::abs(a.rod_deflection - b.rod_deflection)});
      }
    return result;
  }

  /**
   * Time at which the rigid mechanism has the crank angle for the first time,
   * from its energies: with the velocities of the ends, v_0 and v_1, a line
   * with mass has the kinetic energy m (v_0.v_0 + v_0.v_1 + v_1.v_1) / 6. With
   * angle = -s^2 the integrand dt/ds is smooth at the start.
   */
  double
  rigid_time(const SliderCrank &mechanism, const double angle)
  {
    const double L1   = mechanism.crank_length;
    const double L2   = mechanism.rod_length;
    const double mass = mechanism.density * area(mechanism);
    const auto rate   = [&](const double s) {
      const double sine     = std::sin(-s * s);
      const double cosine   = std::cos(-s * s);
      const double rod_sine = -L1 / L2 * sine;
      // all for the angular velocity 1 of the crank
      const double rod_rate =
        -L1 * cosine / (L2 * std::sqrt(1 - rod_sine * rod_sine));
      const double slider = -L1 * sine - L2 * rod_sine * rod_rate;
      const double doubled_kinetic =
        mass * std::pow(L1, 3) / 3 +
        mass * L2 / 3 * (L1 * L1 - L1 * sine * slider + slider * slider);
      const double potential =
        mass * mechanism.gravity * L1 / 2 * (L1 + L2) * sine;
      return 2 * s * std::sqrt(doubled_kinetic / (-2 * potential));
    };
    const unsigned int n_intervals = 100;
    const double h                 = std::sqrt(-angle) / n_intervals;
    double time                    = 0;
    for (unsigned int i = 0; i < n_intervals; ++i)
      for (unsigned int p = 0; p < points.size(); ++p)
        time += h / 2 * weights[p] * rate(h * (i + (1 + points[p]) / 2));
    return time;
  }

  /**
   * The conditions at the hinge and at the slider as a determinant, which
   * vanishes at natural frequencies. From shooting with the differential
   * equations of the stretched beams for (w, psi, bending moment, shear force):
   *   w' = psi + Q / (kappa mu A),   psi' = M / (E I),
   *   M' = -Q - rho I omega^2 psi,   Q' = -rho A omega^2 w.
   */
  double
  slider_determinant(const SliderCrank &mechanism,
                     const BeamTheory theory,
                     const double omega)
  {
    const bool timoshenko  = theory == BeamTheory::timoshenko;
    Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
    system(0, 1)           = 1;
    system(0, 3)           = timoshenko ? 1 / shear_stiffness(mechanism) : 0;
    system(1, 2) = 1 / (mechanism.youngs_modulus * second_moment(mechanism));
    system(2, 1) =
      timoshenko ? -mechanism.density * second_moment(mechanism) * omega * omega
                 : 0;
    system(2, 3) = -1;
    system(3, 0) = -mechanism.density * area(mechanism) * omega * omega;
    const auto transition = [&](const double length) {
      // Steps with the Taylor polynomial of degree 8
      const unsigned int n_steps   = 200;
      const Eigen::Matrix4d scaled = length / n_steps * system;
      Eigen::Matrix4d step         = Eigen::Matrix4d::Identity();
      for (unsigned int k = 8; k >= 1; --k)
        step = Eigen::Matrix4d::Identity() + scaled * step / k;
      Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
      for (unsigned int i = 0; i < n_steps; ++i)
        result = step * result;
      return result;
    };
    // Unknown: rotation and shear force at the start, jump of the rotation
    Eigen::Matrix<double, 4, 3> state = Eigen::Matrix<double, 4, 3>::Zero();
    state(1, 0)                       = 1;
    state(3, 1)                       = 1;
    state = transition(mechanism.crank_length) * state;
    Eigen::Matrix3d conditions;
    conditions.row(0) = state.row(2);
    state(1, 2)       = 1;
    state             = transition(mechanism.rod_length) * state;
    conditions.row(1) = state.row(0);
    conditions.row(2) = state.row(2);
    return conditions.determinant();
  }

  /**
   * The same mechanical model written down a second time, without Lagrange's
   * equations, relative motion and minimal coordinates: the principle of
   * virtual work for material points on a grid of Gauss points, whose
   * velocities and accelerations are differences, with powers of x as shape
   * functions of the same polynomial spaces and a Lagrange multiplier for the
   * slider; integrated with the classical Runge-Kutta method.
   */
  class MaterialPoints
  {
  public:
    MaterialPoints(const SliderCrank &mechanism, const BeamOptions &options)
      : mechanism(mechanism)
      , timoshenko(options.theory == BeamTheory::timoshenko)
      , n_w(options.n_shape_functions)
      , n_psi(timoshenko ? n_w + 1 : 0)
      , n_u(options.extensible ? n_w : 0)
      , n(1 + n_w + n_psi + n_u)
      , position(Eigen::VectorXd::Zero(2 * n))
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
    angle(const unsigned int body) const
    {
      return position(body * n);
    }

    double
    mid_span_deflection(const unsigned int body) const
    {
      return fields(position, body, length(body) / 2).w;
    }

    double
    chord(const unsigned int body) const
    {
      return length(body) + fields(position, body, length(body)).u;
    }

    Eigen::Vector2d
    slider() const
    {
      return place(position, 1, mechanism.rod_length, 0);
    }

  private:
    struct Fields
    {
      double u, w, psi, strain, curvature, shear;
    };

    double
    length(const unsigned int body) const
    {
      return body == 0 ? mechanism.crank_length : mechanism.rod_length;
    }

    // w = sum q_k x^k (1 - x), psi = sum q_k x^k, u = sum q_k x^k, x in [0, 1]
    Fields
    fields(const Eigen::VectorXd &coordinates,
           const unsigned int body,
           const double point) const
    {
      const double L = length(body);
      const double x = point / L;
      const auto q   = coordinates.segment(body * n + 1, n - 1);
      Fields result{0, 0, 0, 0, 0, 0};
      double slope = 0, second_derivative = 0;
      for (unsigned int k = 1; k <= n_w; ++k)
        {
          result.w += q(k - 1) * std::pow(x, k) * (1 - x);
          slope += q(k - 1) *
                   (k * std::pow(x, k - 1.) - (k + 1.) * std::pow(x, k)) / L;
          second_derivative += q(k - 1) *
                               (k * (k - 1.) * std::pow(x, k - 2.) -
                                (k + 1.) * k * std::pow(x, k - 1.)) /
                               (L * L);
        }
      for (unsigned int k = 0; k < n_psi; ++k)
        {
          result.psi += q(n_w + k) * std::pow(x, k);
          result.curvature += q(n_w + k) * k * std::pow(x, k - 1.) / L;
        }
      for (unsigned int k = 1; k <= n_u; ++k)
        {
          result.u += q(n_w + n_psi + k - 1) * std::pow(x, k);
          result.strain += q(n_w + n_psi + k - 1) * k * std::pow(x, k - 1.) / L;
        }
      if (!timoshenko)
        result.curvature = second_derivative;
      result.shear = timoshenko ? slope - result.psi : 0;
      return result;
    }

    Eigen::Vector2d
    place(const Eigen::VectorXd &coordinates,
          const unsigned int body,
          const double x,
          const double zeta) const
    {
      const Fields field = fields(coordinates, body, x);
      Eigen::Vector2d base(0, 0);
      if (body == 1)
        base = place(coordinates, 0, mechanism.crank_length, 0);
      return base +
             Eigen::Rotation2Dd(coordinates(body * n)) *
               Eigen::Vector2d(x + field.u - zeta * field.psi, field.w + zeta);
    }

    // Exact differences: the place is linear in the elastic coordinates, and in
    // the sine and cosine of each angle. The crank does not depend on the
    // coordinates of the rod.
    Eigen::MatrixXd
    jacobian(const Eigen::VectorXd &Q,
             const unsigned int body,
             const double x,
             const double zeta) const
    {
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, Q.size());
      for (Eigen::Index i = 0; i < (body + 1) * n; ++i)
        {
          const double step = i % n == 0 ? pi / 2 : 1;
          const Eigen::VectorXd change =
            step * Eigen::VectorXd::Unit(Q.size(), i);
          J.col(i) = (place(Q + change, body, x, zeta) -
                      place(Q - change, body, x, zeta)) /
                     2;
        }
      return J;
    }

    // The acceleration of the place if the coordinates have none
    Eigen::Vector2d
    acceleration_bias(const Eigen::VectorXd &Q,
                      const Eigen::VectorXd &V,
                      const unsigned int body,
                      const double x,
                      const double zeta) const
    {
      const double h = 2e-3;
      return (16 * (place(Q + h * V, body, x, zeta) +
                    place(Q - h * V, body, x, zeta)) -
              place(Q + 2 * h * V, body, x, zeta) -
              place(Q - 2 * h * V, body, x, zeta) -
              30 * place(Q, body, x, zeta)) /
             (12 * h * h);
    }

    Eigen::VectorXd
    acceleration(const Eigen::VectorXd &Q, const Eigen::VectorXd &V) const
    {
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * n + 1, 2 * n + 1);
      Eigen::VectorXd force  = Eigen::VectorXd::Zero(2 * n + 1);
      for (const unsigned int body : {0, 1})
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            const double x      = length(body) / 2 * (1 + points[p]);
            const double weight = length(body) / 2 * weights[p];
            force.head(2 * n) += weight * elastic_force(Q, body, x);
            // A line without a height has no rotary inertia.
            for (const double side : {-1, 1})
              {
                const double zeta =
                  timoshenko ? side * mechanism.height / std::sqrt(12.) : 0;
                const Eigen::MatrixXd J = jacobian(Q, body, x, zeta);
                const double point_mass =
                  weight * mechanism.density * area(mechanism) / 2;
                matrix.topLeftCorner(2 * n, 2 * n) +=
                  point_mass * J.transpose() * J;
                force.head(2 * n) += point_mass * J.transpose() *
                                     (acceleration_bias(Q, V, body, x, zeta) +
                                      Eigen::Vector2d(0, mechanism.gravity));
              }
          }
      const double L                = mechanism.rod_length;
      matrix.row(2 * n).head(2 * n) = jacobian(Q, 1, L, 0).row(1);
      matrix.col(2 * n)             = matrix.row(2 * n).transpose().eval();
      force(2 * n)                  = acceleration_bias(Q, V, 1, L, 0)(1);
      return -matrix.partialPivLu().solve(force).head(2 * n);
    }

    Eigen::VectorXd
    elastic_force(const Eigen::VectorXd &Q,
                  const unsigned int body,
                  const double x) const
    {
      const double E         = mechanism.youngs_modulus;
      const Fields field     = fields(Q, body, x);
      Eigen::VectorXd result = Eigen::VectorXd::Zero(Q.size());
      for (Eigen::Index i = body * n + 1; i < (body + 1) * n; ++i)
        {
          const Fields unit =
            fields(Eigen::VectorXd::Unit(Q.size(), i), body, x);
          result(i) =
            E * area(mechanism) * field.strain * unit.strain +
            E * second_moment(mechanism) * field.curvature * unit.curvature +
            shear_stiffness(mechanism) * field.shear * unit.shear;
        }
      return result;
    }

    const SliderCrank mechanism;
    const bool timoshenko;
    const unsigned int n_w, n_psi, n_u;
    const Eigen::Index n;
    Eigen::VectorXd position;
    Eigen::VectorXd velocity;
  };

  /** Thick and soft: every term of the equations is large. */
  void
  compare_with_material_points(const BeamTheory theory, const bool extensible)
  {
    SliderCrank mechanism;
    mechanism.crank_length   = 0.6;
    mechanism.rod_length     = 1.1;
    mechanism.height         = 0.2;
    mechanism.youngs_modulus = 1.5e6;
    BeamOptions settings     = options(theory, 3);
    settings.extensible      = extensible;
    settings.step_size       = 1e-3;
    const double end         = 0.4;
    const SliderCrankState s =
      move_slider_crank(mechanism, settings, {end}).front();
    MaterialPoints model(mechanism, settings);
    model.advance(end, 500);
    EXPECT_LT(s.crank_angle, -1);
    EXPECT_GT(s.rod_angle, 0.4);
    EXPECT_GT(std::abs(s.crank_deflection), 1e-3);
    EXPECT_GT(std::abs(s.rod_deflection), 1e-2);
    // Errors of the Runge-Kutta method, measured: up to 2e-8
    const double tolerance = 1e-7;
    EXPECT_NEAR(s.crank_angle, model.angle(0), tolerance);
    EXPECT_NEAR(s.rod_angle, model.angle(1), tolerance);
    EXPECT_NEAR(s.crank_deflection, model.mid_span_deflection(0), tolerance);
    EXPECT_NEAR(s.rod_deflection, model.mid_span_deflection(1), tolerance);
    EXPECT_NEAR(s.slider_position, model.slider()(0), tolerance);
    EXPECT_NEAR(model.slider()(1), 0, tolerance);
    EXPECT_EQ(std::abs(model.chord(0) - mechanism.crank_length) > 1e-3,
              extensible);
    EXPECT_EQ(std::abs(model.chord(1) - mechanism.rod_length) > 1e-3,
              extensible);
  }
} // namespace

TEST(SliderCrankReference, MaterialPointsOfBernoulliAndEuler)
{
  compare_with_material_points(BeamTheory::bernoulli_euler, false);
}

TEST(SliderCrankReference, MaterialPointsOfTimoshenkoWithExtension)
{
  compare_with_material_points(BeamTheory::timoshenko, true);
}

TEST(SliderCrankReference, FrequenciesAreThoseOfTheDifferentialEquations)
{
  const SliderCrank mechanism;
  for (const BeamTheory theory :
       {BeamTheory::bernoulli_euler, BeamTheory::timoshenko})
    {
      const auto frequencies =
        stretched_frequencies(mechanism, options(theory, 12));
      ASSERT_EQ(frequencies.size(), 12u);
      // The fifth one is 5e-8 too high, the sixth one 1e-6.
      for (unsigned int i = 0; i < 5; ++i)
        EXPECT_LT(
          slider_determinant(mechanism, theory, frequencies[i] * (1 - 1e-6)) *
            slider_determinant(mechanism, theory, frequencies[i] * (1 + 1e-6)),
          0);
    }
}

TEST(SliderCrankReference, RigidMechanismFallsInTheTimeOfItsEnergies)
{
  SliderCrank mechanism;
  mechanism.youngs_modulus *= 1e5;
  const std::vector<double> angles{-0.3, -1, -pi / 2, -2.5, -3};
  std::vector<double> times;
  for (const double angle : angles)
    times.push_back(rigid_time(mechanism, angle));
  const auto history =
    move_slider_crank(mechanism,
                      options(BeamTheory::bernoulli_euler, 4),
                      times);
  for (unsigned int i = 0; i < angles.size(); ++i)
    {
      const double rod_angle = std::asin(-0.5 * std::sin(angles[i]));
      // Measured: 3e-9, the deflection over the length
      EXPECT_NEAR(history[i].crank_angle, angles[i], 1e-8);
      EXPECT_NEAR(history[i].rod_angle, rod_angle, 1e-8);
      EXPECT_NEAR(history[i].slider_position,
                  0.5 * std::cos(angles[i]) + std::cos(rod_angle),
                  1e-8);
      EXPECT_LT(std::abs(history[i].rod_deflection), 1e-8);
    }
}

TEST(SliderCrankReference, EnergyIsConserved)
{
  const SliderCrank mechanism;
  for (const bool extensible : {false, true})
    {
      BeamOptions settings = options(BeamTheory::timoshenko, 5);
      settings.extensible  = extensible;
      settings.step_size   = 2e-4;
      const auto history =
        move_slider_crank(mechanism, settings, equidistant(1, 100));
      EXPECT_EQ(history[0].kinetic_energy, 0);
      EXPECT_EQ(history[0].elastic_energy, 0);
      EXPECT_EQ(history[0].potential_energy, 0);
      double largest = 0;
      for (const SliderCrankState &state : history)
        {
          // Measured: 5e-11
          EXPECT_NEAR(state.total_energy(), 0, 1e-9);
          largest = std::max(largest, state.elastic_energy);
        }
      EXPECT_GT(largest, 4e-3);
    }
}

TEST(SliderCrankReference, ConvergesWithTheNumberOfShapeFunctions)
{
  const SliderCrank mechanism;
  const auto times = equidistant(1, 50);
  for (const BeamTheory theory :
       {BeamTheory::bernoulli_euler, BeamTheory::timoshenko})
    {
      std::vector<std::vector<SliderCrankState>> histories;
      for (const unsigned int n : {4, 6, 8, 10})
        {
          BeamOptions settings = options(theory, n);
          settings.step_size   = 5e-4;
          histories.push_back(move_slider_crank(mechanism, settings, times));
        }
      const Difference four  = compare(histories[0], histories[3]);
      const Difference six   = compare(histories[1], histories[3]);
      const Difference eight = compare(histories[2], histories[3]);
      // Measured: 1.3e-5 rad, 1.8e-6 rad, 1e-6 rad and about the same in m
      EXPECT_LT(six.angle, four.angle / 4);
      EXPECT_LT(six.deflection, four.deflection / 4);
      EXPECT_LT(eight.angle, 2e-6);
      EXPECT_LT(eight.deflection, 1e-6);
    }
}

TEST(SliderCrankReference, ConvergesWithTheTenthOrderOfTheStepSize)
{
  // Soft, for vibrations that large steps resolve
  SliderCrank mechanism;
  mechanism.youngs_modulus = 1.5e8;
  const auto times         = equidistant(0.48, 4);
  BeamOptions settings     = options(BeamTheory::bernoulli_euler, 2);
  // Smaller steps would add more errors of the iteration.
  settings.step_size = 1e-3;
  const auto finest  = move_slider_crank(mechanism, settings, times);
  std::vector<double> errors;
  for (const double step_size : {8e-3, 4e-3})
    {
      settings.step_size = step_size;
      errors.push_back(
        compare(move_slider_crank(mechanism, settings, times), finest)
          .deflection);
    }
  EXPECT_GT(errors[1], 5e-12); // far above rounding
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 10, 0.6);
}

TEST(SliderCrankReference, DefaultStepSizeIsAccurate)
{
  const SliderCrank mechanism;
  const auto times = equidistant(0.2, 4);
  for (const BeamTheory theory :
       {BeamTheory::bernoulli_euler, BeamTheory::timoshenko})
    {
      BeamOptions settings = options(theory, 8);
      const auto history   = move_slider_crank(mechanism, settings, times);
      settings.step_size /= 2;
      const Difference error =
        compare(move_slider_crank(mechanism, settings, times), history);
      EXPECT_LT(error.angle, 5e-9);
      EXPECT_LT(error.deflection, 5e-9);
    }
}

TEST(SliderCrankReference, WrongInputIsRejected)
{
  const BeamOptions right;
  for (double SliderCrank::*const member : {&SliderCrank::crank_length,
                                            &SliderCrank::rod_length,
                                            &SliderCrank::height,
                                            &SliderCrank::width,
                                            &SliderCrank::youngs_modulus,
                                            &SliderCrank::density})
    for (const double value : {0., -1., std::nan("")})
      {
        SliderCrank mechanism;
        mechanism.*member = value;
        EXPECT_THROW(move_slider_crank(mechanism, right, {0}),
                     std::invalid_argument);
        EXPECT_THROW(stretched_frequencies(mechanism, right),
                     std::invalid_argument);
      }
  SliderCrank mechanism;
  mechanism.rod_length = mechanism.crank_length;
  EXPECT_THROW(move_slider_crank(mechanism, right, {0}), std::invalid_argument);
  mechanism = SliderCrank();
  EXPECT_THROW(move_slider_crank(mechanism, right, {-1}),
               std::invalid_argument);
  EXPECT_THROW(move_slider_crank(mechanism, right, {1e-3, 0}),
               std::invalid_argument);
}

// Prints the figures that simulations of the slider-crank of Gerstmayr and
// Schoeberl are compared with.
TEST(SliderCrankReference, SliderCrankOfGerstmayrAndSchoeberl)
{
  const SliderCrank mechanism;
  const auto times           = equidistant(1, 500);
  BeamOptions settings       = options(BeamTheory::timoshenko, 8);
  settings.step_size         = 2e-4;
  const auto timoshenko      = move_slider_crank(mechanism, settings, times);
  settings.theory            = BeamTheory::bernoulli_euler;
  const auto bernoulli_euler = move_slider_crank(mechanism, settings, times);
  std::printf(
    "            Bernoulli-Euler                 Timoshenko\n"
    "time [s]    crank [rad] rod deflection [m]  crank [rad] rod "
    "deflection [m]\n");
  double largest = 0;
  for (unsigned int i = 0; i < times.size(); ++i)
    {
      largest = std::max(largest, std::abs(timoshenko[i].rod_deflection));
      if (i % 50 == 0)
        std::printf("%-8.1f %14.8f %18.6e %12.8f %18.6e\n",
                    times[i],
                    bernoulli_euler[i].crank_angle,
                    bernoulli_euler[i].rod_deflection,
                    timoshenko[i].crank_angle,
                    timoshenko[i].rod_deflection);
    }
  const Difference difference = compare(bernoulli_euler, timoshenko);
  std::printf(
    "largest deflection %.6e m; largest differences %.6e rad, %.6e "
    "m\n",
    largest,
    difference.angle,
    difference.deflection);
  // Rotary inertia (H / L)^2 / 4 of the crank makes it slower.
  EXPECT_NEAR(difference.angle, 2.2e-3, 0.3e-3);
  EXPECT_LT(difference.deflection, 0.25 * largest);
}
