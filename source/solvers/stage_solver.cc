// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/stage_solver.h>

#include <deal.II/base/numbers.h>

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



    // sum_i factor_i R^T r_i for one body
    template <typename Number>
    void
    combine_in_body_frame(const StageVector &stages,
                          const unsigned int body,
                          const std::vector<Number> &factors,
                          const Matrix3 &rotation,
                          std::vector<Number> &result)
    {
      const unsigned int n = stages[0][body].size() / dim;
      result.resize(dim * n);
      for (unsigned int a = 0; a < n; ++a)
        {
          Number sum[dim] = {};
          for (unsigned int i = 0; i < factors.size(); ++i)
            for (unsigned int c = 0; c < dim; ++c)
              sum[c] += factors[i] * stages[i][body][dim * a + c];
          for (unsigned int c = 0; c < dim; ++c)
            result[dim * a + c] = rotation[0][c] * sum[0] +
                                  rotation[1][c] * sum[1] +
                                  rotation[2][c] * sum[2];
        }
    }



    // z += Re(factor R w) for one body and stage
    template <typename Number>
    void
    add_in_world_frame(const std::vector<Number> &w,
                       const Number factor,
                       const Matrix3 &rotation,
                       NodalVector &z)
    {
      for (unsigned int a = 0; a < w.size() / dim; ++a)
        {
          Vector3 value;
          for (unsigned int c = 0; c < dim; ++c)
            value[c] = std::real(factor * w[dim * a + c]);
          for (unsigned int c = 0; c < dim; ++c)
            z[dim * a + c] += rotation[c] * value;
        }
    }



    template <typename Number>
    std::unique_ptr<JointSchurComplement<Number>>
    make_schur_complement(const MultibodySystem &system,
                          const std::vector<Matrix3> &rotations,
                          const Number shift,
                          FactorizationCache &cache,
                          Statistics &statistics)
    {
      std::vector<JointedFactorization<Number> *> factors;
      for (const Body &body : system.bodies())
        factors.push_back(&cache.get(body, shift));
      return std::make_unique<JointSchurComplement<Number>>(system,
                                                            rotations,
                                                            factors,
                                                            statistics);
    }
  } // namespace



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
                                   const std::vector<Matrix3> &new_rotations)
  {
    rotations = new_rotations;
    for (unsigned int k = 0; k < diagonalization.components.size(); ++k)
      {
        const auto &component = diagonalization.components[k];
        const std::complex<double> shift =
          component.eigenvalue / (step_size * step_size);
        if (component.is_real())
          real_systems[k] = make_schur_complement(
            system, rotations, shift.real(), cache, statistics);
        else
          complex_systems[k] =
            make_schur_complement(system, rotations, shift, cache, statistics);
      }
  }



  template <typename Number>
  void
  DiagonalizedStageSolver::solve_component(
    const StageDiagonalization::Component &component,
    JointSchurComplement<Number> &schur_complement,
    const StageVector &stages,
    const StageConstraints &constraints,
    StageVector &stage_increments,
    StageConstraints &constraint_increments)
  {
    using Vector = typename JointSchurComplement<Number>::Vector;

    const unsigned int n_stages = stages.size();
    std::vector<Number> from_stages, to_stages;
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        from_stages.push_back(convert<Number>(component.from_stages[i]));
        // the conjugate component contributes the conjugate
        to_stages.push_back((component.is_real() ? 1. : 2.) *
                            convert<Number>(component.to_stages[i]));
      }

    std::vector<std::vector<Number>> bodies(system.bodies().size());
    for (unsigned int b = 0; b < bodies.size(); ++b)
      combine_in_body_frame(stages, b, from_stages, rotations[b], bodies[b]);
    Vector g = Vector::Zero(system.n_constraints());
    for (unsigned int i = 0; i < n_stages; ++i)
      g += from_stages[i] * constraints[i].template cast<Number>();

    const Vector mu = schur_complement.solve(bodies, g);
    solve_counter<Number>(statistics) += bodies.size();

    for (unsigned int i = 0; i < n_stages; ++i)
      {
        for (unsigned int b = 0; b < bodies.size(); ++b)
          add_in_world_frame(bodies[b],
                             to_stages[i],
                             rotations[b],
                             stage_increments[i][b]);
        for (unsigned int r = 0; r < mu.size(); ++r)
          constraint_increments[i](r) += std::real(to_stages[i] * mu(r));
      }
  }



  void
  DiagonalizedStageSolver::solve(StageVector &stages,
                                 StageConstraints &constraints)
  {
    StageVector stage_increments(stages);
    StageConstraints constraint_increments(constraints);
    for (auto &stage : stage_increments)
      for (auto &vector : stage)
        vector = 0;
    for (auto &rows : constraint_increments)
      rows.setZero();

    for (unsigned int k = 0; k < diagonalization.components.size(); ++k)
      if (diagonalization.components[k].is_real())
        solve_component(diagonalization.components[k],
                        *real_systems[k],
                        stages,
                        constraints,
                        stage_increments,
                        constraint_increments);
      else
        solve_component(diagonalization.components[k],
                        *complex_systems[k],
                        stages,
                        constraints,
                        stage_increments,
                        constraint_increments);
    stages.swap(stage_increments);
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
                              const std::vector<Matrix3> &new_rotations)
  {
    rotations = new_rotations;
    for (unsigned int i = 0; i < systems.size(); ++i)
      systems[i] = make_schur_complement(system,
                                         rotations,
                                         1 / (step_size * step_size *
                                              triangularization.diagonal(i)),
                                         cache,
                                         statistics);
  }



  void
  OneStepStageSolver::solve(StageVector &stages, StageConstraints &constraints)
  {
    // With W_j = tau^2 D_j dY_j:
    // (M / (tau^2 D_i) + A) W_i + B^T dLambda_i = r_i - A sum_j<i L_ij W_j,
    // B W_i = g_i - sum_j<i L_ij B W_j.
    const unsigned int n_stages = stages.size();
    const unsigned int n_bodies = system.bodies().size();
    const auto &L               = triangularization.lower;

    std::vector<std::vector<std::vector<double>>> W(n_stages);
    StageConstraints BW(n_stages);
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        std::vector<double> select(n_stages, 0.);
        select[i] = 1;
        W[i].resize(n_bodies);
        for (unsigned int b = 0; b < n_bodies; ++b)
          {
            combine_in_body_frame(stages, b, select, rotations[b], W[i][b]);
            if (i == 0)
              continue;
            NodalVector sum(W[i][b].size()), product(W[i][b].size());
            for (unsigned int j = 0; j < i; ++j)
              for (unsigned int k = 0; k < sum.size(); ++k)
                sum[k] += L(i, j) * W[j][b][k];
            system.bodies()[b].operators().stiffness_matrix.vmult(product, sum);
            for (unsigned int k = 0; k < sum.size(); ++k)
              W[i][b][k] -= product[k];
          }
        BW[i] = constraints[i];
        for (unsigned int j = 0; j < i; ++j)
          BW[i] -= L(i, j) * BW[j];
        constraints[i] = systems[i]->solve(W[i], BW[i]);
        statistics.real_solves += n_bodies;
      }

    for (unsigned int i = 0; i < n_stages; ++i)
      for (unsigned int b = 0; b < n_bodies; ++b)
        {
          stages[i][b] = 0;
          for (unsigned int j = 0; j < n_stages; ++j)
            add_in_world_frame(W[j][b],
                               triangularization.increments(i, j),
                               rotations[b],
                               stages[i][b]);
        }
  }
} // namespace ACF
