// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/input_problems.h>
#include <acf/mechanics/joints.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ACF
{
  namespace
  {
    const char *const direction_form =
      "axes x, y, z separated by ',' or vectors of three numbers separated by "
      "';' (for example '1,0,0; 0,1,1'), linearly independent";

    // Blocked motions along and about the axes x, y, z of the joint.
    struct JointType
    {
      std::string translations;
      std::string rotations;
      bool has_axis;
    };

    const std::map<std::string, JointType> joint_types = {
      {"spherical", {"xyz", "", false}},
      {"revolute", {"xyz", "xy", true}},
      {"cylindrical", {"xy", "xy", true}},
      {"prismatic", {"xy", "xyz", true}},
      {"fixed", {"xyz", "xyz", false}},
      {"universal", {"xyz", "", true}},
      {"point on line", {"xy", "", true}},
      {"point on plane", {"z", "", true}},
      {"planar", {"z", "xy", true}},
      {"distance", {"", "", false}},
      {"mean position", {"", "", false}},
      {"mean rotation", {"", "", false}}};



    bool
    uses_directions(const std::string &type)
    {
      return type == "mean position" || type == "mean rotation";
    }



    // What the entry Free takes away.
    void
    read_free(const JointParameters &parameters,
              std::string &translations,
              std::string &rotations)
    {
      for (const std::string &part :
           Utilities::split_string_list(parameters.free, ','))
        {
          const bool rotation     = (part.rfind("rotation ", 0) == 0);
          const std::string axis  = rotation ? part.substr(9) : part;
          std::string &candidates = rotation ? rotations : translations;
          const auto position     = candidates.find(axis);
          if (axis.size() != 1 || position == std::string::npos)
            throw InputError(parameters.section(),
                             "Free",
                             "'" + part + "'",
                             "motions that the type '" + parameters.type +
                               "' blocks: x, y, z, rotation x, rotation y, "
                               "rotation z of the joint's axes, separated by "
                               "','");
          candidates.erase(position, 1);
        }
    }



    Vector3
    parse_direction(const std::string &text, const JointParameters &parameters)
    {
      const InputError error(parameters.section(),
                             "Directions",
                             "'" + parameters.directions + "'",
                             direction_form);
      Vector3 direction;
      if (text == "x" || text == "y" || text == "z")
        {
          direction[text[0] - 'x'] = 1;
          return direction;
        }
      const auto numbers = Utilities::split_string_list(text, ',');
      if (numbers.size() != dim)
        throw error;
      try
        {
          for (unsigned int i = 0; i < dim; ++i)
            direction[i] = Utilities::string_to_double(numbers[i]);
        }
      catch (const std::exception &)
        {
          throw error;
        }
      if (!(direction.norm() > 0) || !std::isfinite(direction.norm()))
        throw error;
      return direction / direction.norm();
    }



    std::vector<Vector3>
    select(const std::array<Vector3, dim> &axes, const std::string &letters)
    {
      std::vector<Vector3> result;
      for (const char letter : letters)
        result.push_back(axes[letter - 'x']);
      return result;
    }
  } // namespace



  void
  JointParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Type",
      type,
      "What the joint blocks. 'spherical': the relative mean position of the "
      "two surfaces; 'revolute': that and every rotation but that about Axis; "
      "'cylindrical': as revolute, but free along Axis; 'prismatic': free "
      "along Axis only; 'fixed': relative mean position and mean rotation; "
      "'universal': mean position and the angle between Axis (of the first "
      "side) and Cross axis (of the second); 'point on line': mean position "
      "across Axis; 'point on plane': mean position along Axis, the normal; "
      "'planar': that and rotations across Axis; 'distance': the distance of "
      "the mean positions; 'mean position' or 'mean rotation': in the chosen "
      "Directions. Units: none.",
      Patterns::Selection("spherical|revolute|cylindrical|prismatic|fixed|"
                          "universal|point on line|point on plane|planar|"
                          "distance|mean position|mean rotation"));
    prm.add_parameter("Between",
                      between,
                      "The two sides of the joint, 'BODY: SURFACE, BODY: "
                      "SURFACE' or 'BODY: SURFACE, ground'; axes turn with the "
                      "second side; required. Units: none.");
    prm.add_parameter("Directions",
                      directions,
                      "Directions or axes of the types 'mean position' and "
                      "'mean rotation' in the world: " +
                        std::string(direction_form) +
                        "; all three if nothing is given. Units: none.");
    prm.add_parameter("Axis",
                      axis,
                      "Axis of the joint at the start, in world axes: the z "
                      "axis of the joint. Units: none.");
    prm.add_parameter("Cross axis",
                      cross_axis,
                      "Direction of the x axis of the joint, or the second "
                      "axis of a universal joint, at the start, in world axes; "
                      "chosen if nothing is given. Units: none.");
    prm.add_parameter("Free",
                      free,
                      "Motions which the type blocks and which are left free, "
                      "in the joint's axes, for example 'y, rotation x'; the "
                      "joint's axes are those of the world unless there is an "
                      "Axis. Units: none.");
    prm.declare_entry(
      "Offset",
      "none",
      Patterns::Selection("none|keep"),
      "Whether the mean positions of two surfaces must coincide at the start "
      "('none') or keep their distance, which turns with the second side "
      "('keep'). Units: none.");
    prm.add_action("Offset", [this](const std::string &value) {
      keep_offset = (value == "keep");
    });
    prm.add_parameter("Angle",
                      angle,
                      "Prescribed angle about Axis of the first side relative "
                      "to the second, a function of the time t that starts at "
                      "zero. Units: rad.");
    prm.add_parameter("Angular velocity",
                      angular_velocity,
                      "Prescribed angular velocity about Axis of the first "
                      "side relative to the second, a function of the time t. "
                      "Units: rad/s.");
    prm.add_parameter("Displacement",
                      displacement,
                      "Prescribed displacement from the start, a function of "
                      "the time t: along Axis if that is free; or three "
                      "functions separated by ';' for a motion of the blocked "
                      "position in world axes. Units: m.");
    prm.add_parameter("Position",
                      position,
                      "Prescribed mean position of the first side in the "
                      "world, three functions of the time t separated by ';'. "
                      "Units: m.");
    prm.add_parameter("Length",
                      length,
                      "Prescribed distance of a joint of the type 'distance', "
                      "a function of the time t; the distance at the start if "
                      "nothing is given. Units: m.");
  }



  namespace
  {
    // An entry that the type of the joint does not use.
    InputError
    unused(const JointParameters &parameters,
           const std::string &entry,
           const std::string &found,
           const std::string &reason)
    {
      return InputError(parameters.section(),
                        entry,
                        found,
                        "nothing for the type '" + parameters.type + "'; " +
                          reason);
    }



    void
    check_axes(const JointParameters &p)
    {
      InputProblems problems;
      const JointType &kind = joint_types.at(p.type);
      if (!uses_directions(p.type) && !p.directions.empty())
        problems.add(
          unused(p,
                 "Directions",
                 "'" + p.directions + "'",
                 "directions belong to 'mean position' and 'mean rotation'"));
      if (kind.has_axis && !(p.axis.norm() > 0))
        problems.add(
          InputError(p.section(),
                     "Axis",
                     "nothing or the zero vector",
                     "the direction of the axis of the " + p.type + " joint"));
      if (!kind.has_axis && p.axis.norm() > 0)
        problems.add(
          unused(p,
                 "Axis",
                 "a vector",
                 "an axis belongs to 'revolute', 'cylindrical', 'prismatic', "
                 "'universal', 'planar' and points on lines and planes"));
      if (!kind.has_axis && p.cross_axis.norm() > 0)
        problems.add(unused(
          p, "Cross axis", "a vector", "it belongs to types with an axis"));
      if (p.type == "universal" && !(p.cross_axis.norm() > 0))
        problems.add(InputError(p.section(),
                                "Cross axis",
                                "nothing or the zero vector",
                                "the second axis of the universal joint"));
      if (p.axis.norm() > 0 && p.cross_axis.norm() > 0)
        {
          const double cosine = std::abs(p.axis * p.cross_axis) /
                                p.axis.norm() / p.cross_axis.norm();
          if (!(cosine <= (p.type == "universal" ? 1e-8 : 1 - 1e-8)))
            problems.add(InputError(p.section(),
                                    "Cross axis",
                                    "a vector that is not across the axis",
                                    "a vector perpendicular to the axis"));
        }
      if ((uses_directions(p.type) || p.type == "distance") && !p.free.empty())
        problems.add(
          unused(p, "Free", "'" + p.free + "'", "choose its Directions"));
      problems.throw_all();
    }



    // The expressions by themselves.
    void
    check_functions(const JointParameters &p, InputProblems &problems)
    {
      const auto check = [&](const std::string &entry,
                             const std::string &text,
                             const bool is_vector) {
        if (!text.empty())
          problems.attempt([&]() {
            if (is_vector)
              parse_time_vector(text, p.section(), entry);
            else
              TimeFunction(text, p.section(), entry);
          });
      };
      check("Angle", p.angle, false);
      check("Angular velocity", p.angular_velocity, false);
      check("Displacement",
            p.displacement,
            p.displacement.find(';') != std::string::npos);
      check("Position", p.position, true);
      check("Length", p.length, false);
    }



    void
    check_drives(const JointParameters &p)
    {
      const JointType &kind    = joint_types.at(p.type);
      std::string translations = kind.translations, rotations = kind.rotations;
      read_free(p, translations, rotations);
      InputProblems problems;
      const bool turns = (rotations == "xy");
      if (!p.angle.empty() && !p.angular_velocity.empty())
        problems.add(InputError(p.section(),
                                "Angular velocity",
                                "'" + p.angular_velocity + "' beside an Angle",
                                "one of the two"));
      if ((!p.angle.empty() || !p.angular_velocity.empty()) &&
          (!turns || !kind.has_axis))
        problems.add(unused(p,
                            p.angle.empty() ? "Angular velocity" : "Angle",
                            "a prescribed rotation",
                            "it needs an axis about which the joint is free"));
      if (!p.displacement.empty() && !p.drives_the_ground() &&
          (!kind.has_axis || translations != "xy"))
        problems.add(
          unused(p,
                 "Displacement",
                 "'" + p.displacement + "'",
                 "one function needs an axis along which the joint is free, "
                 "three functions move a blocked position"));
      if (p.drives_the_ground() && translations.empty() &&
          p.type != "mean position")
        problems.add(unused(p,
                            p.position.empty() ? "Displacement" : "Position",
                            "a prescribed motion",
                            "it needs a blocked position"));
      if (!p.position.empty() && !p.displacement.empty())
        problems.add(InputError(p.section(),
                                "Position",
                                "'" + p.position + "' beside a Displacement",
                                "one of the two"));
      if (!p.length.empty() && p.type != "distance")
        problems.add(unused(
          p, "Length", "'" + p.length + "'", "it belongs to 'distance'"));
      // functions that do not belong here are no further problem
      if (problems.empty())
        check_functions(p, problems);
      problems.throw_all();
    }
  } // namespace



  void
  JointParameters::check() const
  {
    InputProblems problems;
    problems.attempt([&]() { check_axes(*this); });
    problems.attempt([&]() { check_drives(*this); });
    problems.attempt([&]() { direction_vectors(); });
    problems.throw_all();
  }



  bool
  JointParameters::drives_the_ground() const
  {
    return !position.empty() || displacement.find(';') != std::string::npos;
  }



  std::vector<Vector3>
  JointParameters::direction_vectors() const
  {
    std::vector<Vector3> vectors;
    if (directions.empty())
      for (unsigned int i = 0; i < dim; ++i)
        {
          vectors.emplace_back();
          vectors.back()[i] = 1;
        }
    else
      {
        const bool letters =
          directions.find_first_of("xyz") != std::string::npos;
        for (const std::string &part :
             Utilities::split_string_list(directions, letters ? ',' : ';'))
          vectors.push_back(parse_direction(part, *this));
      }

    Eigen::MatrixXd matrix(dim, vectors.size());
    for (unsigned int k = 0; k < vectors.size(); ++k)
      for (unsigned int i = 0; i < dim; ++i)
        matrix(i, k) = vectors[k][i];
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(1e-8);
    if (decomposition.compute(matrix).rank() !=
        static_cast<long>(vectors.size()))
      throw InputError(section(),
                       "Directions",
                       "'" + directions + "'",
                       direction_form);
    return vectors;
  }



  std::array<Vector3, dim>
  JointParameters::joint_axes() const
  {
    std::array<Vector3, dim> axes;
    if (axis.norm() > 0)
      {
        axes[2]   = axis / axis.norm();
        Vector3 x = cross_axis - (cross_axis * axes[2]) * axes[2];
        if (x.norm() > 0)
          axes[0] = x / x.norm();
        else
          axes[0] = perpendicular(axes[2])[0];
        axes[1] = cross_product_3d(axes[2], axes[0]);
      }
    else
      for (unsigned int i = 0; i < dim; ++i)
        axes[i][i] = 1;
    return axes;
  }



  std::vector<Vector3>
  JointParameters::blocked_translations() const
  {
    if (type == "mean position")
      return direction_vectors();
    std::string translations = joint_types.at(type).translations;
    std::string rotations    = joint_types.at(type).rotations;
    read_free(*this, translations, rotations);
    // the world's axes, if that makes no difference
    if (translations == "xyz")
      return {Vector3({1, 0, 0}), Vector3({0, 1, 0}), Vector3({0, 0, 1})};
    return select(joint_axes(), translations);
  }



  std::vector<Vector3>
  JointParameters::blocked_rotations() const
  {
    if (type == "mean rotation")
      return direction_vectors();
    std::string translations = joint_types.at(type).translations;
    std::string rotations    = joint_types.at(type).rotations;
    read_free(*this, translations, rotations);
    return select(joint_axes(), rotations);
  }
} // namespace ACF
