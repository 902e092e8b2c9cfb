// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_survey.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ACF
{
  namespace
  {
    using Cell = Triangulation<dim>::active_cell_iterator;

    // FEValues want an element, also if nobody asks for shape functions.
    std::unique_ptr<FiniteElement<dim>>
    any_element(const BodyMesh &mesh)
    {
      if (mesh.is_simplex())
        return std::make_unique<FE_SimplexP<dim>>(1);
      return std::make_unique<FE_Q<dim>>(1);
    }



    double
    radius_ratio(const Cell &cell)
    {
      const Point<dim> origin = cell->vertex(0);
      const Vector3 a = cell->vertex(1) - origin, b = cell->vertex(2) - origin,
                    c       = cell->vertex(3) - origin;
      const Vector3 bc      = cross_product_3d(b, c);
      const Vector3 ca      = cross_product_3d(c, a);
      const Vector3 ab      = cross_product_3d(a, b);
      const double volume_6 = std::abs(a * bc);
      const double areas_2  = bc.norm() + ca.norm() + ab.norm() +
                             cross_product_3d(b - a, c - a).norm();
      // r = 6 V / (2 sum of areas), R = |...| / (12 V)
      const double outer =
        ((a * a) * bc + (b * b) * ca + (c * c) * ab).norm() / (2 * volume_6);
      return 3 * (volume_6 / areas_2) / outer;
    }



    double
    scaled_jacobian(const Cell &cell)
    {
      double smallest = std::numeric_limits<double>::infinity();
      for (unsigned int v = 0; v < 8; ++v)
        {
          Tensor<2, dim> edges;
          double sign = 1;
          for (unsigned int d = 0; d < dim; ++d)
            {
              edges[d] = cell->vertex(v ^ (1U << d)) - cell->vertex(v);
              edges[d] /= edges[d].norm();
              sign *= ((v >> d) & 1U) != 0 ? -1 : 1;
            }
          smallest = std::min(smallest, sign * determinant(edges));
        }
      return smallest;
    }



    void
    survey_cells(const BodyMesh &mesh, MeshSurvey &survey)
    {
      const auto element = any_element(mesh);
      FEValues<dim> values(mesh.mapping(),
                           *element,
                           mesh.cell_quadrature(4),
                           update_JxW_values | update_quadrature_points);
      std::map<types::material_id, std::pair<unsigned int, double>> materials;
      Matrix3 second_moment;
      // about a vertex, not to lose digits far from the origin
      const Point<dim> origin = mesh.triangulation().get_vertices()[0];
      Vector3 first_moment;
      survey.lower = survey.upper = origin;
      survey.shortest_edge        = std::numeric_limits<double>::infinity();
      for (const auto &cell : mesh.triangulation().active_cell_iterators())
        {
          values.reinit(cell);
          double volume = 0;
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const Vector3 arm = values.quadrature_point(q) - origin;
              volume += values.JxW(q);
              first_moment += values.JxW(q) * arm;
              second_moment += values.JxW(q) * outer_product(arm, arm);
            }
          survey.volume += volume;
          auto &[n_cells, material_volume] = materials[cell->material_id()];
          ++n_cells;
          material_volume += volume;

          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int d = 0; d < dim; ++d)
              {
                survey.lower[d] = std::min(survey.lower[d], cell->vertex(v)[d]);
                survey.upper[d] = std::max(survey.upper[d], cell->vertex(v)[d]);
              }
          for (unsigned int l = 0; l < cell->n_lines(); ++l)
            {
              const double length =
                cell->line(l)->vertex(0).distance(cell->line(l)->vertex(1));
              survey.shortest_edge = std::min(survey.shortest_edge, length);
              survey.longest_edge  = std::max(survey.longest_edge, length);
            }
          survey.qualities.push_back(cell_shape_quality(cell));
        }

      const Vector3 mean = first_moment / survey.volume;
      survey.centre      = origin + mean;
      second_moment -= survey.volume * outer_product(mean, mean);
      survey.inertia = -second_moment;
      for (unsigned int d = 0; d < dim; ++d)
        survey.inertia[d][d] += trace(second_moment);

      for (const auto &[name, ids] : mesh.regions())
        {
          RegionSurvey region{name};
          for (const types::material_id id : ids)
            {
              region.n_cells += materials[id].first;
              region.volume += materials[id].second;
            }
          survey.regions.push_back(region);
        }
    }



    // A face of the boundary.
    struct BoundaryFace
    {
      std::vector<unsigned int> vertices;
      Facet facet;

      /** Integral of the position, m^3. */
      Vector3 moment;
    };



    std::map<types::boundary_id, std::vector<BoundaryFace>>
    boundary_faces(const BodyMesh &mesh)
    {
      const auto element = any_element(mesh);
      FEFaceValues<dim> values(mesh.mapping(),
                               *element,
                               mesh.face_quadrature(4),
                               update_JxW_values | update_quadrature_points |
                                 update_normal_vectors);
      std::map<types::boundary_id, std::vector<BoundaryFace>> faces;
      for (const auto &cell : mesh.triangulation().active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              values.reinit(cell, f);
              BoundaryFace face;
              for (const unsigned int v : cell->face(f)->vertex_indices())
                {
                  face.vertices.push_back(cell->face(f)->vertex_index(v));
                  face.facet.centre += Vector3(cell->face(f)->vertex(v)) /
                                       (1. * cell->face(f)->n_vertices());
                }
              for (const unsigned int q : values.quadrature_point_indices())
                {
                  face.facet.area += values.JxW(q);
                  face.moment +=
                    values.JxW(q) * Vector3(values.quadrature_point(q));
                  face.facet.normal += values.JxW(q) * values.normal_vector(q);
                }
              face.facet.normal /= face.facet.normal.norm();
              faces[cell->face(f)->boundary_id()].push_back(face);
            }
      return faces;
    }



    // Sets of faces that are connected through vertices.
    unsigned int
    count_pieces(const std::vector<const BoundaryFace *> &faces)
    {
      std::map<unsigned int, unsigned int> parent;
      const auto root = [&](unsigned int vertex) {
        while (parent[vertex] != vertex)
          vertex = parent[vertex] = parent[parent[vertex]];
        return vertex;
      };
      for (const BoundaryFace *const face : faces)
        for (const unsigned int vertex : face->vertices)
          {
            parent.try_emplace(vertex, vertex);
            parent[root(vertex)] = root(face->vertices[0]);
          }
      unsigned int n_pieces = 0;
      for (const auto &[vertex, above] : parent)
        n_pieces += (vertex == above ? 1 : 0);
      return n_pieces;
    }



    SurfaceSurvey
    survey_surface(const std::string &name,
                   const std::vector<const BoundaryFace *> &faces,
                   const std::vector<Point<dim>> &all_vertices)
    {
      SurfaceSurvey surface;
      surface.name    = name;
      surface.n_faces = faces.size();
      std::set<unsigned int> indices;
      std::vector<Facet> facets;
      Vector3 moment;
      for (const BoundaryFace *const face : faces)
        {
          surface.area += face->facet.area;
          moment += face->moment;
          facets.push_back(face->facet);
          indices.insert(face->vertices.begin(), face->vertices.end());
        }
      surface.centre   = Point<dim>(moment / surface.area);
      surface.n_pieces = count_pieces(faces);
      std::vector<Point<dim>> vertices;
      for (const unsigned int index : indices)
        vertices.push_back(all_vertices[index]);
      surface.shape = surface_shape(vertices, facets);
      return surface;
    }
  } // namespace



  double
  cell_shape_quality(const Cell &cell)
  {
    return cell->n_vertices() == 4 ? radius_ratio(cell) : scaled_jacobian(cell);
  }



  MeshSurvey
  survey_mesh(const BodyMesh &mesh)
  {
    MeshSurvey survey;
    survey_cells(mesh, survey);
    survey.worst_cell =
      std::min_element(survey.qualities.begin(), survey.qualities.end()) -
      survey.qualities.begin();
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      if (cell->active_cell_index() == survey.worst_cell)
        for (const unsigned int v : cell->vertex_indices())
          survey.worst_place +=
            Vector3(cell->vertex(v)) / (1. * cell->n_vertices());

    const auto faces = boundary_faces(mesh);
    for (const auto &[name, ids] : mesh.surfaces())
      {
        std::vector<const BoundaryFace *> of_surface;
        for (const types::boundary_id id : ids)
          if (faces.count(id) > 0)
            for (const BoundaryFace &face : faces.at(id))
              of_surface.push_back(&face);
        if (of_surface.empty())
          continue;
        survey.surfaces.push_back(survey_surface(
          name, of_surface, mesh.triangulation().get_vertices()));
      }
    const auto unnamed = faces.find(0);
    if (unnamed != faces.end())
      for (const BoundaryFace &face : unnamed->second)
        {
          ++survey.n_unnamed_faces;
          survey.unnamed_area += face.facet.area;
        }
    return survey;
  }
} // namespace ACF
