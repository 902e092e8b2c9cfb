// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/input_problems.h>
#include <acf/mechanics/force_elements.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>

namespace ACF
{
  void
  ForceElementParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Type",
      type,
      "'spring-damper': along the line between the mean positions of two "
      "surfaces; 'torsional spring': about Axis; 'bushing': along and about "
      "three axes. Units: none.",
      Patterns::Selection("spring-damper|torsional spring|bushing"));
    prm.add_parameter("Between",
                      between,
                      "The two sides, 'BODY: SURFACE, BODY: SURFACE' or 'BODY: "
                      "SURFACE, ground'; axes turn with the second side; "
                      "required. Units: none.");
    prm.add_parameter("Stiffness",
                      stiffness,
                      "Stiffness; of a bushing six numbers, along and about "
                      "its axes x, y, z. Units: N/m, N m/rad.",
                      Patterns::List(Patterns::Double(0), 0, 2 * dim));
    prm.add_parameter("Damping",
                      damping,
                      "Damping coefficient; of a bushing six numbers, along "
                      "and about its axes x, y, z. Units: N s/m, N m s/rad.",
                      Patterns::List(Patterns::Double(0), 0, 2 * dim));
    prm.add_parameter("Free length",
                      free_length,
                      "Length at which a spring-damper has no spring force; "
                      "negative: its length at the start. Units: m.");
    prm.add_parameter("Free angle",
                      free_angle,
                      "Angle of the first side relative to the second at which "
                      "a torsional spring has no moment. Units: rad.");
    prm.add_parameter("Ground point",
                      ground_point,
                      "Where a spring-damper from the ground is attached to "
                      "the ground. Units: m.",
                      Patterns::List(Patterns::Double(), 0, dim));
    prm.add_parameter("Axis",
                      axis,
                      "Axis of a torsional spring, or z axis of a bushing, at "
                      "the start in world axes. Units: none.");
    prm.add_parameter("Actuation",
                      actuation,
                      "Additional force of a spring-damper (positive: pushes) "
                      "or moment of a torsional spring on the first side, a "
                      "function of the time t. Units: N or N m.");
  }



  void
  ForceElementParameters::check() const
  {
    InputProblems problems;
    const bool is_bushing = (type == "bushing");
    const bool is_spring  = (type == "spring-damper");
    const auto count      = [&](const std::string &entry,
                           const std::vector<double> &numbers) {
      const unsigned int n = is_bushing ? 2 * dim : 1;
      if (!numbers.empty() && numbers.size() != n)
        problems.add(InputError(section(),
                                entry,
                                std::to_string(numbers.size()) + " numbers",
                                std::to_string(n) +
                                  (n == 1 ? " number for" : " numbers for") +
                                  " the type '" + type + "'"));
    };
    count("Stiffness", stiffness);
    count("Damping", damping);
    if (stiffness.empty() && damping.empty() && actuation.empty())
      problems.add(InputError(section(),
                              "Stiffness",
                              "nothing",
                              "a Stiffness, a Damping or an Actuation"));
    if (type == "torsional spring" && !(axis.norm() > 0))
      problems.add(InputError(section(),
                              "Axis",
                              "nothing or the zero vector",
                              "the axis of the torsional spring"));
    const auto refuse = [&](const std::string &entry, const bool given) {
      if (given)
        problems.add(InputError(
          section(), entry, "a value", "nothing for the type '" + type + "'"));
    };
    refuse("Axis", is_spring && axis.norm() > 0);
    refuse("Free length", !is_spring && free_length >= 0);
    refuse("Free angle", type != "torsional spring" && free_angle != 0);
    refuse("Ground point", !is_spring && !ground_point.empty());
    refuse("Actuation", is_bushing && !actuation.empty());
    if (!ground_point.empty() && ground_point.size() != dim)
      problems.add(InputError(section(),
                              "Ground point",
                              std::to_string(ground_point.size()) + " numbers",
                              "three numbers"));
    if (!actuation.empty())
      problems.attempt(
        [&]() { TimeFunction(actuation, section(), "Actuation"); });
    problems.throw_all();
  }



  bool
  ForceElement::is_damped() const
  {
    return std::any_of(laws.begin(), laws.end(), [](const Law &law) {
      return law.damping > 0;
    });
  }



  Eigen::VectorXd
  ForceElement::values(const Eigen::VectorXd &s) const
  {
    Eigen::VectorXd y(laws.size());
    for (unsigned int k = 0; k < laws.size(); ++k)
      y(k) = laws[k].function.value(s);
    return y;
  }



  double
  ForceElement::generalized_force(const Law &law,
                                  const double t,
                                  const double y,
                                  const double y_dot,
                                  const double actuation_factor) const
  {
    return -law.stiffness * (y - law.free_value) - law.damping * y_dot +
           actuation_factor * law.actuation(t);
  }



  Eigen::VectorXd
  ForceElement::force(const double t,
                      const Eigen::VectorXd &s,
                      const Eigen::VectorXd &v,
                      const Eigen::VectorXd &y,
                      const double actuation_factor) const
  {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(s.size());
    for (unsigned int k = 0; k < laws.size(); ++k)
      {
        const Eigen::VectorXd gradient = laws[k].function.gradient(s);
        const double y_dot = laws[k].damping > 0 ? gradient.dot(v) : 0.;
        result += generalized_force(laws[k], t, y(k), y_dot, actuation_factor) *
                  gradient;
      }
    return result;
  }



  Eigen::MatrixXd
  ForceElement::stiffness(const double t,
                          const Eigen::VectorXd &s,
                          const Eigen::VectorXd &v,
                          const Eigen::VectorXd &y,
                          const double actuation_factor) const
  {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(s.size(), s.size());
    for (unsigned int k = 0; k < laws.size(); ++k)
      {
        const Eigen::VectorXd gradient = laws[k].function.gradient(s);
        result += laws[k].stiffness * gradient * gradient.transpose();
        if (laws[k].function.is_affine())
          continue;
        const Eigen::MatrixXd hessian = laws[k].function.hessian(s);
        const double y_dot = laws[k].damping > 0 ? gradient.dot(v) : 0.;
        result -= generalized_force(laws[k], t, y(k), y_dot, actuation_factor) *
                  hessian;
        if (laws[k].damping > 0)
          result += laws[k].damping * gradient * (hessian * v).transpose();
      }
    return result;
  }



  Eigen::MatrixXd
  ForceElement::damping(const Eigen::VectorXd &s) const
  {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(s.size(), s.size());
    for (const Law &law : laws)
      if (law.damping > 0)
        {
          const Eigen::VectorXd gradient = law.function.gradient(s);
          result += law.damping * gradient * gradient.transpose();
        }
    return result;
  }



  double
  ForceElement::energy(const Eigen::VectorXd &y) const
  {
    double sum = 0;
    for (unsigned int k = 0; k < laws.size(); ++k)
      sum += 0.5 * laws[k].stiffness * std::pow(y(k) - laws[k].free_value, 2);
    return sum;
  }



  namespace
  {
    void
    add_spring(ForceElement &element,
               const ForceElementParameters &parameters,
               const std::array<JointSide, 2> &sides)
    {
      const auto has_ground = [&](const unsigned int k) {
        return sides[k].is_ground();
      };
      if ((has_ground(0) || has_ground(1)) == parameters.ground_point.empty())
        throw InputError(parameters.section(),
                         "Ground point",
                         parameters.ground_point.empty() ? "nothing"
                                                         : "a point",
                         "a point if, and only if, one side is the ground");
      const auto position = [&](const JointSide &side) {
        if (!side.is_ground())
          return side.position(element.markers);
        const auto &point = parameters.ground_point;
        return MarkerExpression{Vector3({point[0], point[1], point[2]}), {}};
      };
      const auto start = [&](const JointSide &side) {
        return side.is_ground() ? position(side).constant
                                : side.start_position();
      };
      const double length = (start(sides[0]) - start(sides[1])).norm();
      if (!(length > 1e-8 * std::max(sides[0].length(), sides[1].length())))
        throw InputError(parameters.section(),
                         "Between",
                         "a spring-damper without length at the start",
                         "mean positions at a distance, or a bushing");
      ForceElement::Law law;
      law.function =
        MarkerFunction::length(position(sides[0]) - position(sides[1]));
      law.free_value =
        parameters.free_length < 0 ? length : parameters.free_length;
      element.laws.push_back(law);
    }



    void
    add_bushing(ForceElement &element,
                const ForceElementParameters &parameters,
                const std::array<JointSide, 2> &sides)
    {
      JointParameters frame;
      frame.axis      = parameters.axis;
      const auto axes = frame.joint_axes();
      const bool between_bodies =
        !sides[0].is_ground() && !sides[1].is_ground();
      for (unsigned int k = 0; k < 2 * dim; ++k)
        {
          ForceElement::Law law;
          if (k < dim)
            {
              law.function = relative_displacement(element.markers,
                                                   sides[0],
                                                   sides[1],
                                                   axes[k]);
              if (between_bodies)
                law.free_value = axes[k] * (sides[0].start_position() -
                                            sides[1].start_position());
            }
          else
            law.function = relative_rotation(element.markers,
                                             sides[0],
                                             sides[1],
                                             axes[k - dim]);
          element.laws.push_back(law);
        }
    }
  } // namespace



  ForceElement
  make_force_element(const ForceElementParameters &parameters,
                     const std::vector<Body> &bodies)
  {
    ForceElement element;
    element.name    = parameters.name;
    element.section = parameters.section();
    const auto sides =
      parse_sides(parameters.between, bodies, parameters.section());
    if (parameters.type == "spring-damper")
      add_spring(element, parameters, sides);
    else if (parameters.type == "bushing")
      add_bushing(element, parameters, sides);
    else
      {
        ForceElement::Law law;
        law.function   = relative_angle(element.markers,
                                      sides[0],
                                      sides[1],
                                      parameters.axis / parameters.axis.norm());
        law.free_value = parameters.free_angle;
        element.laws.push_back(law);
      }
    for (unsigned int k = 0; k < element.laws.size(); ++k)
      {
        if (!parameters.stiffness.empty())
          element.laws[k].stiffness = parameters.stiffness[k];
        if (!parameters.damping.empty())
          element.laws[k].damping = parameters.damping[k];
      }
    if (!parameters.actuation.empty())
      element.laws[0].actuation =
        TimeFunction(parameters.actuation, parameters.section(), "Actuation");
    return element;
  }
} // namespace ACF
