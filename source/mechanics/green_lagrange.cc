// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parallel.h>
#include <acf/mechanics/green_lagrange.h>

#include <deal.II/base/memory_consumption.h>

#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/vector_memory.h>

#include <algorithm>

#include "green_lagrange_kernels.h"

namespace ACF
{
  namespace
  {
    constexpr unsigned int batch_size = GreenLagrangeOperator::batch_size;

    // Batches, and nodes, that are worth a thread.
    constexpr std::size_t smallest_batches = 64;
    constexpr std::size_t smallest_nodes   = 2048;

    // Memory that calls leave to the next one. (Not one for each thread: while
    // a thread waits for the parts of one call it may begin another one.)
    using Scratch = GrowingVectorMemory<NodalVector>;



    Vector3
    first_node(const NodalVector &x)
    {
      return Vector3({x[0], x[1], x[2]});
    }



    // The loops over a batch, for an instruction set.
    struct BatchLoops
    {
      bool (*force)(const GreenLagrangeOperator::Geometry &,
                    std::size_t,
                    const double *,
                    double *,
                    double *);
      void (*apply_tangent)(const GreenLagrangeOperator::Geometry &,
                            std::size_t,
                            const double *,
                            const double *,
                            double *);
      void (*integrate_gradient)(const GreenLagrangeOperator::Geometry &,
                                 std::size_t,
                                 const double *,
                                 double *,
                                 double *);
    };

#define ACF_BATCH_LOOPS(name, attributes, Cells)                               \
  attributes bool force_##name(                                                \
    const GreenLagrangeOperator::Geometry &geometry,                           \
    const std::size_t batch,                                                   \
    const double *const x,                                                     \
    double *const f,                                                           \
    double *const energies)                                                    \
  {                                                                            \
    return Kernels::force<Cells>(geometry, batch, x, f, energies);             \
  }                                                                            \
  attributes void apply_tangent_##name(                                        \
    const GreenLagrangeOperator::Geometry &geometry,                           \
    const std::size_t batch,                                                   \
    const double *const x,                                                     \
    const double *const dx,                                                    \
    double *const f)                                                           \
  {                                                                            \
    Kernels::apply_tangent<Cells>(geometry, batch, x, dx, f);                  \
  }                                                                            \
  attributes void integrate_gradient_##name(                                   \
    const GreenLagrangeOperator::Geometry &geometry,                           \
    const std::size_t batch,                                                   \
    const double *const x,                                                     \
    double *const integral,                                                    \
    double *const volumes)                                                     \
  {                                                                            \
    Kernels::integrate_gradient<Cells>(geometry, batch, x, integral, volumes); \
  }                                                                            \
  constexpr BatchLoops loops_##name = {force_##name,                           \
                                       apply_tangent_##name,                   \
                                       integrate_gradient_##name};

    ACF_BATCH_LOOPS(any, , Kernels::TwoCells)
#if defined(__x86_64__)
    ACF_BATCH_LOOPS(avx2, ACF_AVX2, Kernels::FourCells)
    ACF_BATCH_LOOPS(avx512, ACF_AVX512, Kernels::EightCells)
#endif
#undef ACF_BATCH_LOOPS

    const BatchLoops &
    batch_loops()
    {
#if defined(__x86_64__)
      if (present_processor() == Processor::avx512)
        return loops_avx512;
      if (present_processor() == Processor::avx2)
        return loops_avx2;
#endif
      return loops_any;
    }
  } // namespace



  GreenLagrangeOperator::GreenLagrangeOperator(const BodyDiscretization &body,
                                               const Material &material)
    : n_nodes(body.n_nodes())
    , n_cells(body.mesh().triangulation().n_active_cells())
    , n_batches((n_cells + batch_size - 1) / batch_size)
  {
    const Quadrature<dim> quadrature =
      body.mesh().cell_quadrature(body.mesh().is_simplex() ? 2 : 4);
    const unsigned int n_shapes = body.scalar_element().n_dofs_per_cell();
    geometry.lambda             = material.lambda();
    geometry.mu                 = material.mu();
    geometry.n_shape_functions  = n_shapes;
    geometry.n_points           = quadrature.size();
    geometry.n_jacobians = body.mesh().is_simplex() && !body.mesh().is_curved()
                             ? 1
                             : quadrature.size();
    for (unsigned int q = 0; q < geometry.n_points; ++q)
      for (unsigned int a = 0; a < n_shapes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          geometry.unit_gradients.push_back(
            body.scalar_element().shape_grad(a, quadrature.point(q))[i]);

    geometry.inverse_jacobians.resize(geometry.jacobian_index(n_batches, 0));
    geometry.weights.resize(n_batches * geometry.n_points * batch_size);
    nodes.resize(n_batches * n_shapes * batch_size);
    FEValues<dim> values(body.mesh().mapping(),
                         body.scalar_element(),
                         quadrature,
                         update_inverse_jacobians | update_JxW_values);
    std::vector<unsigned int> cell_nodes(n_shapes);
    std::vector<unsigned int> n_cells_of_node(n_nodes);
    auto cell = body.dof_handler().begin_active();
    for (unsigned int c = 0; c < n_batches * batch_size; ++c)
      {
        const bool is_cell       = c < n_cells;
        const unsigned int batch = c / batch_size;
        const unsigned int lane  = c % batch_size;
        if (is_cell)
          {
            values.reinit(
              typename Triangulation<dim>::active_cell_iterator(cell));
            body.get_nodes(cell, cell_nodes);
            ++cell;
          }
        for (unsigned int q = 0; q < geometry.n_jacobians; ++q)
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int j = 0; j < dim; ++j)
              geometry.inverse_jacobians[geometry.jacobian_index(batch, q) +
                                         (dim * i + j) * batch_size + lane] =
                values.inverse_jacobian(q)[i][j];
        for (unsigned int q = 0; q < geometry.n_points; ++q)
          geometry
            .weights[(batch * geometry.n_points + q) * batch_size + lane] =
            is_cell ? values.JxW(q) : 0.;
        for (unsigned int a = 0; a < n_shapes; ++a)
          {
            nodes[(batch * n_shapes + a) * batch_size + lane] = cell_nodes[a];
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
      if (const unsigned int lane = k % batch_size;
          k / (n_shapes * batch_size) * batch_size + lane < n_cells)
        node_entries[next[nodes[k]]++] = dim * (k - lane) + lane;
  }



  void
  GreenLagrangeOperator::gather(const NodalVector &x,
                                const Vector3 &origin,
                                const unsigned int batch,
                                AlignedVector<double> &values) const
  {
    const unsigned int n = geometry.n_shape_functions;
    values.resize_fast(n * dim * batch_size);
    const unsigned int *const batch_nodes = &nodes[batch * n * batch_size];
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int lane = 0; lane < batch_size; ++lane)
        {
          const double *const node =
            x.begin() + dim * batch_nodes[a * batch_size + lane];
          for (unsigned int i = 0; i < dim; ++i)
            values[(dim * a + i) * batch_size + lane] = node[i] - origin[i];
        }
  }



  void
  GreenLagrangeOperator::scatter(const NodalVector &cell_values,
                                 NodalVector &result) const
  {
    run_ranges(
      n_nodes,
      [&](const std::size_t begin, const std::size_t end) {
        const double *const values = cell_values.begin();
        double *const sums         = result.begin();
        for (std::size_t a = begin; a < end; ++a)
          {
            double sum[dim] = {};
            for (unsigned int k = node_start[a]; k < node_start[a + 1]; ++k)
              for (unsigned int i = 0; i < dim; ++i)
                sum[i] += values[node_entries[k] + i * batch_size];
            for (unsigned int i = 0; i < dim; ++i)
              sums[dim * a + i] = sum[i];
          }
      },
      smallest_nodes);
  }



  std::optional<double>
  GreenLagrangeOperator::force(const NodalVector &positions,
                               NodalVector &force) const
  {
    AssertDimension(positions.size(), dim * n_nodes);
    const unsigned int values_per_batch =
      geometry.n_shape_functions * dim * batch_size;
    Scratch memory;
    const Scratch::Pointer cell_forces(memory);
    cell_forces->reinit(std::size_t(n_batches) * values_per_batch, true);
    AlignedVector<double> energies(n_batches * batch_size);
    std::vector<char> is_valid(n_batches);
    const Vector3 origin    = first_node(positions);
    const BatchLoops &loops = batch_loops();

    run_ranges(
      n_batches,
      [&](const std::size_t begin, const std::size_t end) {
        AlignedVector<double> x;
        for (std::size_t batch = begin; batch < end; ++batch)
          {
            gather(positions, origin, batch, x);
            is_valid[batch] =
              loops.force(geometry,
                          batch,
                          x.data(),
                          cell_forces->begin() + batch * values_per_batch,
                          &energies[batch * batch_size]);
          }
      },
      smallest_batches);
    double energy = 0;
    for (unsigned int batch = 0; batch < n_batches; ++batch)
      {
        if (!is_valid[batch])
          return {};
        for (unsigned int lane = 0; lane < batch_size; ++lane)
          energy += energies[batch * batch_size + lane];
      }
    scatter(*cell_forces, force);
    return energy;
  }



  void
  GreenLagrangeOperator::apply_tangent(const NodalVector &positions,
                                       const NodalVector &direction,
                                       NodalVector &result) const
  {
    AssertDimension(positions.size(), dim * n_nodes);
    const unsigned int values_per_batch =
      geometry.n_shape_functions * dim * batch_size;
    Scratch memory;
    const Scratch::Pointer cell_forces(memory);
    cell_forces->reinit(std::size_t(n_batches) * values_per_batch, true);
    const Vector3 origin    = first_node(positions);
    const BatchLoops &loops = batch_loops();

    run_ranges(
      n_batches,
      [&](const std::size_t begin, const std::size_t end) {
        AlignedVector<double> x, dx;
        for (std::size_t batch = begin; batch < end; ++batch)
          {
            gather(positions, origin, batch, x);
            gather(direction, Vector3(), batch, dx);
            loops.apply_tangent(geometry,
                                batch,
                                x.data(),
                                dx.data(),
                                cell_forces->begin() +
                                  batch * values_per_batch);
          }
      },
      smallest_batches);
    scatter(*cell_forces, result);
  }



  void
  GreenLagrangeOperator::add_tangent(const NodalVector &positions,
                                     const NodeRotations &rotations,
                                     BlockNodeMatrix &matrix) const
  {
    const double lambda = geometry.lambda, mu = geometry.mu;
    const Vector3 origin = first_node(positions);
    const unsigned int n = geometry.n_shape_functions;
    AlignedVector<double> x;
    std::vector<Vector3> unit(geometry.n_points * n), grad(n);
    for (unsigned int k = 0; k < unit.size(); ++k)
      for (unsigned int i = 0; i < dim; ++i)
        unit[k][i] = geometry.unit_gradients[dim * k + i];
    std::vector<Matrix3> blocks(n * n);
    for (unsigned int cell = 0; cell < n_cells; ++cell)
      {
        const unsigned int batch = cell / batch_size, lane = cell % batch_size;
        if (lane == 0)
          gather(positions, origin, batch, x);
        std::fill(blocks.begin(), blocks.end(), Matrix3());
        for (unsigned int q = 0; q < geometry.n_points; ++q)
          {
            Matrix3 F, inverse;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                inverse[i][j] =
                  geometry.inverse_jacobians[geometry.jacobian_index(batch, q) +
                                             (dim * i + j) * batch_size + lane];
            for (unsigned int a = 0; a < n; ++a)
              {
                grad[a] = unit[q * n + a] * inverse;
                for (unsigned int i = 0; i < dim; ++i)
                  F[i] += x[(dim * a + i) * batch_size + lane] * grad[a];
              }
            const double dV =
              geometry
                .weights[(batch * geometry.n_points + q) * batch_size + lane];
            SymmetricTensor<2, dim> E = 0.5 * symmetrize(transpose(F) * F) -
                                        0.5 * unit_symmetric_tensor<dim>();
            const SymmetricTensor<2, dim> S =
              lambda * trace(E) * unit_symmetric_tensor<dim>() + 2 * mu * E;
            const Matrix3 left_cauchy_green = F * transpose(F);
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
                nodes[(batch * n + a) * batch_size + lane];
              const unsigned int node_b =
                nodes[(batch * n + b) * batch_size + lane];
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
    constexpr unsigned int matrix_size = dim * dim * batch_size;
    AlignedVector<double> integrals(std::size_t(n_batches) * matrix_size);
    AlignedVector<double> volumes(n_batches * batch_size);
    const Vector3 origin    = first_node(positions);
    const BatchLoops &loops = batch_loops();
    run_ranges(
      n_batches,
      [&](const std::size_t begin, const std::size_t end) {
        AlignedVector<double> x;
        for (std::size_t batch = begin; batch < end; ++batch)
          {
            gather(positions, origin, batch, x);
            loops.integrate_gradient(geometry,
                                     batch,
                                     x.data(),
                                     &integrals[batch * matrix_size],
                                     &volumes[batch * batch_size]);
          }
      },
      smallest_batches);

    std::vector<Matrix3> gradients(n_nodes);
    const unsigned int values_per_batch =
      geometry.n_shape_functions * dim * batch_size;
    run_ranges(
      n_nodes,
      [&](const std::size_t begin, const std::size_t end) {
        for (std::size_t a = begin; a < end; ++a)
          {
            double volume = 0;
            for (unsigned int k = node_start[a]; k < node_start[a + 1]; ++k)
              {
                const std::size_t batch = node_entries[k] / values_per_batch;
                const unsigned int lane = node_entries[k] % batch_size;
                volume += volumes[batch * batch_size + lane];
                for (unsigned int i = 0; i < dim; ++i)
                  for (unsigned int j = 0; j < dim; ++j)
                    gradients[a][i][j] +=
                      integrals[batch * matrix_size +
                                (dim * i + j) * batch_size + lane];
              }
            gradients[a] /= volume;
          }
      },
      smallest_nodes);
    return gradients;
  }



  std::size_t
  GreenLagrangeOperator::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(geometry.unit_gradients) +
           geometry.inverse_jacobians.memory_consumption() +
           geometry.weights.memory_consumption() +
           MemoryConsumption::memory_consumption(nodes) +
           MemoryConsumption::memory_consumption(node_start) +
           MemoryConsumption::memory_consumption(node_entries);
  }
} // namespace ACF
