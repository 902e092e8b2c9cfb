// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/time_function.h>

#include <cmath>

#include <unit/mechanics_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  TimeFunction
  function(const std::string &expression)
  {
    return TimeFunction(expression, "Section/name", "Entry");
  }

  void
  expect_simulation_error(const std::function<void()> &action,
                          const std::vector<std::string> &parts)
  {
    try
      {
        action();
        ADD_FAILURE() << "no error with " << parts.front();
      }
    catch (const SimulationError &error)
      {
        for (const std::string &part : parts)
          EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
            << "no '" << part << "' in: " << error.what();
      }
  }
} // namespace

TEST(TimeFunction, ValuesAndDerivatives)
{
  const TimeFunction f = function("2*sin(3*pi*t) + exp(-t)*t^2");
  EXPECT_FALSE(f.is_constant());
  double error = 0, derivative_error = 0;
  // one-sided differences at and near the start
  for (const double t : {0., 5e-5, 1e-4, 2.1e-4, 0.3, 1., 7.5})
    {
      const double w = 3 * numbers::PI, e = std::exp(-t);
      error = std::max(error, std::abs(f(t) - 2 * std::sin(w * t) - e * t * t));
      derivative_error =
        std::max(derivative_error,
                 std::abs(f.derivative(t) - 2 * w * std::cos(w * t) -
                          e * (2 * t - t * t)));
    }
  EXPECT_LT(error, 1e-14);
  // round-off: eps / 1e-4, times the coefficients of the one-sided formula
  EXPECT_LT(derivative_error, 1e-9);
  report("derivatives of functions of time", derivative_error);

  // nothing is asked for before the start
  const TimeFunction root = function("t^1.5*(1+t)^(-1) + if(t < 0, 1/0, 0)");
  for (const double t : {0., 1e-5, 1.9e-4})
    EXPECT_TRUE(std::isfinite(root.derivative(t)));
}

TEST(TimeFunction, Constants)
{
  for (const TimeFunction &f : {TimeFunction(-2.5), function(" -2.5e0 ")})
    {
      EXPECT_TRUE(f.is_constant());
      EXPECT_EQ(f(3), -2.5);
      EXPECT_EQ(f.derivative(3), 0);
    }
  EXPECT_EQ(TimeFunction()(1), 0);
  EXPECT_NEAR(function("pi")(0), numbers::PI, 1e-15);
}

TEST(TimeFunction, Errors)
{
  for (const std::string text :
       {"", " ", "2*x", "sin(t", "t +", "inf", "1,5", "(1,5)*t", "t, 2"})
    expect_input_error([&]() { function(text); },
                       {"Section/name", "'Entry'", "'" + text + "'", "time t"});
  const TimeFunction pole = function("1/(t-1)");
  EXPECT_NEAR(pole(2), 1, 1e-15);
  expect_simulation_error([&]() { pole(1); },
                          {"'Entry'", "'Section/name'", "time 1 s"});
}

TEST(TimeFunction, Vectors)
{
  const TimeVectorFunction f =
    parse_time_vector("t; 2 ; -t^2", "Section/name", "Entry");
  EXPECT_LT((evaluate(f, 3) - Vector3({3, 2, -9})).norm(), 1e-14);
  EXPECT_LT((evaluate_derivative(f, 3) - Vector3({1, 0, -6})).norm(), 1e-9);
  for (const std::string text : {"", "1", "1; 2", "1; 2; 3; 4", "1, 2, 3"})
    expect_input_error(
      [&]() { parse_time_vector(text, "Section/name", "Entry"); },
      {"Section/name", "'Entry'", "'" + text + "'", "three", "';'"});
  expect_input_error(
    [&]() { parse_time_vector("1; 2; y", "Section/name", "Entry"); },
    {"Section/name", "'Entry'", "'y'"});
}

TEST(TimeIntegral, AgainstAntiderivatives)
{
  double error = 0;
  TimeIntegral integral(function("sin(20*t) + 3*t^2"), 0.05);
  // backwards too: the sums of the intervals are kept
  for (const double t : {0., 1e-3, 0.05, 2., 0.731, 5.01})
    error =
      std::max(error,
               std::abs(integral(t) - (1 - std::cos(20 * t)) / 20 - t * t * t));
  // one period is 6 intervals of 12 degrees of exactness
  EXPECT_LT(error, 1e-12);
  report("integrals over time", error);
  EXPECT_NEAR(TimeIntegral(TimeFunction(3), 0.1)(2.5), 7.5, 1e-14);
}

TEST(VectorField, ValuesAndErrors)
{
  const VectorField field("x*y; z^2; pi", "Bodies/b", "Velocity field");
  EXPECT_FALSE(field.is_zero());
  EXPECT_LT((field(Vector3({2, 3, 4})) - Vector3({6, 16, numbers::PI})).norm(),
            1e-14);
  for (const std::string text : {"", "  "})
    {
      const VectorField none(text, "Bodies/b", "Velocity field");
      EXPECT_TRUE(none.is_zero());
      EXPECT_EQ(none(Vector3({1, 2, 3})).norm(), 0);
    }
  for (const std::string text : {"x; y", "x, y, z", "x; y; z; x"})
    expect_input_error(
      [&]() { VectorField(text, "Bodies/b", "Velocity field"); },
      {"Bodies/b", "'Velocity field'", "'" + text + "'", "x, y, z"});
  expect_input_error(
    [&]() { VectorField("x; y; t", "Bodies/b", "Velocity field"); },
    {"Bodies/b", "'Velocity field'", "'t'"});
  const VectorField pole("0; 1/x; 0", "Bodies/b", "Velocity field");
  expect_simulation_error(
    [&]() {
      pole(Vector3({0, 1, 2}));
    },
    {"'Velocity field'", "'Bodies/b'", "(0, 1, 2)"});
}
