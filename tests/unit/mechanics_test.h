// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_mechanics_test_h
#define acf_tests_mechanics_test_h

#include <acf/mechanics/body.h>
#include <acf/mechanics/mesh_generation.h>
#include <acf/mechanics/rotation.h>

#include <deal.II/base/multithread_info.h>

#include <Eigen/Dense>

#include <iostream>
#include <random>

#include <unit/mesh_test.h>

namespace ACF::Testing
{
  /** Print a measured figure, so that it can be quoted. */
  template <typename Value>
  void
  report(const std::string &label, const Value &value)
  {
    std::cout << "[ measured ] " << label << ": " << value << std::endl;
  }

  /** Restores the number of threads. */
  struct ThreadLimit
  {
    ThreadLimit()
      : n_threads(MultithreadInfo::n_threads())
    {}

    ~ThreadLimit()
    {
      MultithreadInfo::set_thread_limit(n_threads);
    }

    const unsigned int n_threads;
  };

  /** Random numbers that are the same in every run. */
  class Random
  {
  public:
    double
    number(const double size)
    {
      return std::uniform_real_distribution<double>(-size, size)(generator);
    }

    Vector3
    vector(const double size)
    {
      const double x = number(size), y = number(size), z = number(size);
      return Vector3({x, y, z});
    }

    Matrix3
    matrix(const double size)
    {
      Matrix3 result;
      for (unsigned int i = 0; i < dim; ++i)
        result[i] = vector(size);
      return result;
    }

    /** Any angle up to a full turn. */
    Matrix3
    rotation()
    {
      Vector3 axis;
      do
        axis = vector(1);
      while (axis.norm() < 0.1);
      return rotation_matrix(number(numbers::PI) / axis.norm() * axis);
    }

    NodalVector
    nodal_vector(const unsigned int size, const double amplitude)
    {
      NodalVector result(size);
      for (double &value : result)
        value = number(amplitude);
      return result;
    }

  private:
    std::mt19937 generator{20260};
  };

  inline Matrix3
  identity_matrix()
  {
    return Matrix3(unit_symmetric_tensor<dim>());
  }

  inline Vector3
  node_value(const NodalVector &v, const unsigned int a)
  {
    return Vector3({v[dim * a], v[dim * a + 1], v[dim * a + 2]});
  }

  /** Replace the value of each node by a function of it. */
  template <typename Map>
  NodalVector
  transformed(const NodalVector &v, const Map &map)
  {
    NodalVector result(v.size());
    for (unsigned int a = 0; a < v.size() / dim; ++a)
      {
        const Vector3 value = map(node_value(v, a));
        for (unsigned int i = 0; i < dim; ++i)
          result[dim * a + i] = value[i];
      }
    return result;
  }

  /** Largest difference, relative to the largest entry of the reference. */
  inline double
  relative_difference(const NodalVector &v, const NodalVector &reference)
  {
    NodalVector difference(v);
    difference -= reference;
    return difference.linfty_norm() / reference.linfty_norm();
  }

  inline double
  relative_difference(const Eigen::MatrixXd &m,
                      const Eigen::MatrixXd &reference)
  {
    return (m - reference).cwiseAbs().maxCoeff() /
           reference.cwiseAbs().maxCoeff();
  }

  inline Eigen::MatrixXd
  to_dense(const BlockNodeMatrix &matrix)
  {
    const NodeGraph &graph = matrix.graph();
    const unsigned int n   = graph.n_nodes();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(dim * n, dim * n);
    for (unsigned int a = 0; a < n; ++a)
      for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1]; ++e)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            result(dim * a + i, dim * graph.column[e] + j) =
              matrix.block(a, graph.column[e])(i, j);
    return result;
  }

  inline Eigen::MatrixXd
  to_dense(const ScalarNodeMatrix &matrix)
  {
    const NodeGraph &graph = matrix.graph();
    const unsigned int n   = graph.n_nodes();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(dim * n, dim * n);
    for (unsigned int a = 0; a < n; ++a)
      for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1]; ++e)
        for (unsigned int i = 0; i < dim; ++i)
          result(dim * a + i, dim * graph.column[e] + i) =
            matrix.value(a, graph.column[e]);
    return result;
  }

  inline Eigen::Matrix3d
  to_eigen(const Matrix3 &matrix)
  {
    Eigen::Matrix3d result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result(i, j) = matrix[i][j];
    return result;
  }

  /** Something between rubber and steel, so that no unit is 1. */
  inline Material
  test_material()
  {
    Material material;
    material.youngs_modulus = 2.1e7;
    material.poissons_ratio = 0.3;
    material.density        = 1200;
    return material;
  }

  /** Moves every vertex by up to @p size, m; faces become non-planar. */
  inline MeshData
  distorted(MeshData data, const double size)
  {
    Random random;
    for (Point<dim> &vertex : data.vertices)
      vertex += random.vector(size);
    return data;
  }

  inline BodyDiscretization
  discretize(MeshData data)
  {
    return BodyDiscretization(
      std::make_unique<const BodyMesh>(std::move(data),
                                       MeshSource{"Bodies/b", "test"}));
  }

  /** A body of box or cylinder shape as a model file describes it. */
  inline BodyParameters
  body_parameters(const std::string &name, const std::string &mesh_entries)
  {
    BodyParameters parameters;
    parameters.name     = name;
    parameters.mesh     = parse_mesh(mesh_entries);
    parameters.material = test_material();
    parameters.check();
    return parameters;
  }
} // namespace ACF::Testing

#endif
