// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/mechanics/joint_side.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ACF
{
  SurfaceName
  parse_surface_name(const std::string &text,
                     const std::string &section,
                     const std::string &entry)
  {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
      throw InputError(section,
                       entry,
                       text.empty() ? "nothing" : "'" + text + "'",
                       "a surface in the form 'BODY: SURFACE'");
    return {Utilities::trim(text.substr(0, colon)),
            Utilities::trim(text.substr(colon + 1))};
  }



  std::vector<unsigned int>
  find_bodies(const std::vector<Body> &bodies,
              const std::string &name,
              const std::string &section,
              const std::string &entry)
  {
    std::vector<unsigned int> found;
    std::string names, whole;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        if (bodies[b].name() == name || bodies[b].whole() == name)
          found.push_back(b);
        if (bodies[b].whole() != whole && !bodies[b].whole().empty())
          names += (b > 0 ? ", " : "") + bodies[b].whole();
        whole = bodies[b].whole();
        names += (names.empty() ? "" : ", ") + bodies[b].name();
      }
    if (found.empty() || name.empty())
      throw InputError(section,
                       entry,
                       "the body '" + name + "', which does not exist",
                       names);
    return found;
  }



  std::vector<BodySurface>
  find_surfaces(const std::string &text,
                const std::vector<Body> &bodies,
                const std::string &section,
                const std::string &entry)
  {
    const SurfaceName name  = parse_surface_name(text, section, entry);
    const auto candidates   = find_bodies(bodies, name.body, section, entry);
    const auto mesh_of_body = [&](const unsigned int b) -> const BodyMesh & {
      return bodies[b].discretization().mesh();
    };
    if (candidates.size() == 1)
      return {
        {candidates[0],
         mesh_of_body(candidates[0]).surface(name.surface, section, entry)}};

    std::vector<BodySurface> found;
    std::set<std::string> names;
    for (const unsigned int b : candidates)
      for (const auto &[surface, ids] : mesh_of_body(b).surfaces())
        {
          names.insert(surface);
          if (surface == name.surface)
            found.push_back({b, ids});
        }
    std::string known;
    for (const std::string &surface : names)
      known += (known.empty() ? "'" : ", '") + surface + "'";
    if (found.empty())
      throw InputError(section,
                       entry,
                       "surface '" + name.surface +
                         "', which the mesh does not have",
                       known);
    return found;
  }



  BodySurface
  find_surface(const std::string &text,
               const std::vector<Body> &bodies,
               const std::string &section,
               const std::string &entry)
  {
    const auto found = find_surfaces(text, bodies, section, entry);
    if (found.size() == 1)
      return found[0];
    std::string parts;
    for (const BodySurface &part : found)
      parts += (parts.empty() ? "'" : ", '") + bodies[part.body].name() + "'";
    const SurfaceName name = parse_surface_name(text, section, entry);
    throw InputError(section,
                     entry,
                     "the surface '" + name.surface + "', which the parts " +
                       parts + " share",
                     "a surface of one part, such as '" +
                       bodies[found[0].body].name() + ": " + name.surface +
                       "'");
  }



  unsigned int
  MarkerSet::add(const Marker &marker)
  {
    const auto it =
      std::find_if(set.begin(), set.end(), [&](const Marker &other) {
        return other.body == marker.body && other.surface == marker.surface &&
               other.functional.is_close(marker.functional);
      });
    if (it != set.end())
      return it - set.begin();
    set.push_back(marker);
    return set.size() - 1;
  }



  Eigen::VectorXd
  MarkerSet::values(const std::vector<NodalVector> &x) const
  {
    Eigen::VectorXd result(dim * set.size());
    for (unsigned int p = 0; p < set.size(); ++p)
      {
        const Vector3 s = set[p].functional(x[set[p].body]);
        for (unsigned int i = 0; i < dim; ++i)
          result(dim * p + i) = s[i];
      }
    return result;
  }



  Vector3
  SurfaceDirection::operator()(const Eigen::VectorXd &marker_values) const
  {
    Vector3 d = along(marker_values);
    if (normal != 0)
      d +=
        normal * cross_product_3d(first(marker_values), second(marker_values));
    return d;
  }



  void
  add_product(MarkerPolynomial &polynomial,
              const double c,
              const MarkerExpression &v,
              const SurfaceDirection &d)
  {
    polynomial.add(c, {v, d.along});
    if (d.normal != 0)
      polynomial.add(c * d.normal, {v, d.first, d.second});
  }



  void
  add_product(MarkerPolynomial &polynomial,
              const double c,
              const SurfaceDirection &d,
              const SurfaceDirection &e)
  {
    add_product(polynomial, c, d.along, e);
    if (d.normal != 0)
      {
        polynomial.add(c * d.normal, {e.along, d.first, d.second});
        if (e.normal != 0)
          polynomial.add(c * d.normal * e.normal,
                         {d.first, d.second, e.first, e.second});
      }
  }



  JointSide::JointSide(const std::string &text,
                       const std::vector<Body> &bodies,
                       const std::string &section,
                       const std::string &entry)
  {
    if (text == "ground")
      return;
    const BodySurface found = find_surface(text, bodies, section, entry);
    index                   = found.body;
    side_body               = &bodies[index];
    surface                 = found.surface;
    geometry                = side_body->reference().geometry(surface);
  }



  double
  JointSide::length() const
  {
    return is_ground() ? 0. : side_body->operators().length;
  }



  MarkerExpression
  JointSide::position(MarkerSet &markers) const
  {
    Assert(!is_ground(), ExcInternalError());
    const unsigned int p =
      markers.add({index, surface, side_body->reference().mean(surface), true});
    return {Vector3(), {{p, 1.}}};
  }



  Vector3
  JointSide::start_position() const
  {
    Assert(!is_ground(), ExcInternalError());
    return side_body->placement_position() +
           side_body->placement_rotation() * geometry.centroid;
  }



  MarkerExpression
  JointSide::director(MarkerSet &markers, const Vector3 &unit_vector) const
  {
    const Vector3 in_body =
      transpose(side_body->placement_rotation()) * unit_vector;
    const unsigned int p =
      markers.add({index,
                   surface,
                   side_body->reference().director(surface, in_body),
                   false});
    return {Vector3(), {{p, 1.}}};
  }



  Vector3
  JointSide::plane_normal() const
  {
    const auto principal = principal_directions();
    if (principal.size() == dim)
      return Vector3();
    return cross_product_3d(principal[0].first, principal[1].first);
  }



  SurfaceDirection
  JointSide::direction(MarkerSet &markers, const Vector3 &unit_vector) const
  {
    SurfaceDirection result;
    if (is_ground())
      {
        result.along.constant = unit_vector;
        return result;
      }
    if (resolves(unit_vector))
      {
        result.along = director(markers, unit_vector);
        return result;
      }

    // in-plane part and normal, both from two directors of the plane
    const Vector3 n        = plane_normal();
    const Vector3 in_plane = unit_vector - (unit_vector * n) * n;
    const Vector3 t        = in_plane.norm() > 1e-8 ? in_plane / in_plane.norm()
                                                    : principal_directions()[0].first;
    result.normal          = unit_vector * n;
    result.first           = director(markers, t);
    result.second          = director(markers, cross_product_3d(n, t));
    if (in_plane.norm() > 1e-8)
      result.along = in_plane.norm() * result.first;
    return result;
  }



  bool
  JointSide::resolves(const Vector3 &unit_vector) const
  {
    return is_ground() ||
           geometry.resolves(transpose(side_body->placement_rotation()) *
                             unit_vector);
  }



  double
  JointSide::extent(const Vector3 &unit_vector) const
  {
    return is_ground()
             ? 0.
             : geometry.extent(transpose(side_body->placement_rotation()) *
                               unit_vector);
  }



  std::vector<std::pair<Vector3, double>>
  JointSide::principal_directions() const
  {
    Assert(!is_ground(), ExcInternalError());
    Eigen::Matrix3d J;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        J(i, j) = geometry.second_moment[i][j];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(J);
    std::vector<std::pair<Vector3, double>> result;
    for (unsigned int k = dim; k-- > 0;)
      if (solver.eigenvalues()(k) > 1e-10 * J.trace())
        {
          Vector3 direction;
          for (unsigned int i = 0; i < dim; ++i)
            direction[i] = solver.eigenvectors()(i, k);
          result.emplace_back(side_body->placement_rotation() * direction,
                              std::sqrt(solver.eigenvalues()(k)));
        }
    return result;
  }



  std::array<Vector3, 2>
  perpendicular(const Vector3 &axis)
  {
    unsigned int smallest = 0;
    for (unsigned int i = 1; i < dim; ++i)
      if (std::abs(axis[i]) < std::abs(axis[smallest]))
        smallest = i;
    Vector3 t;
    t[smallest] = 1;
    t -= (t * axis) * axis;
    t /= t.norm();
    return {{t, cross_product_3d(axis, t)}};
  }
} // namespace ACF
