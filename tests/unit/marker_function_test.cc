// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/marker_function.h>

#include <cmath>

#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  constexpr unsigned int n_markers = 4;

  MarkerExpression
  constant(const Vector3 &v)
  {
    return {v, {}};
  }

  MarkerExpression
  random_expression(Random &random)
  {
    return {random.vector(1),
            {{0, random.number(1)}, {2, random.number(1)}, {3, 0.7}}};
  }

  Eigen::VectorXd
  random_values(Random &random)
  {
    Eigen::VectorXd s(dim * n_markers);
    for (double &value : s)
      value = random.number(1);
    return s;
  }

  Eigen::Vector3d
  evaluate(const MarkerExpression &expression, const Eigen::VectorXd &s)
  {
    Eigen::Vector3d v = to_eigen(expression.constant);
    for (const auto &[p, weight] : expression.terms)
      v += weight * s.segment<3>(3 * p);
    return v;
  }

  /** A polynomial of one product with its value. */
  struct Product
  {
    double coefficient;
    std::vector<MarkerExpression> factors;

    Product(const unsigned int n_factors, Random &random)
      : coefficient(random.number(2))
    {
      for (unsigned int i = 0; i < n_factors; ++i)
        factors.push_back(random_expression(random));
    }

    MarkerPolynomial
    polynomial() const
    {
      MarkerPolynomial result;
      result.add(coefficient, factors);
      return result;
    }

    double
    value(const Eigen::VectorXd &s) const
    {
      std::vector<Eigen::Vector3d> v;
      for (const MarkerExpression &factor : factors)
        v.push_back(evaluate(factor, s));
      switch (v.size())
        {
          case 0:
            return coefficient;
          case 2:
            return coefficient * v[0].dot(v[1]);
          case 3:
            return coefficient * v[0].dot(v[1].cross(v[2]));
          default:
            return coefficient * v[0].cross(v[1]).dot(v[2].cross(v[3]));
        }
    }
  };

  /** Gradient and Hessian against differences; the larger error. */
  double
  derivative_error(const MarkerFunction &function, const Eigen::VectorXd &s)
  {
    const auto value = [&](const Eigen::VectorXd &x) {
      return Eigen::VectorXd::Constant(1, function.value(x)).eval();
    };
    const auto gradient = [&](const Eigen::VectorXd &x) {
      return function.gradient(x);
    };
    return std::max(largest(difference_quotients(value, s).transpose() -
                            function.gradient(s)),
                    largest(difference_quotients(gradient, s) -
                            function.hessian(s)));
  }
} // namespace

TEST(MarkerExpression, Combinations)
{
  Random random;
  const Eigen::VectorXd s = random_values(random);
  MarkerExpression first  = random_expression(random);
  MarkerExpression second{random.vector(1), {{2, 1.5}, {1, -0.5}}};
  EXPECT_LT((to_eigen(first(s)) - evaluate(first, s)).norm(), 1e-15);

  const MarkerExpression difference = first - 3. * second;
  EXPECT_EQ(difference.terms.size(), n_markers); // one term per marker
  EXPECT_LT((to_eigen(difference(s)) - evaluate(first, s) +
             3 * evaluate(second, s))
              .norm(),
            1e-14);
  EXPECT_FALSE(difference.is_constant());
  EXPECT_TRUE(constant(Vector3({1, 2, 3})).is_constant());
}

TEST(MarkerPolynomial, Products)
{
  Random random;
  double value_error = 0, error = 0;
  for (const unsigned int n : {0, 2, 3, 4})
    for (unsigned int k = 0; k < 5; ++k)
      {
        const Product product(n, random), other(n, random);
        MarkerPolynomial sum = product.polynomial();
        sum.add(-2.5, other.polynomial());
        const Eigen::VectorXd s = random_values(random);
        value_error             = std::max(value_error,
                               std::abs(sum.value(s) - product.value(s) +
                                        2.5 * other.value(s)));
        error                   = std::max(error, derivative_error(sum, s));

        // factors and sums
        Eigen::VectorXd gradient = MarkerFunction(sum).gradient(s);
        sum.add_gradient(s, -1, gradient);
        EXPECT_LT(largest(gradient), 1e-13);
      }
  EXPECT_LT(value_error, 1e-13);
  // second differences of steps 1e-5
  EXPECT_LT(error, 1e-8);
  report("marker polynomials, values", value_error);
  report("marker polynomials, derivatives against differences", error);
}

TEST(MarkerFunction, LengthsAndAngles)
{
  Random random;
  double value_error = 0, error = 0;
  for (unsigned int k = 0; k < 10; ++k)
    {
      const Eigen::VectorXd s = random_values(random);
      MarkerExpression v      = random_expression(random);
      v.constant += Vector3({4, 0, 0});
      const MarkerFunction length = MarkerFunction::length(v);
      value_error                 = std::max(value_error,
                             std::abs(length.value(s) - evaluate(v, s).norm()));
      error = std::max(error, derivative_error(length, s));

      // not close to the origin, where angles have no derivatives
      MarkerPolynomial sine   = Product(2 + k % 3, random).polynomial();
      MarkerPolynomial cosine = Product(4 - k % 3, random).polynomial();
      sine.add(k % 2 == 0 ? 2 : -2, std::vector<MarkerExpression>());
      cosine.add(k % 4 < 2 ? 2 : -2, std::vector<MarkerExpression>());
      if (std::hypot(sine.value(s), cosine.value(s)) < 0.5)
        continue;
      const MarkerFunction angle = MarkerFunction::angle(sine, cosine);
      const double radius        = std::hypot(sine.value(s), cosine.value(s));
      value_error                = std::max(
        {value_error,
                        std::abs(radius * std::sin(angle.value(s)) - sine.value(s)),
                        std::abs(radius * std::cos(angle.value(s)) - cosine.value(s))});
      error = std::max(error, derivative_error(angle, s));
      EXPECT_TRUE(angle.is_angle());
      EXPECT_FALSE(length.is_angle());
    }
  EXPECT_LT(value_error, 1e-13);
  EXPECT_LT(error, 1e-7);
  report("lengths and angles, values", value_error);
  report("lengths and angles, derivatives against differences", error);
}

TEST(MarkerFunction, AffineOnes)
{
  Random random;
  const MarkerExpression v = random_expression(random);
  const MarkerExpression c = constant(random.vector(1));
  const auto is_affine     = [](const std::vector<MarkerExpression> &factors) {
    MarkerPolynomial polynomial;
    polynomial.add(3, factors);
    return MarkerFunction(polynomial).is_affine();
  };
  EXPECT_TRUE(is_affine({}));
  EXPECT_TRUE(is_affine({c, c}));
  EXPECT_TRUE(is_affine({v, c}));
  EXPECT_TRUE(is_affine({c, v, c}));
  EXPECT_TRUE(is_affine({c, c, c, v}));
  EXPECT_FALSE(is_affine({v, v}));
  EXPECT_FALSE(is_affine({c, v, v}));
  EXPECT_FALSE(is_affine({v, c, v, c}));
  EXPECT_FALSE(MarkerFunction::length(v).is_affine());
  MarkerPolynomial affine;
  affine.add(1, {v, c});
  EXPECT_FALSE(MarkerFunction::angle(affine, affine).is_affine());

  // one product is enough
  affine.add(1, {v, v});
  EXPECT_FALSE(affine.is_affine());
}
