// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/marker_function.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ACF
{
  namespace
  {
    // The multilinear form of a product; at most four factors.
    double
    multiply(const std::array<Vector3, 4> &v, const unsigned int n)
    {
      switch (n)
        {
          case 0:
            return 1;
          case 2:
            return v[0] * v[1];
          case 3:
            return v[0] * cross_product_3d(v[1], v[2]);
          case 4:
            return cross_product_3d(v[0], v[1]) * cross_product_3d(v[2], v[3]);
          default:
            Assert(false, ExcInternalError());
            return 0;
        }
    }



    std::array<Vector3, 4>
    evaluate(const std::vector<MarkerExpression> &factors,
             const Eigen::VectorXd &s)
    {
      std::array<Vector3, 4> values;
      for (unsigned int i = 0; i < factors.size(); ++i)
        values[i] = factors[i](s);
      return values;
    }



    Vector3
    unit_vector(const unsigned int i)
    {
      Vector3 e;
      e[i] = 1;
      return e;
    }
  } // namespace



  Vector3
  MarkerExpression::operator()(const Eigen::VectorXd &values) const
  {
    Vector3 v = constant;
    for (const auto &[p, weight] : terms)
      for (unsigned int i = 0; i < dim; ++i)
        v[i] += weight * values(dim * p + i);
    return v;
  }



  MarkerExpression &
  MarkerExpression::operator+=(const MarkerExpression &other)
  {
    constant += other.constant;
    for (const auto &term : other.terms)
      {
        const auto it =
          std::find_if(terms.begin(), terms.end(), [&](const auto &mine) {
            return mine.first == term.first;
          });
        if (it == terms.end())
          terms.push_back(term);
        else
          it->second += term.second;
      }
    return *this;
  }



  MarkerExpression
  operator*(const double factor, MarkerExpression expression)
  {
    expression.constant *= factor;
    for (auto &term : expression.terms)
      term.second *= factor;
    return expression;
  }



  MarkerExpression
  operator-(MarkerExpression first, const MarkerExpression &second)
  {
    first += -1. * second;
    return first;
  }



  void
  MarkerPolynomial::add(const double coefficient,
                        const std::vector<MarkerExpression> &factors)
  {
    AssertIndexRange(factors.size(), 5);
    products.push_back({coefficient, factors});
  }



  void
  MarkerPolynomial::add(const double coefficient, const MarkerPolynomial &other)
  {
    for (const Product &product : other.products)
      products.push_back({coefficient * product.coefficient, product.factors});
  }



  bool
  MarkerPolynomial::is_affine() const
  {
    return std::all_of(
      products.begin(), products.end(), [](const Product &product) {
        return std::count_if(product.factors.begin(),
                             product.factors.end(),
                             [](const MarkerExpression &factor) {
                               return !factor.is_constant();
                             }) <= 1;
      });
  }



  double
  MarkerPolynomial::value(const Eigen::VectorXd &s) const
  {
    double sum = 0;
    for (const Product &product : products)
      sum += product.coefficient *
             multiply(evaluate(product.factors, s), product.factors.size());
    return sum;
  }



  void
  MarkerPolynomial::add_gradient(const Eigen::VectorXd &s,
                                 const double factor,
                                 Eigen::VectorXd &gradient) const
  {
    for (const Product &product : products)
      {
        const unsigned int n = product.factors.size();
        const auto values    = evaluate(product.factors, s);
        for (unsigned int i = 0; i < n; ++i)
          if (!product.factors[i].is_constant())
            for (unsigned int c = 0; c < dim; ++c)
              {
                auto varied = values;
                varied[i]   = unit_vector(c);
                const double change =
                  factor * product.coefficient * multiply(varied, n);
                for (const auto &[p, weight] : product.factors[i].terms)
                  gradient(dim * p + c) += weight * change;
              }
      }
  }



  void
  MarkerPolynomial::add_hessian(const Eigen::VectorXd &s,
                                const double factor,
                                Eigen::MatrixXd &hessian) const
  {
    for (const Product &product : products)
      {
        const unsigned int n = product.factors.size();
        const auto values    = evaluate(product.factors, s);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            {
              if (i == j || product.factors[i].is_constant() ||
                  product.factors[j].is_constant())
                continue;
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    auto varied = values;
                    varied[i]   = unit_vector(c);
                    varied[j]   = unit_vector(d);
                    const double change =
                      factor * product.coefficient * multiply(varied, n);
                    for (const auto &[p, weight] : product.factors[i].terms)
                      for (const auto &[q, other] : product.factors[j].terms)
                        hessian(dim * p + c, dim * q + d) +=
                          weight * other * change;
                  }
            }
      }
  }



  MarkerFunction::MarkerFunction(const MarkerPolynomial &polynomial)
    : first(polynomial)
  {}



  MarkerFunction
  MarkerFunction::length(const MarkerExpression &v)
  {
    MarkerFunction function;
    function.kind = Kind::length;
    function.first.add(1, {v, v});
    return function;
  }



  MarkerFunction
  MarkerFunction::angle(const MarkerPolynomial &sine,
                        const MarkerPolynomial &cosine)
  {
    MarkerFunction function;
    function.kind   = Kind::angle;
    function.first  = cosine;
    function.second = sine;
    return function;
  }



  double
  MarkerFunction::value(const Eigen::VectorXd &s) const
  {
    switch (kind)
      {
        case Kind::length:
          return std::sqrt(first.value(s));
        case Kind::angle:
          return std::atan2(second.value(s), first.value(s));
        default:
          return first.value(s);
      }
  }



  Eigen::VectorXd
  MarkerFunction::gradient(const Eigen::VectorXd &s) const
  {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(s.size());
    if (kind == Kind::polynomial)
      first.add_gradient(s, 1, result);
    else if (kind == Kind::length)
      first.add_gradient(s, 0.5 / value(s), result);
    else
      {
        const double P = first.value(s), Q = second.value(s);
        const double r2 = P * P + Q * Q;
        second.add_gradient(s, P / r2, result);
        first.add_gradient(s, -Q / r2, result);
      }
    return result;
  }



  Eigen::MatrixXd
  MarkerFunction::hessian(const Eigen::VectorXd &s) const
  {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(s.size(), s.size());
    if (kind == Kind::polynomial)
      first.add_hessian(s, 1, result);
    else if (kind == Kind::length)
      {
        const double length       = value(s);
        const Eigen::VectorXd own = gradient(s);
        first.add_hessian(s, 0.5 / length, result);
        result -= own * own.transpose() / length;
      }
    else
      {
        const double P = first.value(s), Q = second.value(s);
        const double r2    = P * P + Q * Q;
        Eigen::VectorXd dP = Eigen::VectorXd::Zero(s.size()), dQ = dP;
        first.add_gradient(s, 1, dP);
        second.add_gradient(s, 1, dQ);
        second.add_hessian(s, P / r2, result);
        first.add_hessian(s, -Q / r2, result);
        const Eigen::VectorXd change = (P * dQ - Q * dP) / r2;
        const Eigen::VectorXd growth = (P * dP + Q * dQ) / r2;
        result -= change * growth.transpose() + growth * change.transpose();
      }
    return result;
  }
} // namespace ACF
