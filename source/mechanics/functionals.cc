// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/functionals.h>

#include <deal.II/fe/fe_values.h>

#include <Eigen/Dense>

#include <cmath>
#include <functional>
#include <limits>
#include <map>

namespace ACF
{
  namespace
  {
    // Calls a function with each quadrature point X, its weighted normal N dA,
    // the nodes of the cell and the values of their shape functions.
    using FacePointFunction =
      std::function<void(const Point<dim> &,
                         const Vector3 &,
                         const std::vector<unsigned int> &,
                         const std::vector<double> &)>;

    void
    for_all_face_points(const BodyDiscretization &body,
                        const std::set<types::boundary_id> &surface,
                        const FacePointFunction &function)
    {
      // exact for affine weights times quadratic shape functions
      const auto &element = body.scalar_element();
      FEFaceValues<dim> values(body.mesh().mapping(),
                               element,
                               body.mesh().face_quadrature(4),
                               update_values | update_quadrature_points |
                                 update_normal_vectors | update_JxW_values);
      std::vector<unsigned int> nodes(element.n_dofs_per_cell());
      std::vector<double> phi(element.n_dofs_per_cell());

      for (const auto &cell : body.dof_handler().active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() &&
              surface.count(cell->face(f)->boundary_id()) > 0)
            {
              values.reinit(
                typename Triangulation<dim>::active_cell_iterator(cell), f);
              body.get_nodes(cell, nodes);
              for (const unsigned int q : values.quadrature_point_indices())
                {
                  for (unsigned int i = 0; i < phi.size(); ++i)
                    phi[i] = values.shape_value(i, q);
                  function(values.quadrature_point(q),
                           values.JxW(q) * values.normal_vector(q),
                           nodes,
                           phi);
                }
            }
    }



    NodalFunctional
    from_map(const std::map<unsigned int, double> &weights)
    {
      double largest = 0;
      for (const auto &entry : weights)
        largest = std::max(largest, std::abs(entry.second));

      // Nodes of the cells that do not lie on the surface have a zero weight.
      NodalFunctional result;
      for (const auto &[node, weight] : weights)
        if (std::abs(weight) > 1e-14 * largest)
          {
            result.nodes.push_back(node);
            result.weights.push_back(weight);
          }
      return result;
    }



    NodalFunctional
    weighted_mean(const BodyDiscretization &body,
                  const std::set<types::boundary_id> &surface,
                  const double area,
                  const std::function<double(const Point<dim> &)> &weight)
    {
      std::map<unsigned int, double> weights;
      for_all_face_points(body,
                          surface,
                          [&](const Point<dim> &X,
                              const Vector3 &normal,
                              const std::vector<unsigned int> &nodes,
                              const std::vector<double> &phi) {
                            for (unsigned int i = 0; i < nodes.size(); ++i)
                              weights[nodes[i]] +=
                                weight(X) * phi[i] * normal.norm() / area;
                          });
      return from_map(weights);
    }
  } // namespace



  Vector3
  NodalFunctional::operator()(const NodalVector &x) const
  {
    Vector3 value;
    for (unsigned int k = 0; k < nodes.size(); ++k)
      for (unsigned int i = 0; i < dim; ++i)
        value[i] += weights[k] * x[dim * nodes[k] + i];
    return value;
  }



  void
  NodalFunctional::add_adjoint(const Vector3 &F, NodalVector &force) const
  {
    for (unsigned int k = 0; k < nodes.size(); ++k)
      for (unsigned int i = 0; i < dim; ++i)
        force[dim * nodes[k] + i] += weights[k] * F[i];
  }



  bool
  NodalFunctional::is_close(const NodalFunctional &other) const
  {
    if (nodes != other.nodes)
      return false;
    double largest = 0, difference = 0;
    for (unsigned int k = 0; k < weights.size(); ++k)
      {
        largest = std::max(largest, std::abs(weights[k]));
        difference =
          std::max(difference, std::abs(weights[k] - other.weights[k]));
      }
    return difference <= 1e-12 * largest;
  }



  double
  scalar_product(const NodalFunctional &first, const NodalFunctional &second)
  {
    double sum = 0;
    for (unsigned int k = 0, l = 0;
         k < first.nodes.size() && l < second.nodes.size();)
      if (first.nodes[k] < second.nodes[l])
        ++k;
      else if (first.nodes[k] > second.nodes[l])
        ++l;
      else
        sum += first.weights[k++] * second.weights[l++];
    return sum;
  }



  double
  SurfaceGeometry::extent(const Vector3 &unit_direction) const
  {
    return std::sqrt(
      std::max(0., unit_direction * (second_moment * unit_direction)));
  }



  Vector3
  SurfaceGeometry::solve_second_moment(const Vector3 &a) const
  {
    Eigen::Matrix3d J;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        J(i, j) = second_moment[i][j];
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> decomposition;
    // a plane surface has exactly one direction without extent
    decomposition.setThreshold(1e-10);
    decomposition.compute(J);
    const Eigen::Vector3d solution =
      decomposition.solve(Eigen::Vector3d(a[0], a[1], a[2]));
    return Vector3({solution(0), solution(1), solution(2)});
  }



  bool
  SurfaceGeometry::resolves(const Vector3 &unit_direction) const
  {
    return (second_moment * solve_second_moment(unit_direction) -
            unit_direction)
             .norm() < 1e-6;
  }



  SurfaceGeometry
  surface_geometry(const BodyDiscretization &body,
                   const std::set<types::boundary_id> &surface)
  {
    SurfaceGeometry geometry;
    for_all_face_points(body,
                        surface,
                        [&](const Point<dim> &X,
                            const Vector3 &normal,
                            const std::vector<unsigned int> &,
                            const std::vector<double> &) {
                          const double dA = normal.norm();
                          geometry.area += dA;
                          geometry.centroid += dA * X;
                        });
    if (!(geometry.area > 0))
      throw SimulationError("a surface without area");
    geometry.centroid /= geometry.area;

    for_all_face_points(body,
                        surface,
                        [&](const Point<dim> &X,
                            const Vector3 &normal,
                            const std::vector<unsigned int> &,
                            const std::vector<double> &) {
                          const double dA   = normal.norm();
                          const Vector3 arm = X - Point<dim>(geometry.centroid);
                          geometry.second_moment +=
                            dA / geometry.area * outer_product(arm, arm);
                        });
    return geometry;
  }



  NodalFunctional
  surface_mean(const BodyDiscretization &body,
               const std::set<types::boundary_id> &surface)
  {
    return weighted_mean(body,
                         surface,
                         surface_geometry(body, surface).area,
                         [](const Point<dim> &) { return 1.; });
  }



  NodalFunctional
  surface_moment(const BodyDiscretization &body,
                 const std::set<types::boundary_id> &surface,
                 const Vector3 &v)
  {
    const SurfaceGeometry geometry = surface_geometry(body, surface);
    return weighted_mean(body,
                         surface,
                         geometry.area,
                         [&](const Point<dim> &X) {
                           return v * (X - Point<dim>(geometry.centroid));
                         });
  }



  NodalFunctional
  surface_director(const BodyDiscretization &body,
                   const std::set<types::boundary_id> &surface,
                   const Vector3 &direction)
  {
    const SurfaceGeometry geometry = surface_geometry(body, surface);
    Assert(geometry.resolves(direction),
           ExcMessage("The surface does not resolve this direction."));
    return surface_moment(body,
                          surface,
                          geometry.solve_second_moment(direction));
  }



  std::map<unsigned int, Vector3>
  surface_normals(const BodyDiscretization &body,
                  const std::set<types::boundary_id> &surface)
  {
    std::map<unsigned int, Vector3> result;
    for_all_face_points(body,
                        surface,
                        [&](const Point<dim> &,
                            const Vector3 &normal,
                            const std::vector<unsigned int> &nodes,
                            const std::vector<double> &phi) {
                          for (unsigned int i = 0; i < nodes.size(); ++i)
                            if (phi[i] != 0)
                              result[nodes[i]] += phi[i] * normal;
                        });
    return result;
  }



  std::vector<CellPoint>
  cells_at(const BodyDiscretization &body, const Point<dim> &X)
  {
    const auto &mapping = body.mesh().mapping();
    std::vector<CellPoint> cells;
    for (const auto &cell : body.dof_handler().active_cell_iterators())
      {
        const typename Triangulation<dim>::active_cell_iterator mesh_cell(cell);
        if (!mapping.get_bounding_box(mesh_cell).point_inside(X, 1e-9))
          continue;
        try
          {
            const Point<dim> unit =
              mapping.transform_real_to_unit_cell(mesh_cell, X);
            if (cell->reference_cell().contains_point(unit, 1e-9))
              cells.push_back({cell, unit});
          }
        catch (const typename Mapping<dim>::ExcTransformationFailed &)
          {}
      }
    if (!cells.empty())
      return cells;

    double distance = std::numeric_limits<double>::max();
    for (unsigned int a = 0; a < body.n_nodes(); ++a)
      {
        Point<dim> node;
        for (unsigned int i = 0; i < dim; ++i)
          node[i] = body.reference_positions()[dim * a + i];
        distance = std::min(distance, node.distance(X));
      }
    throw SimulationError("a point outside the body, " +
                          format_number(distance) + " m from the nearest node");
  }



  NodalFunctional
  material_point(const BodyDiscretization &body, const Point<dim> &X)
  {
    const CellPoint place = cells_at(body, X).front();
    const auto &element   = body.scalar_element();
    std::vector<unsigned int> nodes(element.n_dofs_per_cell());
    body.get_nodes(place.cell, nodes);
    std::map<unsigned int, double> weights;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      weights[nodes[i]] = element.shape_value(i, place.unit);
    return from_map(weights);
  }
} // namespace ACF
