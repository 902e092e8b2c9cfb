// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "performance/baselines/central_differences.h"

#include <acf/base/exceptions.h>
#include <acf/mechanics/elastic_force.h>

#include <algorithm>
#include <cmath>

namespace Baselines
{
  std::vector<double>
  lumped_masses(const BodyOperators &body)
  {
    std::vector<double> masses = body.mass_matrix.row_sums();
    if (*std::min_element(masses.begin(), masses.end()) > 0)
      return masses;
    double sum = 0;
    for (unsigned int a = 0; a < body.n_nodes; ++a)
      {
        masses[a] = body.mass_matrix.value(a, a);
        sum += masses[a];
      }
    for (double &mass : masses)
      mass *= body.mass / sum;
    return masses;
  }



  double
  highest_frequency(const BodyOperators &body,
                    const std::vector<double> &masses)
  {
    NodalVector x(body.n_unknowns()), product(body.n_unknowns());
    // neighbours move against each other, with a part in all modes
    for (unsigned int k = 0; k < x.size(); ++k)
      x[k] = (k / dim % 2 == 0 ? 1. : -1.) * (1 + 0.3 * std::sin(k));
    double eigenvalue = 0, change = 1;
    while (change > 1e-6)
      {
        x /= x.l2_norm();
        body.stiffness_matrix.vmult(product, x);
        for (unsigned int k = 0; k < x.size(); ++k)
          product[k] /= masses[k / dim];
        const double last = eigenvalue;
        eigenvalue        = product.l2_norm();
        change            = std::abs(eigenvalue - last) / eigenvalue;
        x.swap(product);
      }
    return std::sqrt(eigenvalue);
  }



  CentralDifferences::CentralDifferences(const MultibodySystem &system,
                                         Statistics &statistics)
    : system(system)
    , statistics(statistics)
    , compliance(Eigen::MatrixXd::Zero(system.n_marker_values(),
                                       system.n_marker_values()))
  {
    check_supported(system);
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const Body &body = system.bodies()[b];
        longest          = std::max(longest, body.operators().length);
        inverse_masses.push_back(lumped_masses(body.operators()));
        for (double &mass : inverse_masses[b])
          mass = 1 / mass;
        forces.emplace_back(body.operators().n_unknowns());

        const auto &functionals = body.reference().functionals();
        const auto &markers     = system.body_markers(b);
        std::vector<double> dense(body.operators().n_nodes);
        for (unsigned int p = 0; p < markers.size(); ++p)
          {
            const NodalFunctional &first = functionals[markers[p]];
            std::fill(dense.begin(), dense.end(), 0.);
            for (unsigned int k = 0; k < first.nodes.size(); ++k)
              dense[first.nodes[k]] =
                first.weights[k] * inverse_masses[b][first.nodes[k]];
            for (unsigned int q = 0; q < markers.size(); ++q)
              {
                const NodalFunctional &second = functionals[markers[q]];
                double sum                    = 0;
                for (unsigned int k = 0; k < second.nodes.size(); ++k)
                  sum += second.weights[k] * dense[second.nodes[k]];
                for (unsigned int i = 0; i < dim; ++i)
                  compliance(dim * (system.first_marker(b) + p) + i,
                             dim * (system.first_marker(b) + q) + i) = sum;
              }
          }
      }
  }



  double
  CentralDifferences::critical_step_size() const
  {
    double frequency = 0;
    for (const Body &body : system.bodies())
      frequency = std::max(frequency,
                           highest_frequency(body.operators(),
                                             lumped_masses(body.operators())));
    return 2 / frequency;
  }



  Eigen::MatrixXd
  CentralDifferences::jacobian(const double t, const Eigen::VectorXd &s) const
  {
    Eigen::MatrixXd D =
      Eigen::MatrixXd::Zero(system.n_constraints(), system.n_marker_values());
    const MarkerLinearization linearization =
      system.linearize(t,
                       s,
                       Eigen::VectorXd(),
                       Eigen::VectorXd::Zero(system.n_constraints()),
                       Eigen::VectorXd());
    for (const auto &entry : linearization.constraints)
      D(entry.row(), entry.col()) += entry.value();
    return D;
  }



  Eigen::VectorXd
  CentralDifferences::solve_constraints(const double t,
                                        const Eigen::VectorXd &s,
                                        const Eigen::MatrixXd &D,
                                        Eigen::VectorXd multipliers) const
  {
    const Eigen::MatrixXd columns = compliance * D.transpose();
    for (unsigned int k = 0; k < 20; ++k)
      {
        const Eigen::VectorXd now      = s - columns * multipliers;
        const Eigen::VectorXd residual = system.constraint_residual(t, now);
        if (residual.lpNorm<Eigen::Infinity>() <= 1e-13 * longest)
          return multipliers;
        multipliers +=
          (jacobian(t, now) * columns).partialPivLu().solve(residual);
      }
    throw SimulationError("The joints cannot be satisfied at time " +
                          std::to_string(t) + " s.");
  }



  void
  CentralDifferences::start(SystemState &state)
  {
    state.multipliers.setZero();
    is_first_step = true;
  }



  void
  CentralDifferences::step(SystemState &state, const double step_size)
  {
    const double h = step_size;
    // the velocities at t = 0 are not those of the middle of a step
    const double impulse = is_first_step ? h / 2 : h;
    is_first_step        = false;

    Eigen::MatrixXd D;
    if (system.n_constraints() > 0)
      D = jacobian(state.time, system.marker_values(state.positions));
    SystemVector &x = state.positions;
    for (unsigned int b = 0; b < x.size(); ++b)
      {
        NodalVector &f = forces[b];
        scratch.reinit(f.size(), true);
        if (!elastic_force(system.bodies()[b], x[b], f, scratch))
          throw SimulationError("A body is turned inside out.");
        ++statistics.force_evaluations;
        f *= -1;
        system.add_loads(b, state.time, x[b], f);
        NodalVector &v = state.velocities[b];
        for (unsigned int a = 0; a < inverse_masses[b].size(); ++a)
          for (unsigned int i = 0; i < dim; ++i)
            {
              const unsigned int k = dim * a + i;
              v[k] += impulse * inverse_masses[b][a] * f[k];
              x[b][k] += h * v[k];
            }
      }
    state.time += h;
    if (system.n_constraints() == 0)
      return;

    state.multipliers       = solve_constraints(state.time,
                                          system.marker_values(x),
                                          h * impulse * D,
                                          state.multipliers);
    const Eigen::VectorXd F = -D.transpose() * state.multipliers;
    for (unsigned int b = 0; b < x.size(); ++b)
      for (unsigned int p = 0; p < system.body_markers(b).size(); ++p)
        {
          const NodalFunctional &functional =
            system.bodies()[b]
              .reference()
              .functionals()[system.body_markers(b)[p]];
          for (unsigned int k = 0; k < functional.nodes.size(); ++k)
            for (unsigned int i = 0; i < dim; ++i)
              {
                const unsigned int a = functional.nodes[k];
                const double change  = impulse * inverse_masses[b][a] *
                                      functional.weights[k] *
                                      F(dim * (system.first_marker(b) + p) + i);
                state.velocities[b][dim * a + i] += change;
                x[b][dim * a + i] += h * change;
              }
        }
  }
} // namespace Baselines
