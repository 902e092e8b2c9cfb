// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/stress.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  namespace
  {
    Matrix3
    displacement_gradient(const std::vector<unsigned int> &nodes,
                          const std::vector<Vector3> &shape_gradients,
                          const NodalVector &q)
    {
      Matrix3 gradient;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
          gradient[c] += q[dim * nodes[i] + c] * shape_gradients[i];
      return gradient;
    }



    Symmetric3
    turned(const Matrix3 &R, const Symmetric3 &tensor)
    {
      return symmetrize(R * Matrix3(tensor) * transpose(R));
    }
  } // namespace



  double
  von_mises_stress(const Symmetric3 &stress)
  {
    return std::sqrt(1.5) * deviator(stress).norm();
  }



  StressEvaluation::StressEvaluation(const Body &body,
                                     const NodalVector &positions,
                                     const double time)
    : body(body)
    , q(positions.size())
  {
    const auto frame =
      ACF::body_rotation(mean_deformation_gradient(body.operators(), positions),
                         body.rotation_measure());
    if (!frame)
      throw SimulationError("The body '" + body.name() + "' at time " +
                            format_number(time) +
                            " s is so deformed that it has no rotation; its "
                            "stress cannot be evaluated.");
    body_rotation = frame->rotation;
    ACF::co_rotated_displacement(body.operators(), positions, body_rotation, q);
  }



  StressAndStrain
  StressEvaluation::at(const Matrix3 &gradient) const
  {
    const Material &material = body.material();
    const bool is_reduced    = body.strain_measure() == StrainMeasure::reduced;
    Symmetric3 strain        = symmetrize(gradient);
    if (!is_reduced)
      strain += 0.5 * symmetrize(transpose(gradient) * gradient);
    Symmetric3 stress =
      material.lambda() * trace(strain) * unit_symmetric_tensor<dim>() +
      2 * material.mu() * strain;
    if (!is_reduced)
      {
        const Matrix3 F = gradient + Matrix3(unit_symmetric_tensor<dim>());
        stress          = turned(F, stress) / determinant(F);
      }
    return {turned(body_rotation, stress), turned(body_rotation, strain)};
  }



  template <typename Visit>
  void
  StressEvaluation::for_all_cells(const Quadrature<dim> &quadrature,
                                  const Visit &visit) const
  {
    const BodyDiscretization &space = body.discretization();
    FEValues<dim> values(space.mesh().mapping(),
                         space.scalar_element(),
                         quadrature,
                         update_gradients | update_JxW_values);
    std::vector<unsigned int> nodes(values.dofs_per_cell);
    std::vector<Vector3> gradients(values.dofs_per_cell);
    std::vector<StressAndStrain> at_points(quadrature.size());
    for (const auto &cell : space.dof_handler().active_cell_iterators())
      {
        values.reinit(typename Triangulation<dim>::active_cell_iterator(cell));
        space.get_nodes(cell, nodes);
        for (const unsigned int point : values.quadrature_point_indices())
          {
            for (const unsigned int i : values.dof_indices())
              gradients[i] = values.shape_grad(i, point);
            at_points[point] = at(displacement_gradient(nodes, gradients, q));
          }
        visit(cell->active_cell_index(),
              nodes,
              values.get_JxW_values(),
              at_points);
      }
  }



  std::vector<StressAndStrain>
  StressEvaluation::nodal_values(std::vector<double> *const largest) const
  {
    const BodyDiscretization &space = body.discretization();
    std::vector<StressAndStrain> result(space.n_nodes());
    std::vector<unsigned int> n_cells(space.n_nodes(), 0);
    if (largest != nullptr)
      largest->assign(space.mesh().triangulation().n_active_cells(), 0.);
    for_all_cells(
      Quadrature<dim>(space.scalar_element().get_unit_support_points()),
      [&](const unsigned int cell,
          const auto &nodes,
          const auto &,
          const auto &at) {
        for (unsigned int i = 0; i < nodes.size(); ++i)
          {
            result[nodes[i]].stress += at[i].stress;
            result[nodes[i]].strain += at[i].strain;
            ++n_cells[nodes[i]];
            if (largest != nullptr)
              (*largest)[cell] =
                std::max((*largest)[cell], von_mises_stress(at[i].stress));
          }
      });
    for (unsigned int a = 0; a < result.size(); ++a)
      {
        result[a].stress /= n_cells[a];
        result[a].strain /= n_cells[a];
      }
    return result;
  }



  std::vector<Symmetric3>
  StressEvaluation::cell_means() const
  {
    const BodyDiscretization &space = body.discretization();
    std::vector<Symmetric3> result(
      space.mesh().triangulation().n_active_cells());
    const auto average = [&](const unsigned int cell,
                             const auto &,
                             const auto &weights,
                             const auto &at) {
      double volume = 0;
      for (unsigned int point = 0; point < at.size(); ++point)
        {
          volume += weights[point];
          result[cell] += weights[point] * at[point].stress;
        }
      result[cell] /= volume;
    };
    if (space.mesh().is_simplex())
      for_all_cells(QGaussSimplex<dim>(2), average);
    else
      for_all_cells(QGauss<dim>(3), average);
    return result;
  }



  PointStress::PointStress(const Body &body, const Point<dim> &X)
  {
    const BodyDiscretization &space = body.discretization();
    for (const auto &[cell, unit] : cells_at(space, X))
      {
        FEValues<dim> values(space.mesh().mapping(),
                             space.scalar_element(),
                             Quadrature<dim>(std::vector<Point<dim>>{unit}),
                             update_gradients);
        values.reinit(typename Triangulation<dim>::active_cell_iterator(cell));
        CellGradient gradient;
        gradient.nodes.resize(values.dofs_per_cell);
        space.get_nodes(cell, gradient.nodes);
        for (const unsigned int i : values.dof_indices())
          gradient.gradients.push_back(values.shape_grad(i, 0));
        cells.push_back(gradient);
      }
  }



  StressAndStrain
  PointStress::operator()(const StressEvaluation &evaluation) const
  {
    StressAndStrain result;
    for (const CellGradient &cell : cells)
      {
        const StressAndStrain value = evaluation.at(displacement_gradient(
          cell.nodes, cell.gradients, evaluation.co_rotated_displacement()));
        result.stress += value.stress;
        result.strain += value.strain;
      }
    result.stress /= cells.size();
    result.strain /= cells.size();
    return result;
  }
} // namespace ACF
