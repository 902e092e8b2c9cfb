// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_marker_function_h
#define acf_mechanics_marker_function_h

#include <acf/base/types.h>

#include <Eigen/Dense>

#include <utility>
#include <vector>

namespace ACF
{
  /**
   * An affine combination of marker values, $v(s) = v_0 + \sum_k w_k s_{p_k}$.
   * A marker is a vector-valued functional of a body's positions: the mean
   * position of a surface or one of its directors.
   */
  struct MarkerExpression
  {
    Vector3 constant;

    /** Pairs $(p_k, w_k)$. */
    std::vector<std::pair<unsigned int, double>> terms;

    /** @param values $s_0, s_1, ...$, three components each */
    Vector3
    operator()(const Eigen::VectorXd &values) const;

    bool
    is_constant() const
    {
      return terms.empty();
    }

    MarkerExpression &
    operator+=(const MarkerExpression &other);
  };

  MarkerExpression
  operator*(const double factor, MarkerExpression expression);

  MarkerExpression
  operator-(MarkerExpression first, const MarkerExpression &second);



  /**
   * A sum of products of marker expressions. With two factors a product is
   * $a \cdot b$, with three $a \cdot (b \times c)$, with four
   * $(a \times b) \cdot (c \times d)$; with none it is a number.
   */
  class MarkerPolynomial
  {
  public:
    void
    add(const double coefficient, const std::vector<MarkerExpression> &factors);

    void
    add(const double coefficient, const MarkerPolynomial &other);

    /** Whether its gradient is constant. */
    bool
    is_affine() const;

    double
    value(const Eigen::VectorXd &s) const;

    /** Adds factor times the gradient, size of s. */
    void
    add_gradient(const Eigen::VectorXd &s,
                 const double factor,
                 Eigen::VectorXd &gradient) const;

    /** Adds factor times the second derivative. */
    void
    add_hessian(const Eigen::VectorXd &s,
                const double factor,
                Eigen::MatrixXd &hessian) const;

  private:
    struct Product
    {
      double coefficient;
      std::vector<MarkerExpression> factors;
    };

    std::vector<Product> products;
  };



  /**
   * A scalar function of marker values: what a joint keeps at zero, what a
   * spring lengthens, what a probe shows. One of a polynomial P, a length
   * $\sqrt P$ (m), or the angle $\mathrm{atan2}(Q, P)$ (rad).
   */
  class MarkerFunction
  {
  public:
    enum class Kind
    {
      polynomial,
      length,
      angle
    };

    MarkerFunction() = default;

    /** P */
    MarkerFunction(const MarkerPolynomial &polynomial);

    /** $|v|$ */
    static MarkerFunction
    length(const MarkerExpression &v);

    /** $\mathrm{atan2}(Q, P)$ */
    static MarkerFunction
    angle(const MarkerPolynomial &sine, const MarkerPolynomial &cosine);

    bool
    is_affine() const
    {
      return kind == Kind::polynomial && first.is_affine();
    }

    bool
    is_angle() const
    {
      return kind == Kind::angle;
    }

    double
    value(const Eigen::VectorXd &s) const;

    /**
     * @pre lengths are not zero
     */
    Eigen::VectorXd
    gradient(const Eigen::VectorXd &s) const;

    Eigen::MatrixXd
    hessian(const Eigen::VectorXd &s) const;

  private:
    Kind kind = Kind::polynomial;

    /** P */
    MarkerPolynomial first;

    /** Q */
    MarkerPolynomial second;
  };
} // namespace ACF

#endif
