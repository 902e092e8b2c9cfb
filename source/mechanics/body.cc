// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/input_problems.h>
#include <acf/mechanics/body.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>

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
    prm.declare_entry(
      "Strain",
      "reduced",
      Patterns::Selection("reduced|Green-Lagrange"),
      "Measure of strain: the small strain in the frame of the body, or "
      "that of Green and Lagrange, which has geometric stiffening and holds "
      "for large deflections, at the price of a loop over the elements. "
      "Units: none.");
    prm.add_action("Strain", [this](const std::string &value) {
      strain_measure = (value == "reduced" ? StrainMeasure::reduced
                                           : StrainMeasure::green_lagrange);
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
    prm.add_parameter("Displacement field",
                      displacement_field,
                      "Displacement at the start in the axes of the mesh, "
                      "three expressions of its coordinates x, y, z separated "
                      "by ';'; zero if nothing is given. Units: m.");
    prm.add_parameter("Velocity field",
                      velocity_field,
                      "Velocity at the start in the axes of the mesh, added to "
                      "the rigid motion: three expressions of the mesh's "
                      "coordinates x, y, z separated by ';'; zero if nothing "
                      "is given. Units: m/s.");
    prm.add_parameter("Mass damping",
                      mass_damping,
                      "Rayleigh damping of the deformation proportional to the "
                      "mass, in the rotating frame: rigid motions are not "
                      "damped. Units: 1/s.",
                      Patterns::Double(0));
    prm.add_parameter("Stiffness damping",
                      stiffness_damping,
                      "Rayleigh damping of the deformation proportional to the "
                      "stiffness, in the rotating frame. Units: s.",
                      Patterns::Double(0));
  }



  void
  BodyParameters::check() const
  {
    InputProblems problems;
    problems.attempt([&]() { mesh.check(section()); });
    const auto require_positive = [&](const std::string &entry,
                                      const double value) {
      if (!(value > 0))
        problems.add(InputError(section(),
                                entry,
                                value == 0 ? "nothing or zero"
                                           : "'" + format_number(value) + "'",
                                "a positive number"));
    };
    require_positive("Young's modulus", material.youngs_modulus);
    require_positive("Density", material.density);
    if (!(material.poissons_ratio > -1 && material.poissons_ratio < 0.5))
      problems.add(
        InputError(section(),
                   "Poisson's ratio",
                   "'" + format_number(material.poissons_ratio) + "'",
                   "a number larger than -1 and smaller than 0.5"));
    problems.attempt([&]() {
      VectorField(displacement_field, section(), "Displacement field");
    });
    problems.attempt(
      [&]() { VectorField(velocity_field, section(), "Velocity field"); });
    problems.throw_all();
  }



  ReferenceBody::ReferenceBody(const BodyParameters &parameters,
                               const std::filesystem::path &directory)
    : ReferenceBody(parameters,
                    make_mesh(parameters.mesh, parameters.section(), directory))
  {}



  ReferenceBody::ReferenceBody(const BodyParameters &parameters,
                               std::unique_ptr<const BodyMesh> body_mesh)
    : mesh(parameters.mesh)
    , material(parameters.material)
    , finite_elements(std::move(body_mesh))
    , constant_operators(
        assemble_body_operators(finite_elements, parameters.material))
  {
    // so that areas, volumes and their products are numbers
    const double length = constant_operators.length;
    if (!(length > 1e-30 && length < 1e30))
      throw InputError(parameters.section(),
                       "Mesh",
                       "'" + mesh.mesh + "', a body with a length of " +
                         format_number(length) + " m",
                       "bodies between 1e-30 and 1e30 m");
    const double body_mass = constant_operators.mass;
    if (!std::isnormal(body_mass))
      throw InputError(parameters.section(),
                       "Density",
                       "a body with a mass of " + format_number(body_mass) +
                         " kg",
                       "a density and a mesh that make a positive mass");
  }



  bool
  ReferenceBody::fits(const BodyParameters &parameters) const
  {
    return parameters.mesh == mesh && parameters.material == material;
  }



  const GreenLagrangeOperator &
  ReferenceBody::green_lagrange() const
  {
    if (!green_lagrange_operator)
      green_lagrange_operator =
        std::make_unique<const GreenLagrangeOperator>(finite_elements,
                                                      material);
    return *green_lagrange_operator;
  }



  unsigned int
  ReferenceBody::add_functional(const NodalFunctional &functional)
  {
    const auto it = std::find_if(marker_functionals.begin(),
                                 marker_functionals.end(),
                                 [&](const NodalFunctional &other) {
                                   return other.is_close(functional);
                                 });
    if (it != marker_functionals.end())
      return it - marker_functionals.begin();
    marker_functionals.push_back(functional);
    return marker_functionals.size() - 1;
  }



  ReferenceBody::SurfaceIntegrals &
  ReferenceBody::integrals(const Surface &surface) const
  {
    const auto it = surface_integrals.find(surface);
    if (it != surface_integrals.end())
      return it->second;
    SurfaceIntegrals &result = surface_integrals[surface];
    result.geometry          = surface_geometry(finite_elements, surface);
    return result;
  }



  const SurfaceGeometry &
  ReferenceBody::geometry(const Surface &surface) const
  {
    return integrals(surface).geometry;
  }



  const NodalFunctional &
  ReferenceBody::mean(const Surface &surface) const
  {
    auto &mean = integrals(surface).mean;
    if (!mean)
      mean = surface_mean(finite_elements, surface);
    return *mean;
  }



  const NodalFunctional &
  ReferenceBody::director(const Surface &surface,
                          const Vector3 &direction) const
  {
    auto &directors = integrals(surface).directors;
    for (const auto &[known, functional] : directors)
      if ((known - direction).norm() < 1e-14)
        return functional;
    directors.emplace_back(
      direction, surface_director(finite_elements, surface, direction));
    return directors.back().second;
  }



  Body::Body(const BodyParameters &parameters,
             const std::shared_ptr<ReferenceBody> &reference)
    : parameters(parameters)
    , reference_body(reference)
    , initial_rotation(rotation_matrix(parameters.rotation))
    , displacement(parameters.displacement_field,
                   parameters.section(),
                   "Displacement field")
    , velocity(parameters.velocity_field,
               parameters.section(),
               "Velocity field")
  {}



  NodalVector
  Body::placement() const
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
  Body::nodal_field(const VectorField &field) const
  {
    const NodalVector &X = operators().reference_positions;
    NodalVector result(X.size());
    for (unsigned int a = 0; a < operators().n_nodes; ++a)
      {
        Vector3 position;
        for (unsigned int i = 0; i < dim; ++i)
          position[i] = X[dim * a + i];
        const Vector3 value = initial_rotation * field(position);
        for (unsigned int i = 0; i < dim; ++i)
          result[dim * a + i] = value[i];
      }
    return result;
  }



  NodalVector
  Body::initial_positions() const
  {
    NodalVector x = placement();
    if (!displacement.is_zero())
      x += nodal_field(displacement);
    return x;
  }



  NodalVector
  Body::initial_velocities() const
  {
    const NodalVector x = initial_positions();
    const Vector3 centre =
      whole_centre ? *whole_centre : mass_mean(operators(), x);
    NodalVector v(x.size());
    for (unsigned int a = 0; a < operators().n_nodes; ++a)
      {
        Vector3 arm;
        for (unsigned int i = 0; i < dim; ++i)
          arm[i] = x[dim * a + i] - centre[i];
        const Vector3 rigid =
          parameters.velocity +
          cross_product_3d(parameters.angular_velocity, arm);
        for (unsigned int i = 0; i < dim; ++i)
          v[dim * a + i] = rigid[i];
      }
    if (!velocity.is_zero())
      v += nodal_field(velocity);
    return v;
  }
} // namespace ACF
