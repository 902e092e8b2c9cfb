// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_body_h
#define acf_mechanics_body_h

#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/functionals.h>
#include <acf/mechanics/rotation.h>

#include <filesystem>
#include <memory>
#include <string>

namespace ACF
{
  /** What a model file says of a body. */
  struct BodyParameters
  {
    std::string name;
    MeshParameters mesh;
    Material material;
    RotationMeasure rotation_measure = RotationMeasure::polar;

    /** Placement $x = \text{position} + R_0 X$; m and rad. */
    Point<dim> position;
    Vector3 rotation;

    /** Rigid motion at the start: $v + \omega \times (x - \bar x)$. */
    Vector3 velocity;
    Vector3 angular_velocity;

    /** Declares the entries of a body in the current subsection. */
    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError for values that the patterns cannot exclude */
    void
    check() const;

    /** Path of the body's subsection. */
    std::string
    section() const
    {
      return "Bodies/" + name;
    }
  };



  /**
   * A body of the system: its constant operators, its placement in the world
   * and the functionals through which joints act on it.
   */
  class Body
  {
  public:
    /**
     * Makes or reads the mesh and assembles the operators.
     * @param directory where relative mesh file names start
     */
    Body(const BodyParameters &parameters,
         const std::filesystem::path &directory);

    const std::string &
    name() const
    {
      return parameters.name;
    }

    /** Path of the body's subsection in the model file. */
    std::string
    section() const
    {
      return parameters.section();
    }

    const BodyDiscretization &
    discretization() const
    {
      return *finite_elements;
    }

    const BodyOperators &
    operators() const
    {
      return *constant_operators;
    }

    const Material &
    material() const
    {
      return parameters.material;
    }

    RotationMeasure
    rotation_measure() const
    {
      return parameters.rotation_measure;
    }

    /** $R_0$ of the placement. */
    const Matrix3 &
    placement_rotation() const
    {
      return initial_rotation;
    }

    /** Nodal positions $x_a$ at the start, m. */
    NodalVector
    initial_positions() const;

    /** Nodal velocities at the start, m/s. */
    NodalVector
    initial_velocities() const;

    /** Functionals through which joints act on the body. */
    const std::vector<NodalFunctional> &
    joint_functionals() const
    {
      return functionals;
    }

    /**
     * Makes a functional one of the joint_functionals(), unless it is.
     * @return its index
     */
    unsigned int
    add_joint_functional(const NodalFunctional &functional);

  private:
    BodyParameters parameters;
    std::shared_ptr<const BodyDiscretization> finite_elements;
    std::shared_ptr<const BodyOperators> constant_operators;
    Matrix3 initial_rotation;
    std::vector<NodalFunctional> functionals;
  };
} // namespace ACF

#endif
