// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_output_test_h
#define acf_tests_output_test_h

#include <acf/mechanics/multibody_system.h>

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

/** Bodies whose output is tested. */
namespace OutputTest
{
  using namespace ACF;
  namespace fs = std::filesystem;
  using Field  = std::function<Vector3(const Vector3 &)>;

  /** An empty directory that goes away with the object. */
  class Directory
  {
  public:
    explicit Directory(const std::string &name)
      : path(fs::current_path() / ("output_test_" + name))
    {
      fs::remove_all(path);
      fs::create_directory(path);
    }

    ~Directory()
    {
      fs::remove_all(path);
    }

    std::set<std::string>
    files() const
    {
      std::set<std::string> names;
      for (const auto &entry : fs::directory_iterator(path))
        names.insert(entry.path().filename());
      return names;
    }

    const fs::path path;
  };

  inline Vector3
  vector(const double x, const double y, const double z)
  {
    Vector3 result;
    result[0] = x;
    result[1] = y;
    result[2] = z;
    return result;
  }

  // A box from (-1, -0.5, -0.25) to (2, 0.5, 0.75), placed far away and turned
  // by an angle beyond 90 degrees.
  inline BodyParameters
  box(const std::string &element)
  {
    BodyParameters body;
    body.name                    = element + " box";
    body.mesh.mesh               = "box";
    body.mesh.element            = element;
    body.mesh.box_from           = {-1, -0.5, -0.25};
    body.mesh.box_to             = {2, 0.5, 0.75};
    body.mesh.cells              = {3, 2, 2};
    body.material.youngs_modulus = 2e11;
    body.material.poissons_ratio = 0;
    body.material.density        = 7800;
    body.position                = Point<dim>(10, -20, 30);
    body.rotation                = vector(1.2, -0.7, 1.9);
    body.velocity                = vector(3, 2, 1);
    body.angular_velocity        = vector(-1, 4, 2);
    return body;
  }

  inline BodyParameters
  cylinder(const std::string &element)
  {
    BodyParameters body       = box(element);
    body.name                 = element + " cylinder";
    body.mesh                 = MeshParameters();
    body.mesh.mesh            = "cylinder";
    body.mesh.element         = element;
    body.mesh.cylinder_from   = {0, 0, 0};
    body.mesh.cylinder_to     = {1, 2, 2};
    body.mesh.cylinder_radius = 0.5;
    body.mesh.cells           = {5, 3};
    return body;
  }

  inline std::vector<BodyParameters>
  all_shapes()
  {
    return {box("hexahedron"),
            box("tetrahedron"),
            cylinder("hexahedron"),
            cylinder("tetrahedron")};
  }

  inline MultibodySystem
  make_system(const std::vector<BodyParameters> &bodies)
  {
    return MultibodySystem(bodies, {}, LoadParameters(), fs::current_path());
  }

  inline Vector3
  node(const NodalVector &values, const unsigned int a)
  {
    return vector(values[dim * a], values[dim * a + 1], values[dim * a + 2]);
  }

  /** Nodal values f(x_a). */
  inline NodalVector
  nodal_values(const NodalVector &positions, const Field &f)
  {
    NodalVector result(positions.size());
    for (unsigned int a = 0; a < positions.size() / dim; ++a)
      {
        const Vector3 value = f(node(positions, a));
        for (unsigned int i = 0; i < dim; ++i)
          result[dim * a + i] = value[i];
      }
    return result;
  }
} // namespace OutputTest

#endif
