// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/green_lagrange.h>

#include <deal.II/base/memory_consumption.h>
#include <deal.II/base/parallel.h>

#include <deal.II/fe/fe_values.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    constexpr unsigned int n_lanes = VectorizedArray<double>::size();

    /** Batches, or blocks of nodes, that are worth a task. */
    constexpr unsigned int grain = 64;



    Vector3
    first_node(const NodalVector &x)
    {
      return Vector3({x[0], x[1], x[2]});
    }
  } // namespace



  GreenLagrangeOperator::GreenLagrangeOperator(const BodyDiscretization &body,
                                               const Material &material)
    : lambda(material.lambda())
    , mu(material.mu())
    , n_nodes(body.n_nodes())
    , n_cells(body.mesh().triangulation().n_active_cells())
    , n_batches((n_cells + n_lanes - 1) / n_lanes)
    , n_shape_functions(body.scalar_element().n_dofs_per_cell())
  {
    const Quadrature<dim> quadrature =
      body.mesh().cell_quadrature(body.mesh().is_simplex() ? 2 : 4);
    n_points = quadrature.size();
    for (unsigned int q = 0; q < n_points; ++q)
      for (unsigned int a = 0; a < n_shape_functions; ++a)
        unit_gradients.push_back(
          body.scalar_element().shape_grad(a, quadrature.point(q)));

    inverse_jacobians.resize(n_batches * n_points);
    weights.resize(n_batches * n_points);
    nodes.resize(n_batches * n_shape_functions * n_lanes);
    FEValues<dim> values(body.mesh().mapping(),
                         body.scalar_element(),
                         quadrature,
                         update_inverse_jacobians | update_JxW_values);
    std::vector<unsigned int> cell_nodes(n_shape_functions);
    std::vector<unsigned int> n_cells_of_node(n_nodes);
    auto cell = body.dof_handler().begin_active();
    for (unsigned int lane = 0; lane < n_batches * n_lanes; ++lane)
      {
        const bool is_cell       = lane < n_cells;
        const unsigned int batch = lane / n_lanes;
        if (is_cell)
          {
            values.reinit(
              typename Triangulation<dim>::active_cell_iterator(cell));
            body.get_nodes(cell, cell_nodes);
            ++cell;
          }
        for (unsigned int q = 0; q < n_points; ++q)
          {
            const auto &J = values.inverse_jacobian(q);
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                inverse_jacobians[batch * n_points + q][i][j][lane % n_lanes] =
                  J[i][j];
            weights[batch * n_points + q][lane % n_lanes] =
              is_cell ? values.JxW(q) : 0.;
          }
        for (unsigned int a = 0; a < n_shape_functions; ++a)
          {
            nodes[(batch * n_shape_functions + a) * n_lanes + lane % n_lanes] =
              cell_nodes[a];
            if (is_cell)
              ++n_cells_of_node[cell_nodes[a]];
          }
      }

    node_start.assign(n_nodes + 1, 0);
    for (unsigned int a = 0; a < n_nodes; ++a)
      node_start[a + 1] = node_start[a] + n_cells_of_node[a];
    node_entries.resize(node_start.back());
    std::vector<unsigned int> next(node_start.begin(), node_start.end() - 1);
    for (unsigned int k = 0; k < nodes.size(); ++k)
      if (k / (n_shape_functions * n_lanes) * n_lanes + k % n_lanes < n_cells)
        node_entries[next[nodes[k]]++] = k;
  }



  void
  GreenLagrangeOperator::gather(const NodalVector &x,
                                const Vector3 &origin,
                                const unsigned int batch,
                                Values &values) const
  {
    values.resize_fast(n_shape_functions);
    const unsigned int *const batch_nodes =
      &nodes[batch * n_shape_functions * n_lanes];
    for (unsigned int a = 0; a < n_shape_functions; ++a)
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        for (unsigned int i = 0; i < dim; ++i)
          values[a][i][lane] =
            x[dim * batch_nodes[a * n_lanes + lane] + i] - origin[i];
  }



  GreenLagrangeOperator::Matrix
  GreenLagrangeOperator::gradient(const Values &values,
                                  const unsigned int batch,
                                  const unsigned int q) const
  {
    const Vector3 *const grad = &unit_gradients[q * n_shape_functions];
    Matrix unit;
    for (unsigned int a = 0; a < n_shape_functions; ++a)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          unit[i][j] += values[a][i] * grad[a][j];
    return unit * inverse_jacobians[batch * n_points + q];
  }



  void
  GreenLagrangeOperator::add_divergence(const Matrix &P,
                                        const unsigned int batch,
                                        const unsigned int q,
                                        Tensor<1, dim, Lanes> *result) const
  {
    const Vector3 *const grad = &unit_gradients[q * n_shape_functions];
    const Matrix unit         = (weights[batch * n_points + q] * P) *
                        transpose(inverse_jacobians[batch * n_points + q]);
    for (unsigned int a = 0; a < n_shape_functions; ++a)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          result[a][i] += unit[i][j] * grad[a][j];
  }



  GreenLagrangeOperator::Symmetric
  GreenLagrangeOperator::stress(const Symmetric &E) const
  {
    Symmetric S            = (2 * mu) * E;
    const Lanes volumetric = lambda * trace(E);
    for (unsigned int i = 0; i < dim; ++i)
      S[i][i] += volumetric;
    return S;
  }



  void
  GreenLagrangeOperator::scatter(const Values &cell_values,
                                 NodalVector &result) const
  {
    const auto sum = [&](const unsigned int begin, const unsigned int end) {
      for (unsigned int a = begin; a < end; ++a)
        {
          Vector3 value;
          for (unsigned int k = node_start[a]; k < node_start[a + 1]; ++k)
            for (unsigned int i = 0; i < dim; ++i)
              value[i] += cell_values[node_entries[k] / n_lanes][i]
                                     [node_entries[k] % n_lanes];
          for (unsigned int i = 0; i < dim; ++i)
            result[dim * a + i] = value[i];
        }
    };
    parallel::apply_to_subranges(0U, n_nodes, sum, n_lanes * grain);
  }



  std::optional<double>
  GreenLagrangeOperator::force(const NodalVector &positions,
                               NodalVector &force) const
  {
    AssertDimension(positions.size(), dim * n_nodes);
    Values &cell_forces = scratch.get();
    cell_forces.resize_fast(n_batches * n_shape_functions);
    std::vector<double> energies(n_batches), determinants(n_batches);
    const Vector3 origin = first_node(positions);

    const auto integrate = [&](const unsigned int begin,
                               const unsigned int end) {
      Values x;
      for (unsigned int batch = begin; batch < end; ++batch)
        {
          gather(positions, origin, batch, x);
          Tensor<1, dim, Lanes> *const f =
            &cell_forces[batch * n_shape_functions];
          std::fill(f, f + n_shape_functions, Tensor<1, dim, Lanes>());
          Lanes energy = 0., smallest = 1.;
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const Matrix F = gradient(x, batch, q);
              Symmetric E    = symmetrize(transpose(F) * F);
              for (unsigned int i = 0; i < dim; ++i)
                E[i][i] -= 1.;
              E *= 0.5;
              const Symmetric S = stress(E);
              energy += weights[batch * n_points + q] * (0.5 * (E * S));
              smallest = std::min(smallest, determinant(F));
              add_divergence(F * Matrix(S), batch, q, f);
            }
          energies[batch]     = 0;
          determinants[batch] = 1;
          for (unsigned int lane = 0; lane < n_lanes; ++lane)
            {
              energies[batch] += energy[lane];
              // not a number is no positive one
              if (!(smallest[lane] > 0))
                determinants[batch] = 0;
            }
        }
    };
    parallel::apply_to_subranges(0U, n_batches, integrate, grain);
    double energy = 0;
    for (unsigned int batch = 0; batch < n_batches; ++batch)
      {
        if (determinants[batch] == 0)
          return {};
        energy += energies[batch];
      }
    scatter(cell_forces, force);
    return energy;
  }



  void
  GreenLagrangeOperator::apply_tangent(const NodalVector &positions,
                                       const NodalVector &direction,
                                       NodalVector &result) const
  {
    AssertDimension(positions.size(), dim * n_nodes);
    Values &cell_forces = scratch.get();
    cell_forces.resize_fast(n_batches * n_shape_functions);
    const Vector3 origin = first_node(positions);

    const auto integrate = [&](const unsigned int begin,
                               const unsigned int end) {
      Values x, dx;
      for (unsigned int batch = begin; batch < end; ++batch)
        {
          gather(positions, origin, batch, x);
          gather(direction, Vector3(), batch, dx);
          Tensor<1, dim, Lanes> *const f =
            &cell_forces[batch * n_shape_functions];
          std::fill(f, f + n_shape_functions, Tensor<1, dim, Lanes>());
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const Matrix F  = gradient(x, batch, q);
              const Matrix dF = gradient(dx, batch, q);
              Symmetric E     = symmetrize(transpose(F) * F);
              for (unsigned int i = 0; i < dim; ++i)
                E[i][i] -= 1.;
              E *= 0.5;
              const Matrix S(stress(E));
              const Matrix dS(stress(symmetrize(transpose(F) * dF)));
              add_divergence(dF * S + F * dS, batch, q, f);
            }
        }
    };
    parallel::apply_to_subranges(0U, n_batches, integrate, grain);
    scatter(cell_forces, result);
  }



  void
  GreenLagrangeOperator::add_tangent(const NodalVector &positions,
                                     const NodeRotations &rotations,
                                     BlockNodeMatrix &matrix) const
  {
    const Vector3 origin = first_node(positions);
    const unsigned int n = n_shape_functions;
    Values x;
    // of one lane
    std::vector<Vector3> grad(n);
    std::vector<Matrix3> blocks(n * n);
    for (unsigned int cell = 0; cell < n_cells; ++cell)
      {
        const unsigned int batch = cell / n_lanes, lane = cell % n_lanes;
        if (lane == 0)
          gather(positions, origin, batch, x);
        std::fill(blocks.begin(), blocks.end(), Matrix3());
        for (unsigned int q = 0; q < n_points; ++q)
          {
            const Matrix F_lanes = gradient(x, batch, q);
            const Matrix &J      = inverse_jacobians[batch * n_points + q];
            Matrix3 F, inverse;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                {
                  F[i][j]       = F_lanes[i][j][lane];
                  inverse[i][j] = J[i][j][lane];
                }
            const double dV           = weights[batch * n_points + q][lane];
            SymmetricTensor<2, dim> E = 0.5 * symmetrize(transpose(F) * F) -
                                        0.5 * unit_symmetric_tensor<dim>();
            const SymmetricTensor<2, dim> S =
              lambda * trace(E) * unit_symmetric_tensor<dim>() + 2 * mu * E;
            const Matrix3 left_cauchy_green = F * transpose(F);
            for (unsigned int a = 0; a < n; ++a)
              grad[a] = unit_gradients[q * n + a] * inverse;
            for (unsigned int a = 0; a < n; ++a)
              {
                const Vector3 F_a = F * grad[a], S_a = S * grad[a];
                for (unsigned int b = 0; b < n; ++b)
                  {
                    const Vector3 F_b      = F * grad[b];
                    const double geometric = S_a * grad[b];
                    const double laplace   = mu * (grad[a] * grad[b]);
                    Matrix3 &block         = blocks[a * n + b];
                    for (unsigned int i = 0; i < dim; ++i)
                      {
                        block[i][i] += geometric * dV;
                        for (unsigned int j = 0; j < dim; ++j)
                          block[i][j] +=
                            (lambda * F_a[i] * F_b[j] + mu * F_b[i] * F_a[j] +
                             laplace * left_cauchy_green[i][j]) *
                            dV;
                      }
                  }
              }
          }
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < n; ++b)
            {
              const unsigned int node_a =
                nodes[(batch * n + a) * n_lanes + lane];
              const unsigned int node_b =
                nodes[(batch * n + b) * n_lanes + lane];
              matrix.add(node_a,
                         node_b,
                         transpose(rotations[node_a]) * blocks[a * n + b] *
                           rotations[node_b]);
            }
      }
  }



  std::vector<Matrix3>
  GreenLagrangeOperator::node_gradients(const NodalVector &positions) const
  {
    AssertDimension(positions.size(), dim * n_nodes);
    const Vector3 origin = first_node(positions);
    AlignedVector<Matrix> integrals(n_batches);
    AlignedVector<Lanes> volumes(n_batches);
    const auto integrate = [&](const unsigned int begin,
                               const unsigned int end) {
      Values x;
      for (unsigned int batch = begin; batch < end; ++batch)
        {
          gather(positions, origin, batch, x);
          Matrix integral;
          Lanes volume = 0.;
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const Lanes dV = weights[batch * n_points + q];
              integral += dV * gradient(x, batch, q);
              volume += dV;
            }
          integrals[batch] = integral;
          volumes[batch]   = volume;
        }
    };
    parallel::apply_to_subranges(0U, n_batches, integrate, grain);

    std::vector<Matrix3> gradients(n_nodes);
    const auto average = [&](const unsigned int begin, const unsigned int end) {
      for (unsigned int a = begin; a < end; ++a)
        {
          double volume = 0;
          for (unsigned int k = node_start[a]; k < node_start[a + 1]; ++k)
            {
              const unsigned int batch =
                node_entries[k] / (n_shape_functions * n_lanes);
              const unsigned int lane = node_entries[k] % n_lanes;
              volume += volumes[batch][lane];
              for (unsigned int i = 0; i < dim; ++i)
                for (unsigned int j = 0; j < dim; ++j)
                  gradients[a][i][j] += integrals[batch][i][j][lane];
            }
          gradients[a] /= volume;
        }
    };
    parallel::apply_to_subranges(0U, n_nodes, average, n_lanes * grain);
    return gradients;
  }



  std::size_t
  GreenLagrangeOperator::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(unit_gradients) +
           inverse_jacobians.memory_consumption() +
           weights.memory_consumption() +
           MemoryConsumption::memory_consumption(nodes) +
           MemoryConsumption::memory_consumption(node_start) +
           MemoryConsumption::memory_consumption(node_entries);
  }
} // namespace ACF
