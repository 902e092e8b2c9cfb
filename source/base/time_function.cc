// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/base/parameter_patterns.h>
#include <acf/base/time_function.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

namespace ACF
{
  namespace
  {
    // Of several values, as in '1,5', muParser would take the last one.
    bool
    has_several_values(const std::string &expression)
    {
      int depth = 0;
      for (const char c : expression)
        {
          depth += (c == '(') - (c == ')');
          if (c == ',' && depth == 0)
            return true;
        }
      return false;
    }



    // deal.II prints what is wrong with an expression to std::cerr before it
    // throws: catches that text.
    class ParserMessage
    {
    public:
      ParserMessage()
        : former(std::cerr.rdbuf(stream.rdbuf()))
      {}

      ParserMessage(const ParserMessage &) = delete;
      ParserMessage &
      operator=(const ParserMessage &) = delete;

      ~ParserMessage()
      {
        std::cerr.rdbuf(former);
      }

      // " (reason)", from a line "Message:  <reason>"; muParser names the
      // position in most of them.
      std::string
      reason() const
      {
        const std::string text  = stream.str();
        const std::size_t begin = text.find('<', text.find("Message:"));
        const std::size_t end   = text.find(">\n", begin);
        return end == std::string::npos
                 ? ""
                 : " (" + text.substr(begin + 1, end - begin - 1) + ")";
      }

    private:
      std::ostringstream stream;
      std::streambuf *const former;
    };



    template <int d>
    std::shared_ptr<const FunctionParser<d>>
    make_parser(const std::string &variables,
                const std::string &expression,
                const std::string &section,
                const std::string &entry,
                const std::string &allowed)
    {
      const auto parser = std::make_shared<FunctionParser<d>>();
      const ParserMessage message;
      try
        {
          if (Utilities::trim(expression).empty())
            throw std::invalid_argument("empty");
          if (has_several_values(expression))
            throw std::invalid_argument("several values");
          parser->initialize(variables, expression, {{"pi", numbers::PI}});
          parser->value(Point<d>()); // errors may wait for the first evaluation
        }
      catch (const std::exception &)
        {
          throw InputError(section,
                           entry,
                           in_quotes(expression) + message.reason(),
                           allowed);
        }
      return parser;
    }



    // Whether a text is one number.
    bool
    parse_number(const std::string &text, double &value)
    {
      try
        {
          value = Utilities::string_to_double(Utilities::trim(text));
          return std::isfinite(value);
        }
      catch (const std::exception &)
        {
          return false;
        }
    }



    std::vector<std::string>
    split_three(const std::string &text,
                const std::string &section,
                const std::string &entry,
                const std::string &allowed)
    {
      const auto parts = Utilities::split_string_list(text, ';');
      if (parts.size() != dim)
        throw InputError(section, entry, "'" + text + "'", allowed);
      return parts;
    }
  } // namespace



  TimeFunction::TimeFunction(const double value)
    : constant(value)
  {}



  TimeFunction::TimeFunction(const std::string &expression,
                             const std::string &section,
                             const std::string &entry)
    : constant(0)
    , description("'" + entry + "' in section '" + section + "'")
  {
    if (!parse_number(expression, constant))
      parser = make_parser<1>("t",
                              expression,
                              section,
                              entry,
                              "an expression of the time t, for example "
                              "'2*sin(3*pi*t)'");
  }



  double
  TimeFunction::operator()(const double t) const
  {
    if (!parser)
      return constant;
    const double value = parser->value(Point<1>(t));
    if (!std::isfinite(value))
      throw SimulationError("The function " + description +
                            " is not finite at time " + format_number(t) +
                            " s.");
    return value;
  }



  double
  TimeFunction::derivative(const double t) const
  {
    if (!parser)
      return 0;
    const double h        = 1e-4 * (1 + std::abs(t));
    const TimeFunction &f = *this;
    if (t < 2 * h)
      return (-25 * f(t) + 48 * f(t + h) - 36 * f(t + 2 * h) +
              16 * f(t + 3 * h) - 3 * f(t + 4 * h)) /
             (12 * h);
    return (8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) /
           (12 * h);
  }



  TimeVectorFunction
  parse_time_vector(const std::string &text,
                    const std::string &section,
                    const std::string &entry)
  {
    TimeVectorFunction result;
    for (const std::string &part :
         split_three(text,
                     section,
                     entry,
                     "three expressions of the time t separated by ';'"))
      result.emplace_back(part, section, entry);
    return result;
  }



  Vector3
  evaluate(const TimeVectorFunction &function, const double t)
  {
    AssertDimension(function.size(), dim);
    return Vector3({function[0](t), function[1](t), function[2](t)});
  }



  Vector3
  evaluate_derivative(const TimeVectorFunction &function, const double t)
  {
    AssertDimension(function.size(), dim);
    return Vector3({function[0].derivative(t),
                    function[1].derivative(t),
                    function[2].derivative(t)});
  }



  TimeIntegral::TimeIntegral(const TimeFunction &function,
                             const double interval)
    : function(function)
    , interval(interval)
  {}



  double
  TimeIntegral::integrate(const double from, const double to) const
  {
    static const QGauss<1> quadrature(6);
    double sum = 0;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      sum += quadrature.weight(q) *
             function(from + quadrature.point(q)[0] * (to - from));
    return sum * (to - from);
  }



  double
  TimeIntegral::operator()(const double t) const
  {
    if (function.is_constant())
      return function(0) * t;
    const auto n = static_cast<std::size_t>(std::max(0., t / interval));
    while (sums.size() <= n)
      sums.push_back(sums.back() + integrate((sums.size() - 1) * interval,
                                             sums.size() * interval));
    return sums[n] + integrate(n * interval, t);
  }



  VectorField::VectorField(const std::string &text,
                           const std::string &section,
                           const std::string &entry)
    : description("'" + entry + "' in section '" + section + "'")
  {
    if (Utilities::trim(text).empty())
      return;
    const std::string allowed =
      "three expressions of the coordinates x, y, z of the mesh separated by "
      "';', for example '0; 1e-3*sin(pi*y); 0'";
    for (const std::string &part : split_three(text, section, entry, allowed))
      parsers.push_back(
        make_parser<dim>("x,y,z", part, section, entry, allowed));
  }



  Vector3
  VectorField::operator()(const Vector3 &position) const
  {
    Vector3 value;
    for (unsigned int i = 0; i < parsers.size(); ++i)
      value[i] = parsers[i]->value(Point<dim>(position));
    if (!std::isfinite(value.norm()))
      throw SimulationError(
        "The field " + description + " is not finite at the point (" +
        format_number(position[0]) + ", " + format_number(position[1]) + ", " +
        format_number(position[2]) + ") m of the mesh.");
    return value;
  }
} // namespace ACF
