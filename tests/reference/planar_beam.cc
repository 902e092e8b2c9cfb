// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The floating frame of reference of a planar beam.
//
// The material point (x, zeta), with x along the undeformed axis and zeta
// across, is at r = r0 + R(theta) s in the y-z plane,
//
//   s = s0 + N q,   s0 = (x, zeta),   N q = (u - zeta psi, w + 0),
//
// where theta is the angle of the chord, if w(0) = w(L) = 0 and u(0) = 0, and
// where the fields u(x), w(x), psi(x) depend linearly on the coordinates q.
// With J = R^T dR/dtheta, the rotation by a right angle, the velocity is
// r0' + R (theta' J s + N q'), so that the kinetic energy is, for r0' = 0,
//
//   T = 1/2 I theta'^2 + theta' q'^T (b + G q) + 1/2 q'^T M q'
//   I = int rho s.s = I0 + 2 a^T q + q^T M q,
//   I0 = int rho s0.s0,   a = int rho N^T s0,   b = int rho N^T J s0,
//   M = int rho N^T N,    G = int rho N^T J N = -G^T.
//
// The elastic energy is 1/2 q^T K q. A moving base adds r0'' to all
// accelerations, and so acts like gravity: with S = int rho s = S0 + P q, the
// moment of first order, the virtual work of -r0'' is that on R S, whose
// gradient is D = (R J S, R P). Lagrange's equations are then
//
//   I theta'' + (b + G q)^T q'' + 2 theta' (a + M q)^T q'
//     + (R J S)^T (r0'' + g e_z) = 0,
//   (b + G q) theta'' + M q'' + 2 theta' G q' - theta'^2 (a + M q) + K q
//     + (R P)^T (r0'' + g e_z) = 0,
//
// where 2 theta' G q' is the Coriolis force: half of it comes from d/dt (G q)
// theta', half from dT/dq = theta' G^T q' + ...; the term q'^T G q' of the
// first equation vanishes since G is skew. theta'^2 (a + M q) is the
// centrifugal force. The base exerts the derivative of the momentum, less the
// weight,
//
//   F = m (r0'' + g e_z) + D Q'' + 2 theta' R J P q' - theta'^2 R S.
//
// Integration across the height leaves, with m = rho A and j = rho A H^2 / 12,
//
//   a = m int u_ x,   b = m int w_ x + j int psi_,
//   M = m int (u_ u + w_ w) + j int psi_ psi,   G = m int (w_ u - u_ w),
//   I0 = m L^3 / 3 + j L,   S0 = (m L^2 / 2, 0),   P = m int (u; w),
//   K = E A int u_' u' + E I int psi_' psi'
//       + kappa mu A int (w_' - psi_) (w' - psi),
//
// (u_ the row, u the column of the shape functions). The theory of Bernoulli
// and Euler is psi = w' and j = 0; without extension u = 0.

#include "reference/planar_beam.h"

#include <Eigen/Dense>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace Reference
{
  using Eigen::Matrix2d;
  using Eigen::Matrix2Xd;
  using Eigen::MatrixXd;
  using Eigen::Vector2d;
  using Eigen::VectorXd;
  using Index = Eigen::Index;

  namespace
  {
    // Polynomials on [0, L] as columns of coefficients of the Legendre
    // polynomials P_k(2 x / L - 1): all integrals are then exact.
    struct LegendreSpace
    {
      LegendreSpace(const double length, const Index n)
        : gram(n)
        , derivative(MatrixXd::Zero(n, n))
        , antiderivative(MatrixXd::Zero(n, n))
        , one(VectorXd::Unit(n, 0))
        , x(length / 2 * (VectorXd::Unit(n, 0) + VectorXd::Unit(n, 1)))
        , at_middle(VectorXd::Unit(n, 0))
      {
        for (Index k = 0; k < n; ++k)
          {
            gram(k) = length / (2. * k + 1);
            // P_k' = (2k-1) P_{k-1} + (2k-5) P_{k-3} + ...
            for (Index l = k - 1; l >= 0; l -= 2)
              derivative(l, k) = 2 / length * (2. * l + 1);
            // The integral from -1 of P_k is (P_{k+1} - P_{k-1}) / (2k+1),
            // with P_{-1} = -1. The last polynomial has none in this space.
            if (k + 1 < n)
              {
                antiderivative(k + 1, k) = gram(k) / 2;
                antiderivative(k ? k - 1 : 0, k) =
                  k ? -gram(k) / 2 : gram(k) / 2;
              }
            // P_k(0) = -(k-1)/k P_{k-2}(0)
            if (k >= 2)
              at_middle(k) = -(k - 1.) / k * at_middle(k - 2);
          }
      }

      VectorXd gram;
      MatrixXd derivative;
      MatrixXd antiderivative;
      VectorXd one;
      VectorXd x;
      VectorXd at_middle;
    };

    // R(theta) (c, s) for a vector (c, s) of the frame
    Matrix2d
    rotation(const double angle)
    {
      Matrix2d result;
      result << std::cos(angle), -std::sin(angle), std::sin(angle),
        std::cos(angle);
      return result;
    }

    // J
    Vector2d
    right_angle(const Vector2d &vector)
    {
      return {-vector(1), vector(0)};
    }
  } // namespace

  double
  cowper_coefficient(const double poissons_ratio)
  {
    return 10 * (1 + poissons_ratio) / (12 + 11 * poissons_ratio);
  }

  void
  require(const bool condition, const std::string &name, const double found)
  {
    if (!condition)
      throw std::invalid_argument(name + ", but found " +
                                  std::to_string(found));
  }

  void
  check(const PlanarBeam &beam, const BeamOptions &options)
  {
    const std::pair<const char *, double> positive[] = {
      {"length", beam.length},
      {"height", beam.height},
      {"width", beam.width},
      {"youngs_modulus", beam.youngs_modulus},
      {"density", beam.density},
      {"n_shape_functions", options.n_shape_functions},
      {"step_size", options.step_size},
      {"shear_coefficient", options.shear_coefficient.value_or(1)}};
    for (const auto &[name, value] : positive)
      require(std::isfinite(value) && value > 0,
              std::string(name) + " must be positive",
              value);
    const double nu = beam.poissons_ratio;
    require(nu > -1 && nu <= 0.5, "-1 < poissons_ratio <= 0.5 must hold", nu);
    require(std::isfinite(beam.gravity),
            "gravity must be finite",
            beam.gravity);
  }

  BeamFields
  polynomial_fields(const double length,
                    const BeamOptions &options,
                    const Support support)
  {
    const Index n         = options.n_shape_functions;
    const bool timoshenko = options.theory == BeamTheory::timoshenko;
    const LegendreSpace space(length, n + 2);
    // w' and psi from compatible spaces, so that nothing locks
    const Index n_psi = timoshenko ? n + (support == Support::chord) : 0;
    const Index n_u   = options.extensible ? n : 0;
    const MatrixXd polynomials   = MatrixXd::Identity(n + 2, n + 2);
    const MatrixXd zero_at_start = space.antiderivative.leftCols(n);
    BeamFields fields;
    fields.weights = space.gram;
    fields.one     = space.one;
    fields.x       = space.x;
    fields.u       = MatrixXd::Zero(n + 2, 1 + n + n_psi + n_u);
    fields.w = fields.psi = fields.u;
    if (support == Support::chord)
      {
        // Integrals of P_1, P_2, ... vanish at both ends.
        fields.w.middleCols(1, n) = space.antiderivative.middleCols(1, n);
        fields.psi.middleCols(1 + n, n_psi) = polynomials.leftCols(n_psi);
      }
    else
      {
        fields.w.middleCols(1, n) =
          (timoshenko ? polynomials : space.antiderivative) * zero_at_start;
        fields.psi.middleCols(1 + n, n_psi) = zero_at_start.leftCols(n_psi);
      }
    fields.u.rightCols(n_u) = zero_at_start.leftCols(n_u);
    if (!timoshenko)
      fields.psi = space.derivative * fields.w;
    fields.strain    = space.derivative * fields.u;
    fields.curvature = space.derivative * fields.psi;
    fields.shear     = space.derivative * fields.w - fields.psi;
    // P_k(1) = 1
    fields.tip_extension       = fields.u.colwise().sum();
    fields.mid_span_deflection = fields.w.transpose() * space.at_middle;
    return fields;
  }

  FloatingBeam::FloatingBeam(const PlanarBeam &beam,
                             const BeamOptions &options,
                             const BeamFields &fields)
    : P(2, fields.u.cols())
    , length(beam.length)
    , tip_extension(fields.tip_extension)
    , mid_span_deflection(fields.mid_span_deflection)
  {
    const double stiffness     = beam.youngs_modulus * beam.height * beam.width;
    const double square_radius = beam.height * beam.height / 12;
    const double m             = beam.density * beam.height * beam.width;
    const double j =
      options.theory == BeamTheory::timoshenko ? m * square_radius : 0;
    const double kappa = options.shear_coefficient.value_or(
      cowper_coefficient(beam.poissons_ratio));
    const auto product = [&](const MatrixXd &left, const MatrixXd &right) {
      return MatrixXd(left.transpose() * fields.weights.asDiagonal() * right);
    };
    const MatrixXd &u   = fields.u;
    const MatrixXd &w   = fields.w;
    const MatrixXd &psi = fields.psi;

    M = m * (product(u, u) + product(w, w)) + j * product(psi, psi);
    G = m * (product(w, u) - product(u, w));
    K =
      stiffness * (product(fields.strain, fields.strain) +
                   square_radius * product(fields.curvature, fields.curvature) +
                   kappa / (2 * (1 + beam.poissons_ratio)) *
                     product(fields.shear, fields.shear));
    a  = m * product(u, fields.x);
    b  = m * product(w, fields.x) + j * product(psi, fields.one);
    I0 = m * std::pow(beam.length, 3) / 3 + j * beam.length;
    S0 = m * beam.length * beam.length / 2;
    P << m * product(fields.one, u), m * product(fields.one, w);
    mass = m * beam.length;
  }

  Vector2d
  FloatingBeam::first_moment(const VectorXd &Q) const
  {
    return rotation(Q(0)) * (Vector2d(S0, 0) + P * Q);
  }

  Matrix2Xd
  FloatingBeam::first_moment_gradient(const VectorXd &Q) const
  {
    Matrix2Xd result = rotation(Q(0)) * P;
    result.col(0)    = right_angle(first_moment(Q));
    return result;
  }

  VectorXd
  FloatingBeam::residual(const VectorXd &Q,
                         const VectorXd &V,
                         const VectorXd &A,
                         const Vector2d &base_acceleration) const
  {
    const VectorXd MQ       = M * Q;
    const VectorXd coupling = b + G * Q;
    // The entries of theta in M, G and K are zero.
    VectorXd result = M * A + coupling * A(0) + K * Q + 2 * V(0) * (G * V) -
                      V(0) * V(0) * (a + MQ);
    result(0) = (I0 + 2 * a.dot(Q) + Q.dot(MQ)) * A(0) + coupling.dot(A) +
                2 * V(0) * (a + MQ).dot(V);
    return result + first_moment_gradient(Q).transpose() * base_acceleration;
  }

  Vector2d
  FloatingBeam::base_force(const VectorXd &Q,
                           const VectorXd &V,
                           const VectorXd &A,
                           const Vector2d &base_acceleration) const
  {
    return mass * base_acceleration + first_moment_gradient(Q) * A +
           2 * V(0) * right_angle(rotation(Q(0)) * (P * V)) -
           V(0) * V(0) * first_moment(Q);
  }

  double
  FloatingBeam::kinetic_energy(const VectorXd &Q,
                               const VectorXd &V,
                               const Vector2d &base_velocity) const
  {
    return 0.5 * (I0 + 2 * a.dot(Q) + Q.dot(M * Q)) * V(0) * V(0) +
           V(0) * V.dot(b + G * Q) + 0.5 * V.dot(M * V) +
           base_velocity.dot(first_moment_gradient(Q) * V) +
           0.5 * mass * base_velocity.squaredNorm();
  }

  double
  FloatingBeam::elastic_energy(const VectorXd &Q) const
  {
    return 0.5 * Q.dot(K * Q);
  }

  double
  FloatingBeam::chord(const VectorXd &Q) const
  {
    return length + tip_extension.dot(Q);
  }
} // namespace Reference
