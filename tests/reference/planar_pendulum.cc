// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The floating frame of reference of a planar beam.
//
// The material point (x, zeta), with x along the undeformed axis and zeta
// across, is at r = R(theta) s in the y-z plane,
//
//   s = s0 + N q,   s0 = (x, zeta),   N q = (u - zeta psi, w + 0),
//
// where theta is the angle of the chord, as w(0) = w(L) = 0 and u(0) = 0, and
// where the fields u(x), w(x), psi(x) depend linearly on the coordinates q.
// With J = R^T dR/dtheta, the rotation by a right angle, the velocity is
// R (theta' J s + N q'), so that the kinetic energy is
//
//   T = 1/2 I theta'^2 + theta' q'^T (b + G q) + 1/2 q'^T M q'
//   I = int rho s.s = I0 + 2 a^T q + q^T M q,
//   I0 = int rho s0.s0,   a = int rho N^T s0,   b = int rho N^T J s0,
//   M = int rho N^T N,    G = int rho N^T J N = -G^T.
//
// The elastic energy is 1/2 q^T K q, the potential one g times the z component
// of R S with S = int rho s = S0 + P q. Lagrange's equations are then
//
//   I theta'' + (b + G q)^T q'' + 2 theta' (a + M q)^T q'
//     = -g e_z^T R J S,
//   (b + G q) theta'' + M q'' + 2 theta' G q' - theta'^2 (a + M q) + K q
//     = -g P^T R^T e_z,
//
// where 2 theta' G q' is the Coriolis force: half of it comes from d/dt (G q)
// theta', half from dT/dq = theta' G^T q' + ...; the term q'^T G q' of the
// first equation vanishes since G is skew. theta'^2 (a + M q) is the
// centrifugal force.
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

#include "reference/planar_pendulum.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace Reference
{
  namespace
  {
    using Eigen::MatrixXd;
    using Eigen::VectorXd;
    using Index = Eigen::Index;

    enum class Support
    {
      chord,
      clamped
    };

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

      MatrixXd
      product(const MatrixXd &left, const MatrixXd &right) const
      {
        return left.transpose() * gram.asDiagonal() * right;
      }

      VectorXd gram;
      MatrixXd derivative;
      MatrixXd antiderivative;
      VectorXd one;
      VectorXd x;
      VectorXd at_middle;
    };

    // The shape functions of the fields, one column per coordinate. The first
    // coordinate is the angle, which moves none of the fields.
    struct Fields
    {
      MatrixXd u, w, psi;
    };

    Fields
    shape_functions(const BeamOptions &options,
                    const Support support,
                    const LegendreSpace &space)
    {
      const Index n         = options.n_shape_functions;
      const bool timoshenko = options.theory == BeamTheory::timoshenko;
      // w' and psi from compatible spaces, so that nothing locks
      const Index n_psi = timoshenko ? n + (support == Support::chord) : 0;
      const Index n_u   = options.extensible ? n : 0;
      const MatrixXd polynomials   = MatrixXd::Identity(n + 2, n + 2);
      const MatrixXd zero_at_start = space.antiderivative.leftCols(n);
      Fields fields;
      fields.u = MatrixXd::Zero(n + 2, 1 + n + n_psi + n_u);
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
      return fields;
    }

    // The constants of the equations of motion, named as above but for all
    // coordinates (theta, q): the entries of theta are zero.
    struct BeamMatrices
    {
      BeamMatrices(const PlanarBeam &beam,
                   const BeamOptions &options,
                   const Support support);

      MatrixXd M, G, K;
      VectorXd a, b, Py, Pz;
      double I0, S0;

      // u(L) and w(L/2) as functions of q
      VectorXd tip_extension, mid_span_deflection;
    };

    BeamMatrices::BeamMatrices(const PlanarBeam &beam,
                               const BeamOptions &options,
                               const Support support)
    {
      check(beam, options);
      const LegendreSpace space(beam.length, options.n_shape_functions + 2);
      const auto [u, w, psi]   = shape_functions(options, support, space);
      const MatrixXd strain    = space.derivative * u;
      const MatrixXd curvature = space.derivative * psi;
      const MatrixXd shear     = space.derivative * w - psi;

      const bool timoshenko  = options.theory == BeamTheory::timoshenko;
      const double stiffness = beam.youngs_modulus * beam.height * beam.width;
      const double square_radius = beam.height * beam.height / 12;
      const double m             = beam.density * beam.height * beam.width;
      const double j             = timoshenko ? m * square_radius : 0;
      const double kappa         = options.shear_coefficient.value_or(
        cowper_coefficient(beam.poissons_ratio));

      M = m * (space.product(u, u) + space.product(w, w)) +
          j * space.product(psi, psi);
      G = m * (space.product(w, u) - space.product(u, w));
      // shear is zero in the theory of Bernoulli and Euler.
      K  = stiffness * (space.product(strain, strain) +
                       square_radius * space.product(curvature, curvature) +
                       kappa / (2 * (1 + beam.poissons_ratio)) *
                         space.product(shear, shear));
      a  = m * space.product(u, space.x);
      b  = m * space.product(w, space.x) + j * space.product(psi, space.one);
      I0 = m * std::pow(beam.length, 3) / 3 + j * beam.length;
      S0 = m * beam.length * beam.length / 2;
      Py = m * space.product(u, space.one);
      Pz = m * space.product(w, space.one);

      tip_extension       = u.colwise().sum();
      mid_span_deflection = w.transpose() * space.at_middle;
    }

    // The equations of motion mass(Q) Q'' + force(Q, Q') = 0, Q = (theta, q),
    // and their solution with the Gauss method with five stages (order 10,
    // A-stable, conserves the energy of linear systems). The unknowns are the
    // accelerations of the stages,
    //
    //   Q_i = Q + c_i h V + h^2 sum_j (A^2)_ij Q''_j,
    //   V_i = V + h sum_j A_ij Q''_j,
    //
    // and the matrix of the simplified Newton iteration keeps the mass and the
    // elastic stiffness, which is all that becomes large with stiff modes. The
    // high order serves the vibrations: the release excites all of them, none
    // is damped, and the errors of their phases accumulate.
    class Pendulum
    {
    public:
      Pendulum(const PlanarBeam &beam, const BeamOptions &options);

      void
      step(const double step_size);

      PendulumState
      state(const double time) const;

    private:
      static constexpr Index n_stages = 5;
      using StageMatrix = Eigen::Matrix<double, n_stages, n_stages>;

      MatrixXd
      mass(const VectorXd &Q) const;

      VectorXd
      force(const VectorXd &Q, const VectorXd &V) const;

      void
      factorize(const double step_size);

      const double length;
      const double gravity;
      const BeamMatrices beam;
      VectorXd position;
      VectorXd velocity;
      MatrixXd acceleration;

      // The coefficients c, b and A of the method
      Eigen::Matrix<double, n_stages, 1> nodes;
      Eigen::Matrix<double, n_stages, 1> weights;
      StageMatrix A;
      Eigen::PartialPivLU<MatrixXd> factors;
      double factorized_step = 0;
      bool slow              = false;
    };

    Pendulum::Pendulum(const PlanarBeam &beam, const BeamOptions &options)
      : length(beam.length)
      , gravity(beam.gravity)
      , beam(beam, options, Support::chord)
      , position(VectorXd::Zero(this->beam.M.rows()))
      , velocity(position)
      , acceleration(MatrixXd::Zero(position.size(), n_stages))
    {
      const double root  = 2 * std::sqrt(10. / 7);
      const double inner = std::sqrt(5 - root) / 6;
      const double outer = std::sqrt(5 + root) / 6;
      nodes << 0.5 - outer, 0.5 - inner, 0.5, 0.5 + inner, 0.5 + outer;
      // Collocation: sum_j A_ij c_j^k = c_i^(k+1) / (k+1), and the same for
      // the weights with 1 instead of c_i.
      StageMatrix powers;
      Eigen::Matrix<double, n_stages, n_stages + 1> integrals;
      for (Index k = 0; k < n_stages; ++k)
        {
          powers.row(k) = nodes.array().pow(k);
          integrals.row(k) << nodes.array().pow(k + 1).transpose(), 1;
          integrals.row(k) /= k + 1.;
        }
      integrals = powers.fullPivLu().solve(integrals).eval();
      A         = integrals.leftCols<n_stages>().transpose();
      weights   = integrals.col(n_stages);
    }

    MatrixXd
    Pendulum::mass(const VectorXd &Q) const
    {
      MatrixXd result         = beam.M;
      const VectorXd coupling = beam.b + beam.G * Q;
      result.col(0) += coupling;
      result.row(0) += coupling.transpose();
      result(0, 0) = beam.I0 + 2 * beam.a.dot(Q) + Q.dot(beam.M * Q);
      return result;
    }

    VectorXd
    Pendulum::force(const VectorXd &Q, const VectorXd &V) const
    {
      const double sine          = std::sin(Q(0));
      const double cosine        = std::cos(Q(0));
      const VectorXd centrifugal = beam.a + beam.M * Q;
      VectorXd result            = beam.K * Q + 2 * V(0) * (beam.G * V) -
                        V(0) * V(0) * centrifugal +
                        gravity * (sine * beam.Py + cosine * beam.Pz);
      result(0) =
        2 * V(0) * centrifugal.dot(V) +
        gravity * (cosine * (beam.S0 + beam.Py.dot(Q)) - sine * beam.Pz.dot(Q));
      return result;
    }

    void
    Pendulum::factorize(const double step_size)
    {
      const Index n           = position.size();
      const MatrixXd M        = mass(position);
      const StageMatrix scale = step_size * step_size * A * A;
      MatrixXd matrix(n_stages * n, n_stages * n);
      for (Index i = 0; i < n_stages; ++i)
        for (Index j = 0; j < n_stages; ++j)
          matrix.block(i * n, j * n, n, n) =
            scale(i, j) * beam.K + (i == j ? 1. : 0.) * M;
      factors.compute(matrix);
      factorized_step = step_size;
    }

    void
    Pendulum::step(const double step_size)
    {
      // Steps in equal intervals differ by rounding only.
      if (std::abs(step_size - factorized_step) > 1e-10 * step_size || slow)
        factorize(step_size);
      const double h            = step_size;
      const StageMatrix AA      = A * A;
      double increment          = std::numeric_limits<double>::infinity();
      unsigned int n_iterations = 0;
      while (!(increment <= 1e-14))
        {
          if (++n_iterations > 50)
            throw std::runtime_error("The Newton iteration does not converge.");
          MatrixXd residual(position.size(), n_stages);
          for (Index i = 0; i < n_stages; ++i)
            {
              const VectorXd Q = position + nodes(i) * h * velocity +
                                 h * h * acceleration * AA.row(i).transpose();
              const VectorXd V =
                velocity + h * acceleration * A.row(i).transpose();
              residual.col(i) = mass(Q) * acceleration.col(i) + force(Q, V);
            }
          const VectorXd correction = factors.solve(residual.reshaped());
          acceleration -= correction.reshaped(position.size(), n_stages);
          increment = h * h * correction.lpNorm<Eigen::Infinity>() /
                      std::max(1., position.lpNorm<Eigen::Infinity>());
        }
      slow = n_iterations > 8;
      position +=
        h * velocity + h * h * acceleration * (A.transpose() * weights);
      velocity += h * acceleration * weights;
    }

    PendulumState
    Pendulum::state(const double time) const
    {
      const double sine   = std::sin(position(0));
      const double cosine = std::cos(position(0));
      const double chord  = length + beam.tip_extension.dot(position);
      PendulumState result;
      result.time                = time;
      result.chord_angle         = position(0);
      result.mid_span_deflection = beam.mid_span_deflection.dot(position);
      result.tip_y               = chord * cosine;
      result.tip_z               = chord * sine;
      result.kinetic_energy = 0.5 * velocity.dot(mass(position) * velocity);
      result.elastic_energy = 0.5 * position.dot(beam.K * position);
      result.potential_energy =
        gravity * (sine * (beam.S0 + beam.Py.dot(position)) +
                   cosine * beam.Pz.dot(position));
      return result;
    }

    // Without extension; the angle moves the beam if it is pinned, otherwise
    // it is an additional coordinate of its own. Either way its frequency, the
    // first, is zero.
    std::vector<double>
    frequencies(const PlanarBeam &beam,
                BeamOptions options,
                const Support support)
    {
      options.extensible = false;
      BeamMatrices matrices(beam, options, support);
      matrices.M(0, 0) = matrices.I0;
      if (support == Support::chord)
        {
          matrices.M.col(0) += matrices.b;
          matrices.M.row(0) += matrices.b.transpose();
        }
      const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(
        matrices.K, matrices.M, Eigen::EigenvaluesOnly);
      if (solver.info() != Eigen::Success)
        throw std::runtime_error("The eigenvalue solver failed.");
      const VectorXd squares =
        solver.eigenvalues().segment(1, options.n_shape_functions);
      const VectorXd result = squares.cwiseSqrt();
      return {result.begin(), result.end()};
    }
  } // namespace

  double
  PendulumState::total_energy() const
  {
    return kinetic_energy + elastic_energy + potential_energy;
  }

  double
  cowper_coefficient(const double poissons_ratio)
  {
    return 10 * (1 + poissons_ratio) / (12 + 11 * poissons_ratio);
  }

  std::vector<PendulumState>
  swing_pendulum(const PlanarBeam &beam,
                 const BeamOptions &options,
                 const std::vector<double> &times)
  {
    Pendulum pendulum(beam, options);
    std::vector<PendulumState> history;
    double now = 0;
    for (const double time : times)
      {
        require(std::isfinite(time) && time >= now,
                "times must be finite, not negative and must not decrease",
                time);
        // The factor keeps rounding from adding a step.
        const double n_steps =
          std::ceil((time - now) / options.step_size * (1 - 1e-10));
        for (double step = 0; step < n_steps; ++step)
          pendulum.step((time - now) / n_steps);
        now = time;
        history.push_back(pendulum.state(now));
      }
    return history;
  }

  std::vector<double>
  pinned_free_frequencies(const PlanarBeam &beam, const BeamOptions &options)
  {
    return frequencies(beam, options, Support::chord);
  }

  std::vector<double>
  clamped_free_frequencies(const PlanarBeam &beam, const BeamOptions &options)
  {
    return frequencies(beam, options, Support::clamped);
  }

  double
  supported_static_deflection(const PlanarBeam &beam,
                              const BeamOptions &options)
  {
    BeamMatrices matrices(beam, options, Support::chord);
    // Holds the angle.
    matrices.K(0, 0) = 1;
    const VectorXd q = matrices.K.ldlt().solve(-beam.gravity * matrices.Pz);
    return matrices.mid_span_deflection.dot(q);
  }
} // namespace Reference
