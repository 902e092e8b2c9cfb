// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_joint_pair_h
#define acf_tests_joint_pair_h

#include <acf/mechanics/joints.h>

#include <unit/multibody_test.h>

namespace ACF::Testing
{
  inline const Vector3 place({0.4, -1.2, 2}), turn_a({0.4, -1.1, 2}),
    turn_b({-1.3, 0.2, 0.9});

  /**
   * A box and a cylinder of which "x max" and a surface with the mean position
   * X have the same place, or a distance.
   */
  inline std::vector<Body>
  make_bodies(const Vector3 &X, const Vector3 &distance = Vector3())
  {
    static const BodyParameters box =
      body_at("a", box_mesh, turn_a, Vector3({1, 0, 1.5}), place);
    BodyParameters cylinder =
      body_at("b", cylinder_mesh, turn_b, X, place + distance);
    static const auto first  = std::make_shared<ReferenceBody>(box, ".");
    static const auto second = std::make_shared<ReferenceBody>(cylinder, ".");
    std::vector<Body> bodies;
    bodies.emplace_back(box, first);
    bodies.emplace_back(cylinder, second);
    return bodies;
  }

  /** A joint and how its residual follows from the motions of its sides. */
  struct JointedPair
  {
    std::vector<Body> bodies;
    Joint joint;
    std::array<Vector3, dim> axes;

    /** Where the first side is at the start. */
    Vector3 centre = place;

    JointedPair(const JointParameters &parameters,
                const std::vector<Body> &all_bodies)
      : bodies(all_bodies)
      , joint(make_joint(parameters, bodies))
      , axes(parameters.joint_axes())
    {
      if (!joint.sides[0].is_ground())
        centre = joint.sides[0].start_position();
    }

    /** Marker values if the first side has moved relative to the second, and
     * the second, if it is a body, in the world. */
    Eigen::VectorXd
    values(const RigidMotion &relative, const RigidMotion &common) const
    {
      std::vector<NodalVector> x;
      for (const Body &body : bodies)
        x.push_back(body.placement());
      const auto move = [&](const unsigned int side, const auto &motion) {
        NodalVector &y = x[joint.sides[side].body_index()];
        y              = transformed(y, motion);
      };
      if (joint.sides[0].is_ground())
        move(1, relative.inverse());
      else if (joint.sides[1].is_ground())
        move(0, relative);
      else
        {
          move(0, [&](const Vector3 &v) { return common(relative(v)); });
          move(1, common);
        }
      return joint.markers.values(x);
    }

    Eigen::VectorXd
    residual(const RigidMotion &relative,
             const RigidMotion &common,
             const double t = 0) const
    {
      return joint.residual(t, values(relative, common));
    }
  };
} // namespace ACF::Testing

#endif
