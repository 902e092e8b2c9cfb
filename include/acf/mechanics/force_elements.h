// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_force_elements_h
#define acf_mechanics_force_elements_h

#include <acf/mechanics/joints.h>

namespace ACF
{
  /** What a model file says of a spring-damper or a bushing. */
  struct ForceElementParameters
  {
    std::string name;

    /** See add_parameters(). */
    std::string type = "spring-damper";

    /** "BODY: SURFACE, BODY: SURFACE" or "BODY: SURFACE, ground". */
    std::string between;

    /** N/m or N m/rad; six numbers for a bushing. */
    std::vector<double> stiffness;

    /** N s/m or N m s/rad; six numbers for a bushing. */
    std::vector<double> damping;

    /** Length without force, m; negative: the length at the start. */
    double free_length = -1;

    /** Angle without moment, rad. */
    double free_angle = 0;

    /** World point to which a spring from the ground is attached, m. */
    std::vector<double> ground_point;

    /** World axis at the start. */
    Vector3 axis;

    /** Additional force or moment, an expression of time. */
    std::string actuation;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError */
    void
    check() const;

    std::string
    section() const
    {
      return "Force elements/" + name;
    }
  };



  /**
   * A force element: a sum of laws, each on one function y of marker values,
   * with the generalised force
   * \f[ Q = -k (y - y_0) - d\, \dot y + Q_0(t) \f]
   * and so the forces $Q\, \partial y / \partial s$ on the markers. y is the
   * distance of two mean positions (Q is then positive if it pushes), an angle
   * about an axis, or a component of a bushing's deformation.
   * See theory (9.1).
   */
  class ForceElement
  {
  public:
    /** One law. Units: N or N m per unit of y. */
    struct Law
    {
      MarkerFunction function;
      double stiffness  = 0;
      double damping    = 0;
      double free_value = 0;
      TimeFunction actuation;
    };

    std::string name;
    std::string section;
    MarkerSet markers;
    std::vector<Law> laws;

    /** Whether the force depends on velocities. */
    bool
    is_damped() const;

    /** Values y of the laws, size n_laws. */
    Eigen::VectorXd
    values(const Eigen::VectorXd &s) const;

    /**
     * Forces on the markers.
     * @param s, v values and velocities of the markers
     * @param y values of the laws, continuous also for angles
     * @param actuation_factor factor of $Q_0$
     */
    Eigen::VectorXd
    force(const double t,
          const Eigen::VectorXd &s,
          const Eigen::VectorXd &v,
          const Eigen::VectorXd &y,
          const double actuation_factor = 1) const;

    /** $-\partial\,\text{force} / \partial s$ at frozen velocities. */
    Eigen::MatrixXd
    stiffness(const double t,
              const Eigen::VectorXd &s,
              const Eigen::VectorXd &v,
              const Eigen::VectorXd &y,
              const double actuation_factor = 1) const;

    /** $-\partial\,\text{force} / \partial v$. */
    Eigen::MatrixXd
    damping(const Eigen::VectorXd &s) const;

    /** Energy of the springs, J. */
    double
    energy(const Eigen::VectorXd &y) const;

  private:
    /** Q of a law. */
    double
    generalized_force(const Law &law,
                      const double t,
                      const double y,
                      const double y_dot,
                      const double actuation_factor) const;
  };

  /** @throws InputError naming what is wrong */
  ForceElement
  make_force_element(const ForceElementParameters &parameters,
                     const std::vector<Body> &bodies);
} // namespace ACF

#endif
