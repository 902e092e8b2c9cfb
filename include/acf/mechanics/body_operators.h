// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_body_operators_h
#define acf_mechanics_body_operators_h

#include <acf/base/types.h>
#include <acf/mechanics/mesh.h>
#include <acf/mechanics/node_matrix.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>

#include <memory>

namespace ACF
{
  /** Linear elastic, isotropic, homogeneous material. */
  struct Material
  {
    /** Young's modulus, Pa. */
    double youngs_modulus = 0;

    /** Poisson's ratio. */
    double poissons_ratio = 0;

    /** kg/m^3 */
    double density = 0;

    /** First Lame coefficient, Pa. */
    double
    lambda() const;

    /** Shear modulus, Pa. */
    double
    mu() const;

    bool
    operator==(const Material &other) const
    {
      return youngs_modulus == other.youngs_modulus &&
             poissons_ratio == other.poissons_ratio && density == other.density;
    }
  };



  /**
   * The finite element space of a body: quadratic Lagrange elements on
   * tetrahedra or hexahedra, three components per node. The unknowns are
   * numbered 3 a + i for node a and component i; nodes are numbered in the
   * reverse Cuthill-McKee order of the mesh.
   */
  class BodyDiscretization
  {
  public:
    explicit BodyDiscretization(std::unique_ptr<const BodyMesh> mesh);

    const BodyMesh &
    mesh() const
    {
      return *body_mesh;
    }

    const FESystem<dim> &
    finite_element() const
    {
      return element;
    }

    /** The scalar element of one component. */
    const FiniteElement<dim> &
    scalar_element() const
    {
      return element.base_element(0);
    }

    const DoFHandler<dim> &
    dof_handler() const
    {
      return handler;
    }

    unsigned int
    n_nodes() const
    {
      return handler.n_dofs() / dim;
    }

    /** Numbers of the nodes of a cell in the order of scalar_element(). */
    void
    get_nodes(const typename DoFHandler<dim>::active_cell_iterator &cell,
              std::vector<unsigned int> &nodes) const;

    /** Reference positions $X_a$ of the nodes, m. */
    const NodalVector &
    reference_positions() const
    {
      return positions;
    }

  private:
    void
    renumber_nodes();

    std::unique_ptr<const BodyMesh> body_mesh;
    FESystem<dim> element;
    DoFHandler<dim> handler;
    NodalVector positions;
  };



  /**
   * Everything of a body that is independent of time, in its reference frame.
   * This is all that the time integration knows of a body's discretisation:
   * n vector-valued coefficients $x_a$ whose shape functions $\phi_a$ represent
   * affine motions.
   */
  struct BodyOperators
  {
    /** Zero operators with the given couplings. */
    explicit BodyOperators(const std::shared_ptr<const NodeGraph> &graph);

    unsigned int n_nodes = 0;

    /** $m_{ab} = \int \rho \phi_a \phi_b\, dV$, kg. */
    ScalarNodeMatrix mass_matrix;

    /** Small-strain stiffness A, N/m. */
    BlockNodeMatrix stiffness_matrix;

    /** $X_a$, m. */
    NodalVector reference_positions;

    /** $g_a = \frac1V \int \nabla \phi_a\, dV$, 1/m. */
    NodalVector averaging_vectors;

    /** $\int \rho \phi_a\, dV$, kg: the load of a unit acceleration. */
    std::vector<double> nodal_masses;

    /** m^3 */
    double volume = 0;

    /** kg */
    double mass = 0;

    /** Centre of mass in the reference state, m. */
    Vector3 centre;

    /** Inertia tensor about the centre of mass in the reference state, kg m^2.
     */
    Matrix3 inertia;

    /** Diagonal of the bounding box of the nodes, m. */
    double length = 0;

    unsigned int
    n_unknowns() const
    {
      return dim * n_nodes;
    }

    std::size_t
    memory_consumption() const;
  };

  /**
   * Assembles the operators of a body by quadrature, once. See theory (1.1),
   * theory (1.2), theory (1.3), theory (1.4).
   */
  BodyOperators
  assemble_body_operators(const BodyDiscretization &body,
                          const Material &material);
} // namespace ACF

#endif
