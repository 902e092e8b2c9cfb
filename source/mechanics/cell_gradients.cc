// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/cell_gradients.h>

#include <deal.II/fe/fe_values.h>

namespace ACF
{
  CellGradients::CellGradients(const BodyDiscretization &space)
  {
    FEValues<dim> values(space.mesh().mapping(),
                         space.scalar_element(),
                         space.mesh().cell_quadrature(2),
                         update_inverse_jacobians | update_JxW_values);
    n_cell_nodes  = values.dofs_per_cell;
    n_cell_points = values.n_quadrature_points;
    for (const Point<dim> &xi : values.get_quadrature().get_points())
      for (unsigned int a = 0; a < n_cell_nodes; ++a)
        for (unsigned int m = 0; m < dim; ++m)
          unit_gradients.push_back(space.scalar_element().shape_grad(a, xi)[m]);

    const std::size_t n_cells =
      space.dof_handler().get_triangulation().n_active_cells();
    cell_nodes.reserve(n_cells * n_cell_nodes);
    points.reserve(n_cells * n_cell_points);
    std::vector<unsigned int> nodes(n_cell_nodes);
    for (const auto &cell : space.dof_handler().active_cell_iterators())
      {
        values.reinit(typename Triangulation<dim>::active_cell_iterator(cell));
        space.get_nodes(cell, nodes);
        cell_nodes.insert(cell_nodes.end(), nodes.begin(), nodes.end());
        for (const unsigned int point : values.quadrature_point_indices())
          {
            MappedPoint kept;
            for (unsigned int m = 0; m < dim; ++m)
              for (unsigned int j = 0; j < dim; ++j)
                kept.inverse_jacobian[m][j] =
                  values.inverse_jacobian(point)[m][j];
            kept.volume = values.JxW(point);
            points.push_back(kept);
          }
      }
  }



  void
  CellGradients::evaluate(const NodalVector &q,
                          const std::size_t cell,
                          std::vector<Matrix3> &gradients) const
  {
    gradients.resize(n_cell_points);
    const unsigned int *const node = nodes(cell);
    const double *unit_gradient    = unit_gradients.data();
    for (unsigned int p = 0; p < n_cell_points; ++p)
      {
        // by the coordinates of the cell
        double G[dim][dim] = {};
        for (unsigned int a = 0; a < n_cell_nodes; ++a, unit_gradient += dim)
          {
            const double *const value = q.begin() + dim * node[a];
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int m = 0; m < dim; ++m)
                G[i][m] += value[i] * unit_gradient[m];
          }
        const auto &inverse = points[n_cell_points * cell + p].inverse_jacobian;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            gradients[p][i][j] = G[i][0] * inverse[0][j] +
                                 G[i][1] * inverse[1][j] +
                                 G[i][2] * inverse[2][j];
      }
  }
} // namespace ACF
