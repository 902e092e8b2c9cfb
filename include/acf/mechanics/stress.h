// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_stress_h
#define acf_mechanics_stress_h

#include <acf/mechanics/body.h>

#include <deal.II/base/symmetric_tensor.h>

#include <optional>
#include <vector>

namespace ACF
{
  /** A stress (Pa) or a strain. */
  using Symmetric3 = SymmetricTensor<2, dim>;

  /**
   * $\sigma_v = \sqrt{\tfrac32 s : s}$ with the deviator s of a stress, Pa.
   * See theory (3.5).
   */
  double
  von_mises_stress(const Symmetric3 &stress);



  /** Stress and strain in one state, in the axes of the world. */
  struct StressAndStrain
  {
    /** Pa */
    Symmetric3 stress;
    Symmetric3 strain;
  };

  /**
   * Stress and strain of a body in a state, cell by cell. The stress is that of
   * Cauchy:
   * \f[ \sigma = R\,(\lambda\, \mathrm{tr}(\varepsilon) I +
   *                  2 \mu \varepsilon)\,R^T, \quad
   *     \varepsilon = \mathrm{Sym}(\nabla q) \f]
   * with the rotation R of the body and the co-rotated displacement q; with the
   * strain of Green and Lagrange E, and $F = I + \nabla q$,
   * \f[ \sigma = R\,(\det F)^{-1} F (\lambda\, \mathrm{tr}(E) I + 2 \mu E)
   *              F^T\,R^T. \f]
   * The strain is $R\,\varepsilon\,R^T$ or $R\,E\,R^T$: its components are
   * along the axes of the world for a body that turns with R. See theory (3.4),
   * theory (4.3).
   */
  class StressEvaluation
  {
  public:
    /**
     * @param body lives longer than this object
     * @param positions $x_a$, m
     * @param time of these positions for messages, s
     * @throws SimulationError if the mean deformation gradient has no rotation
     */
    StressEvaluation(const Body &body,
                     const NodalVector &positions,
                     const double time);

    /** From the gradient of q. */
    StressAndStrain
    at(const Matrix3 &gradient) const;

    /**
     * Of all nodes of the body, each the mean over the cells at the node, with
     * equal weights.
     * @param[out] largest if not null: of each cell, in the order of the mesh,
     * the largest von Mises stress at its nodes, without averaging with other
     * cells, Pa
     */
    std::vector<StressAndStrain>
    nodal_values(std::vector<double> *const largest = nullptr) const;

    /** Stress of all cells, in the order of the mesh: the mean over the volume
     * of the cell, Pa. */
    std::vector<Symmetric3>
    cell_means() const;

    /** q, m */
    const NodalVector &
    co_rotated_displacement() const
    {
      return q;
    }

    /** R */
    const Matrix3 &
    rotation() const
    {
      return body_rotation;
    }

  private:
    /** Calls visit(cell, nodes, integration weights, values) for all cells with
     * the values at the points of a quadrature formula. */
    template <typename Visit>
    void
    for_all_cells(const Quadrature<dim> &quadrature, const Visit &visit) const;

    const Body &body;
    Matrix3 body_rotation;
    NodalVector q;
  };



  /** Stress and strain at a material point; where cells meet, their mean. */
  class PointStress
  {
  public:
    /**
     * @param body lives longer than this object
     * @param X in the coordinates of the mesh, m
     * @throws SimulationError if the body does not contain the point
     */
    PointStress(const Body &body, const Point<dim> &X);

    StressAndStrain
    operator()(const StressEvaluation &evaluation) const;

  private:
    /** $\nabla \phi_a(X)$ of the nodes a of a cell. */
    struct CellGradient
    {
      std::vector<unsigned int> nodes;
      std::vector<Vector3> gradients;
    };

    std::vector<CellGradient> cells;
  };
} // namespace ACF

#endif
