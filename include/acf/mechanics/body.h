// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_body_h
#define acf_mechanics_body_h

#include <acf/base/time_function.h>
#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/functionals.h>
#include <acf/mechanics/green_lagrange.h>
#include <acf/mechanics/reduced_strain.h>
#include <acf/mechanics/rotation.h>

#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace ACF
{
  /** How the elastic energy of a body follows from its deformation. */
  enum class StrainMeasure
  {
    /** Small strain in the frame of the body, see reduced_strain_force(). */
    reduced,

    /** See GreenLagrangeOperator. */
    green_lagrange
  };

  /** What a model file says of a body. */
  struct BodyParameters
  {
    std::string name;

    /** Name of the body that this one is a part of; empty: of none. */
    std::string whole;

    MeshParameters mesh;
    Material material;
    RotationMeasure rotation_measure = RotationMeasure::polar;
    StrainMeasure strain_measure     = StrainMeasure::reduced;

    /** Rayleigh damping of the deformation: alpha, 1/s, and beta, s. */
    double mass_damping      = 0;
    double stiffness_damping = 0;

    /** Placement $x = \text{position} + R_0 X$; m and rad. */
    Point<dim> position;
    Vector3 rotation;

    /** Rigid motion at the start: $v + \omega \times (x - \bar x)$. */
    Vector3 velocity;
    Vector3 angular_velocity;

    /** Fields of the mesh's coordinates in its axes, "x; y; z"; may be empty.
     */
    std::string displacement_field;
    std::string velocity_field;

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
      return "Bodies/" + (whole.empty() ? name : whole);
    }
  };



  /**
   * What identical bodies (same mesh, element and material) share: everything
   * that does not depend on where a body is, and so also its factorisations.
   */
  class ReferenceBody
  {
  public:
    /**
     * Makes or reads the mesh and assembles the operators.
     * @param directory where relative mesh file names start
     */
    ReferenceBody(const BodyParameters &parameters,
                  const std::filesystem::path &directory);

    /** With a mesh that exists already. */
    ReferenceBody(const BodyParameters &parameters,
                  std::unique_ptr<const BodyMesh> body_mesh);

    /** Whether a body with these parameters can share it. */
    bool
    fits(const BodyParameters &parameters) const;

    const BodyDiscretization &
    discretization() const
    {
      return finite_elements;
    }

    const BodyOperators &
    operators() const
    {
      return constant_operators;
    }

    /** Made when it is needed first. */
    const GreenLagrangeOperator &
    green_lagrange() const;

    /** Functionals through which joints and force elements act. */
    const std::vector<NodalFunctional> &
    functionals() const
    {
      return marker_functionals;
    }

    /**
     * Makes a functional one of the functionals(), unless it is.
     * @return its index
     */
    unsigned int
    add_functional(const NodalFunctional &functional);

    /** See surface_geometry(); integrated once for each surface. */
    const SurfaceGeometry &
    geometry(const Surface &surface) const;

    /** See surface_mean(). */
    const NodalFunctional &
    mean(const Surface &surface) const;

    /** See surface_director(). */
    const NodalFunctional &
    director(const Surface &surface, const Vector3 &direction) const;

  private:
    MeshParameters mesh;
    Material material;
    BodyDiscretization finite_elements;
    BodyOperators constant_operators;
    mutable std::unique_ptr<const GreenLagrangeOperator>
      green_lagrange_operator;
    std::vector<NodalFunctional> marker_functionals;

    /** What was integrated over surfaces; many joints ask for the same. */
    struct SurfaceIntegrals
    {
      SurfaceGeometry geometry;
      std::optional<NodalFunctional> mean;
      std::list<std::pair<Vector3, NodalFunctional>> directors;
    };

    SurfaceIntegrals &
    integrals(const Surface &surface) const;

    mutable std::map<Surface, SurfaceIntegrals> surface_integrals;
  };



  /** A body of the system: a reference body and its placement in the world. */
  class Body
  {
  public:
    Body(const BodyParameters &parameters,
         const std::shared_ptr<ReferenceBody> &reference);

    const std::string &
    name() const
    {
      return parameters.name;
    }

    /** Name of the body that this one is a part of; empty: of none. */
    const std::string &
    whole() const
    {
      return parameters.whole;
    }

    /** Path of the body's subsection in the model file. */
    std::string
    section() const
    {
      return parameters.section();
    }

    ReferenceBody &
    reference()
    {
      return *reference_body;
    }

    const ReferenceBody &
    reference() const
    {
      return *reference_body;
    }

    const BodyDiscretization &
    discretization() const
    {
      return reference_body->discretization();
    }

    const BodyOperators &
    operators() const
    {
      return reference_body->operators();
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

    StrainMeasure
    strain_measure() const
    {
      return parameters.strain_measure;
    }

    /** alpha, 1/s */
    double
    mass_damping() const
    {
      return parameters.mass_damping;
    }

    /** beta, s */
    double
    stiffness_damping() const
    {
      return parameters.stiffness_damping;
    }

    bool
    is_damped() const
    {
      return mass_damping() > 0 || stiffness_damping() > 0;
    }

    /** Where the origin of the mesh is placed, m. */
    Vector3
    placement_position() const
    {
      return parameters.position;
    }

    /** $R_0$ of the placement. */
    const Matrix3 &
    placement_rotation() const
    {
      return initial_rotation;
    }

    /** Nodal positions of the undeformed body as it is placed, m. */
    NodalVector
    placement() const;

    /** Nodal positions $x_a$ at the start, with the displacement field, m. */
    NodalVector
    initial_positions() const;

    /** Nodal velocities at the start, m/s. */
    NodalVector
    initial_velocities() const;

    /**
     * For a part: the centre of mass at the start of the whole body, whose
     * velocity and about which the angular velocity are those of the model, m.
     */
    void
    set_whole_centre(const Vector3 &centre)
    {
      whole_centre = centre;
    }

  private:
    /** A field of the mesh's coordinates at the nodes, turned by $R_0$. */
    NodalVector
    nodal_field(const VectorField &field) const;

    BodyParameters parameters;
    std::shared_ptr<ReferenceBody> reference_body;
    Matrix3 initial_rotation;
    VectorField displacement;
    VectorField velocity;
    std::optional<Vector3> whole_centre;
  };
} // namespace ACF

#endif
