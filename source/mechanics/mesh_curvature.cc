// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "mesh_curvature.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace ACF
{
  namespace
  {
    /** Of places of nodes, relative to the length of the edge. */
    constexpr double edge_tolerance = 1e-10;

    /** The smallest determinant of the derivative of the quadratic map at 84
     * points, relative to that of the straight tetrahedron, and where it is. */
    std::pair<double, Point<dim>>
    curved_quality(const MeshData &data, const CellData<dim> &cell)
    {
      const auto vertex = [&](const unsigned int v) {
        return Vector3(data.vertices[cell.vertices[v]]);
      };
      // offset of a node from the middle of its edge
      std::vector<std::tuple<unsigned int, unsigned int, Vector3>> offsets;
      for (unsigned int v = 0; v < 4; ++v)
        for (unsigned int w = 0; w < v; ++w)
          {
            const auto edge = data.curved_edges.find(
              std::minmax({cell.vertices[v], cell.vertices[w]}));
            if (edge != data.curved_edges.end())
              offsets.emplace_back(
                v, w, Vector3(edge->second) - 0.5 * (vertex(v) + vertex(w)));
          }
      std::pair<double, Point<dim>> worst = {1., Point<dim>()};
      if (offsets.empty())
        return worst;

      Tensor<2, dim> straight; // one derivative per row
      for (unsigned int d = 0; d < dim; ++d)
        straight[d] = vertex(d + 1) - vertex(0);
      const double straight_volume = determinant(straight);
      constexpr unsigned int n     = 6;
      for (unsigned int i = 0; i <= n; ++i)
        for (unsigned int j = 0; i + j <= n; ++j)
          for (unsigned int k = 0; i + j + k <= n; ++k)
            {
              const std::array<double, 4> lambda = {
                {1. * (n - i - j - k) / n, 1. * i / n, 1. * j / n, 1. * k / n}};
              Tensor<2, dim> derivative = straight;
              Vector3 position;
              for (unsigned int v = 0; v < 4; ++v)
                position += lambda[v] * vertex(v);
              for (const auto &[v, w, offset] : offsets)
                {
                  position += 4 * lambda[v] * lambda[w] * offset;
                  // the derivative of lambda_v along d is 1, 0, or -1 for v = 0
                  for (unsigned int d = 0; d < dim; ++d)
                    {
                      const auto slope = [d](const unsigned int vertex) {
                        return vertex == 0 ? -1. : (vertex == d + 1 ? 1. : 0.);
                      };
                      derivative[d] +=
                        4 * (slope(v) * lambda[w] + lambda[v] * slope(w)) *
                        offset;
                    }
                }
              const double jacobian = determinant(derivative) / straight_volume;
              if (!(jacobian >= worst.first))
                worst = {jacobian, Point<dim>(position)};
            }
      return worst;
    }
  } // namespace

  Point<dim>
  edge_middle(const MeshData &data, const unsigned int a, const unsigned int b)
  {
    return data.vertices[a] + 0.5 * (data.vertices[b] - data.vertices[a]);
  }

  bool
  add_edge_node(MeshData &data,
                const unsigned int a,
                const unsigned int b,
                const Point<dim> &node)
  {
    const double smallest =
      edge_tolerance * data.vertices[a].distance(data.vertices[b]);
    return data.curved_edges.try_emplace(std::minmax(a, b), node)
             .first->second.distance(node) <= smallest;
  }

  void
  drop_straight_edges(MeshData &data)
  {
    for (auto edge = data.curved_edges.begin();
         edge != data.curved_edges.end();)
      {
        const auto [a, b] = edge->first;
        const double smallest =
          edge_tolerance * data.vertices[a].distance(data.vertices[b]);
        if (edge->second.distance(edge_middle(data, a, b)) <= smallest)
          edge = data.curved_edges.erase(edge);
        else
          ++edge;
      }
  }

  void
  check_curved_cells(const MeshData &data, const MeshSource &source)
  {
    constexpr double smallest_quality = 1e-3;
    unsigned int n_folded             = 0;
    std::string first;
    for (unsigned int c = 0; c < data.cells.size(); ++c)
      {
        const auto [quality, place] = curved_quality(data, data.cells[c]);
        if (quality >= smallest_quality)
          continue;
        if (n_folded == 0)
          first =
            describe_cell(data, c) + ", at the point " + describe_point(place);
        ++n_folded;
      }
    if (n_folded > 0)
      throw source.error(
        std::to_string(n_folded) +
          " folded cells (whose curved edges make the Jacobian negative, or "
          "less than a thousandth of that of the straight cell), the "
          "first: " +
          first,
        "curved cells with a positive Jacobian: a finer mesh, or Geometry = "
        "straight");
  }
} // namespace ACF
