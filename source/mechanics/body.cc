// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/body.h>
#include <acf/mechanics/mesh_import.h>
#include <acf/mechanics/reduced_strain.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>

namespace ACF
{
  void
  BodyParameters::add_parameters(ParameterHandler &prm)
  {
    mesh.add_parameters(prm);
    prm.add_parameter("Young's modulus",
                      material.youngs_modulus,
                      "Young's modulus of the material; required. Units: Pa.",
                      Patterns::Double(0));
    prm.add_parameter("Poisson's ratio",
                      material.poissons_ratio,
                      "Poisson's ratio of the material, larger than -1 and "
                      "smaller than 0.5. Units: none.",
                      Patterns::Double(-1, 0.5));
    prm.add_parameter("Density",
                      material.density,
                      "Density of the material; required. Units: kg/m^3.",
                      Patterns::Double(0));
    prm.declare_entry(
      "Rotation measure",
      "polar",
      Patterns::Selection("polar|three points"),
      "How the rotation of the body follows from its mean deformation "
      "gradient: by polar decomposition, or (cheaper, as in the paper) from "
      "three material points. Units: none.");
    prm.add_action("Rotation measure", [this](const std::string &value) {
      rotation_measure = (value == "polar" ? RotationMeasure::polar
                                           : RotationMeasure::three_points);
    });
    prm.add_parameter("Position",
                      position,
                      "Where the origin of the mesh is placed in the world. "
                      "Units: m.");
    prm.add_parameter("Rotation",
                      rotation,
                      "Rotation vector (axis times angle) that turns the mesh "
                      "about its origin before it is placed. Units: rad.");
    prm.add_parameter("Velocity",
                      velocity,
                      "Velocity of the centre of mass at the start. "
                      "Units: m/s.");
    prm.add_parameter("Angular velocity",
                      angular_velocity,
                      "Angular velocity of the body at the start, in world "
                      "axes. Units: rad/s.");
  }



  void
  BodyParameters::check() const
  {
    mesh.check(section());
    const auto require_positive = [&](const std::string &entry,
                                      const double value) {
      if (!(value > 0))
        throw InputError(section(),
                         entry,
                         value == 0 ? "nothing or zero"
                                    : "'" + format_number(value) + "'",
                         "a positive number");
    };
    require_positive("Young's modulus", material.youngs_modulus);
    require_positive("Density", material.density);
    if (!(material.poissons_ratio > -1 && material.poissons_ratio < 0.5))
      throw InputError(section(),
                       "Poisson's ratio",
                       "'" + format_number(material.poissons_ratio) + "'",
                       "a number larger than -1 and smaller than 0.5");
  }



  Body::Body(const BodyParameters &parameters,
             const std::filesystem::path &directory)
    : parameters(parameters)
    , finite_elements(std::make_shared<const BodyDiscretization>(
        make_mesh(parameters.mesh, parameters.section(), directory)))
    , constant_operators(std::make_shared<const BodyOperators>(
        assemble_body_operators(*finite_elements, parameters.material)))
    , initial_rotation(rotation_matrix(parameters.rotation))
  {}



  NodalVector
  Body::initial_positions() const
  {
    const NodalVector &X = operators().reference_positions;
    NodalVector x(X.size());
    for (unsigned int a = 0; a < operators().n_nodes; ++a)
      for (unsigned int i = 0; i < dim; ++i)
        {
          x[dim * a + i] = parameters.position[i];
          for (unsigned int j = 0; j < dim; ++j)
            x[dim * a + i] += initial_rotation[i][j] * X[dim * a + j];
        }
    return x;
  }



  NodalVector
  Body::initial_velocities() const
  {
    const NodalVector x  = initial_positions();
    const Vector3 centre = mass_mean(operators(), x);
    NodalVector v(x.size());
    for (unsigned int a = 0; a < operators().n_nodes; ++a)
      {
        Vector3 arm;
        for (unsigned int i = 0; i < dim; ++i)
          arm[i] = x[dim * a + i] - centre[i];
        const Vector3 velocity =
          parameters.velocity +
          cross_product_3d(parameters.angular_velocity, arm);
        for (unsigned int i = 0; i < dim; ++i)
          v[dim * a + i] = velocity[i];
      }
    return v;
  }



  unsigned int
  Body::add_joint_functional(const NodalFunctional &functional)
  {
    const auto it =
      std::find(functionals.begin(), functionals.end(), functional);
    if (it != functionals.end())
      return it - functionals.begin();
    functionals.push_back(functional);
    return functionals.size() - 1;
  }
} // namespace ACF
