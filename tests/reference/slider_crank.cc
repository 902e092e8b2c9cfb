// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Two floating beams (planar_beam.cc): the crank with the coordinates
// Q1 = (theta1, q1) and its base at rest, the rod with Q2 = (theta2, q2) and
// its base at the end of the crank,
//
//   P = R(theta1) (c1, 0),   c1 = L1 + u1(L1),
//
// where c1 and c2 are the lengths of the chords. The rod exerts the force -F on
// the crank at P, where F is what accelerates the rod and carries its weight.
// With r1 and r2, the left-hand sides of the equations of the single beams, and
// B = dP/dQ1, the mechanism without the slider's support fulfils
//
//   r1 + B^T F = 0,   r2(P'') = 0.
//
// The support, c1 sin(theta1) + c2 sin(theta2) = 0, determines theta2 as long
// as c1 < c2, so that the coordinates y = (theta1, q1, q2) are minimal. Its
// derivatives give theta2' = s^T y' and theta2'' = s^T y'' + s0,
//
//   s = -(c1 cos(theta1), sin(theta1) dc1/dq1, sin(theta2) dc2/dq2)
//         / (c2 cos(theta2)),
//   s0 = (c1 sin(theta1) theta1'^2 + c2 sin(theta2) theta2'^2
//         - 2 c1' cos(theta1) theta1' - 2 c2' cos(theta2) theta2')
//         / (c2 cos(theta2)),
//
// and in the equations of y the force of the support is eliminated if s times
// the equation of theta2 is added to them.

#include "reference/slider_crank.h"

#include <cmath>
#include <stdexcept>

#include "reference/gauss_method.h"

namespace Reference
{
  namespace
  {
    using Eigen::Matrix2Xd;
    using Eigen::MatrixXd;
    using Eigen::Vector2d;
    using Eigen::VectorXd;
    using Index = Eigen::Index;

    FloatingBeam
    floating_beam(const SliderCrank &mechanism,
                  const double length,
                  const BeamOptions &options)
    {
      const PlanarBeam beam{length,
                            mechanism.height,
                            mechanism.width,
                            mechanism.youngs_modulus,
                            mechanism.poissons_ratio,
                            mechanism.density,
                            mechanism.gravity};
      check(beam, options);
      return {beam,
              options,
              polynomial_fields(length, options, Support::chord)};
    }

    class Mechanism : public EquationsOfMotion
    {
    public:
      Mechanism(const SliderCrank &mechanism, const BeamOptions &options);

      VectorXd
      residual(const double,
               const VectorXd &y,
               const VectorXd &velocity,
               const VectorXd &acceleration) const override;

      const MatrixXd &
      stiffness() const override
      {
        return K;
      }

      SliderCrankState
      state(const double time,
            const VectorXd &y,
            const VectorXd &velocity) const;

    private:
      // The motion of both beams and of the end of the crank
      struct Motion
      {
        VectorXd Q1, V1, Q2, V2;
        // s and s0
        VectorXd angle_gradient;
        double angle_bias;
        // B, and P'' without B Q1''
        Matrix2Xd joint_gradient;
        Vector2d joint_bias;
      };

      Motion
      motion(const VectorXd &y, const VectorXd &velocity) const;

      const FloatingBeam crank;
      const FloatingBeam rod;
      const Vector2d gravity;
      MatrixXd K;
    };

    Mechanism::Mechanism(const SliderCrank &mechanism,
                         const BeamOptions &options)
      : crank(floating_beam(mechanism, mechanism.crank_length, options))
      , rod(floating_beam(mechanism, mechanism.rod_length, options))
      , gravity(0, mechanism.gravity)
    {
      require(mechanism.rod_length > mechanism.crank_length,
              "rod_length must be greater than crank_length",
              mechanism.rod_length);
      const Index n1              = crank.K.rows();
      const Index n2              = rod.K.rows() - 1;
      K                           = MatrixXd::Zero(n1 + n2, n1 + n2);
      K.topLeftCorner(n1, n1)     = crank.K;
      K.bottomRightCorner(n2, n2) = rod.K.bottomRightCorner(n2, n2);
    }

    Mechanism::Motion
    Mechanism::motion(const VectorXd &y, const VectorXd &velocity) const
    {
      const Index n1 = crank.K.rows();
      const Index n2 = rod.K.rows() - 1;
      Motion m;
      m.Q1 = y.head(n1);
      m.V1 = velocity.head(n1);
      m.Q2.resize(1 + n2);
      m.V2.resize(1 + n2);
      m.Q2 << 0, y.tail(n2);
      m.V2 << 0, velocity.tail(n2);

      const double c1         = crank.chord(m.Q1);
      const double c2         = rod.chord(m.Q2);
      const double c1_rate    = crank.tip_extension.dot(m.V1);
      const double c2_rate    = rod.tip_extension.dot(m.V2);
      const double sine       = std::sin(m.Q1(0));
      const double cosine     = std::cos(m.Q1(0));
      const double rod_sine   = -c1 * sine / c2;
      const double rod_cosine = std::sqrt(1 - rod_sine * rod_sine);
      if (!(std::abs(rod_sine) < 1))
        throw std::runtime_error("The chord of the rod is too short.");

      m.joint_gradient =
        Vector2d(cosine, sine) * crank.tip_extension.transpose();
      m.joint_gradient.col(0) = c1 * Vector2d(-sine, cosine);

      m.angle_gradient.resize(n1 + n2);
      m.angle_gradient << m.joint_gradient.row(1).transpose(),
        rod_sine * rod.tip_extension.tail(n2);
      m.angle_gradient /= -c2 * rod_cosine;
      m.Q2(0) = std::asin(rod_sine);
      m.V2(0) = m.angle_gradient.dot(velocity);

      const double rate = m.V1(0);
      m.joint_bias      = 2 * c1_rate * rate * Vector2d(-sine, cosine) -
                     c1 * rate * rate * Vector2d(cosine, sine);
      m.angle_bias = -(m.joint_bias(1) + 2 * c2_rate * m.V2(0) * rod_cosine -
                       c2 * m.V2(0) * m.V2(0) * rod_sine) /
                     (c2 * rod_cosine);
      return m;
    }

    VectorXd
    Mechanism::residual(const double,
                        const VectorXd &y,
                        const VectorXd &velocity,
                        const VectorXd &acceleration) const
    {
      const Motion m    = motion(y, velocity);
      const VectorXd A1 = acceleration.head(m.Q1.size());
      VectorXd A2(m.Q2.size());
      A2 << m.angle_gradient.dot(acceleration) + m.angle_bias,
        acceleration.tail(m.Q2.size() - 1);
      const Vector2d joint = m.joint_gradient * A1 + m.joint_bias + gravity;
      const VectorXd rod_residual = rod.residual(m.Q2, m.V2, A2, joint);
      VectorXd result(y.size());
      result << crank.residual(m.Q1, m.V1, A1, gravity) +
                  m.joint_gradient.transpose() *
                    rod.base_force(m.Q2, m.V2, A2, joint),
        rod_residual.tail(m.Q2.size() - 1);
      return result + rod_residual(0) * m.angle_gradient;
    }

    SliderCrankState
    Mechanism::state(const double time,
                     const VectorXd &y,
                     const VectorXd &velocity) const
    {
      const Motion m  = motion(y, velocity);
      const double c1 = crank.chord(m.Q1);
      const Vector2d joint =
        c1 * Vector2d(std::cos(m.Q1(0)), std::sin(m.Q1(0)));
      SliderCrankState result;
      result.time             = time;
      result.crank_angle      = m.Q1(0);
      result.rod_angle        = m.Q2(0);
      result.crank_deflection = crank.mid_span_deflection.dot(m.Q1);
      result.rod_deflection   = rod.mid_span_deflection.dot(m.Q2);
      result.slider_position  = joint(0) + rod.chord(m.Q2) * std::cos(m.Q2(0));
      result.kinetic_energy =
        crank.kinetic_energy(m.Q1, m.V1, Vector2d::Zero()) +
        rod.kinetic_energy(m.Q2, m.V2, m.joint_gradient * m.V1);
      result.elastic_energy =
        crank.elastic_energy(m.Q1) + rod.elastic_energy(m.Q2);
      result.potential_energy = gravity.dot(
        crank.first_moment(m.Q1) + rod.first_moment(m.Q2) + rod.mass * joint);
      return result;
    }
  } // namespace

  double
  SliderCrankState::total_energy() const
  {
    return kinetic_energy + elastic_energy + potential_energy;
  }

  std::vector<SliderCrankState>
  move_slider_crank(const SliderCrank &mechanism,
                    const BeamOptions &options,
                    const std::vector<double> &times)
  {
    const Mechanism equations(mechanism, options);
    const VectorXd zero = VectorXd::Zero(equations.stiffness().rows());
    GaussMethod method(equations, zero, zero);
    std::vector<SliderCrankState> history;
    for (const double time : times)
      {
        require(std::isfinite(time) && time >= method.time(),
                "times must be finite, not negative and must not decrease",
                time);
        method.advance(time, options.step_size);
        history.push_back(
          equations.state(time, method.position(), method.velocity()));
      }
    return history;
  }

  std::vector<double>
  stretched_frequencies(const SliderCrank &mechanism,
                        const BeamOptions &options)
  {
    BeamOptions inextensible = options;
    inextensible.extensible  = false;
    const Mechanism equations(mechanism, inextensible);
    const MatrixXd &K = equations.stiffness();
    const MatrixXd M  = equations.mass_matrix(0, VectorXd::Zero(K.rows()));
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(
      K, M, Eigen::EigenvaluesOnly);
    if (solver.info() != Eigen::Success)
      throw std::runtime_error("The eigenvalue solver failed.");
    // The first one is zero: the motion of the rigid mechanism.
    const VectorXd squares =
      solver.eigenvalues().segment(1, options.n_shape_functions);
    const VectorXd result = squares.cwiseSqrt();
    return {result.begin(), result.end()};
  }
} // namespace Reference
