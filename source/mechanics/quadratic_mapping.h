// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_quadratic_mapping_h
#define acf_mechanics_quadratic_mapping_h

#include <acf/mechanics/mesh_data.h>

#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace ACF
{
  /**
   * The isoparametric mapping of tetrahedra with ten nodes: deal.II's mapping
   * by shape functions, which puts the nodes on straight edges, with nodes of
   * our own on some edges.
   */
  class QuadraticMapping : public MappingFE<dim>
  {
  public:
    /** @param data whose vertices are those of the triangulation */
    QuadraticMapping(const Triangulation<dim> &triangulation,
                     const MeshData &data)
      : QuadraticMapping(make_nodes(triangulation, data))
    {}

    virtual std::unique_ptr<Mapping<dim>>
    clone() const override
    {
      return std::make_unique<QuadraticMapping>(*this);
    }

    /** Of the nodes, enlarged by what a quadratic function with values between
     * 0 and 1 at three nodes can have beyond them. */
    virtual BoundingBox<dim>
    get_bounding_box(
      const typename Triangulation<dim>::cell_iterator &cell) const override
    {
      BoundingBox<dim> box(compute_mapping_support_points(cell));
      double side = 0;
      for (unsigned int d = 0; d < dim; ++d)
        side = std::max(side, box.side_length(d));
      box.extend(0.125 * side);
      return box;
    }

  protected:
    virtual std::vector<Point<dim>>
    compute_mapping_support_points(
      const typename Triangulation<dim>::cell_iterator &cell) const override
    {
      return (*nodes)[cell->active_cell_index()];
    }

    // Cells with vertices that are translations of others may be curved in
    // another way.
    virtual CellSimilarity::Similarity
    fill_fe_values(const typename Triangulation<dim>::cell_iterator &cell,
                   const CellSimilarity::Similarity /*similarity*/,
                   const Quadrature<dim> &quadrature,
                   const typename Mapping<dim>::InternalDataBase &internal_data,
                   internal::FEValuesImplementation::MappingRelatedData<dim>
                     &output) const override
    {
      return MappingFE<dim>::fill_fe_values(
        cell, CellSimilarity::none, quadrature, internal_data, output);
    }

  private:
    using Nodes = std::shared_ptr<const std::vector<std::vector<Point<dim>>>>;

    explicit QuadraticMapping(Nodes nodes)
      : MappingFE<dim>(FE_SimplexP<dim>(2))
      , nodes(std::move(nodes))
    {}

    static Nodes
    make_nodes(const Triangulation<dim> &triangulation, const MeshData &data)
    {
      const FE_SimplexP<dim> element(2);
      const auto &unit_points = element.get_unit_support_points();
      const auto reference    = ReferenceCells::Tetrahedron;

      // of each node on an edge, found by its place
      std::vector<std::pair<unsigned int, unsigned int>> ends(
        unit_points.size());
      for (unsigned int n = 4; n < unit_points.size(); ++n)
        for (unsigned int v = 0; v < 4; ++v)
          for (unsigned int w = 0; w < v; ++w)
            if ((reference.vertex<dim>(v) + Vector3(reference.vertex<dim>(w)) -
                 2 * Vector3(unit_points[n]))
                  .norm() < 1e-6)
              ends[n] = {v, w};

      auto result = std::make_shared<std::vector<std::vector<Point<dim>>>>(
        triangulation.n_active_cells());
      for (const auto &cell : triangulation.active_cell_iterators())
        for (unsigned int n = 0; n < unit_points.size(); ++n)
          {
            auto &cell_nodes = (*result)[cell->active_cell_index()];
            if (n < 4)
              {
                cell_nodes.push_back(cell->vertex(n));
                continue;
              }
            const auto [v, w] = ends[n];
            const auto edge   = data.curved_edges.find(
              std::minmax({cell->vertex_index(v), cell->vertex_index(w)}));
            cell_nodes.push_back(
              edge != data.curved_edges.end()
                ? edge->second
                : Point<dim>(0.5 *
                             (cell->vertex(v) + Vector3(cell->vertex(w)))));
          }
      return result;
    }

    Nodes nodes;
  };
} // namespace ACF

#endif
