// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "performance/baselines/hilber_hughes_taylor.h"

#include <acf/base/exceptions.h>
#include <acf/mechanics/elastic_force.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Baselines
{
  HilberHughesTaylor::HilberHughesTaylor(const MultibodySystem &system,
                                         const double alpha,
                                         const unsigned int least_iterations,
                                         const TimeParameters &parameters,
                                         Statistics &statistics)
    : system(system)
    , alpha(alpha)
    , beta((1 - alpha) * (1 - alpha) / 4)
    , gamma(0.5 - alpha)
    , least_iterations(least_iterations)
    , parameters(parameters)
    , statistics(statistics)
    , tangent(system)
    , newton_constant(std::numeric_limits<double>::infinity())
  {
    check_supported(system);
    for (const Body &body : system.bodies())
      if (body.strain_measure() != StrainMeasure::green_lagrange)
        throw SimulationError(
          "The conventional solution needs the strain of "
          "Green and Lagrange.");
  }



  double
  HilberHughesTaylor::norm(const SystemVector &x) const
  {
    double largest = 0;
    for (unsigned int b = 0; b < x.size(); ++b)
      {
        const BodyOperators &body = system.bodies()[b].operators();
        largest =
          std::max(largest,
                   x[b].l2_norm() / std::sqrt(1. * body.n_nodes) / body.length);
      }
    return largest;
  }



  // M a + S^T D^T lambda = -b, D S a = the acceleration of the constraints.
  void
  HilberHughesTaylor::start(SystemState &state)
  {
    state.multipliers.setZero();
    accelerations = unbalanced_forces(system, state);
    for (NodalVector &a : accelerations)
      a *= -1;
    state.multipliers = constraint_acceleration(system, state);

    SaddlePointMatrix mass(system);
    mass.factorize(std::vector<std::unique_ptr<const BlockNodeMatrix>>(
                     system.bodies().size()),
                   1.,
                   system.linearize(state.time,
                                    system.marker_values(state.positions),
                                    Eigen::VectorXd(),
                                    Eigen::VectorXd::Zero(
                                      system.n_constraints()),
                                    state.law_values));
    mass.solve(accelerations, state.multipliers);
    forces = unbalanced_forces(system, state);
  }



  void
  HilberHughesTaylor::solve(const SystemState &state,
                            const double shift,
                            SystemVector &r,
                            Eigen::VectorXd &g)
  {
    std::vector<std::unique_ptr<const BlockNodeMatrix>> stiffness;
    {
      const PhaseTimer timer(statistics, "tangent");
      for (unsigned int b = 0; b < system.bodies().size(); ++b)
        stiffness.push_back(
          ElasticTangent::at(system.bodies()[b], state.positions[b])
            .value()
            .matrix(NodeRotations()));
    }
    {
      const PhaseTimer timer(statistics, "factorisation");
      tangent.factorize(stiffness,
                        shift,
                        system.linearize(state.time,
                                         system.marker_values(state.positions),
                                         Eigen::VectorXd(),
                                         state.multipliers,
                                         state.law_values));
      ++statistics.real_factorizations;
      statistics.factor_entries = tangent.n_factor_entries();
      statistics.factor_bytes   = statistics.factor_entries * sizeof(double);
    }
    const PhaseTimer timer(statistics, "solves");
    tangent.solve(r, g);
    ++statistics.real_solves;
  }



  void
  HilberHughesTaylor::step(SystemState &state, const double step_size)
  {
    const double h      = step_size;
    const double weight = alpha / (1 + alpha);
    const double shift  = 1 / ((1 + alpha) * beta * h * h);
    state.time += h;
    for (unsigned int b = 0; b < accelerations.size(); ++b)
      {
        state.positions[b].add(h,
                               state.velocities[b],
                               h * h / 2,
                               accelerations[b]);
        state.velocities[b].add(h, accelerations[b]);
      }

    double last = 0;
    for (unsigned int k = 1;; ++k)
      {
        SystemVector d = unbalanced_forces(system, state);
        for (unsigned int b = 0; b < d.size(); ++b)
          {
            NodalVector inertia(d[b].size());
            system.bodies()[b].operators().mass_matrix.vmult(inertia,
                                                             accelerations[b]);
            d[b].sadd(-1, -1 / (1 + alpha), inertia);
            d[b].add(weight, forces[b]);
          }
        Eigen::VectorXd multipliers =
          -system.constraint_residual(state.positions, state.time);
        solve(state, shift, d, multipliers);
        for (unsigned int b = 0; b < d.size(); ++b)
          {
            state.positions[b] += d[b];
            state.velocities[b].add(gamma / (beta * h), d[b]);
            accelerations[b].add(1 / (beta * h * h), d[b]);
          }
        state.multipliers += multipliers;
        ++statistics.newton_iterations;
        statistics.max_newton_iterations =
          std::max(statistics.max_newton_iterations, k);

        // an automatic tolerance is one of the program's own method
        const double tolerance =
          parameters.newton_tolerance > 0 ? parameters.newton_tolerance : 1e-10;
        const double correction = norm(d);
        if (k > 1)
          newton_constant = correction / (last * last);
        last = correction;
        if (k >= least_iterations &&
            (correction == 0 ||
             newton_constant * correction * correction <= tolerance))
          break;
        if (k == parameters.max_newton_iterations || !std::isfinite(correction))
          throw SimulationError("Newton's method does not converge at time " +
                                std::to_string(state.time) + " s.");
      }
    forces = unbalanced_forces(system, state);
  }
} // namespace Baselines
