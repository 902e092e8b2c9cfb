// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/tangent_system.h>

#include <algorithm>
#include <limits>

namespace ACF
{
  TangentSystem::TangentSystem(const MultibodySystem &system,
                               Statistics &statistics)
    : system(system)
    , statistics(statistics)
  {}



  bool
  TangentSystem::linearize(const SystemState &state, const double load_factor)
  {
    tangents.clear();
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        auto tangent =
          ElasticTangent::at(system.bodies()[b], state.positions[b]);
        if (!tangent)
          return false;
        tangents.push_back(std::move(*tangent));
      }
    const unsigned int n = system.n_marker_values();
    linearization        = system.linearize(state.time,
                                     system.marker_values(state.positions),
                                     Eigen::VectorXd::Zero(n),
                                     state.multipliers,
                                     state.law_values,
                                     load_factor);
    G.resize(n, n);
    G.setFromTriplets(linearization.stiffness.begin(),
                      linearization.stiffness.end());
    lumped_mass.resize(n, n);
    lumped_mass.setFromTriplets(linearization.mass.begin(),
                                linearization.mass.end());
    return true;
  }



  void
  TangentSystem::add_marker_product(const Eigen::SparseMatrix<double> &N,
                                    const SystemVector &x,
                                    SystemVector &y) const
  {
    if (N.nonZeros() == 0)
      return;
    const Eigen::VectorXd F = N * system.marker_values(x);
    for (unsigned int b = 0; b < y.size(); ++b)
      system.add_marker_forces(b, F, y[b]);
  }



  void
  TangentSystem::apply_stiffness(SystemVector &y, const SystemVector &x) const
  {
    for (unsigned int b = 0; b < x.size(); ++b)
      tangents[b].vmult(y[b], x[b]);
    add_marker_product(G, x, y);
  }



  void
  TangentSystem::apply_mass(SystemVector &y, const SystemVector &x) const
  {
    for (unsigned int b = 0; b < x.size(); ++b)
      system.bodies()[b].operators().mass_matrix.vmult(y[b], x[b]);
    add_marker_product(lumped_mass, x, y);
  }



  void
  TangentSystem::factorize(const double shift)
  {
    if (shift != factor_shift)
      {
        coupled_system.reset();
        cache = std::make_unique<FactorizationCache>(statistics);
        coupled_system =
          std::make_unique<CoupledSystem<double>>(system, *cache, statistics);
        factor_shift = shift;
      }
    std::vector<NodeRotations> rotations;
    std::vector<LowRankChange> changes;
    for (unsigned int b = 0; b < tangents.size(); ++b)
      {
        const ReducedStrainTangent &reduced = tangents[b].reduced_tangent();
        rotations.push_back(tangents[b].rotation());
        changes.push_back({reduced.columns, reduced.coefficients});
        if (auto matrix = tangents[b].matrix(rotations[b]))
          cache->replace_stiffness(system.bodies()[b], std::move(matrix));
      }
    coupled_system->prepare(
      std::vector<BodyMatrix<double>>(system.bodies().size(), {shift, 1.}),
      rotations,
      linearization,
      {shift, 0., 1.},
      changes);
  }



  void
  TangentSystem::solve(SystemVector &r, Eigen::VectorXd &g)
  {
    for (unsigned int b = 0; b < r.size(); ++b)
      NodeRotations(tangents[b].rotation())
        .to_body(r[b],
                 system.bodies()[b].operators().n_nodes,
                 coupled_system->body(b));
    g = coupled_system->solve(g);
    statistics.real_solves += r.size();
    for (unsigned int b = 0; b < r.size(); ++b)
      NodeRotations(tangents[b].rotation())
        .to_world(coupled_system->solution(b),
                  system.bodies()[b].operators().n_nodes,
                  r[b]);
  }



  double
  slow_squared_rate(const MultibodySystem &system)
  {
    double rate = std::numeric_limits<double>::max();
    for (const Body &body : system.bodies())
      {
        const Material &material = body.material();
        const double length      = body.operators().length;
        rate                     = std::min(rate,
                        1e-6 * material.youngs_modulus /
                          (material.density * length * length));
      }
    return rate;
  }
} // namespace ACF
