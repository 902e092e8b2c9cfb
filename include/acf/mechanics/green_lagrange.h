// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_green_lagrange_h
#define acf_mechanics_green_lagrange_h

#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/node_rotations.h>

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/thread_local_storage.h>
#include <deal.II/base/vectorization.h>

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
   * exactly, 27 per hexahedron. Several cells at once fill the lanes of a
   * vector register; threads share the cells. Results do not depend on the
   * number of threads.
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

  private:
    using Lanes     = VectorizedArray<double>;
    using Matrix    = Tensor<2, dim, Lanes>;
    using Symmetric = SymmetricTensor<2, dim, Lanes>;
    using Values    = AlignedVector<Tensor<1, dim, Lanes>>;

    /** Positions or displacements at the nodes of a batch of cells. */
    void
    gather(const NodalVector &x,
           const Vector3 &origin,
           const unsigned int batch,
           Values &values) const;

    /** $\sum_a x_a \otimes \nabla\phi_a$ at a quadrature point. */
    Matrix
    gradient(const Values &values,
             const unsigned int batch,
             const unsigned int q) const;

    /** Adds $P\, \nabla\phi_a$ dV of a quadrature point to the cells' nodes. */
    void
    add_divergence(const Matrix &P,
                   const unsigned int batch,
                   const unsigned int q,
                   Tensor<1, dim, Lanes> *result) const;

    /** $\lambda\, \mathrm{tr}(E)\, I + 2 \mu E$ */
    Symmetric
    stress(const Symmetric &E) const;

    /** Adds the values of all cells at the nodes. */
    void
    scatter(const Values &cell_values, NodalVector &result) const;

    double lambda;
    double mu;
    unsigned int n_nodes;
    unsigned int n_cells;
    unsigned int n_batches;
    unsigned int n_shape_functions;
    unsigned int n_points;

    /** Of the shape functions on the unit cell, [q][a]. */
    std::vector<Vector3> unit_gradients;

    /** Inverse Jacobians and dV, [batch][q]. */
    AlignedVector<Matrix> inverse_jacobians;
    AlignedVector<Lanes> weights;

    /** [batch][a][lane]; lanes beyond the last cell repeat it without weight.
     */
    std::vector<unsigned int> nodes;

    /** For each node where the values of its cells are: compressed rows of
     * (batch * n_shape_functions + a) * n_lanes + lane. */
    std::vector<unsigned int> node_start;
    std::vector<unsigned int> node_entries;

    mutable Threads::ThreadLocalStorage<Values> scratch;
  };
} // namespace ACF

#endif
