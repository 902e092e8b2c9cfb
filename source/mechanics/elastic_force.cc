// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/elastic_force.h>

namespace ACF
{
  std::optional<double>
  elastic_force(const Body &body,
                const NodalVector &positions,
                NodalVector &force,
                NodalVector &scratch)
  {
    if (body.strain_measure() == StrainMeasure::green_lagrange)
      return body.reference().green_lagrange().force(positions, force);
    return reduced_strain_force(
      body.operators(), body.rotation_measure(), positions, force, scratch);
  }



  std::optional<double>
  elastic_energy(const Body &body, const NodalVector &positions)
  {
    if (body.strain_measure() == StrainMeasure::reduced)
      return reduced_strain_energy(body.operators(),
                                   body.rotation_measure(),
                                   positions);
    NodalVector force(positions.size());
    return body.reference().green_lagrange().force(positions, force);
  }



  bool
  internal_force(const Body &body,
                 const NodalVector &positions,
                 const NodalVector &velocities,
                 NodalVector &force,
                 NodalVector &scratch)
  {
    if (!body.is_damped())
      return elastic_force(body, positions, force, scratch).has_value();
    const bool is_reduced = body.strain_measure() == StrainMeasure::reduced;
    if (!damped_reduced_strain_force(body.operators(),
                                     body.rotation_measure(),
                                     positions,
                                     velocities,
                                     body.mass_damping(),
                                     body.stiffness_damping(),
                                     force,
                                     scratch,
                                     is_reduced))
      return false;
    if (is_reduced)
      return true;
    if (!body.reference().green_lagrange().force(positions, scratch))
      return false;
    force += scratch;
    return true;
  }



  std::optional<ElasticTangent>
  ElasticTangent::at(const Body &body, const NodalVector &positions)
  {
    ElasticTangent tangent;
    tangent.body = &body;
    if (body.strain_measure() == StrainMeasure::green_lagrange)
      {
        const auto frame =
          body_rotation(mean_deformation_gradient(body.operators(), positions),
                        body.rotation_measure());
        if (!frame)
          return {};
        tangent.reduced.rotation = frame->rotation;
        tangent.reduced.columns.resize(positions.size(), 0);
        tangent.positions = positions;
        return tangent;
      }
    auto reduced = reduced_strain_tangent(body.operators(),
                                          body.rotation_measure(),
                                          positions);
    if (!reduced)
      return {};
    tangent.reduced = std::move(*reduced);
    return tangent;
  }



  void
  ElasticTangent::vmult(NodalVector &y, const NodalVector &x) const
  {
    if (positions.size() > 0)
      {
        body->reference().green_lagrange().apply_tangent(positions, x, y);
        return;
      }
    NodalVector local(x.size()), product(x.size());
    const NodeRotations frame(rotation());
    const unsigned int n = body->operators().n_nodes;
    frame.to_body(x, n, local);
    body->operators().stiffness_matrix.vmult(product, local);
    if (reduced.columns.cols() > 0)
      {
        const Eigen::Map<const Eigen::VectorXd> w(local.begin(), local.size());
        Eigen::Map<Eigen::VectorXd>(product.begin(), product.size()) +=
          reduced.columns *
          (reduced.coefficients * (reduced.columns.transpose() * w));
      }
    frame.to_world(product, n, y);
  }



  std::unique_ptr<const BlockNodeMatrix>
  ElasticTangent::matrix(const NodeRotations &frames) const
  {
    if (positions.size() == 0)
      return {};
    auto matrix =
      std::make_unique<BlockNodeMatrix>(body->operators().stiffness_matrix);
    *matrix = 0.;
    body->reference().green_lagrange().add_tangent(positions, frames, *matrix);
    return matrix;
  }
} // namespace ACF
