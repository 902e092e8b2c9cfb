// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/parallel.h>
#include <acf/solvers/coupled_system.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ACF
{
  template <typename Number>
  CoupledSystem<Number>::CoupledSystem(const MultibodySystem &system,
                                       FactorizationCache &cache,
                                       Statistics &statistics)
    : system(system)
    , cache(cache)
    , statistics(statistics)
    , offsets(system.bodies().size())
  {
    std::size_t n = 0;
    for (const Body &body : system.bodies())
      n += body.operators().n_unknowns();
    values.resize(n);
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      first_values.push_back(dim * system.first_marker(b));
  }



  template <typename Number>
  void
  CoupledSystem<Number>::group_bodies()
  {
    groups.clear();
    for (unsigned int b = 0; b < factors.size(); ++b)
      {
        const auto group =
          std::find_if(groups.begin(), groups.end(), [&](const auto &other) {
            return factors[other[0]] == factors[b];
          });
        if (group == groups.end())
          groups.push_back({b});
        else
          group->push_back(b);
      }
    std::size_t offset = 0;
    for (const auto &group : groups)
      for (const unsigned int b : group)
        {
          offsets[b] = offset;
          offset += factors[b]->size();
        }
  }



  namespace
  {
    // ", the constraints of the joints 'a', 'b' depend on each other", if so.
    std::string
    dependent_joints(const MultibodySystem &system,
                     const Eigen::SparseMatrix<double> &D)
    {
      using Iterator = Eigen::SparseMatrix<double>::InnerIterator;

      for (unsigned int k = 0; k < D.cols(); ++k)
        for (Iterator entry(D, k); entry; ++entry)
          if (!std::isfinite(entry.value()))
            return ", the gradient of a constraint of the joint '" +
                   system.joints()[system.joint_of_row(entry.row())].name +
                   "' is not finite";
      const Eigen::MatrixXd null_space =
        find_repeated_constraints(D * D.transpose()).null_space;
      std::set<std::string> names;
      for (unsigned int r = 0; r < null_space.rows(); ++r)
        if (null_space.cols() > 0 &&
            null_space.row(r).lpNorm<Eigen::Infinity>() > 1e-6)
          names.insert("'" + system.joints()[system.joint_of_row(r)].name +
                       "'");
      std::string list;
      for (const std::string &name : names)
        list += (list.empty() ? "" : ", ") + name;
      return list.empty() ? ""
                          : ", as constraints of the joints " + list +
                              " depend on each other";
    }
  } // namespace



  template <typename Number>
  void
  CoupledSystem<Number>::prepare(
    const std::vector<BodyMatrix<Number>> &matrices,
    const std::vector<NodeRotations> &node_rotations,
    const MarkerLinearization &linearization,
    const MarkerCoefficients<Number> &coefficients,
    const std::vector<LowRankChange> &terms)
  {
    const unsigned int n_bodies = system.bodies().size();
    factors.resize(n_bodies);
    scales.resize(n_bodies);
    rotations.resize(system.n_marker_values() / dim);
    for (unsigned int b = 0; b < n_bodies; ++b)
      {
        factors[b]          = &cache.get(system.bodies()[b], matrices[b].shift);
        scales[b]           = matrices[b].scale;
        const auto &markers = system.body_markers(b);
        for (unsigned int p = 0; p < markers.size(); ++p)
          {
            const NodalFunctional &functional =
              system.bodies()[b].reference().functionals()[markers[p]];
            const Matrix3 &R = node_rotations[b][functional.nodes[0]];
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                rotations[system.first_marker(b) + p](i, j) = R[i][j];
          }
      }
    group_bodies();
    compliances.resize(n_bodies);
    for (unsigned int b = 0; b < n_bodies; ++b)
      compliances[b] = {&factors[b]->compliance(),
                        rotations.data() + system.first_marker(b),
                        &system.body_markers(b),
                        Number(1) / scales[b]};
    const unsigned int n = system.n_marker_values();
    const unsigned int m = system.n_constraints();
    prepare_changes(terms);
    if (n + n_change_unknowns == 0)
      return;

    // H and D, with one pattern for all times
    triplets.clear();
    const auto append = [&](const MarkerLinearization::Triplets &entries,
                            const Number factor) {
      for (const auto &entry : entries)
        triplets.emplace_back(entry.col(), entry.row(), factor * entry.value());
    };
    append(linearization.stiffness, coefficients.stiffness);
    append(linearization.damping, coefficients.damping);
    append(linearization.mass, coefficients.mass);
    H_transposed.assemble(n, n, triplets, is_first);
    marker_sizes.clear();
    if (!triplets.empty())
      for (const auto &compliance : compliances)
        compliance.append_sizes(marker_sizes);
    D.assemble(m, n, linearization.constraints, is_first);
    redundancy = linearization.redundancy;

    is_complete = false;
    if (!changes.empty() || !stiffness_is_small())
      factorize_all();
    else if (m > 0)
      {
        if (constraint_system.factorize(
              compliances, first_values, D.matrix(), redundancy))
          ++statistics.constraint_factorizations;
        else
          factorize_all();
      }
    is_first = false;
  }



  template <typename Number>
  void
  CoupledSystem<Number>::factorize_all()
  {
    ++statistics.marker_factorizations;
    if (!marker_system.factorize(compliances,
                                 first_values,
                                 H_transposed.matrix(),
                                 D.matrix(),
                                 redundancy,
                                 changes))
      throw SimulationError(
        "the equations of the joints and force elements are singular" +
        dependent_joints(system, D.matrix()));
    is_complete = true;
  }



  template <typename Number>
  void
  CoupledSystem<Number>::prepare_changes(
    const std::vector<LowRankChange> &terms)
  {
    changes.clear();
    n_change_unknowns = 0;
    if (std::all_of(terms.begin(), terms.end(), [](const auto &term) {
          return term.columns.cols() == 0;
        }))
      return;

    const PhaseTimer timer(statistics, "solves");
    const unsigned int first =
      system.n_marker_values() + system.n_constraints();
    changes.resize(terms.size());
    for (unsigned int b = 0; b < terms.size(); ++b)
      {
        MatrixChange<Number> &change = changes[b];
        const unsigned int rank      = terms[b].columns.cols();
        change.first                 = first + n_change_unknowns;
        n_change_unknowns += rank;
        change.marker_values.resize(dim * system.body_markers(b).size(), rank);
        if (rank == 0)
          continue;

        // columns of U may have different units
        const Eigen::VectorXd norms = terms[b].columns.colwise().norm();
        const Eigen::MatrixXd B =
          norms.asDiagonal() * terms[b].coefficients * norms.asDiagonal();
        change.size    = B.cwiseAbs().maxCoeff();
        change.columns = (terms[b].columns * norms.cwiseInverse().asDiagonal())
                           .template cast<Number>();
        change.solutions = change.columns;
        factors[b]->factorization().solve(change.solutions.data(), rank);
        change.solutions /= scales[b];
        change.matrix = change.columns.transpose() * change.solutions;
        change.matrix += B.inverse().template cast<Number>();
        change.matrix *= change.size;
        for (unsigned int j = 0; j < rank; ++j)
          {
            Vector s(change.marker_values.rows());
            evaluate_markers(b, change.solutions.col(j).data(), s);
            change.marker_values.col(j) = s;
          }
      }
  }



  template <typename Number>
  void
  CoupledSystem<Number>::solve_bodies()
  {
    const PhaseTimer timer(statistics, "solves");
    run_tasks(groups.size(), [&](const unsigned int k) {
      const auto &group = groups[k];
      factors[group[0]]->factorization().solve(body(group[0]), group.size());
      for (const unsigned int b : group)
        if (scales[b] != Number(1))
          for (std::size_t i = 0; i < factors[b]->size(); ++i)
            body(b)[i] /= scales[b];
    });
  }



  template <typename Number>
  void
  CoupledSystem<Number>::evaluate_markers(const unsigned int b,
                                          const Number *w,
                                          Eigen::Ref<Vector> s) const
  {
    const auto &markers = system.body_markers(b);
    for (unsigned int p = 0; p < markers.size(); ++p)
      s.template segment<dim>(dim * p) =
        rotations[system.first_marker(b) + p] *
        factors[b]->functional_value(markers[p], w);
  }



  template <typename Number>
  typename CoupledSystem<Number>::Vector
  CoupledSystem<Number>::marker_displacements(const Vector &phi) const
  {
    Vector s(phi.size());
    for (unsigned int b = 0; b < compliances.size(); ++b)
      {
        const unsigned int n = compliances[b].n_values();
        s.segment(first_values[b], n) =
          compliances[b].displacements(phi.segment(first_values[b], n));
      }
    return s;
  }



  template <typename Number>
  double
  CoupledSystem<Number>::largest_displacement(const Vector &s) const
  {
    double result = 0;
    for (unsigned int p = 0; p < marker_sizes.size(); ++p)
      result = std::max(result,
                        s.template segment<dim>(dim * p).squaredNorm() /
                          marker_sizes[p]);
    return std::sqrt(result);
  }



  template <typename Number>
  bool
  CoupledSystem<Number>::stiffness_is_small() const
  {
    const auto &H = H_transposed.matrix();
    for (unsigned int k = 0; k < H.outerSize(); ++k)
      for (typename std::decay_t<decltype(H)>::InnerIterator entry(H, k); entry;
           ++entry)
        if (entry.row() / dim == k / dim &&
            marker_sizes[k / dim] * std::abs(entry.value()) >
              largest_contraction)
          return false;
    return true;
  }



  template <typename Number>
  bool
  CoupledSystem<Number>::eliminate_markers(const Vector &uncoupled,
                                           const Vector &g,
                                           Vector &mu,
                                           Vector &phi)
  {
    const bool constrained = g.size() > 0;
    mu                     = g;
    if (constrained)
      mu = constraint_system.solve(D.matrix() * uncoupled - g);
    phi = D.matrix().transpose() * mu;
    if (H_transposed.matrix().nonZeros() == 0)
      return true;

    Vector change     = uncoupled - marker_displacements(phi);
    const double size = largest_displacement(change);
    double contracted = size;
    while (true)
      {
        Vector force = H_transposed.matrix().transpose() * change;
        change       = -marker_displacements(force);
        if (!(largest_displacement(change) > 1e-10 * size))
          return true;
        if (constrained)
          {
            const Vector mu_change =
              constraint_system.solve(D.matrix() * change);
            mu += mu_change;
            const Vector reactions = D.matrix().transpose() * mu_change;
            force += reactions;
            change -= marker_displacements(reactions);
          }
        const double next = largest_displacement(change);
        if (next > largest_contraction * contracted)
          return false;
        contracted = next;
        phi += force;
      }
  }



  template <typename Number>
  typename CoupledSystem<Number>::Vector
  CoupledSystem<Number>::couple(const Vector &uncoupled,
                                const Vector &g,
                                const Vector &change_values)
  {
    const unsigned int n = system.n_marker_values();
    Vector mu;
    if (is_complete || !eliminate_markers(uncoupled, g, mu, marker_forces))
      {
        if (!is_complete)
          factorize_all();
        Vector rhs(n + g.size() + n_change_unknowns);
        rhs << uncoupled, g, change_values;
        unknowns      = marker_system.solve(rhs);
        mu            = unknowns.segment(n, g.size());
        marker_forces = H_transposed.matrix().transpose() * unknowns.head(n) +
                        D.matrix().transpose() * mu;
      }
    return mu;
  }



  template <typename Number>
  const Number *
  CoupledSystem<Number>::solution(const unsigned int b)
  {
    const bool has_markers = !system.body_markers(b).empty();
    const bool is_changed  = !changes.empty() && changes[b].columns.cols() > 0;
    if (right_hand_sides_are_zero)
      {
        if (!has_markers && !is_changed)
          return nullptr;
        if (!has_markers)
          std::fill(body(b), body(b) + factors[b]->size(), Number(0));
      }
    if (has_markers)
      factors[b]->subtract_columns(
        compliances[b].functional_forces(
          marker_forces.segment(first_values[b], compliances[b].n_values())),
        body(b),
        right_hand_sides_are_zero);
    if (is_changed)
      Eigen::Map<Vector>(body(b), factors[b]->size()) -=
        changes[b].solutions *
        (changes[b].size *
         unknowns.segment(changes[b].first, changes[b].columns.cols()));
    return body(b);
  }



  template <typename Number>
  typename CoupledSystem<Number>::Vector
  CoupledSystem<Number>::solve(const Vector &g)
  {
    right_hand_sides_are_zero = false;
    solve_bodies();
    if (system.n_marker_values() + n_change_unknowns == 0)
      return g;
    Vector uncoupled(system.n_marker_values());
    Vector change_values(n_change_unknowns);
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        evaluate_markers(b,
                         body(b),
                         uncoupled.segment(dim * system.first_marker(b),
                                           dim *
                                             system.body_markers(b).size()));
        if (!changes.empty() && changes[b].columns.cols() > 0)
          change_values.segment(changes[b].first - uncoupled.size() - g.size(),
                                changes[b].columns.cols()) =
            changes[b].columns.transpose() *
            Eigen::Map<Vector>(body(b), factors[b]->size());
      }
    return couple(uncoupled, g, change_values);
  }



  template <typename Number>
  typename CoupledSystem<Number>::Vector
  CoupledSystem<Number>::solve_constraints(const Vector &g)
  {
    right_hand_sides_are_zero = true;
    if (system.n_marker_values() == 0)
      return g;
    return couple(Vector::Zero(system.n_marker_values()),
                  g,
                  Vector::Zero(n_change_unknowns));
  }



  template class CoupledSystem<double>;
  template class CoupledSystem<std::complex<double>>;
} // namespace ACF
