// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/joints.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ACF
{
  void
  Drive::add_motion(const double c, const TimeFunction &motion)
  {
    motions.emplace_back(c, motion);
  }



  void
  Drive::add_rate(const double c, const TimeFunction &rate)
  {
    rates.emplace_back(c, rate);
    integrals.emplace_back(c, TimeIntegral(rate, 1e-3));
  }



  double
  Drive::value(const double t) const
  {
    double sum = 0;
    for (const auto &[c, motion] : motions)
      sum += c * motion(t);
    for (const auto &[c, integral] : integrals)
      sum += c * integral(t);
    return sum;
  }



  double
  Drive::rate(const double t) const
  {
    double sum = 0;
    for (const auto &[c, motion] : motions)
      sum += c * motion.derivative(t);
    for (const auto &[c, rate] : rates)
      sum += c * rate(t);
    return sum;
  }



  bool
  Joint::is_affine() const
  {
    return std::all_of(rows.begin(), rows.end(), [](const Row &row) {
      return row.function.is_affine();
    });
  }



  Eigen::VectorXd
  Joint::residual(const double t, const Eigen::VectorXd &s) const
  {
    Eigen::VectorXd result(rows.size());
    for (unsigned int r = 0; r < rows.size(); ++r)
      {
        result(r) =
          rows[r].function.value(s) - rows[r].offset - rows[r].drive.value(t);
        if (rows[r].function.is_angle())
          result(r) = std::remainder(result(r), 2 * numbers::PI);
      }
    return result;
  }



  Eigen::MatrixXd
  Joint::jacobian(const Eigen::VectorXd &s) const
  {
    Eigen::MatrixXd result(rows.size(), s.size());
    for (unsigned int r = 0; r < rows.size(); ++r)
      result.row(r) = rows[r].function.gradient(s).transpose();
    return result;
  }



  Eigen::VectorXd
  Joint::drive_rates(const double t) const
  {
    Eigen::VectorXd result(rows.size());
    for (unsigned int r = 0; r < rows.size(); ++r)
      result(r) = rows[r].drive.rate(t);
    return result;
  }



  Eigen::MatrixXd
  Joint::geometric_stiffness(const Eigen::VectorXd &s,
                             const Eigen::VectorXd &multipliers) const
  {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(s.size(), s.size());
    for (unsigned int r = 0; r < rows.size(); ++r)
      if (!rows[r].function.is_affine() && multipliers(r) != 0)
        result += multipliers(r) * rows[r].function.hessian(s);
    return result;
  }



  std::array<std::string, 2>
  split_sides(const std::string &text,
              const std::string &section,
              const std::string &entry)
  {
    const auto names = Utilities::split_string_list(text, ',');
    if (names.size() != 2 || (names[0] == "ground" && names[1] == "ground") ||
        names[0] == names[1])
      throw InputError(section,
                       entry,
                       text.empty() ? "nothing" : "'" + text + "'",
                       "two surfaces, 'BODY: SURFACE, BODY: SURFACE', or a "
                       "surface and the ground, 'BODY: SURFACE, ground'");
    return {{names[0], names[1]}};
  }



  std::array<JointSide, 2>
  parse_sides(const std::string &text,
              const std::vector<Body> &bodies,
              const std::string &section,
              const std::string &entry)
  {
    const auto names = split_sides(text, section, entry);
    return {{JointSide(names[0], bodies, section, entry),
             JointSide(names[1], bodies, section, entry)}};
  }



  MarkerExpression
  relative_position(MarkerSet &markers,
                    const JointSide &first,
                    const JointSide &second)
  {
    const auto position = [&](const JointSide &side, const JointSide &other) {
      if (!side.is_ground())
        return side.position(markers);
      return MarkerExpression{other.start_position(), {}};
    };
    return position(first, second) - position(second, first);
  }



  MarkerPolynomial
  relative_displacement(MarkerSet &markers,
                        const JointSide &first,
                        const JointSide &second,
                        const Vector3 &direction)
  {
    MarkerPolynomial result;
    add_product(result,
                1,
                relative_position(markers, first, second),
                second.direction(markers, direction));
    return result;
  }



  MarkerPolynomial
  relative_rotation(MarkerSet &markers,
                    const JointSide &first,
                    const JointSide &second,
                    const Vector3 &axis)
  {
    // axis . Theta sum_k J_k p_k x d_k with Theta = (tr(J) I - J)^-1 and the
    // directors d_k along the principal directions p_k of a surface
    const JointSide &weighted = first.is_ground() ? second : first;
    const JointSide &other    = first.is_ground() ? first : second;
    const double sign         = first.is_ground() ? -1 : 1;

    auto principal = weighted.principal_directions();
    if (principal.size() < dim)
      principal.emplace_back(cross_product_3d(principal[0].first,
                                              principal[1].first),
                             0.);
    double sum = 0;
    for (const auto &[p, extent] : principal)
      sum += extent * extent;
    Vector3 scaled;
    for (const auto &[p, extent] : principal)
      scaled += (axis * p) / (sum - extent * extent) * p;

    MarkerPolynomial result;
    for (const auto &[p, extent] : principal)
      {
        const Vector3 arm = cross_product_3d(scaled, p);
        if (extent > 0 && arm.norm() > 1e-12 * scaled.norm())
          add_product(result,
                      sign * extent * extent * arm.norm(),
                      weighted.direction(markers, p),
                      other.direction(markers, arm / arm.norm()));
      }
    return result;
  }



  MarkerFunction
  relative_angle(MarkerSet &markers,
                 const JointSide &first,
                 const JointSide &second,
                 const Vector3 &axis)
  {
    const JointSide &weighted = first.is_ground() ? second : first;
    const JointSide &other    = first.is_ground() ? first : second;
    const double sign         = first.is_ground() ? -1 : 1;

    // directions across the axis in which the surface extends
    std::vector<std::pair<Vector3, double>> across;
    const auto principal = weighted.principal_directions();
    for (const auto &[p, extent] : principal)
      {
        const Vector3 t = p - (p * axis) * axis;
        if (t.norm() > 1e-6 && weighted.resolves(t / t.norm()) &&
            std::none_of(across.begin(), across.end(), [&](const auto &old) {
              return std::abs(old.first * t) > 1e-6 * t.norm();
            }))
          across.emplace_back(t / t.norm(), weighted.extent(t / t.norm()));
      }
    if (across.empty()) // a plane oblique to the axis: its line across
      {
        Vector3 t = cross_product_3d(axis,
                                     cross_product_3d(principal[0].first,
                                                      principal[1].first));
        t /= t.norm();
        across.emplace_back(t, weighted.extent(t));
      }

    MarkerPolynomial sine, cosine;
    for (const auto &[t, extent] : across)
      {
        const double weight  = extent * extent;
        const auto direction = weighted.direction(markers, t);
        add_product(cosine, weight, direction, other.direction(markers, t));
        add_product(sine,
                    sign * weight,
                    direction,
                    other.direction(markers, cross_product_3d(axis, t)));
      }
    return MarkerFunction::angle(sine, cosine);
  }



  namespace
  {
    // How well the surface of a side shows the direction of an axis by its
    // extent along it, against that across it.
    double
    slenderness(const JointSide &side,
                const Vector3 &axis,
                const std::array<Vector3, 2> &across)
    {
      if (side.is_ground())
        return 1;
      if (!side.resolves(across[0]) || !side.resolves(across[1]))
        return std::numeric_limits<double>::infinity();
      if (!side.resolves(axis))
        return 0;
      return side.extent(axis) /
             std::min(side.extent(across[0]), side.extent(across[1]));
    }



    // Rotations blocked about two axes: the axis as a direction of one side is
    // perpendicular to two directions of the other side. The axis is that of
    // the more slender side: of a pin in a thin plate, or of a fork around an
    // eye, whose cheeks are too short to show it by their own twist.
    void
    add_hinge(Joint &joint, const std::array<Vector3, 2> &across)
    {
      const JointSide &weighted =
        joint.sides[0].is_ground() ? joint.sides[1] : joint.sides[0];
      const JointSide &other =
        joint.sides[0].is_ground() ? joint.sides[0] : joint.sides[1];
      const Vector3 axis = cross_product_3d(across[0], across[1]);

      const double here  = slenderness(weighted, axis, across);
      const double there = slenderness(other, axis, across);
      const bool same    = (here == there) ||
                        std::abs(here - there) < 1e-6 * std::max(here, there);
      const bool along_is_better = same ? here >= 1 : here > there;
      for (const Vector3 &t : across)
        {
          MarkerPolynomial row;
          add_product(
            row,
            1,
            weighted.direction(joint.markers, along_is_better ? axis : t),
            other.direction(joint.markers, along_is_better ? t : axis));
          joint.rows.push_back({row, 0, Drive()});
        }
    }



    void
    add_blocked_rotations(Joint &joint, const std::vector<Vector3> &axes)
    {
      if (axes.size() == 2)
        {
          const Vector3 axis = cross_product_3d(axes[0], axes[1]);
          return add_hinge(joint, perpendicular(axis / axis.norm()));
        }
      for (const Vector3 &axis : axes)
        joint.rows.push_back({relative_rotation(joint.markers,
                                                joint.sides[0],
                                                joint.sides[1],
                                                axis),
                              0,
                              Drive()});
    }



    std::string
    vector_text(const Vector3 &v)
    {
      return format_number(v[0]) + ", " + format_number(v[1]) + ", " +
             format_number(v[2]);
    }



    // The components of a prescribed motion of the ground's side.
    TimeVectorFunction
    prescribed_motion(const Joint &joint, const JointParameters &parameters)
    {
      const std::string entry =
        parameters.position.empty() ? "Displacement" : "Position";
      const std::string &text = parameters.position.empty()
                                  ? parameters.displacement
                                  : parameters.position;
      if (text.empty() || text.find(';') == std::string::npos)
        {
          if (!parameters.position.empty())
            parse_time_vector(text, joint.section, entry);
          return {};
        }
      const TimeVectorFunction motion =
        parse_time_vector(text, joint.section, entry);
      const Vector3 start = parameters.position.empty()
                              ? Vector3()
                              : joint.sides[0].start_position();
      const double jump   = (evaluate(motion, 0) - start).norm();
      if (jump > 1e-8 * joint.sides[0].length())
        throw InputError(
          joint.section,
          entry,
          "a motion that starts at " + vector_text(evaluate(motion, 0)) +
            " m, which is a jump of " + format_number(jump) + " m",
          "a motion that starts at " + vector_text(start) + " m");
      return motion;
    }



    void
    add_blocked_translations(Joint &joint,
                             const std::vector<Vector3> &directions,
                             const JointParameters &parameters)
    {
      const JointSide &first = joint.sides[0], &second = joint.sides[1];
      const TimeVectorFunction motion = prescribed_motion(joint, parameters);

      MarkerExpression distance =
        relative_position(joint.markers, first, second);
      const Vector3 offset =
        first.is_ground() || second.is_ground()
          ? Vector3()
          : first.start_position() - second.start_position();
      const double tolerance = 1e-8 * std::max(first.length(), second.length());
      double gap             = 0;
      for (const Vector3 &direction : directions)
        gap = std::max(gap, std::abs(direction * offset));
      if (gap > tolerance && !parameters.keep_offset)
        throw InputError(
          joint.section,
          "Between",
          "surfaces whose mean positions are " + format_number(offset.norm()) +
            " m apart (" + vector_text(offset) + ")",
          "surfaces that coincide in the blocked directions, or the entry "
          "'Offset = keep'");

      const bool all_blocked = (directions.size() == dim);
      for (const Vector3 &direction : directions)
        {
          Joint::Row row;
          MarkerPolynomial function;
          if (all_blocked)
            {
              SurfaceDirection constant;
              constant.along.constant = direction;
              add_product(function, 1, distance, constant);
              if (gap > tolerance)
                add_product(function,
                            -offset.norm(),
                            constant.along,
                            second.direction(joint.markers,
                                             offset / offset.norm()));
              else
                row.offset = direction * offset;
            }
          else
            {
              add_product(function,
                          1,
                          distance,
                          second.direction(joint.markers, direction));
              row.offset = direction * offset;
            }
          if (!motion.empty())
            {
              // a start other than zero belongs to an absolute position
              for (unsigned int i = 0; i < dim; ++i)
                row.drive.add_motion(direction[i], motion[i]);
              if (!parameters.position.empty())
                row.offset -= direction * first.start_position();
            }
          row.function = function;
          joint.rows.push_back(row);
        }
    }



    void
    add_distance(Joint &joint, const JointParameters &parameters)
    {
      const MarkerExpression distance =
        relative_position(joint.markers, joint.sides[0], joint.sides[1]);
      const double start =
        joint.sides[1].is_ground() || joint.sides[0].is_ground()
          ? 0.
          : (joint.sides[0].start_position() - joint.sides[1].start_position())
              .norm();
      if (!(start > 1e-8 * joint.sides[0].length()))
        throw InputError(joint.section,
                         "Between",
                         "surfaces whose mean positions coincide",
                         "two surfaces of bodies at a distance from each "
                         "other");
      Joint::Row row;
      row.function = MarkerFunction::length(distance);
      if (parameters.length.empty())
        row.offset = start;
      else
        {
          const TimeFunction length(parameters.length, joint.section, "Length");
          if (std::abs(length(0) - start) > 1e-8 * start)
            throw InputError(joint.section,
                             "Length",
                             "a length that starts at " +
                               format_number(length(0)) + " m, which is a jump",
                             "a length that starts at the distance " +
                               format_number(start) + " m of the surfaces");
          row.drive.add_motion(1, length);
        }
      joint.rows.push_back(row);
    }



    void
    add_universal(Joint &joint, const JointParameters &parameters)
    {
      const Vector3 a = parameters.axis / parameters.axis.norm();
      const Vector3 b = parameters.cross_axis / parameters.cross_axis.norm();
      MarkerPolynomial row;
      add_product(row,
                  1,
                  joint.sides[0].direction(joint.markers, a),
                  joint.sides[1].direction(joint.markers, b));
      joint.rows.push_back({row, 0, Drive()});
    }



    void
    add_drives(Joint &joint, const JointParameters &parameters)
    {
      if (!parameters.angle.empty() || !parameters.angular_velocity.empty())
        {
          Joint::Row row;
          row.function = relative_angle(joint.markers,
                                        joint.sides[0],
                                        joint.sides[1],
                                        joint.axes[2]);
          if (!parameters.angle.empty())
            {
              const TimeFunction angle(parameters.angle,
                                       joint.section,
                                       "Angle");
              if (std::abs(angle(0)) > 1e-10)
                throw InputError(joint.section,
                                 "Angle",
                                 "an angle that starts at " +
                                   format_number(angle(0)) +
                                   " rad, which is a jump",
                                 "an angle that starts at zero, where the "
                                 "bodies are placed");
              row.drive.add_motion(1, angle);
            }
          else
            row.drive.add_rate(1,
                               TimeFunction(parameters.angular_velocity,
                                            joint.section,
                                            "Angular velocity"));
          joint.rows.push_back(row);
        }
      if (!parameters.displacement.empty() &&
          parameters.displacement.find(';') == std::string::npos)
        {
          const TimeFunction displacement(parameters.displacement,
                                          joint.section,
                                          "Displacement");
          if (std::abs(displacement(0)) >
              1e-8 * std::max(joint.sides[0].length(), joint.sides[1].length()))
            throw InputError(joint.section,
                             "Displacement",
                             "a displacement that starts at " +
                               format_number(displacement(0)) +
                               " m, which is a jump",
                             "a displacement that starts at zero, where the "
                             "bodies are placed");
          Joint::Row row;
          row.function = relative_displacement(joint.markers,
                                               joint.sides[0],
                                               joint.sides[1],
                                               joint.axes[2]);
          if (!joint.sides[0].is_ground() && !joint.sides[1].is_ground())
            row.offset = joint.axes[2] * (joint.sides[0].start_position() -
                                          joint.sides[1].start_position());
          row.drive.add_motion(1, displacement);
          joint.rows.push_back(row);
        }
    }
  } // namespace



  Joint
  make_joint(const JointParameters &parameters, const std::vector<Body> &bodies)
  {
    Joint joint;
    joint.name    = parameters.name;
    joint.section = parameters.section();
    joint.sides   = parse_sides(parameters.between, bodies, joint.section);
    joint.axes    = parameters.joint_axes();
    if (parameters.drives_the_ground() && !joint.sides[1].is_ground())
      throw InputError(joint.section,
                       parameters.position.empty() ? "Displacement"
                                                   : "Position",
                       "a motion in world axes of a joint between bodies",
                       "such a motion for a joint whose second side is the "
                       "ground");

    if (parameters.type == "distance")
      add_distance(joint, parameters);
    else
      {
        const std::vector<Vector3> translations =
          parameters.blocked_translations();
        if (!translations.empty())
          add_blocked_translations(joint, translations, parameters);
        add_blocked_rotations(joint, parameters.blocked_rotations());
        if (parameters.type == "universal")
          add_universal(joint, parameters);
      }
    add_drives(joint, parameters);
    return joint;
  }
} // namespace ACF
