// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_loads_h
#define acf_mechanics_loads_h

#include <acf/base/time_function.h>
#include <acf/mechanics/joint_side.h>

namespace ACF
{
  /** What a model file says of gravity. */
  struct LoadParameters
  {
    /** m/s^2 */
    Vector3 gravity;

    /** Factor of gravity, an expression of time. */
    std::string gravity_factor = "1";

    void
    add_parameters(ParameterHandler &prm);
  };



  /** What a model file says of a load on a surface. */
  struct SurfaceLoadParameters
  {
    std::string name;

    /** force, torque, traction or pressure. */
    std::string type = "force";

    /** "BODY: SURFACE". */
    std::string on;

    /** Functions of time: one for a pressure, else three. */
    std::string value;

    /** Whether the direction turns with the body. */
    bool follows = false;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError */
    void
    check() const;

    std::string
    section() const
    {
      return "Loads/" + name;
    }
  };



  /**
   * A load on a surface, which keeps its distribution in the rotating frame of
   * the body with rotation R: $f_a = R\, P_a\, \hat m(t)$ with constant
   * matrices $P_a$. For the value m(t) of
   * - a force (N) or a traction (N/m^2): $P_a = \frac1A \int \phi_a\, dA\, I$
   * or
   *   $\int \phi_a\, dA\, I$;
   * - a torque (N m): $P_a \hat m = \frac1A \int \phi_a\,
   *   (\Theta \hat m) \times (X - \bar X)\, dA$, the traction of a rigid
   *   rotation, $\Theta = (\mathrm{tr}(J) I - J)^{-1}$;
   * - a pressure (Pa): $P_a \hat m = -p \int \phi_a N\, dA$.
   * Loads with fixed directions have $\hat m = R^T m$, those that follow the
   * body $\hat m = R_0^T m$ with its placement. Small strains are not seen.
   * See theory (9.3).
   */
  class SurfaceLoad
  {
  public:
    SurfaceLoad(const SurfaceLoadParameters &parameters,
                const std::vector<Body> &bodies,
                const BodySurface &place);

    unsigned int
    body() const
    {
      return body_index;
    }

    /** Whether R is needed. */
    bool
    depends_on_rotation() const
    {
      return follows || !is_isotropic;
    }

    /**
     * Adds the nodal forces times a factor; the rotation counts if
     * depends_on_rotation().
     */
    void
    add_force(const double t,
              const Matrix3 &rotation,
              NodalVector &force,
              const double factor = 1) const;

  private:
    unsigned int body_index;
    bool follows;

    /** Whether all $P_a$ are multiples of the unit matrix. */
    bool is_isotropic;
    bool is_pressure;
    Matrix3 placement_rotation;
    std::vector<unsigned int> nodes;
    std::vector<Matrix3> patterns;
    TimeVectorFunction value;
  };

  /**
   * A load, one for each part of a divided body that has some of the surface.
   * @throws InputError if there is no such surface, or parts share one that
   *   carries a force or a torque
   */
  std::vector<SurfaceLoad>
  make_surface_loads(const SurfaceLoadParameters &parameters,
                     const std::vector<Body> &bodies);
} // namespace ACF

#endif
