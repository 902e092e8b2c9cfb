// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_cell_gradients_h
#define acf_mechanics_cell_gradients_h

#include <acf/mechanics/body_operators.h>

#include <vector>

namespace ACF
{
  /**
   * Gradients of nodal fields at the integration points of the cells of a
   * reference body, again and again: what depends on the cells only is computed
   * once and kept, 80 bytes per point and 4 bytes per node of a cell.
   *
   * The rule integrates quadratic polynomials: four points in a tetrahedron, 2
   * x 2 x 2 in a hexahedron.
   */
  class CellGradients
  {
  public:
    explicit CellGradients(const BodyDiscretization &space);

    std::size_t
    n_cells() const
    {
      return cell_nodes.size() / n_cell_nodes;
    }

    /** Of a cell. */
    unsigned int
    n_points() const
    {
      return n_cell_points;
    }

    /** Of a cell, in the order of BodyDiscretization::scalar_element(). */
    const unsigned int *
    nodes(const std::size_t cell) const
    {
      return cell_nodes.data() + n_cell_nodes * cell;
    }

    /** Integration weight times determinant of the mapping, m^3. */
    double
    volume(const std::size_t cell, const unsigned int point) const
    {
      return points[n_cell_points * cell + point].volume;
    }

    /**
     * $H_{ij} = \partial q_i / \partial X_j$ at the points of a cell, in the
     * order of their numbers.
     * @param[out] gradients n_points() matrices
     */
    void
    evaluate(const NodalVector &q,
             const std::size_t cell,
             std::vector<Matrix3> &gradients) const;

  private:
    struct MappedPoint
    {
      /** $\partial \xi_m / \partial X_j$ */
      double inverse_jacobian[dim][dim];

      double volume;
    };

    unsigned int n_cell_nodes;
    unsigned int n_cell_points;

    /** [point][node][m], derivatives by the coordinates $\xi$ of the cell. */
    std::vector<double> unit_gradients;

    /** [cell][node] */
    std::vector<unsigned int> cell_nodes;

    /** [cell][point] */
    std::vector<MappedPoint> points;
  };
} // namespace ACF

#endif
