// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/solvers/joint_schur_complement.h>

namespace ACF
{
  namespace
  {
    // D (I x R): the columns of each functional times the rotation.
    Eigen::MatrixXd
    rotate_constraints(const Eigen::MatrixXd &D, const Matrix3 &rotation)
    {
      Eigen::Matrix3d R;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          R(i, j) = rotation[i][j];
      Eigen::MatrixXd result(D.rows(), D.cols());
      for (unsigned int p = 0; p < D.cols() / dim; ++p)
        result.middleCols<dim>(dim * p) = D.middleCols<dim>(dim * p) * R;
      return result;
    }
  } // namespace



  template <typename Number>
  JointSchurComplement<Number>::JointSchurComplement(
    const MultibodySystem &system,
    const std::vector<Matrix3> &rotations,
    std::vector<JointedFactorization<Number> *> factors,
    Statistics &statistics)
    : system(system)
    , factors(std::move(factors))
    , statistics(statistics)
  {
    if (system.n_constraints() == 0)
      return;

    Matrix sum = Matrix::Zero(system.n_constraints(), system.n_constraints());
    for (unsigned int b = 0; b < rotations.size(); ++b)
      {
        const auto &constraints = system.constraints(b);
        rotated_constraints.push_back(
          rotate_constraints(constraints.matrix, rotations[b]));
        const Matrix D     = rotated_constraints[b].template cast<Number>();
        const Matrix block = D * this->factors[b]->compliance() * D.transpose();
        for (unsigned int r = 0; r < constraints.rows.size(); ++r)
          for (unsigned int s = 0; s < constraints.rows.size(); ++s)
            sum(constraints.rows[r], constraints.rows[s]) += block(r, s);
      }
    schur_complement.compute(sum);
    ++statistics.schur_complements;
  }



  template <typename Number>
  typename JointSchurComplement<Number>::Vector
  JointSchurComplement<Number>::solve(std::vector<std::vector<Number>> &bodies,
                                      const Vector &g)
  {
    {
      const PhaseTimer timer(statistics, "solves");
      for (unsigned int b = 0; b < bodies.size(); ++b)
        factors[b]->factorization().solve(bodies[b].data());
    }
    if (system.n_constraints() == 0)
      return g;

    Vector residual = -g;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto &rows    = system.constraints(b).rows;
        const Vector values = rotated_constraints[b].template cast<Number>() *
                              factors[b]->functional_values(bodies[b]);
        for (unsigned int r = 0; r < rows.size(); ++r)
          residual(rows[r]) += values(r);
      }
    const Vector mu = schur_complement.solve(residual);

    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto &rows = system.constraints(b).rows;
        if (rows.empty())
          continue;
        Vector lambda(rows.size());
        for (unsigned int r = 0; r < rows.size(); ++r)
          lambda(r) = mu(rows[r]);
        factors[b]->subtract_columns(
          rotated_constraints[b].transpose().template cast<Number>() * lambda,
          bodies[b]);
      }
    return mu;
  }



  template class JointSchurComplement<double>;
  template class JointSchurComplement<std::complex<double>>;
} // namespace ACF
