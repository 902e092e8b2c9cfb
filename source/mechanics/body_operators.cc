// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/thread_order.h>
#include <acf/mechanics/body_operators.h>

#include <deal.II/base/memory_consumption.h>
#include <deal.II/base/work_stream.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    FESystem<dim>
    quadratic_element(const BodyMesh &mesh)
    {
      return mesh.is_simplex() ? FESystem<dim>(FE_SimplexP<dim>(2), dim)
                               : FESystem<dim>(FE_Q<dim>(2), dim);
    }



    // Couplings of the nodes, from the cells.
    DynamicSparsityPattern
    node_couplings(const BodyDiscretization &body)
    {
      DynamicSparsityPattern pattern(body.n_nodes());
      std::vector<unsigned int> nodes(body.scalar_element().n_dofs_per_cell());
      for (const auto &cell : body.dof_handler().active_cell_iterators())
        {
          body.get_nodes(cell, nodes);
          std::vector<unsigned int> sorted(nodes);
          std::sort(sorted.begin(), sorted.end());
          for (const unsigned int a : nodes)
            pattern.add_entries(a, sorted.begin(), sorted.end(), true);
        }
      return pattern;
    }



    std::shared_ptr<const NodeGraph>
    make_node_graph(const BodyDiscretization &body)
    {
      const DynamicSparsityPattern pattern = node_couplings(body);
      std::vector<std::size_t> row_start{0};
      std::vector<unsigned int> column;
      row_start.reserve(body.n_nodes() + 1);
      column.reserve(pattern.n_nonzero_elements());
      for (unsigned int a = 0; a < body.n_nodes(); ++a)
        {
          for (auto it = pattern.begin(a); it != pattern.end(a); ++it)
            column.push_back(it->column());
          row_start.push_back(column.size());
        }
      return std::make_shared<NodeGraph>(std::move(row_start),
                                         std::move(column));
    }



    // Values of the shape functions on a cell, one object per thread.
    struct CellValues
    {
      CellValues(const BodyDiscretization &body,
                 const Quadrature<dim> &quadrature,
                 const UpdateFlags flags)
        : body(body)
        , values(body.mesh().mapping(),
                 body.scalar_element(),
                 quadrature,
                 flags)
      {}

      CellValues(const CellValues &other)
        : CellValues((observe_order(&other), other.body),
                     other.values.get_quadrature(),
                     other.values.get_update_flags())
      {}

      const BodyDiscretization &body;
      FEValues<dim> values;
    };



    // What a cell adds; entries are numbered i n + j for n nodes.
    template <typename Entry>
    struct CellMatrix
    {
      std::vector<unsigned int> nodes;
      std::vector<Entry> entries;

      // of the gradients of the shape functions
      std::vector<Vector3> integrals;
      double volume = 0;
    };



    // Integrates cells in parallel, and adds them one after the other, so that
    // sums do not depend on threads.
    template <typename Entry, typename Integrate, typename Add>
    void
    for_all_cells(const BodyDiscretization &body,
                  const Quadrature<dim> &quadrature,
                  const UpdateFlags flags,
                  const Integrate &integrate,
                  const Add &add)
    {
      CellMatrix<Entry> matrix;
      matrix.nodes.resize(body.scalar_element().dofs_per_cell);
      const CellValues sample(body, quadrature, flags);
      publish_order(&sample);
      WorkStream::run(
        body.dof_handler().begin_active(),
        body.dof_handler().end(),
        [&](const DoFHandler<dim>::active_cell_iterator &cell,
            CellValues &scratch,
            CellMatrix<Entry> &result) {
          observe_order(&sample);
          observe_order(&result);
          scratch.values.reinit(
            typename Triangulation<dim>::active_cell_iterator(cell));
          body.get_nodes(cell, result.nodes);
          integrate(scratch.values, result);
          publish_order(&result);
        },
        [&](const CellMatrix<Entry> &result) {
          observe_order(&result);
          observe_order(&add);
          add(result);
          publish_order(&add);
          publish_order(&result);
        },
        sample,
        matrix);
      observe_order(&add);
    }



    void
    assemble_mass(const BodyDiscretization &body,
                  const double density,
                  ScalarNodeMatrix &mass_matrix)
    {
      for_all_cells<double>(
        body,
        body.mesh().cell_quadrature(4),
        update_values | update_JxW_values,
        [&](const FEValues<dim> &values, CellMatrix<double> &cell) {
          const unsigned int n = cell.nodes.size();
          cell.entries.assign(n * n, 0.);
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              for (const unsigned int q : values.quadrature_point_indices())
                cell.entries[i * n + j] += density * values.shape_value(i, q) *
                                           values.shape_value(j, q) *
                                           values.JxW(q);
        },
        [&](const CellMatrix<double> &cell) {
          const unsigned int n = cell.nodes.size();
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              mass_matrix.add(cell.nodes[i],
                              cell.nodes[j],
                              cell.entries[i * n + j]);
        });
    }



    // A_ab = int lambda grad(a) x grad(b) + mu grad(b) x grad(a)
    //            + mu grad(a) . grad(b) I
    Matrix3
    stiffness_block(const FEValues<dim> &values,
                    const Material &material,
                    const unsigned int a,
                    const unsigned int b)
    {
      const double lambda = material.lambda();
      const double mu     = material.mu();
      Matrix3 block;
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const Vector3 &grad_a = values.shape_grad(a, q);
          const Vector3 &grad_b = values.shape_grad(b, q);
          const double dV       = values.JxW(q);
          const double laplace  = mu * (grad_a * grad_b) * dV;
          for (unsigned int c = 0; c < dim; ++c)
            {
              for (unsigned int d = 0; d < dim; ++d)
                block[c][d] += (lambda * grad_a[c] * grad_b[d] +
                                mu * grad_b[c] * grad_a[d]) *
                               dV;
              block[c][c] += laplace;
            }
        }
      return block;
    }



    void
    assemble_stiffness(const BodyDiscretization &body,
                       const Material &material,
                       BlockNodeMatrix &stiffness_matrix,
                       NodalVector &averaging_vectors,
                       double &volume)
    {
      for_all_cells<Matrix3>(
        body,
        body.mesh().cell_quadrature(body.mesh().is_simplex() ? 2 : 4),
        update_gradients | update_JxW_values,
        [&](const FEValues<dim> &values, CellMatrix<Matrix3> &cell) {
          const unsigned int n = cell.nodes.size();
          cell.volume          = 0;
          cell.integrals.assign(n, Vector3());
          for (const unsigned int q : values.quadrature_point_indices())
            {
              cell.volume += values.JxW(q);
              for (unsigned int i = 0; i < n; ++i)
                cell.integrals[i] += values.JxW(q) * values.shape_grad(i, q);
            }
          cell.entries.resize(n * n);
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              cell.entries[i * n + j] = stiffness_block(values, material, i, j);
        },
        [&](const CellMatrix<Matrix3> &cell) {
          const unsigned int n = cell.nodes.size();
          volume += cell.volume;
          for (unsigned int i = 0; i < n; ++i)
            {
              for (unsigned int c = 0; c < dim; ++c)
                averaging_vectors[dim * cell.nodes[i] + c] +=
                  cell.integrals[i][c];
              for (unsigned int j = 0; j < n; ++j)
                stiffness_matrix.add(cell.nodes[i],
                                     cell.nodes[j],
                                     cell.entries[i * n + j]);
            }
        });
      averaging_vectors /= volume;
    }



    // Centre of mass and inertia from the mass matrix: positions are
    // represented exactly by the nodal values.
    void
    compute_rigid_inertia(BodyOperators &operators)
    {
      const NodalVector &X = operators.reference_positions;
      for (unsigned int a = 0; a < operators.n_nodes; ++a)
        {
          operators.mass += operators.nodal_masses[a];
          for (unsigned int i = 0; i < dim; ++i)
            operators.centre[i] += operators.nodal_masses[a] * X[dim * a + i];
        }
      operators.centre /= operators.mass;

      NodalVector arm(X), mass_times_arm(X.size());
      for (unsigned int a = 0; a < operators.n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          arm[dim * a + i] -= operators.centre[i];
      operators.mass_matrix.vmult(mass_times_arm, arm);

      Matrix3 second_moment;
      for (unsigned int a = 0; a < operators.n_nodes; ++a)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            second_moment[i][j] +=
              arm[dim * a + i] * mass_times_arm[dim * a + j];
      for (unsigned int i = 0; i < dim; ++i)
        {
          operators.inertia[i][i] = trace(second_moment);
          for (unsigned int j = 0; j < dim; ++j)
            operators.inertia[i][j] -= second_moment[i][j];
        }
    }



    double
    bounding_box_diagonal(const NodalVector &X)
    {
      Vector3 lower, upper;
      for (unsigned int i = 0; i < dim; ++i)
        {
          lower[i] = upper[i] = X[i];
          for (unsigned int k = i; k < X.size(); k += dim)
            {
              lower[i] = std::min(lower[i], X[k]);
              upper[i] = std::max(upper[i], X[k]);
            }
        }
      return (upper - lower).norm();
    }
  } // namespace



  double
  Material::lambda() const
  {
    return youngs_modulus * poissons_ratio /
           ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
  }



  double
  Material::mu() const
  {
    return youngs_modulus / (2 * (1 + poissons_ratio));
  }



  BodyDiscretization::BodyDiscretization(std::unique_ptr<const BodyMesh> mesh)
    : body_mesh(std::move(mesh))
    , element(quadratic_element(*body_mesh))
    , handler(body_mesh->triangulation())
  {
    handler.distribute_dofs(element);
    renumber_nodes();

    positions.reinit(handler.n_dofs());
    const auto &points = scalar_element().get_unit_support_points();
    std::vector<unsigned int> nodes(points.size());
    for (const auto &cell : handler.active_cell_iterators())
      {
        get_nodes(cell, nodes);
        for (unsigned int i = 0; i < points.size(); ++i)
          {
            const Point<dim> X =
              body_mesh->mapping().transform_unit_to_real_cell(
                typename Triangulation<dim>::active_cell_iterator(cell),
                points[i]);
            for (unsigned int c = 0; c < dim; ++c)
              positions[dim * nodes[i] + c] = X[c];
          }
      }
  }



  void
  BodyDiscretization::get_nodes(
    const typename DoFHandler<dim>::active_cell_iterator &cell,
    std::vector<unsigned int> &nodes) const
  {
    std::vector<types::global_dof_index> dofs(element.n_dofs_per_cell());
    cell->get_dof_indices(dofs);
    for (unsigned int i = 0; i < nodes.size(); ++i)
      nodes[i] = dofs[element.component_to_system_index(0, i)] / dim;
  }



  void
  BodyDiscretization::renumber_nodes()
  {
#ifdef DEBUG
    // deal.II numbers the components of a support point one after the other
    std::vector<types::global_dof_index> dofs(element.n_dofs_per_cell());
    for (const auto &cell : handler.active_cell_iterators())
      {
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < scalar_element().n_dofs_per_cell(); ++i)
          for (unsigned int c = 0; c < dim; ++c)
            Assert(dofs[element.component_to_system_index(c, i)] ==
                     dofs[element.component_to_system_index(0, i)] + c,
                   ExcInternalError());
      }
#endif

    std::vector<DynamicSparsityPattern::size_type> order(n_nodes());
    SparsityTools::reorder_Cuthill_McKee(node_couplings(*this), order);
    std::vector<types::global_dof_index> new_dofs(handler.n_dofs());
    for (unsigned int a = 0; a < n_nodes(); ++a)
      for (unsigned int c = 0; c < dim; ++c)
        new_dofs[dim * a + c] = dim * (n_nodes() - 1 - order[a]) + c;
    handler.renumber_dofs(new_dofs);
  }



  BodyOperators::BodyOperators(const std::shared_ptr<const NodeGraph> &graph)
    : n_nodes(graph->n_nodes())
    , mass_matrix(graph)
    , stiffness_matrix(graph)
  {}



  std::size_t
  BodyOperators::memory_consumption() const
  {
    return mass_matrix.graph().memory_consumption() +
           mass_matrix.memory_consumption() +
           stiffness_matrix.memory_consumption() +
           reference_positions.memory_consumption() +
           averaging_vectors.memory_consumption() +
           MemoryConsumption::memory_consumption(nodal_masses);
  }



  BodyOperators
  assemble_body_operators(const BodyDiscretization &body,
                          const Material &material)
  {
    BodyOperators operators(make_node_graph(body));
    operators.reference_positions = body.reference_positions();
    operators.averaging_vectors.reinit(operators.n_unknowns());
    assemble_mass(body, material.density, operators.mass_matrix);
    assemble_stiffness(body,
                       material,
                       operators.stiffness_matrix,
                       operators.averaging_vectors,
                       operators.volume);
    operators.nodal_masses = operators.mass_matrix.row_sums();
    operators.length = bounding_box_diagonal(operators.reference_positions);
    compute_rigid_inertia(operators);
    return operators;
  }
} // namespace ACF
