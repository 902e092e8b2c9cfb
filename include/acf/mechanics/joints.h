// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_joints_h
#define acf_mechanics_joints_h

#include <acf/base/time_function.h>
#include <acf/mechanics/joint_side.h>

namespace ACF
{
  /** What a model file says of a joint. */
  struct JointParameters
  {
    std::string name;

    /** See add_parameters(). */
    std::string type = "spherical";

    /** "BODY: SURFACE, BODY: SURFACE" or "BODY: SURFACE, ground". */
    std::string between;

    /** World directions or axes that are blocked, as text. */
    std::string directions;

    /** World axis of the types that have one. */
    Vector3 axis;

    /** World direction of the joint's x axis; second axis of a universal. */
    Vector3 cross_axis;

    /** Joint axes left free: "y, rotation x". */
    std::string free;

    /** Whether a distance of the surfaces at the placement is kept. */
    bool keep_offset = false;

    /** Prescribed motions, expressions of time; empty: none. */
    std::string angle;
    std::string angular_velocity;
    std::string displacement;
    std::string position;
    std::string length;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError for values that the patterns cannot exclude */
    void
    check() const;

    /** Directions as unit vectors; x, y, z if nothing is given. */
    std::vector<Vector3>
    direction_vectors() const;

    /** World directions of the joint's axes x, y, z at the placement. */
    std::array<Vector3, dim>
    joint_axes() const;

    /** World directions and axes of blocked motions at the placement. */
    std::vector<Vector3>
    blocked_translations() const;

    std::vector<Vector3>
    blocked_rotations() const;

    /** Whether a motion is prescribed in world axes, as three functions. */
    bool
    drives_the_ground() const;

    std::string
    section() const
    {
      return "Joints/" + name;
    }
  };



  /** A prescribed motion: $u(t) = \sum_k c_k f_k(t)$ or its integral. */
  class Drive
  {
  public:
    /** @param motion $c\, u$ with the displacement or angle u */
    void
    add_motion(const double c, const TimeFunction &motion);

    /** @param rate $c\, \dot u$; u(0) = 0 */
    void
    add_rate(const double c, const TimeFunction &rate);

    bool
    is_constant() const
    {
      return motions.empty() && integrals.empty();
    }

    double
    value(const double t) const;

    double
    rate(const double t) const;

  private:
    std::vector<std::pair<double, TimeFunction>> motions;
    std::vector<std::pair<double, TimeFunction>> rates;
    std::vector<std::pair<double, TimeIntegral>> integrals;
  };



  /**
   * A joint: integral constraints with multipliers (paper Sec. 4, Eq. (16)),
   * \f[ \Phi_r = y_r(s) - o_r - u_r(t) = 0 \f]
   * on functions $y_r$ of the values s of its markers, with constants $o_r$ and
   * prescribed motions $u_r$. The forces on the markers are
   * $-D^T \lambda$, $D = \partial y / \partial s$. Rows that constrain
   * positions are in m (multipliers in N), rows that constrain rotations in rad
   * (multipliers in N m). What it constrains, see make_joint().
   * See theory (8.3).
   */
  class Joint
  {
  public:
    /** One constraint. */
    struct Row
    {
      MarkerFunction function;
      double offset = 0;
      Drive drive;
    };

    std::string name;

    /** Section of the model file. */
    std::string section;

    /** First and second side. */
    std::array<JointSide, 2> sides;

    /** Axes x, y, z of the joint at the placement, as unit vectors. */
    std::array<Vector3, dim> axes;

    MarkerSet markers;
    std::vector<Row> rows;

    unsigned int
    n_constraints() const
    {
      return rows.size();
    }

    /** Whether D is constant. */
    bool
    is_affine() const;

    /** $\Phi$ for marker values, size n_constraints(). */
    Eigen::VectorXd
    residual(const double t, const Eigen::VectorXd &s) const;

    /** D, size n_constraints() x size of s. */
    Eigen::MatrixXd
    jacobian(const Eigen::VectorXd &s) const;

    /** $\dot u(t)$, size n_constraints(). */
    Eigen::VectorXd
    drive_rates(const double t) const;

    /** $\sum_r \lambda_r\, \partial^2 y_r / \partial s^2$. */
    Eigen::MatrixXd
    geometric_stiffness(const Eigen::VectorXd &s,
                        const Eigen::VectorXd &multipliers) const;
  };

  /**
   * Makes a joint. Its axes are those of the world at the placement of the
   * bodies, unless an axis is given, which is then its z axis. Blocked
   * translations keep the mean positions of the two surfaces together. If all
   * three are blocked, they are so in the world; otherwise the directions turn
   * with the second side. Rotations blocked about one or three axes: the mean
   * relative rotation about them,
   * $\theta = (\mathrm{tr}(J) I - J)^{-1} \frac1A \int (X - \bar X) \times x$
   * with the weights of the first side that is a body, seen from the other
   * side, is zero; it is exact for small angles about the other axes. Rotations
   * blocked about two axes: the third axis, as a direction of one side, stays
   * perpendicular to two directions of the other one, for any angle about it.
   * See theory (8.5).
   *
   * @throws InputError naming what is wrong and which bodies and surfaces exist
   */
  Joint
  make_joint(const JointParameters &parameters,
             const std::vector<Body> &bodies);

  /**
   * The angle by which the first side has turned about an axis relative to the
   * second one since the placement, in (-pi, pi], rad.
   * See theory (8.7).
   */
  MarkerFunction
  relative_angle(MarkerSet &markers,
                 const JointSide &first,
                 const JointSide &second,
                 const Vector3 &axis);

  /**
   * Mean relative rotation of two sides about an axis, rad, exact for small
   * angles. @pre one side is a body
   * See theory (8.6).
   */
  MarkerPolynomial
  relative_rotation(MarkerSet &markers,
                    const JointSide &first,
                    const JointSide &second,
                    const Vector3 &axis);

  /**
   * Distance of the mean positions along a direction that turns with the second
   * side, from the second to the first, m. The ground lies where the first
   * side is at the placement.
   * See theory (8.4).
   */
  MarkerPolynomial
  relative_displacement(MarkerSet &markers,
                        const JointSide &first,
                        const JointSide &second,
                        const Vector3 &direction);

  /** The two sides of the entry 'Between'. @throws InputError */
  std::array<JointSide, 2>
  parse_sides(const std::string &text,
              const std::vector<Body> &bodies,
              const std::string &section,
              const std::string &entry = "Between");

  /**
   * Where the first side is relative to the second one, in world axes; zero if
   * the second is the ground and at the placement.
   * See theory (8.4).
   */
  MarkerExpression
  relative_position(MarkerSet &markers,
                    const JointSide &first,
                    const JointSide &second);
} // namespace ACF

#endif
