// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_problems.h>
#include <acf/mechanics/loads.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>

namespace ACF
{
  void
  LoadParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Gravity",
                      gravity,
                      "Acceleration of gravity on all bodies. Units: m/s^2.");
    prm.add_parameter("Gravity factor",
                      gravity_factor,
                      "Factor of Gravity, a function of the time t. "
                      "Units: none.");
  }



  void
  SurfaceLoadParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Type",
      type,
      "'force': resultant, spread evenly; 'torque': moment, spread like the "
      "displacement of a rotation; 'traction': force per area of the "
      "reference state; 'pressure': against the outward normal. "
      "Units: none.",
      Patterns::Selection("force|torque|traction|pressure"));
    prm.add_parameter("On",
                      on,
                      "The loaded surface, 'BODY: SURFACE'; required. "
                      "Units: none.");
    prm.add_parameter("Value",
                      value,
                      "The load, functions of the time t: one for a pressure, "
                      "else three in world axes separated by ';'; required. "
                      "Units: N, N m, N/m^2 or Pa.");
    prm.declare_entry(
      "Direction",
      "fixed",
      Patterns::Selection("fixed|follows the body"),
      "Whether the load keeps its direction in the world or turns with the "
      "body from its direction at the start; a pressure always follows the "
      "body. Units: none.");
    prm.add_action("Direction", [this](const std::string &text) {
      follows = (text != "fixed");
    });
  }



  void
  SurfaceLoadParameters::check() const
  {
    InputProblems problems;
    if (type == "pressure" && follows)
      problems.add(InputError(section(),
                              "Direction",
                              "'follows the body'",
                              "nothing for a pressure, which always does"));
    problems.attempt([&]() {
      if (type == "pressure")
        TimeFunction(value, section(), "Value");
      else
        parse_time_vector(value, section(), "Value");
    });
    problems.throw_all();
  }



  SurfaceLoad::SurfaceLoad(const SurfaceLoadParameters &parameters,
                           const std::vector<Body> &bodies,
                           const BodySurface &place)
    : body_index(place.body)
    , follows(parameters.follows)
    , is_isotropic(parameters.type == "force" || parameters.type == "traction")
    , is_pressure(parameters.type == "pressure")
  {
    const Body &body                = bodies[body_index];
    placement_rotation              = body.placement_rotation();
    const BodyDiscretization &space = body.discretization();
    const Surface &surface          = place.surface;
    const SurfaceGeometry geometry  = surface_geometry(space, surface);

    std::map<unsigned int, Matrix3> pattern;
    if (is_isotropic)
      {
        const NodalFunctional mean = surface_mean(space, surface);
        const double area = parameters.type == "force" ? 1. : geometry.area;
        for (unsigned int k = 0; k < mean.nodes.size(); ++k)
          for (unsigned int i = 0; i < dim; ++i)
            pattern[mean.nodes[k]][i][i] = area * mean.weights[k];
      }
    else if (is_pressure)
      for (const auto &[node, normal] : surface_normals(space, surface))
        for (unsigned int i = 0; i < dim; ++i)
          pattern[node][i][0] = -normal[i];
    else
      {
        Matrix3 rigid = -1. * geometry.second_moment;
        for (unsigned int i = 0; i < dim; ++i)
          rigid[i][i] += trace(geometry.second_moment);
        const Matrix3 theta = invert(rigid);
        for (unsigned int j = 0; j < dim; ++j)
          {
            Vector3 axis;
            axis[j]                      = 1;
            const NodalFunctional moment = surface_moment(space, surface, axis);
            for (unsigned int k = 0; k < moment.nodes.size(); ++k)
              for (unsigned int c = 0; c < dim; ++c)
                {
                  Vector3 unit;
                  unit[c]                = 1;
                  const Vector3 traction = cross_product_3d(theta * unit, axis);
                  for (unsigned int i = 0; i < dim; ++i)
                    pattern[moment.nodes[k]][i][c] +=
                      moment.weights[k] * traction[i];
                }
          }
      }
    for (const auto &[node, matrix] : pattern)
      {
        nodes.push_back(node);
        patterns.push_back(matrix);
      }
    if (is_pressure)
      value = {TimeFunction(parameters.value, parameters.section(), "Value"),
               TimeFunction(),
               TimeFunction()};
    else
      value =
        parse_time_vector(parameters.value, parameters.section(), "Value");
  }



  void
  SurfaceLoad::add_force(const double t,
                         const Matrix3 &rotation,
                         NodalVector &force,
                         const double factor) const
  {
    Vector3 m = factor * evaluate(value, t);
    if (!is_pressure && follows)
      m = transpose(placement_rotation) * m;
    else if (!is_pressure && !is_isotropic)
      m = transpose(rotation) * m;
    for (unsigned int k = 0; k < nodes.size(); ++k)
      {
        Vector3 f = patterns[k] * m;
        if (depends_on_rotation())
          f = rotation * f;
        for (unsigned int i = 0; i < dim; ++i)
          force[dim * nodes[k] + i] += f[i];
      }
  }



  std::vector<SurfaceLoad>
  make_surface_loads(const SurfaceLoadParameters &parameters,
                     const std::vector<Body> &bodies)
  {
    const bool is_density =
      (parameters.type == "traction" || parameters.type == "pressure");
    std::vector<BodySurface> places;
    if (is_density)
      places = find_surfaces(parameters.on, bodies, parameters.section(), "On");
    else
      places = {
        find_surface(parameters.on, bodies, parameters.section(), "On")};
    std::vector<SurfaceLoad> loads;
    for (const BodySurface &place : places)
      loads.emplace_back(parameters, bodies, place);
    return loads;
  }
} // namespace ACF
