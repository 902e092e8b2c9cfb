// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The rod is a floating beam (planar_beam.cc) with the coordinates
// Q = (phi2, q), on the base P = l1 (cos(phi1), sin(phi1)), phi1 = Omega t. Its
// other end and the block are at x3 = P_x + c cos(phi2) with c = L + u(L). With
// r, the left-hand side of the equations of the rod, the equations are
//
//   r(P'') + G1^T lambda1 + G2^T lambda2 = 0,   m3 x3'' + lambda2 = 0,
//   G1 = (c cos(phi2), sin(phi2) dc/dq),
//   G2 = (c sin(phi2), -cos(phi2) dc/dq) = -dx3/dQ,
//
// and the torque -lambda3 on the crank, whose end bears the force -F of the
// rod without the constraints, follows from
//
//   (dP/dphi1)^T F + lambda1 l1 cos(phi1) + lambda2 l1 sin(phi1) + lambda3 = 0.
//
// The first constraint, P_y + c sin(phi2) = 0, determines phi2, so that q are
// minimal coordinates, with phi2' = s^T q' + ... and phi2'' = s^T q'' + s0,
//
//   s  = -sin(phi2) dc/dq / (c cos(phi2)),
//   s0 = -(P_y'' + 2 c' cos(phi2) phi2' - c sin(phi2) phi2'^2)
//          / (c cos(phi2)).

#include "reference/ivp_slider_crank.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "reference/gauss_method.h"

namespace Reference
{
  namespace
  {
    using Eigen::MatrixXd;
    using Eigen::Vector2d;
    using Eigen::VectorXd;
    using Index = Eigen::Index;

    const double pi = std::acos(-1.);

    // Nodes and weights of the Gauss quadrature on [-1, 1], the eigenvalues and
    // eigenvectors of the matrix of the recursion of the Legendre polynomials.
    // An odd number of points has a point in the middle.
    std::pair<VectorXd, VectorXd>
    gauss_quadrature(const Index n_points)
    {
      MatrixXd matrix = MatrixXd::Zero(n_points, n_points);
      for (Index k = 1; k < n_points; ++k)
        matrix(k, k - 1) = k / std::sqrt(4. * k * k - 1);
      const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
      return {solver.eigenvalues(),
              2 * solver.eigenvectors().row(0).array().square()};
    }

    BeamFields
    quadrature(const double length, const Index n_points)
    {
      const auto [nodes, weights] = gauss_quadrature(n_points);
      BeamFields fields;
      fields.weights = length / 2 * weights;
      fields.one     = VectorXd::Ones(n_points);
      fields.x       = length / 2 * (nodes.array() + 1);
      return fields;
    }

    // Two sines, two nodes of a quadratic polynomial
    BeamFields
    test_set_fields(const double length)
    {
      // Enough for the squares of the sines
      BeamFields fields      = quadrature(length, 25);
      const Eigen::ArrayXd s = fields.x / length;
      fields.u               = MatrixXd::Zero(s.size(), 5);
      fields.w = fields.psi = fields.strain = fields.curvature = fields.shear =
        fields.u;
      for (const Index k : {1, 2})
        {
          const double factor     = k * pi / length;
          fields.w.col(k)         = (k * pi * s).sin();
          fields.psi.col(k)       = factor * (k * pi * s).cos();
          fields.curvature.col(k) = -factor * factor * (k * pi * s).sin();
        }
      fields.u.col(3)            = 4 * s * (1 - s);
      fields.u.col(4)            = s * (2 * s - 1);
      fields.strain.col(3)       = (4 - 8 * s) / length;
      fields.strain.col(4)       = (4 * s - 1) / length;
      fields.tip_extension       = VectorXd::Unit(5, 4);
      fields.mid_span_deflection = VectorXd::Unit(5, 1);
      return fields;
    }

    // Polynomials as values at quadrature points
    BeamFields
    sampled_polynomial_fields(const double length, const BeamOptions &options)
    {
      const BeamFields polynomials =
        polynomial_fields(length, options, Support::chord);
      const Index n     = polynomials.x.size();
      BeamFields fields = quadrature(length, 2 * (n / 2) + 25);
      MatrixXd legendre(fields.x.size(), n);
      const Eigen::ArrayXd x = 2 * fields.x.array() / length - 1;
      legendre.col(0)        = fields.one;
      legendre.col(1)        = x;
      for (Index k = 1; k + 1 < n; ++k)
        legendre.col(k + 1) = ((2 * k + 1.) * x * legendre.col(k).array() -
                               k * legendre.col(k - 1).array()) /
                              (k + 1.);
      fields.u                   = legendre * polynomials.u;
      fields.w                   = legendre * polynomials.w;
      fields.psi                 = legendre * polynomials.psi;
      fields.strain              = legendre * polynomials.strain;
      fields.curvature           = legendre * polynomials.curvature;
      fields.shear               = legendre * polynomials.shear;
      fields.tip_extension       = polynomials.tip_extension;
      fields.mid_span_deflection = polynomials.mid_span_deflection;
      return fields;
    }

    // What the models differ in
    struct Rod
    {
      Rod(const IvpSliderCrank &mechanism, const IvpOptions &options);

      // Coordinates of the field with the coordinates q of the test set
      VectorXd
      projection(const std::array<double, 4> &q) const;

      // Inverse of it in the models of the test set
      std::array<double, 4>
      amplitudes(const VectorXd &coordinates) const;

      static BeamOptions
      beam_options(const IvpOptions &options);

      const bool polynomials;
      const double length;
      const double height;
      const BeamFields fields;
      FloatingBeam beam;
    };

    BeamOptions
    Rod::beam_options(const IvpOptions &options)
    {
      BeamOptions result;
      result.theory            = options.model == RodModel::timoshenko
                                   ? BeamTheory::timoshenko
                                   : BeamTheory::bernoulli_euler;
      result.extensible        = true;
      result.n_shape_functions = options.n_shape_functions;
      result.step_size         = options.step_size;
      return result;
    }

    Rod::Rod(const IvpSliderCrank &mechanism, const IvpOptions &options)
      : polynomials(options.model == RodModel::bernoulli_euler ||
                    options.model == RodModel::timoshenko)
      , length(mechanism.rod.length)
      , height(mechanism.rod.height)
      , fields(polynomials
                 ? sampled_polynomial_fields(length, beam_options(options))
                 : test_set_fields(length))
      , beam(mechanism.rod, beam_options(options), fields)
    {
      if (!polynomials)
        beam.I0 += beam.mass * height * height / 12;
      if (options.model == RodModel::published)
        beam.M += (15 - 1) * beam.mass / length * fields.u.transpose() *
                  fields.weights.asDiagonal() * fields.u;
    }

    VectorXd
    Rod::projection(const std::array<double, 4> &q) const
    {
      VectorXd u(fields.x.size()), w(u), psi(u);
      for (Index i = 0; i < u.size(); ++i)
        {
          const double s       = fields.x(i) / length;
          const RodField field = rod_field(q, fields.x(i), length);
          u(i)                 = field.axial;
          w(i)                 = field.lateral;
          psi(i)               = pi / length *
                   (q[0] * std::cos(pi * s) + 2 * q[1] * std::cos(2 * pi * s));
        }
      // Of the velocities of material points, without the angle
      const double square_radius = height * height / 12;
      const MatrixXd product =
        fields.u.transpose() * fields.weights.asDiagonal() * fields.u +
        fields.w.transpose() * fields.weights.asDiagonal() * fields.w +
        square_radius * fields.psi.transpose() * fields.weights.asDiagonal() *
          fields.psi;
      const VectorXd right =
        fields.u.transpose() * fields.weights.asDiagonal() * u +
        fields.w.transpose() * fields.weights.asDiagonal() * w +
        square_radius * fields.psi.transpose() * fields.weights.asDiagonal() *
          psi;
      const Index n = right.size() - 1;
      return product.bottomRightCorner(n, n).ldlt().solve(right.tail(n));
    }

    std::array<double, 4>
    Rod::amplitudes(const VectorXd &coordinates) const
    {
      const Index n          = coordinates.size();
      const Eigen::ArrayXd s = fields.x / length;
      const VectorXd weighted =
        fields.weights.asDiagonal() * (fields.w.rightCols(n) * coordinates);
      std::array<double, 4> result;
      for (unsigned int k : {1, 2})
        result[k - 1] = 2 / length * weighted.dot((k * pi * s).sin().matrix());
      result[2] = fields.u.row(s.size() / 2).tail(n) * coordinates;
      result[3] = fields.tip_extension.tail(n).dot(coordinates);
      return result;
    }

    class DrivenRod : public EquationsOfMotion
    {
    public:
      DrivenRod(const IvpSliderCrank &mechanism, const IvpOptions &options);

      VectorXd
      residual(const double time,
               const VectorXd &q,
               const VectorXd &velocity,
               const VectorXd &acceleration) const override;

      const MatrixXd &
      stiffness() const override
      {
        return K;
      }

      IvpSliderCrankState
      state(const double time,
            const VectorXd &q,
            const VectorXd &velocity) const;

      const Rod rod;

    private:
      struct Motion
      {
        // P, P', P''
        Vector2d base, base_velocity, base_acceleration;
        VectorXd Q, V;
        double sine, cosine;
        // s and s0
        VectorXd angle_gradient;
        double angle_bias;
        // dx3/dQ, and x3'' without that times Q''
        VectorXd slider_gradient;
        double slider_bias;
      };

      Motion
      motion(const double time,
             const VectorXd &q,
             const VectorXd &velocity) const;

      VectorXd
      rod_acceleration(const Motion &m, const VectorXd &acceleration) const;

      // r + m3 x3'' dx3/dQ
      VectorXd
      supported_residual(const Motion &m, const VectorXd &A) const;

      const double crank_length;
      const double angular_velocity;
      const double slider_mass;
      const MatrixXd K;
    };

    DrivenRod::DrivenRod(const IvpSliderCrank &mechanism,
                         const IvpOptions &options)
      : rod(mechanism, options)
      , crank_length(mechanism.crank_length)
      , angular_velocity(mechanism.angular_velocity)
      , slider_mass(mechanism.slider_mass)
      , K(rod.beam.K.bottomRightCorner(rod.beam.K.rows() - 1,
                                       rod.beam.K.rows() - 1))
    {}

    DrivenRod::Motion
    DrivenRod::motion(const double time,
                      const VectorXd &q,
                      const VectorXd &velocity) const
    {
      const double crank_angle = angular_velocity * time;
      Motion m;
      m.base =
        crank_length * Vector2d(std::cos(crank_angle), std::sin(crank_angle));
      m.base_velocity     = angular_velocity * Vector2d(-m.base(1), m.base(0));
      m.base_acceleration = -angular_velocity * angular_velocity * m.base;
      m.Q.resize(1 + q.size());
      m.V.resize(1 + q.size());
      m.Q << 0, q;
      m.V << 0, velocity;

      const VectorXd extension = rod.beam.tip_extension;
      const double c           = rod.beam.chord(m.Q);
      const double c_rate      = extension.dot(m.V);
      m.sine                   = -m.base(1) / c;
      if (!(std::abs(m.sine) < 1))
        throw std::runtime_error("The chord of the rod is too short.");
      m.cosine = std::sqrt(1 - m.sine * m.sine);
      m.Q(0)   = std::asin(m.sine);
      m.V(0)   = -(m.base_velocity(1) + c_rate * m.sine) / (c * m.cosine);

      const double rate = m.V(0);
      m.angle_gradient  = -m.sine / (c * m.cosine) * extension.tail(q.size());
      m.angle_bias = -(m.base_acceleration(1) + 2 * c_rate * m.cosine * rate -
                       c * m.sine * rate * rate) /
                     (c * m.cosine);
      m.slider_gradient    = m.cosine * extension;
      m.slider_gradient(0) = -c * m.sine;
      m.slider_bias = m.base_acceleration(0) - 2 * c_rate * m.sine * rate -
                      c * m.cosine * rate * rate;
      return m;
    }

    VectorXd
    DrivenRod::rod_acceleration(const Motion &m,
                                const VectorXd &acceleration) const
    {
      VectorXd A(m.Q.size());
      A << m.angle_gradient.dot(acceleration) + m.angle_bias, acceleration;
      return A;
    }

    VectorXd
    DrivenRod::supported_residual(const Motion &m, const VectorXd &A) const
    {
      return rod.beam.residual(m.Q, m.V, A, m.base_acceleration) +
             slider_mass * (m.slider_gradient.dot(A) + m.slider_bias) *
               m.slider_gradient;
    }

    VectorXd
    DrivenRod::residual(const double time,
                        const VectorXd &q,
                        const VectorXd &velocity,
                        const VectorXd &acceleration) const
    {
      const Motion m = motion(time, q, velocity);
      const VectorXd full =
        supported_residual(m, rod_acceleration(m, acceleration));
      return full.tail(q.size()) + full(0) * m.angle_gradient;
    }

    IvpSliderCrankState
    DrivenRod::state(const double time,
                     const VectorXd &q,
                     const VectorXd &velocity) const
    {
      const Motion m   = motion(time, q, velocity);
      const VectorXd A = rod_acceleration(m, acceleration(time, q, velocity));
      const double c   = rod.beam.chord(m.Q);
      IvpSliderCrankState result;
      result.time                 = time;
      result.rod_angle            = m.Q(0);
      result.rod_angular_velocity = m.V(0);
      result.slider_position      = m.base(0) + c * m.cosine;
      result.slider_velocity = m.base_velocity(0) + m.slider_gradient.dot(m.V);
      result.displacements   = rod.amplitudes(q);
      result.velocities      = rod.amplitudes(velocity);
      result.mid_span_deflection = rod.beam.mid_span_deflection.dot(m.Q);
      const double lambda1 = -supported_residual(m, A)(0) / (c * m.cosine);
      const double lambda2 =
        -slider_mass * (m.slider_gradient.dot(A) + m.slider_bias);
      const Vector2d crank_end_force =
        rod.beam.base_force(m.Q, m.V, A, m.base_acceleration) +
        Vector2d(-lambda2, lambda1);
      result.multipliers = {
        {lambda1,
         lambda2,
         -Vector2d(-m.base(1), m.base(0)).dot(crank_end_force)}};
      result.kinetic_energy =
        rod.beam.kinetic_energy(m.Q, m.V, m.base_velocity) +
        0.5 * slider_mass * result.slider_velocity * result.slider_velocity;
      result.elastic_energy = rod.beam.elastic_energy(m.Q);
      return result;
    }

    void
    check(const IvpSliderCrank &mechanism, const IvpOptions &options)
    {
      check(mechanism.rod, Rod::beam_options(options));
      require(mechanism.crank_length > 0 &&
                mechanism.crank_length < mechanism.rod.length,
              "crank_length must be positive and less than the rod's",
              mechanism.crank_length);
      require(std::isfinite(mechanism.angular_velocity),
              "angular_velocity must be finite",
              mechanism.angular_velocity);
      require(mechanism.slider_mass >= 0,
              "slider_mass must not be negative",
              mechanism.slider_mass);
      require(mechanism.rod.gravity == 0,
              "gravity must be zero",
              mechanism.rod.gravity);
      require(options.n_shape_functions >= 2,
              "n_shape_functions must be at least 2",
              options.n_shape_functions);
    }
  } // namespace

  RodField
  rod_field(const std::array<double, 4> &q, const double x, const double length)
  {
    const double s = x / length;
    return {4 * s * (1 - s) * q[2] + s * (2 * s - 1) * q[3],
            q[0] * std::sin(pi * s) + q[1] * std::sin(2 * pi * s)};
  }

  std::vector<IvpSliderCrankState>
  drive_slider_crank(const IvpSliderCrank &mechanism,
                     const IvpOptions &options,
                     const std::vector<double> &times)
  {
    check(mechanism, options);
    const DrivenRod equations(mechanism, options);
    // Magnitudes of the coordinates: of sines in m, of polynomials without unit
    const double deflection = 1e-3;
    const double slope      = 0.1;
    GaussMethod method(equations,
                       equations.rod.projection(mechanism.displacements),
                       equations.rod.projection(mechanism.velocities),
                       equations.rod.polynomials ? slope : deflection);
    std::vector<IvpSliderCrankState> history;
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
} // namespace Reference
