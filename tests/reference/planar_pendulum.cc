// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "reference/planar_pendulum.h"

#include <cmath>
#include <stdexcept>

#include "reference/gauss_method.h"

namespace Reference
{
  namespace
  {
    using Eigen::MatrixXd;
    using Eigen::Vector2d;
    using Eigen::VectorXd;

    FloatingBeam
    floating_beam(const PlanarBeam &beam,
                  const BeamOptions &options,
                  const Support support)
    {
      check(beam, options);
      return {beam, options, polynomial_fields(beam.length, options, support)};
    }

    // A floating beam whose base rests.
    class Pendulum : public EquationsOfMotion
    {
    public:
      Pendulum(const PlanarBeam &beam, const BeamOptions &options)
        : beam(floating_beam(beam, options, Support::chord))
        , gravity(0, beam.gravity)
      {}

      VectorXd
      residual(const double,
               const VectorXd &Q,
               const VectorXd &V,
               const VectorXd &A) const override
      {
        return beam.residual(Q, V, A, gravity);
      }

      const MatrixXd &
      stiffness() const override
      {
        return beam.K;
      }

      PendulumState
      state(const double time, const VectorXd &Q, const VectorXd &V) const
      {
        PendulumState result;
        result.time                = time;
        result.chord_angle         = Q(0);
        result.mid_span_deflection = beam.mid_span_deflection.dot(Q);
        result.tip_y               = beam.chord(Q) * std::cos(Q(0));
        result.tip_z               = beam.chord(Q) * std::sin(Q(0));
        result.kinetic_energy   = beam.kinetic_energy(Q, V, Vector2d::Zero());
        result.elastic_energy   = beam.elastic_energy(Q);
        result.potential_energy = gravity.dot(beam.first_moment(Q));
        return result;
      }

    private:
      const FloatingBeam beam;
      const Vector2d gravity;
    };

    // Without extension; the angle moves the beam if it is pinned, otherwise
    // it is an additional coordinate of its own. Either way its frequency, the
    // first, is zero.
    std::vector<double>
    frequencies(const PlanarBeam &beam,
                BeamOptions options,
                const Support support)
    {
      options.extensible    = false;
      FloatingBeam matrices = floating_beam(beam, options, support);
      matrices.M(0, 0)      = matrices.I0;
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

  std::vector<PendulumState>
  swing_pendulum(const PlanarBeam &beam,
                 const BeamOptions &options,
                 const std::vector<double> &times)
  {
    const Pendulum pendulum(beam, options);
    const VectorXd zero = VectorXd::Zero(pendulum.stiffness().rows());
    GaussMethod method(pendulum, zero, zero);
    std::vector<PendulumState> history;
    for (const double time : times)
      {
        require(std::isfinite(time) && time >= method.time(),
                "times must be finite, not negative and must not decrease",
                time);
        method.advance(time, options.step_size);
        history.push_back(
          pendulum.state(time, method.position(), method.velocity()));
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
    FloatingBeam matrices = floating_beam(beam, options, Support::chord);
    // Holds the angle.
    matrices.K(0, 0) = 1;
    const VectorXd q =
      matrices.K.ldlt().solve(-beam.gravity * matrices.P.row(1).transpose());
    return matrices.mid_span_deflection.dot(q);
  }
} // namespace Reference
