// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/stage_tangent.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <cmath>

namespace ACF
{
  namespace
  {
    // A vector of all stages, scaled, in one.
    class Packing
    {
    public:
      Packing(const MultibodySystem &system, const unsigned int n_stages)
        : n_stages(n_stages)
        , n_constraints(system.n_constraints())
      {
        for (const Body &body : system.bodies())
          {
            const BodyOperators &operators = body.operators();
            sizes.push_back(operators.n_unknowns());
            scales.push_back(operators.length *
                             std::sqrt(1. * operators.n_nodes));
            n_unknowns += operators.n_unknowns();
          }
      }

      unsigned int
      size() const
      {
        return n_stages * (n_unknowns + n_constraints);
      }

      // @param scaled whether to increments without dimension
      void
      pack(const StageVector &z,
           const StageConstraints &lambda,
           const bool scaled,
           Vector<double> &v) const
      {
        unsigned int k = 0;
        for (unsigned int i = 0; i < n_stages; ++i)
          {
            for (unsigned int b = 0; b < sizes.size(); ++b)
              for (const double value : z[i][b])
                v[k++] = scaled ? value / scales[b] : value;
            for (unsigned int r = 0; r < n_constraints; ++r)
              v[k++] = scaled ? lambda[i](r) / multiplier_scale : lambda[i](r);
          }
      }

      void
      unpack(const Vector<double> &v,
             const bool scaled,
             StageVector &z,
             StageConstraints &lambda) const
      {
        unsigned int k = 0;
        for (unsigned int i = 0; i < n_stages; ++i)
          {
            for (unsigned int b = 0; b < sizes.size(); ++b)
              for (double &value : z[i][b])
                value = scaled ? v[k++] * scales[b] : v[k++];
            for (unsigned int r = 0; r < n_constraints; ++r)
              lambda[i](r) = scaled ? v[k++] * multiplier_scale : v[k++];
          }
      }

      void
      balance_multipliers(const StageVector &z, const StageConstraints &lambda)
      {
        double positions = 0, multipliers = 0;
        for (unsigned int i = 0; i < n_stages; ++i)
          {
            for (unsigned int b = 0; b < sizes.size(); ++b)
              positions += z[i][b].norm_sqr() / (scales[b] * scales[b]);
            multipliers += lambda[i].squaredNorm();
          }
        if (positions > 0 && multipliers > 0)
          multiplier_scale = std::sqrt(multipliers / positions);
      }

    private:
      const unsigned int n_stages;
      const unsigned int n_constraints;
      unsigned int n_unknowns = 0;
      std::vector<unsigned int> sizes;
      std::vector<double> scales;
      double multiplier_scale = 1;
    };



    // x -> K S x for scaled increments x
    struct Operator
    {
      const StageTangent &tangent;
      const Packing &packing;
      StageVector &z, &r;
      StageConstraints &lambda, &g;

      void
      vmult(Vector<double> &y, const Vector<double> &x) const
      {
        packing.unpack(x, true, z, lambda);
        tangent.vmult(r, g, z, lambda);
        packing.pack(r, g, false, y);
      }
    };



    // r -> S^-1 P^-1 r
    struct Preconditioner
    {
      StageSolver &solver;
      const Packing &packing;
      StageVector &r;
      StageConstraints &g;

      void
      vmult(Vector<double> &y, const Vector<double> &x) const
      {
        packing.unpack(x, false, r, g);
        solver.solve(r, g);
        packing.pack(r, g, true, y);
      }
    };



    Eigen::SparseMatrix<double>
    matrix_of(const MarkerLinearization::Triplets &triplets,
              const unsigned int n_rows,
              const unsigned int n_columns)
    {
      Eigen::SparseMatrix<double> matrix(n_rows, n_columns);
      matrix.setFromTriplets(triplets.begin(), triplets.end());
      return matrix;
    }
  } // namespace



  StageTangent::StageTangent(const MultibodySystem &system,
                             const ButcherTableau &tableau)
    : system(system)
    , A_inverse(tableau.A.inverse())
    , A_inverse_squared(A_inverse * A_inverse)
    , bodies(tableau.n_stages())
    , markers(tableau.n_stages())
  {}



  void
  StageTangent::reset(const double step_size,
                      const StageRotations &new_rotations)
  {
    tau       = step_size;
    rotations = new_rotations;
    for (auto &stage : bodies)
      {
        stage.clear();
        stage.resize(system.bodies().size());
      }
    for (Markers &matrices : markers)
      matrices = Markers();
  }



  bool
  StageTangent::linearize_body(const unsigned int stage,
                               const unsigned int body,
                               const NodalVector &positions)
  {
    bodies[stage][body] = ElasticTangent::at(system.bodies()[body], positions);
    return bodies[stage][body].has_value();
  }



  void
  StageTangent::linearize_markers(const unsigned int stage,
                                  const MarkerLinearization &linearization)
  {
    const unsigned int n = system.n_marker_values();
    Markers &matrices    = markers[stage];
    matrices.stiffness   = matrix_of(linearization.stiffness, n, n);
    matrices.damping     = matrix_of(linearization.damping, n, n);
    matrices.mass        = matrix_of(linearization.mass, n, n);
    matrices.constraints =
      matrix_of(linearization.constraints, system.n_constraints(), n);
  }



  void
  StageTangent::apply_stiffness(const unsigned int stage,
                                const unsigned int body,
                                const NodalVector &z,
                                NodalVector &y) const
  {
    if (bodies[stage][body])
      {
        bodies[stage][body]->vmult(y, z);
        return;
      }
    const NodeRotations &frames = rotations.stages[stage][body];
    const unsigned int n        = z.size() / dim;
    NodalVector local(z.size());
    frames.to_body(z, n, local);
    system.bodies()[body].operators().stiffness_matrix.vmult(y, local);
    frames.to_world(y, n, y);
  }



  void
  StageTangent::vmult(StageVector &r,
                      StageConstraints &g,
                      const StageVector &z,
                      const StageConstraints &lambda) const
  {
    const unsigned int n_stages = bodies.size();
    const unsigned int n_bodies = system.bodies().size();
    const double rate = 1 / tau, squared_rate = rate * rate;
    for (unsigned int i = 0; i < n_stages; ++i)
      {
        SystemVector z_rate(n_bodies), acceleration(n_bodies);
        for (unsigned int b = 0; b < n_bodies; ++b)
          {
            z_rate[b].reinit(z[i][b].size());
            acceleration[b].reinit(z[i][b].size());
            for (unsigned int j = 0; j < n_stages; ++j)
              {
                z_rate[b].add(rate * A_inverse(i, j), z[j][b]);
                acceleration[b].add(squared_rate * A_inverse_squared(i, j),
                                    z[j][b]);
              }
            const Body &body = system.bodies()[b];
            NodalVector strained(z[i][b]), accelerated(acceleration[b]);
            if (body.is_damped())
              {
                strained.add(body.stiffness_damping(), z_rate[b]);
                accelerated.add(body.mass_damping(), z_rate[b]);
              }
            apply_stiffness(i, b, strained, r[i][b]);
            body.operators().mass_matrix.vmult(strained, accelerated);
            r[i][b] += strained;
          }
        if (system.n_marker_values() == 0)
          continue;
        const Markers &matrices = markers[i];
        const Eigen::VectorXd s = system.marker_values(z[i]);
        Eigen::VectorXd F =
          matrices.stiffness * s + matrices.constraints.transpose() * lambda[i];
        if (matrices.damping.nonZeros() > 0)
          F += matrices.damping * system.marker_values(z_rate);
        if (matrices.mass.nonZeros() > 0)
          F += matrices.mass * system.marker_values(acceleration);
        for (unsigned int b = 0; b < n_bodies; ++b)
          system.add_marker_forces(b, F, r[i][b]);
        g[i] = matrices.constraints * s;
      }
  }



  double
  StageTangent::solve(StageSolver &preconditioner,
                      const double tolerance,
                      const unsigned int max_iterations,
                      StageVector &r,
                      StageConstraints &g,
                      unsigned int &n_iterations) const
  {
    Packing packing(system, bodies.size());
    Vector<double> right_hand_side(packing.size()), x(packing.size());
    packing.pack(r, g, false, right_hand_side);

    StageVector z(r);
    StageConstraints lambda(g);
    preconditioner.solve(z, lambda);
    packing.balance_multipliers(z, lambda);
    packing.pack(z, lambda, true, x);
    const double size = x.l2_norm();
    n_iterations      = 0;
    if (size == 0)
      {
        r.swap(z);
        g.swap(lambda);
        return 0;
      }

    // x = P^-1 r is a good start already
    StageVector work(r);
    StageConstraints constraint_work(g);
    const Operator matrix{*this, packing, z, work, lambda, constraint_work};
    const Preconditioner inverse{preconditioner, packing, z, lambda};
    IterationNumberControl control(max_iterations, tolerance * size);
    SolverGMRES<Vector<double>> solver(
      control, SolverGMRES<Vector<double>>::AdditionalData(max_iterations + 2));
    solver.solve(matrix, x, right_hand_side, inverse);
    n_iterations = 1 + control.last_step();
    packing.unpack(x, true, r, g);
    return control.last_value() / size;
  }
} // namespace ACF
