// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/solvers/stage_frames.h>
#include <acf/solvers/stage_solver.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  namespace
  {
    template <typename Number>
    Number
    convert(const std::complex<double> &z)
    {
      if constexpr (std::is_same<Number, double>::value)
        return z.real();
      else
        return z;
    }



    template <typename Number>
    unsigned long &
    solve_counter(Statistics &statistics)
    {
      return std::is_same<Number, double>::value ? statistics.real_solves
                                                 : statistics.complex_solves;
    }



    // The rotations of a body in the stages, or the mean one of all.
    std::vector<const NodeRotations *>
    frames_of(const StageRotations &rotations,
              const unsigned int body,
              const bool are_mean)
    {
      std::vector<const NodeRotations *> frames;
      for (const auto &stage : rotations.stages)
        frames.push_back(are_mean ? &rotations.mean[body] : &stage[body]);
      return frames;
    }



    // One body in all stages.
    std::vector<NodalVector *>
    stages_of(StageVector &vector, const unsigned int body)
    {
      std::vector<NodalVector *> stages;
      for (SystemVector &stage : vector)
        stages.push_back(&stage[body]);
      return stages;
    }

    std::vector<const NodalVector *>
    stages_of(const StageVector &vector, const unsigned int body)
    {
      std::vector<const NodalVector *> stages;
      for (const SystemVector &stage : vector)
        stages.push_back(&stage[body]);
      return stages;
    }



    // The matrix of a body in which rate stands for the derivative by time:
    // with Rayleigh damping rate^2 M + rate (alpha M + beta A) + A.
    template <typename Number>
    BodyMatrix<Number>
    body_matrix(const Body &body, const Number rate, const Number squared_rate)
    {
      if (!body.is_damped())
        return {squared_rate, Number(1)};
      const Number scale = 1. + body.stiffness_damping() * rate;
      return {(squared_rate + body.mass_damping() * rate) / scale, scale};
    }



    // The rate of a component of the diagonalised stages, and its square;
    // eigenvalues of the inverse tableau have positive real parts.
    std::pair<std::complex<double>, std::complex<double>>
    rates_of(const StageDiagonalization::Component &component,
             const double step_size)
    {
      return {std::sqrt(component.eigenvalue) / step_size,
              component.eigenvalue / (step_size * step_size)};
    }

    // Those of a one-step matrix.
    std::pair<double, double>
    rates_of(const double diagonal, const double step_size)
    {
      const double squared_rate = 1 / (step_size * step_size * diagonal);
      return {std::sqrt(squared_rate), squared_rate};
    }



    // Makes a system if there is none, and prepares it.
    template <typename Number>
    void
    prepare_system(std::unique_ptr<CoupledSystem<Number>> &coupled_system,
                   const MultibodySystem &system,
                   const Number rate,
                   const Number squared_rate,
                   const std::vector<NodeRotations> &rotations,
                   const MarkerLinearization &linearization,
                   const std::vector<LowRankChange> &changes,
                   FactorizationCache &cache,
                   Statistics &statistics)
    {
      if (!coupled_system)
        coupled_system =
          std::make_unique<CoupledSystem<Number>>(system, cache, statistics);
      std::vector<BodyMatrix<Number>> matrices;
      for (const Body &body : system.bodies())
        matrices.push_back(body_matrix(body, rate, squared_rate));
      coupled_system->prepare(matrices,
                              rotations,
                              linearization,
                              {squared_rate, rate, Number(1)},
                              changes);
    }
  } // namespace



  std::vector<StageMatrix>
  stage_matrices(const Body &body,
                 const ButcherTableau &tableau,
                 const bool one_step,
                 const double step_size)
  {
    std::vector<StageMatrix> matrices;
    if (one_step)
      {
        const Eigen::VectorXd diagonal = triangularize_stages(tableau).diagonal;
        for (const double entry : diagonal)
          {
            const auto [rate, squared_rate] = rates_of(entry, step_size);
            matrices.push_back(
              {body_matrix(body, rate, squared_rate).shift, true});
          }
        return matrices;
      }
    for (const auto &component : diagonalize_stages(tableau).components)
      {
        const auto [rate, squared_rate] = rates_of(component, step_size);
        if (component.is_real())
          matrices.push_back(
            {body_matrix(body, rate.real(), squared_rate.real()).shift, true});
        else
          matrices.push_back(
            {body_matrix(body, rate, squared_rate).shift, false});
      }
    return matrices;
  }



  DiagonalizedStageSolver::DiagonalizedStageSolver(
    const MultibodySystem &system,
    const ButcherTableau &tableau,
    FactorizationCache &cache,
    Statistics &statistics)
    : system(system)
    , diagonalization(diagonalize_stages(tableau))
    , cache(cache)
    , statistics(statistics)
    , real_systems(diagonalization.components.size())
    , complex_systems(diagonalization.components.size())
  {}



  void
  DiagonalizedStageSolver::prepare(const double step_size,
                                   const StageRotations &new_rotations,
                                   const MarkerLinearization &linearization,
                                   const std::vector<LowRankChange> &changes)
  {
    rotations = new_rotations;
    for (unsigned int k = 0; k < diagonalization.components.size(); ++k)
      {
        const auto &component           = diagonalization.components[k];
        const auto [rate, squared_rate] = rates_of(component, step_size);
        if (component.is_real())
          prepare_system(real_systems[k],
                         system,
                         rate.real(),
                         squared_rate.real(),
                         rotations.mean,
                         linearization,
                         changes,
                         cache,
                         statistics);
        else
          prepare_system(complex_systems[k],
                         system,
                         rate,
                         squared_rate,
                         rotations.mean,
                         linearization,
                         changes,
                         cache,
                         statistics);
      }
  }



  template <typename Number>
  void
  DiagonalizedStageSolver::solve_component(
    const StageDiagonalization::Component &component,
    CoupledSystem<Number> &coupled_system,
    const bool is_first,
    const StageVector *const stages,
    const StageConstraints &constraints,
    StageVector &stage_increments,
    StageConstraints &constraint_increments)
  {
    using Vector = typename CoupledSystem<Number>::Vector;

    const unsigned int n_stages = constraints.size();
    const unsigned int n_bodies = system.bodies().size();
    std::vector<Number> from_stages, to_stages;
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        from_stages.push_back(convert<Number>(component.from_stages[i]));
        // the conjugate component contributes the conjugate
        to_stages.push_back((component.is_real() ? 1. : 2.) *
                            convert<Number>(component.to_stages[i]));
      }
    Vector g = Vector::Zero(system.n_constraints());
    for (unsigned int i = 0; i < n_stages; ++i)
      g += from_stages[i] * constraints[i].template cast<Number>();

    Vector mu;
    if (stages != nullptr)
      {
        run_tasks(n_bodies, [&](const unsigned int b) {
          combine_in_body_frame(stages_of(*stages, b),
                                from_stages,
                                frames_of(rotations, b, false),
                                coupled_system.body(b));
        });
        mu = coupled_system.solve(g);
        solve_counter<Number>(statistics) += n_bodies;
      }
    else
      mu = coupled_system.solve_constraints(g);

    run_tasks(n_bodies, [&](const unsigned int b) {
      if (const Number *const w = coupled_system.solution(b))
        add_in_world_frame(w,
                           to_stages,
                           frames_of(rotations, b, stages == nullptr),
                           is_first && stages != nullptr,
                           stages_of(stage_increments, b));
    });
    for (unsigned int i = 0; i < n_stages; ++i)
      for (unsigned int r = 0; r < mu.size(); ++r)
        constraint_increments[i](r) =
          (is_first ? 0 : constraint_increments[i](r)) +
          std::real(to_stages[i] * mu(r));
  }



  void
  DiagonalizedStageSolver::solve_all(const StageVector *const stages,
                                     const StageConstraints &constraints,
                                     StageVector &stage_increments,
                                     StageConstraints &constraint_increments)
  {
    for (unsigned int k = 0; k < diagonalization.components.size(); ++k)
      if (diagonalization.components[k].is_real())
        solve_component(diagonalization.components[k],
                        *real_systems[k],
                        k == 0,
                        stages,
                        constraints,
                        stage_increments,
                        constraint_increments);
      else
        solve_component(diagonalization.components[k],
                        *complex_systems[k],
                        k == 0,
                        stages,
                        constraints,
                        stage_increments,
                        constraint_increments);
  }



  void
  DiagonalizedStageSolver::solve(StageVector &stages,
                                 StageConstraints &constraints)
  {
    StageConstraints constraint_increments(constraints);
    // one component has read the right-hand sides before it writes
    if (diagonalization.components.size() == 1)
      solve_all(&stages, constraints, stages, constraint_increments);
    else
      {
        work = stages;
        solve_all(&work, constraints, stages, constraint_increments);
      }
    constraints.swap(constraint_increments);
  }



  void
  DiagonalizedStageSolver::solve_constraints(StageVector &stages,
                                             StageConstraints &constraints)
  {
    StageConstraints constraint_increments(constraints);
    solve_all(nullptr, constraints, stages, constraint_increments);
    constraints.swap(constraint_increments);
  }



  OneStepStageSolver::OneStepStageSolver(const MultibodySystem &system,
                                         const ButcherTableau &tableau,
                                         FactorizationCache &cache,
                                         Statistics &statistics)
    : system(system)
    , triangularization(triangularize_stages(tableau))
    , cache(cache)
    , statistics(statistics)
    , systems(tableau.n_stages())
  {}



  void
  OneStepStageSolver::prepare(const double step_size,
                              const StageRotations &new_rotations,
                              const MarkerLinearization &linearization,
                              const std::vector<LowRankChange> &changes)
  {
    rotations            = new_rotations;
    const unsigned int n = system.n_marker_values();
    marker_stiffness.resize(n, n);
    marker_stiffness.setFromTriplets(linearization.stiffness.begin(),
                                     linearization.stiffness.end());
    for (unsigned int i = 0; i < systems.size(); ++i)
      {
        const auto [rate, squared_rate] =
          rates_of(triangularization.diagonal(i), step_size);
        prepare_system(systems[i],
                       system,
                       rate,
                       squared_rate,
                       rotations.mean,
                       linearization,
                       changes,
                       cache,
                       statistics);
      }
  }



  void
  OneStepStageSolver::multiply_stiffness(const SystemVector &w,
                                         SystemVector &product) const
  {
    Eigen::VectorXd F;
    const auto rotate = [&](const bool to_world) {
      for (unsigned int b = 0; b < w.size(); ++b)
        for (unsigned int p = 0; p < system.body_markers(b).size(); ++p)
          {
            const NodalFunctional &functional =
              system.bodies()[b]
                .reference()
                .functionals()[system.body_markers(b)[p]];
            const Matrix3 &R     = rotations.mean[b][functional.nodes[0]];
            const unsigned int k = dim * (system.first_marker(b) + p);
            const Vector3 value({F(k), F(k + 1), F(k + 2)});
            const Vector3 rotated = to_world ? R * value : value * R;
            for (unsigned int i = 0; i < dim; ++i)
              F(k + i) = rotated[i];
          }
    };
    if (marker_stiffness.nonZeros() > 0)
      {
        F = system.marker_values(w);
        rotate(true);
        F = (marker_stiffness * F).eval();
        rotate(false);
      }
    for (unsigned int b = 0; b < w.size(); ++b)
      {
        system.bodies()[b].operators().stiffness_matrix.vmult(product[b], w[b]);
        if (F.size() > 0)
          system.add_marker_forces(b, F, product[b]);
      }
  }



  void
  OneStepStageSolver::solve_all(const StageVector *const stages,
                                const StageConstraints &constraints,
                                StageVector &stage_increments,
                                StageConstraints &constraint_increments)
  {
    // With W_j = tau^2 D_j dY_j:
    // (M / (tau^2 D_i) + K) W_i + B^T dLambda_i = r_i - K sum_j<i L_ij W_j,
    // B W_i = g_i - sum_j<i L_ij B W_j.
    const unsigned int n_stages = constraints.size();
    const unsigned int n_bodies = system.bodies().size();
    const auto &L               = triangularization.lower;

    StageConstraints BW(n_stages);
    SystemVector sum(stage_increments[0]), product(stage_increments[0]);
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        std::vector<double> select(n_stages, 0.);
        select[i] = 1;
        for (unsigned int b = 0; b < n_bodies; ++b)
          {
            double *const r = systems[i]->body(b);
            if (stages != nullptr)
              combine_in_body_frame(stages_of(*stages, b),
                                    select,
                                    frames_of(rotations, b, false),
                                    r);
            else
              std::fill(r, r + sum[b].size(), 0.);
            sum[b] = 0;
            for (unsigned int j = 0; j < i; ++j)
              for (unsigned int k = 0; k < sum[b].size(); ++k)
                sum[b][k] += L(i, j) * systems[j]->body(b)[k];
          }
        if (i > 0)
          {
            multiply_stiffness(sum, product);
            for (unsigned int b = 0; b < n_bodies; ++b)
              for (unsigned int k = 0; k < product[b].size(); ++k)
                systems[i]->body(b)[k] -= product[b][k];
          }
        BW[i] = constraints[i];
        for (unsigned int j = 0; j < i; ++j)
          BW[i] -= L(i, j) * BW[j];
        constraint_increments[i] = systems[i]->solve(BW[i]);
        for (unsigned int b = 0; b < n_bodies; ++b)
          systems[i]->solution(b);
        statistics.real_solves += n_bodies;
      }

    for (unsigned int b = 0; b < n_bodies; ++b)
      {
        const auto frames = frames_of(rotations, b, stages == nullptr);
        for (unsigned int j = 0; j < n_stages; ++j)
          {
            std::vector<double> factors;
            for (unsigned int i = 0; i < n_stages; ++i)
              factors.push_back(triangularization.increments(i, j));
            add_in_world_frame(systems[j]->body(b),
                               factors,
                               frames,
                               j == 0 && stages != nullptr,
                               stages_of(stage_increments, b));
          }
      }
  }



  void
  OneStepStageSolver::solve(StageVector &stages, StageConstraints &constraints)
  {
    StageVector stage_increments(stages);
    StageConstraints constraint_increments(constraints);
    solve_all(&stages, constraints, stage_increments, constraint_increments);
    stages.swap(stage_increments);
    constraints.swap(constraint_increments);
  }



  void
  OneStepStageSolver::solve_constraints(StageVector &stages,
                                        StageConstraints &constraints)
  {
    StageConstraints constraint_increments(constraints);
    solve_all(nullptr, constraints, stages, constraint_increments);
    constraints.swap(constraint_increments);
  }
} // namespace ACF
