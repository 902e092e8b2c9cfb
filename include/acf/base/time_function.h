// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_time_function_h
#define acf_base_time_function_h

#include <acf/base/types.h>

#include <memory>
#include <string>
#include <vector>

namespace dealii
{
  template <int>
  class FunctionParser;
}

namespace ACF
{
  /**
   * A function of time t (s) from an expression of a model file, evaluated by
   * muParser through deal.II. Knows pi.
   */
  class TimeFunction
  {
  public:
    /** A constant. */
    TimeFunction(const double value = 0);

    /**
     * @param section, entry where the expression stands, for messages
     * @throws InputError if it is no expression of t
     */
    TimeFunction(const std::string &expression,
                 const std::string &section,
                 const std::string &entry);

    /** @throws SimulationError if the value is not finite */
    double
    operator()(const double t) const;

    /**
     * First derivative, from differences of fourth order with the spacing
     * h = 1e-4 (1 + |t|) s, one-sided where they would reach before t = 0.
     */
    double
    derivative(const double t) const;

    bool
    is_constant() const
    {
      return !parser;
    }

  private:
    double constant;
    std::string description;
    std::shared_ptr<const FunctionParser<1>> parser;
  };

  /** Three functions of time, "x; y; z". */
  using TimeVectorFunction = std::vector<TimeFunction>;

  /** @throws InputError unless there are three expressions separated by ';' */
  TimeVectorFunction
  parse_time_vector(const std::string &text,
                    const std::string &section,
                    const std::string &entry);

  Vector3
  evaluate(const TimeVectorFunction &function, const double t);

  Vector3
  evaluate_derivative(const TimeVectorFunction &function, const double t);



  /**
   * $\int_0^t f\, dt'$ by Gauss quadrature with six points on intervals of one
   * length, of which the sums are kept.
   */
  class TimeIntegral
  {
  public:
    /** @param interval length of the intervals, s */
    TimeIntegral(const TimeFunction &function, const double interval);

    double
    operator()(const double t) const;

  private:
    double
    integrate(const double from, const double to) const;

    TimeFunction function;
    double interval;
    mutable std::vector<double> sums{0.};
  };



  /**
   * A vector field of the coordinates x, y, z (m) from three expressions
   * separated by ';'.
   */
  class VectorField
  {
  public:
    VectorField() = default;

    /** An empty text is a field that is zero. @throws InputError */
    VectorField(const std::string &text,
                const std::string &section,
                const std::string &entry);

    bool
    is_zero() const
    {
      return parsers.empty();
    }

    /** @throws SimulationError if the value is not finite */
    Vector3
    operator()(const Vector3 &position) const;

  private:
    std::string description;
    std::vector<std::shared_ptr<const FunctionParser<dim>>> parsers;
  };
} // namespace ACF

#endif
