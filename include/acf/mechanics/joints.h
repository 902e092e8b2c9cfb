// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_joints_h
#define acf_mechanics_joints_h

#include <acf/mechanics/body.h>

#include <Eigen/Dense>

namespace ACF
{
  /** What a model file says of a joint. */
  struct JointParameters
  {
    std::string name;

    /** mean position, spherical, mean rotation, revolute or fixed. */
    std::string type = "spherical";

    /** "BODY: SURFACE, ground". */
    std::string between;

    /** World directions or axes that are blocked, as text. */
    std::string directions;

    /** World axis of a revolute joint. */
    Vector3 axis;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError for values that the patterns cannot exclude */
    void
    check() const;

    /** Directions as unit vectors; x, y, z if nothing is given. */
    std::vector<Vector3>
    direction_vectors() const;

    std::string
    section() const
    {
      return "Joints/" + name;
    }
  };



  /** A surface of a body, as model files name it: "BODY: SURFACE". */
  struct SurfaceName
  {
    std::string body;
    std::string surface;
  };

  /**
   * Splits "BODY: SURFACE".
   * @throws InputError naming @p section and @p entry if it has another form
   */
  SurfaceName
  parse_surface_name(const std::string &text,
                     const std::string &section,
                     const std::string &entry);

  /**
   * The body of a name.
   * @throws InputError that names the bodies that exist
   */
  unsigned int
  find_body(const std::vector<Body> &bodies,
            const std::string &name,
            const std::string &section,
            const std::string &entry);



  /**
   * A joint: integral constraints with multipliers,
   * \f[ \Phi = \sum_p D_p s_p(u) - b = 0 \f]
   * on values $s_p$ of surface functionals (paper Eq. (16)). The constraint
   * forces on the body are $-\lambda^T D_p$ on each value. Rows that constrain
   * positions are in m (multipliers in N), rows that constrain rotations in rad
   * (multipliers in N m).
   */
  struct Joint
  {
    std::string name;

    /** Index of the body. */
    unsigned int body = 0;

    /** Indices p of the functionals in Body::joint_functionals(). */
    std::vector<unsigned int> functionals;

    /** Whether a functional is a mean position or a director or moment. */
    std::vector<bool> is_mean_position;

    /** $(D_1, D_2, ...)$, size n_rows x 3 functionals. */
    Eigen::MatrixXd matrix;

    /** b, size n_rows. */
    Eigen::VectorXd right_hand_side;

    unsigned int
    n_constraints() const
    {
      return matrix.rows();
    }
  };

  /**
   * Makes a joint of a body to the ground and gives the body its functionals.
   *
   * Positions: the mean position of the surface keeps its value of the start in
   * the given directions. Rotations blocked about one or three axes: the mean
   * rotation of the surface,
   * $\theta = (\mathrm{tr}(J) I - J)^{-1} \frac1A \int (X - \bar X) \times x$,
   * keeps the value zero in these axes, which presumes small rotations about
   * the others. Rotations blocked about two axes: the surface turns about the
   * third axis e by any angle; either the director of e stays parallel to e, or
   * the directors perpendicular to e stay perpendicular, whichever the surface
   * resolves better.
   *
   * @throws InputError naming what is wrong and which bodies and surfaces exist
   */
  Joint
  make_joint(const JointParameters &parameters, std::vector<Body> &bodies);
} // namespace ACF

#endif
