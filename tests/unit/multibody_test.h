// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_multibody_test_h
#define acf_tests_multibody_test_h

#include <acf/mechanics/multibody_system.h>

#include <unit/mechanics_test.h>

namespace ACF::Testing
{
  /** Mean of "x max": (1, 0, 1.5); of "z min": the origin. */
  inline const std::string box_mesh =
    "set Mesh = box\n set Box from = -1, -0.5, 0\n set Box to = 1, 0.5, 3\n"
    "set Cells = 2, 1, 2\n set Element = hexahedron\n";

  /** Mean of "start": the origin; of "side": (0, 0, 0.6). */
  inline const std::string cylinder_mesh =
    "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
    "set Cylinder to = 0, 0, 1.2\n set Cylinder radius = 0.5\n"
    "set Cells = 3, 1\n set Element = tetrahedron\n";

  inline Vector3
  unit(const Vector3 &v)
  {
    return v / v.norm();
  }

  inline Eigen::Vector3d
  to_eigen(const Vector3 &v)
  {
    return Eigen::Vector3d(v[0], v[1], v[2]);
  }

  inline double
  largest(const Eigen::MatrixXd &matrix)
  {
    return matrix.size() > 0 ? matrix.cwiseAbs().maxCoeff() : 0.;
  }

  /** A turned body of which a point X of the mesh is placed at x. */
  inline BodyParameters
  body_at(const std::string &name,
          const std::string &mesh,
          const Vector3 &rotation,
          const Vector3 &X,
          const Vector3 &x)
  {
    BodyParameters parameters = body_parameters(name, mesh);
    parameters.rotation       = rotation;
    parameters.position       = Point<dim>(x - rotation_matrix(rotation) * X);
    return parameters;
  }

  inline JointParameters
  joint_parameters(const std::string &type,
                   const std::string &between,
                   const std::string &directions = "",
                   const Vector3 &axis           = Vector3())
  {
    JointParameters joint;
    joint.name       = "joint";
    joint.type       = type;
    joint.between    = between;
    joint.directions = directions;
    joint.axis       = axis;
    joint.check();
    return joint;
  }

  /** x -> centre + translation + rotation (x - centre). */
  struct RigidMotion
  {
    Vector3 centre;
    Vector3 translation;
    Matrix3 rotation = identity_matrix();

    Vector3
    operator()(const Vector3 &x) const
    {
      return centre + translation + rotation * (x - centre);
    }

    RigidMotion
    inverse() const
    {
      return {centre,
              -(transpose(rotation) * translation),
              transpose(rotation)};
    }
  };

  inline RigidMotion
  random_motion(Random &random)
  {
    return {random.vector(1), random.vector(3), random.rotation()};
  }

  /** Turned, moved and deformed; each body differently. */
  inline void
  disturb(SystemVector &positions, Random &random)
  {
    for (NodalVector &x : positions)
      {
        const RigidMotion motion = random_motion(random);
        x                        = transformed(x, [&](const Vector3 &v) {
          return motion(v) + 0.1 * v[0] * v[1] * Vector3({1, -1, 2});
        });
      }
  }

  /** Resultant force and moment about a point. */
  struct Resultant
  {
    Vector3 force;
    Vector3 moment;

    void
    add(const NodalVector &positions,
        const NodalVector &forces,
        const Vector3 &point = Vector3())
    {
      for (unsigned int a = 0; a < forces.size() / dim; ++a)
        {
          force += node_value(forces, a);
          moment += cross_product_3d(node_value(positions, a) - point,
                                     node_value(forces, a));
        }
    }
  };

  /** Nodal forces of marker forces F on a body. */
  inline NodalVector
  nodal_force(const MultibodySystem &system,
              const unsigned int body,
              const Eigen::VectorXd &F)
  {
    NodalVector force(system.bodies()[body].operators().n_unknowns());
    system.add_marker_forces(body, F, force);
    return force;
  }

  inline Eigen::VectorXd
  random_vector(const unsigned int size, const double amplitude, Random &random)
  {
    Eigen::VectorXd result(size);
    for (double &value : result)
      value = random.number(amplitude);
    return result;
  }

  /** Derivative of a vector function, by central differences. */
  template <typename Function>
  Eigen::MatrixXd
  difference_quotients(const Function &function,
                       const Eigen::VectorXd &x,
                       const double h = 1e-5)
  {
    Eigen::MatrixXd result;
    for (unsigned int i = 0; i < x.size(); ++i)
      {
        Eigen::VectorXd step     = Eigen::VectorXd::Zero(x.size());
        step(i)                  = h;
        const Eigen::VectorXd dy = (function(x + step) - function(x - step));
        if (i == 0)
          result.resize(dy.size(), x.size());
        result.col(i) = dy / (2 * h);
      }
    return result;
  }

  inline Eigen::MatrixXd
  to_dense(const MarkerLinearization::Triplets &triplets,
           const unsigned int n_rows,
           const unsigned int n_columns)
  {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n_rows, n_columns);
    for (const auto &entry : triplets)
      result(entry.row(), entry.col()) += entry.value();
    return result;
  }
} // namespace ACF::Testing

#endif
