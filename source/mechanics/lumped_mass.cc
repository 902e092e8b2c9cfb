// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_problems.h>
#include <acf/mechanics/lumped_mass.h>

#include <deal.II/base/parameter_handler.h>

#include <cmath>

namespace ACF
{
  void
  LumpedMassParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "The surface that carries the mass, 'BODY: SURFACE'; "
                      "required. Units: none.");
    prm.add_parameter("Mass",
                      mass,
                      "Mass, which moves with the mean position of the "
                      "surface. Units: kg.",
                      Patterns::Double(0));
    prm.add_parameter("Inertia",
                      inertia,
                      "Inertia tensor about the mean position, which turns "
                      "with the surface: xx, yy, zz, yz, zx, xy in world axes "
                      "at the start (diagonal entries are integrals of y^2 + "
                      "z^2, others of -y z). Units: kg m^2.",
                      Patterns::List(Patterns::Double(), 0, 2 * dim));
  }



  void
  LumpedMassParameters::check() const
  {
    InputProblems problems;
    if (!inertia.empty() && inertia.size() != 2 * dim)
      problems.add(InputError(section(),
                              "Inertia",
                              std::to_string(inertia.size()) + " numbers",
                              "six numbers: xx, yy, zz, yz, zx, xy"));
    if (mass == 0 && inertia.empty())
      problems.add(InputError(
        section(), "Mass", "nothing or zero", "a positive Mass or an Inertia"));
    problems.throw_all();
  }



  namespace
  {
    // E = tr(J)/2 I - J in world axes
    Eigen::Matrix3d
    euler_tensor(const LumpedMassParameters &parameters)
    {
      const auto &J = parameters.inertia;
      Eigen::Matrix3d inertia;
      inertia << J[0], J[5], J[4], J[5], J[1], J[3], J[4], J[3], J[2];
      const Eigen::Matrix3d E =
        0.5 * inertia.trace() * Eigen::Matrix3d::Identity() - inertia;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(E);
      if (!(solver.eigenvalues()(0) >= -1e-9 * std::abs(inertia.trace())))
        throw InputError(parameters.section(),
                         "Inertia",
                         "a tensor that no rigid body has",
                         "one whose principal values are positive, none of "
                         "them larger than the sum of the others");
      return E;
    }
  } // namespace



  LumpedMass
  make_lumped_mass(const LumpedMassParameters &parameters,
                   const std::vector<Body> &bodies)
  {
    LumpedMass lump;
    lump.name = parameters.name;
    lump.mass = parameters.mass;
    const JointSide side(parameters.on, bodies, parameters.section(), "On");
    if (side.is_ground())
      throw InputError(parameters.section(),
                       "On",
                       "the ground",
                       "a surface in the form 'BODY: SURFACE'");
    side.position(lump.markers);
    if (parameters.inertia.empty())
      {
        lump.mass_matrix = Eigen::MatrixXd::Constant(1, 1, parameters.mass);
        return lump;
      }

    const Eigen::Matrix3d E = euler_tensor(parameters);
    const auto principal    = side.principal_directions();
    const unsigned int n    = principal.size();
    Eigen::MatrixXd P(dim, n);
    for (unsigned int k = 0; k < n; ++k)
      {
        side.direction(lump.markers, principal[k].first);
        for (unsigned int i = 0; i < dim; ++i)
          P(i, k) = principal[k].first[i];
      }
    const Eigen::MatrixXd in_surface = P.transpose() * E * P;
    if ((P * in_surface * P.transpose() - E).norm() > 1e-6 * E.norm())
      throw InputError(parameters.section(),
                       "Inertia",
                       "mass at a distance from the plane surface '" +
                         parameters.on + "'",
                       "for a plane surface the inertia of a plate in its "
                       "plane (normal value equal to the sum of the two "
                       "others), or a surface that is not plane, such as a "
                       "pin's");
    lump.mass_matrix       = Eigen::MatrixXd::Zero(1 + n, 1 + n);
    lump.mass_matrix(0, 0) = parameters.mass;
    lump.mass_matrix.bottomRightCorner(n, n) = in_surface;
    return lump;
  }
} // namespace ACF
