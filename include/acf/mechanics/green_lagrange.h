// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_green_lagrange_h
#define acf_mechanics_green_lagrange_h

#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/node_rotations.h>

#include <deal.II/base/aligned_vector.h>

#include <optional>
#include <vector>

namespace ACF
{
  /**
   * Elastic energy of the Green-Lagrange strain with the material of St. Venant
   * and Kirchhoff, its gradient and its second derivative,
   * \f[ W = \int \tfrac{\lambda}{2} (\mathrm{tr} E)^2 + \mu\, E : E \, dV,
   * \quad E = \tfrac12 (F^T F - I), \quad F = \sum_a x_a \otimes \nabla\phi_a,
   * \f] \f[ f_a = \int F S\, \nabla\phi_a\, dV, \quad S = \lambda\,
   * \mathrm{tr}(E)\, I + 2 \mu E, \f] \f[ (K \delta)_a = \int (\delta F\, S +
   * F\, \delta S)\, \nabla\phi_a\, dV \f] (Bonet and Wood, Nonlinear continuum
   * mechanics for finite element analysis, Sec. 6.4.1 and 9.3). At rest K is
   * the small-strain stiffness A.
   *
   * A loop over quadrature points: four per tetrahedron, which integrate A
   * exactly, 27 per hexahedron. A batch of eight cells at once fills the
   * registers of the processor, with functions for its instruction set; threads
   * share the batches. Results do not depend on the number of threads.
   * See theory (4.1), theory (4.2).
   */
  class GreenLagrangeOperator
  {
  public:
    GreenLagrangeOperator(const BodyDiscretization &body,
                          const Material &material);

    /**
     * @param positions $x_a$, m
     * @param[out] force $f_a$, N; must have the size of @p positions
     * @return W, J; nothing, and no force, if a cell is turned inside out at a
     * quadrature point ($\det F \le 0$)
     */
    std::optional<double>
    force(const NodalVector &positions, NodalVector &force) const;

    /**
     * @param positions $x_a$, m
     * @param direction $\delta_a$, m
     * @param[out] result K $\delta$, N; must have the size of @p positions
     */
    void
    apply_tangent(const NodalVector &positions,
                  const NodalVector &direction,
                  NodalVector &result) const;

    /**
     * K in frames of the nodes: adds $R_a^T K_{ab} R_b$ for all couples.
     */
    void
    add_tangent(const NodalVector &positions,
                const NodeRotations &rotations,
                BlockNodeMatrix &matrix) const;

    /**
     * Deformation gradients at the nodes, for each the mean of F in the cells
     * around.
     */
    std::vector<Matrix3>
    node_gradients(const NodalVector &positions) const;

    std::size_t
    memory_consumption() const;

    /** Cells that are integrated at once. */
    static constexpr unsigned int batch_size = 8;

    /** What the integrals need of the cells; those beyond the last one repeat
     * it without weight. */
    struct Geometry
    {
      double lambda;
      double mu;
      unsigned int n_shape_functions;
      unsigned int n_points;

      /** One for all points of straight tetrahedra. */
      unsigned int n_jacobians;

      /** Of the shape functions on the unit cell, [q][a][i]. */
      std::vector<double> unit_gradients;

      /** Inverse Jacobians, 1/m, [batch][q][i][j][cell]. */
      AlignedVector<double> inverse_jacobians;

      /** dV, m^3, [batch][q][cell]. */
      AlignedVector<double> weights;

      /** Of the first entry of an inverse Jacobian. */
      std::size_t
      jacobian_index(const std::size_t batch, const unsigned int q) const
      {
        return dim * dim * batch_size *
               (batch * n_jacobians + (n_jacobians == 1 ? 0 : q));
      }
    };

  private:
    /** Positions relative to an origin, or displacements, at the nodes of a
     * batch of cells, [a][i][cell]. */
    void
    gather(const NodalVector &x,
           const Vector3 &origin,
           const unsigned int batch,
           AlignedVector<double> &values) const;

    /** Adds the values of all cells, [batch][a][i][cell], at the nodes. */
    void
    scatter(const NodalVector &cell_values, NodalVector &result) const;

    Geometry geometry;
    unsigned int n_nodes;
    unsigned int n_cells;
    unsigned int n_batches;

    /** [batch][a][cell] */
    std::vector<unsigned int> nodes;

    /** For each node where the values of its cells are: compressed rows of
     * indices of [batch][a][0][cell]. */
    std::vector<unsigned int> node_start;
    std::vector<unsigned int> node_entries;
  };
} // namespace ACF

#endif
