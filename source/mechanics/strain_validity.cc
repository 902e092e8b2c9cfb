// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/strain_validity.h>

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ACF
{
  namespace
  {
    using Strain = SymmetricTensor<2, dim>;

    // Strains below this are round-off of positions; they are not compared.
    constexpr double smallest_strain = 1e-10;



    // Angle of the polar rotation of I + H.
    double
    rotation_angle(const Matrix3 &H)
    {
      const std::optional<BodyRotation> polar =
        polar_rotation(H + Matrix3(unit_symmetric_tensor<dim>()));
      if (!polar)
        return numbers::PI;
      const Matrix3 twice_skew = polar->rotation - transpose(polar->rotation);
      return std::atan2(twice_skew.norm() / std::sqrt(2.),
                        trace(polar->rotation) - 1);
    }



    // Integrals over the body: of e : C : e of the strain and of its neglected
    // part, and of the product of both.
    struct Energies
    {
      double strain = 0, neglected = 0, mixed = 0;

      void
      add(const Material &material,
          const Strain &strain_at_point,
          const Strain &neglected_at_point,
          const double dV)
      {
        const auto product = [&](const Strain &a, const Strain &b) {
          return dV * (material.lambda() * trace(a) * trace(b) +
                       2 * material.mu() * (a * b));
        };
        strain += product(strain_at_point, strain_at_point);
        neglected += product(neglected_at_point, neglected_at_point);
        mixed += product(strain_at_point, neglected_at_point);
      }
    };



    // The figures of all integration points.
    void
    judge_strains(const Body &body,
                  const CellGradients &gradients,
                  const NodalVector &q,
                  StrainValidity &validity)
    {
      const bool is_reduced = body.strain_measure() == StrainMeasure::reduced;
      Energies energies;
      Matrix3 most_turned;
      double largest_skew = -1;
      std::vector<Matrix3> cell_gradients;
      for (std::size_t cell = 0; cell < gradients.n_cells(); ++cell)
        {
          gradients.evaluate(q, cell, cell_gradients);
          for (unsigned int point = 0; point < gradients.n_points(); ++point)
            {
              const Matrix3 &H = cell_gradients[point];
              Strain strain    = symmetrize(H);
              Strain neglected = 0.5 * symmetrize(transpose(H) * H);
              if (!is_reduced)
                {
                  strain += neglected;
                  neglected = 0;
                }
              energies.add(body.material(),
                           strain,
                           neglected,
                           gradients.volume(cell, point));
              if (strain.norm() > validity.strain)
                for (const double principal : eigenvalues(strain))
                  validity.strain =
                    std::max(validity.strain, std::abs(principal));
              const double skew = (H - transpose(H)).norm_square();
              if (skew > largest_skew)
                {
                  largest_skew = skew;
                  most_turned  = H;
                }
            }
        }

      validity.rotation  = rotation_angle(most_turned);
      const double floor = smallest_strain * smallest_strain *
                           body.material().youngs_modulus *
                           body.operators().volume;
      const double scale        = std::max(energies.strain, floor);
      validity.neglected_strain = std::sqrt(energies.neglected / scale);
      validity.neglected_energy = 2 * std::abs(energies.mixed) / scale;
    }



    // Lengths relative to the thickness of a body along them.
    class Thickness
    {
    public:
      explicit Thickness(const BodyOperators &body)
      {
        // of a homogeneous body J = (tr(inertia) I / 2 - inertia) / mass
        const Matrix3 J =
          (0.5 * trace(body.inertia) * Matrix3(unit_symmetric_tensor<dim>()) -
           body.inertia) /
          body.mass;
        inverse = invert(12 * J);
      }

      double
      squared(const Vector3 &length) const
      {
        return length * (inverse * length);
      }

    private:
      Matrix3 inverse;
    };



    Vector3
    value(const NodalVector &q, const unsigned int node)
    {
      return Vector3({q[dim * node], q[dim * node + 1], q[dim * node + 2]});
    }



    double
    largest_deflection(const BodyOperators &body, const NodalVector &q)
    {
      const Thickness thickness(body);
      double largest = 0;
      for (unsigned int a = 0; a < body.n_nodes; ++a)
        largest = std::max(largest, thickness.squared(value(q, a)));
      return std::sqrt(largest);
    }



    // Ends and middle of an edge of a cell, by shape functions.
    using Edge = std::array<unsigned int, 3>;

    std::vector<Edge>
    cell_edges(const FiniteElement<dim> &element)
    {
      const auto &points            = element.get_unit_support_points();
      const ReferenceCell reference = element.reference_cell();
      const auto node_at            = [&points](const Point<dim> &x) {
        return std::find_if(points.begin(),
                            points.end(),
                            [&x](const Point<dim> &y) {
                              return x.distance(y) < 1e-8;
                            }) -
               points.begin();
      };
      std::vector<Edge> edges;
      for (unsigned int a = 0; a < reference.n_vertices(); ++a)
        for (unsigned int b = 0; b < a; ++b)
          {
            const Point<dim> from = reference.template vertex<dim>(a),
                             to   = reference.template vertex<dim>(b);
            // any two vertices of a tetrahedron, but no diagonals of a cube
            if (!reference.is_simplex() && from.distance(to) > 1.1)
              continue;
            Edge edge;
            edge[0] = node_at(from);
            edge[1] = node_at(to);
            edge[2] = node_at(from + 0.5 * (to - from));
            edges.push_back(edge);
          }
      return edges;
    }



    double
    largest_sagitta(const Body &body,
                    const CellGradients &gradients,
                    const NodalVector &q)
    {
      const std::vector<Edge> edges =
        cell_edges(body.discretization().scalar_element());
      const Thickness thickness(body.operators());
      double largest = 0;
      for (std::size_t cell = 0; cell < gradients.n_cells(); ++cell)
        {
          const unsigned int *const nodes = gradients.nodes(cell);
          for (const Edge &edge : edges)
            largest =
              std::max(largest,
                       thickness.squared(value(q, nodes[edge[2]]) -
                                         0.5 * (value(q, nodes[edge[0]]) +
                                                value(q, nodes[edge[1]]))));
        }
      return std::sqrt(largest);
    }
  } // namespace



  std::optional<StrainValidity>
  strain_validity(const Body &body,
                  const CellGradients &gradients,
                  const NodalVector &positions)
  {
    const std::optional<BodyRotation> frame =
      body_rotation(mean_deformation_gradient(body.operators(), positions),
                    body.rotation_measure());
    if (!frame)
      return {};

    NodalVector q(positions.size());
    co_rotated_displacement(body.operators(), positions, frame->rotation, q);
    StrainValidity validity;
    judge_strains(body, gradients, q, validity);
    validity.deflection   = largest_deflection(body.operators(), q);
    validity.cell_bending = largest_sagitta(body, gradients, q);
    return validity;
  }
} // namespace ACF
