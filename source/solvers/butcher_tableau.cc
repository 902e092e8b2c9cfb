// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/butcher_tableau.h>

#include <deal.II/base/exceptions.h>

#include <cmath>

namespace ACF
{
  using namespace dealii;

  namespace
  {
    // a_ij = int_0^c_i l_j: solve sum_j a_ij c_j^(k-1) = c_i^k / k.
    Eigen::MatrixXd
    collocation_coefficients(const Eigen::VectorXd &c)
    {
      const unsigned int s = c.size();
      Eigen::MatrixXd moments(s, s), integrals(s, s);
      for (unsigned int i = 0; i < s; ++i)
        for (unsigned int k = 0; k < s; ++k)
          {
            moments(i, k)   = std::pow(c(i), k);
            integrals(i, k) = std::pow(c(i), k + 1) / (k + 1);
          }
      return integrals * moments.inverse();
    }
  } // namespace



  ButcherTableau
  radau_iia(const unsigned int n_stages)
  {
    AssertThrow(n_stages >= 1 && n_stages <= 3, ExcNotImplemented());
    ButcherTableau tableau;
    tableau.c.resize(n_stages);
    const double root = std::sqrt(6.);
    if (n_stages == 1)
      tableau.c << 1;
    else if (n_stages == 2)
      tableau.c << 1. / 3, 1;
    else
      tableau.c << (4 - root) / 10, (4 + root) / 10, 1;
    tableau.A = collocation_coefficients(tableau.c);
    return tableau;
  }



  StageDiagonalization
  diagonalize_stages(const ButcherTableau &tableau)
  {
    const Eigen::MatrixXd inverse = tableau.A.inverse();
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(inverse * inverse);
    const Eigen::MatrixXcd T         = solver.eigenvectors();
    const Eigen::MatrixXcd T_inverse = T.inverse();

    StageDiagonalization result;
    for (unsigned int k = 0; k < tableau.n_stages(); ++k)
      {
        const std::complex<double> d = solver.eigenvalues()(k);
        if (d.imag() < 0)
          continue; // its conjugate is kept
        StageDiagonalization::Component component;
        component.eigenvalue = d;
        for (unsigned int i = 0; i < tableau.n_stages(); ++i)
          {
            component.to_stages.push_back(T(i, k));
            component.from_stages.push_back(T_inverse(k, i));
          }
        result.components.push_back(component);
      }
    return result;
  }



  StageTriangularization
  triangularize_stages(const ButcherTableau &tableau)
  {
    const unsigned int s  = tableau.n_stages();
    Eigen::MatrixXd upper = tableau.A * tableau.A;
    StageTriangularization result;
    result.lower = Eigen::MatrixXd::Identity(s, s);
    for (unsigned int k = 0; k < s; ++k)
      for (unsigned int i = k + 1; i < s; ++i)
        {
          result.lower(i, k) = upper(i, k) / upper(k, k);
          upper.row(i) -= result.lower(i, k) * upper.row(k);
        }
    result.diagonal = upper.diagonal();
    result.increments =
      tableau.A * tableau.A * result.diagonal.cwiseInverse().asDiagonal();
    return result;
  }



  std::vector<double>
  stage_shape(const ButcherTableau &tableau, const double c)
  {
    const Eigen::VectorXd &nodes = tableau.c;
    std::vector<double> values;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        double value = c * c / (nodes(i) * nodes(i));
        for (unsigned int j = 0; j < tableau.n_stages(); ++j)
          if (j != i)
            value *= (c - nodes(j)) / (nodes(i) - nodes(j));
        values.push_back(value);
      }
    return values;
  }
} // namespace ACF
