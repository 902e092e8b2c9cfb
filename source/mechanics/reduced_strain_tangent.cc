// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/reduced_strain_tangent.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ACF
{
  namespace
  {
    // A vector of the body with one column per node.
    using NodeColumns      = Eigen::Map<Eigen::Matrix3Xd>;
    using ConstNodeColumns = Eigen::Map<const Eigen::Matrix3Xd>;



    NodeColumns
    node_columns(NodalVector &v)
    {
      return {v.begin(), dim, static_cast<Eigen::Index>(v.size() / dim)};
    }



    ConstNodeColumns
    node_columns(const NodalVector &v)
    {
      return {v.begin(), dim, static_cast<Eigen::Index>(v.size() / dim)};
    }



    Eigen::Matrix3d
    to_eigen(const Matrix3 &matrix)
    {
      Eigen::Matrix3d result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          result(i, j) = matrix[i][j];
      return result;
    }



    // Round-off of q in units of eps sqrt(n) max(|x|, l). Rigid bodies of
    // 10^5 nodes, up to 100 lengths away, have up to 9.
    constexpr double round_off_factor = 50;



    /** Whether q is no more than round-off of sums over the positions. */
    bool
    is_rigid(const BodyOperators &body,
             const NodalVector &positions,
             const NodalVector &q)
    {
      const double round_off = std::numeric_limits<double>::epsilon() *
                               std::sqrt(body.n_nodes) *
                               std::max(positions.linfty_norm(), body.length);
      return q.linfty_norm() <= round_off_factor * round_off;
    }



    /** U and B of a deformed body; f_hat is the force in the body axes. */
    void
    fill_rotation_terms(const BodyOperators &body,
                        const BodyRotation &frame,
                        const NodalVector &q,
                        const Eigen::Matrix3Xd &f_hat,
                        ReducedStrainTangent &tangent)
    {
      const ConstNodeColumns q_a = node_columns(q);
      const ConstNodeColumns g   = node_columns(body.averaging_vectors);
      const Eigen::Vector3d centre(body.centre[0],
                                   body.centre[1],
                                   body.centre[2]);
      const Eigen::Matrix3Xd y =
        q_a + (node_columns(body.reference_positions).colwise() - centre);

      Eigen::Matrix3d G = y * f_hat.transpose();
      G.diagonal().array() -= G.trace();

      tangent.columns.resize(body.n_unknowns(), 2 * dim);
      NodalVector turned(q.size()), product(q.size());
      for (unsigned int j = 0; j < dim; ++j)
        {
          const Eigen::Vector3d e = Eigen::Vector3d::Unit(j);
          node_columns(turned)    = -q_a.colwise().cross(e);
          body.stiffness_matrix.vmult(product, turned);

          const Eigen::Matrix3d spin = to_eigen(frame.spin_gradient[j]);
          const NodeColumns P        = node_columns(product);
          NodeColumns Phi(tangent.columns.col(j).data(), dim, body.n_nodes);
          NodeColumns T(tangent.columns.col(dim + j).data(), dim, body.n_nodes);
          Phi = spin * g;
          T   = P + f_hat.colwise().cross(e);
          for (unsigned int a = 0; a < body.n_nodes; ++a)
            G.col(j) +=
              Eigen::Vector3d(q_a.col(a)).cross(Eigen::Vector3d(P.col(a)));
        }

      const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
      tangent.coefficients           = Eigen::MatrixXd::Zero(2 * dim, 2 * dim);
      tangent.coefficients.topLeftCorner<3, 3>()    = (G + G.transpose()) / 2;
      tangent.coefficients.topRightCorner<3, 3>()   = -identity;
      tangent.coefficients.bottomLeftCorner<3, 3>() = -identity;
    }
  } // namespace



  std::optional<ReducedStrainTangent>
  reduced_strain_tangent(const BodyOperators &body,
                         const RotationMeasure measure,
                         const NodalVector &positions)
  {
    NodalVector force(positions.size()), q(positions.size());
    if (!reduced_strain_force(body, measure, positions, force, q))
      return {};
    const BodyRotation frame =
      *body_rotation(mean_deformation_gradient(body, positions), measure);
    co_rotated_displacement(body, positions, frame.rotation, q);

    ReducedStrainTangent tangent;
    tangent.rotation = frame.rotation;
    if (is_rigid(body, positions, q))
      {
        tangent.columns.resize(body.n_unknowns(), 0);
        return tangent;
      }

    const Eigen::Matrix3Xd f_hat =
      to_eigen(frame.rotation).transpose() * node_columns(force);
    fill_rotation_terms(body, frame, q, f_hat, tangent);
    return tangent;
  }
} // namespace ACF
