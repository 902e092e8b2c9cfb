// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/solvers/shifted_factorization.h>

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/timer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace ACF
{
  namespace
  {
    // The maximum norm of K.
    template <typename Number>
    double
    maximum_norm(const ShiftedMatrix<Number> &matrix)
    {
      const NodeGraph &graph = matrix.stiffness.graph();
      double norm            = 0;
      for (unsigned int a = 0; a < graph.n_nodes(); ++a)
        for (unsigned int i = 0; i < dim; ++i)
          {
            double row_sum = 0;
            for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1];
                 ++e)
              {
                const NodeBlock block =
                  matrix.stiffness.block(a, graph.column[e]);
                for (unsigned int j = 0; j < dim; ++j)
                  if (j != i)
                    row_sum += std::abs(block(i, j));
                row_sum += std::abs(block(i, i) +
                                    matrix.shift *
                                      matrix.mass.value(a, graph.column[e]));
              }
            norm = std::max(norm, row_sum);
          }
      return norm;
    }



    // Real and imaginary part of nodal values, or the former alone.
    template <typename Number>
    std::vector<NodalVector>
    parts_of(const std::vector<Number> &x)
    {
      std::vector<NodalVector> parts(std::is_same<Number, double>::value ? 1
                                                                         : 2,
                                     NodalVector(x.size()));
      for (std::size_t k = 0; k < x.size(); ++k)
        {
          parts[0][k] = std::real(x[k]);
          if (parts.size() == 2)
            parts[1][k] = std::imag(x[k]);
        }
      return parts;
    }



    void
    subtract(const NodalVector *const product, std::vector<double> &r)
    {
      for (std::size_t k = 0; k < r.size(); ++k)
        r[k] -= product[0][k];
    }

    void
    subtract(const NodalVector *const product,
             std::vector<std::complex<double>> &r)
    {
      for (std::size_t k = 0; k < r.size(); ++k)
        r[k] -= std::complex<double>(product[0][k], product[1][k]);
    }



    // r <- r - K x
    template <typename Number>
    void
    subtract_product(const ShiftedMatrix<Number> &matrix,
                     const std::vector<Number> &x,
                     std::vector<Number> &r)
    {
      std::vector<Number> scaled(x);
      for (Number &value : scaled)
        value *= matrix.shift;
      const std::vector<NodalVector> values        = parts_of(x);
      const std::vector<NodalVector> accelerations = parts_of(scaled);
      std::vector<NodalVector> products(values);
      std::vector<const NodalVector *> sources, inertia;
      std::vector<NodalVector *> targets;
      for (unsigned int p = 0; p < values.size(); ++p)
        {
          sources.push_back(&values[p]);
          inertia.push_back(&accelerations[p]);
          targets.push_back(&products[p]);
        }
      matrix.stiffness.vmult(targets, sources);
      subtract(products.data(), r);
      matrix.mass.vmult(targets, inertia);
      subtract(products.data(), r);
    }



    // Infinite if one is not finite, which std::max alone ignores.
    template <typename Number>
    double
    maximum_norm(const std::vector<Number> &x)
    {
      double norm = 0;
      for (const Number &entry : x)
        norm = std::isfinite(std::abs(entry))
                 ? std::max(norm, std::abs(entry))
                 : std::numeric_limits<double>::infinity();
      return norm;
    }



    template <typename Number>
    [[noreturn]] void
    fail(const std::vector<Number> &x, const std::string &reason)
    {
      throw SimulationError("The factorisation of a body with " +
                            std::to_string(x.size()) +
                            " unknowns is inaccurate: " + reason + ".");
    }



    std::string
    text_of(const double number)
    {
      std::ostringstream text;
      text << number;
      return text.str();
    }
  } // namespace



  namespace
  {
    template <typename Real, typename Number>
    std::unique_ptr<SupernodalFactor<Number, Real>>
    factorize(const std::shared_ptr<const EliminationTree> &tree,
              const ShiftedMatrix<Number> &matrix,
              const unsigned int n_threads)
    {
      auto factor =
        std::make_unique<SupernodalFactor<Number, Real>>(tree, n_threads);
      factorize_multifrontal<Number>(*tree,
                                     matrix,
                                     [&](const unsigned int supernode,
                                         const Number *columns,
                                         const std::size_t leading_dimension) {
                                       factor->store(supernode,
                                                     columns,
                                                     leading_dimension);
                                     });
      return factor;
    }
  } // namespace



  template <typename Number>
  ShiftedFactorization<Number>::ShiftedFactorization(
    const BodyOperators &body,
    const BlockNodeMatrix &stiffness,
    const Number shift,
    const std::shared_ptr<const EliminationTree> &tree,
    const FactorPrecision precision)
  {
    Timer timer;
    const ShiftedMatrix<Number> matrix = {body.mass_matrix, stiffness, shift};
    const unsigned int n_threads       = MultithreadInfo::n_threads();

    // the masses as load in all directions, which every body has
    Vector load(body.n_unknowns());
    for (unsigned int k = 0; k < load.size(); ++k)
      load[k] = body.nodal_masses[k / dim] * (1. + k % dim);

    if (precision != FactorPrecision::double_precision)
      {
        single_factor = factorize<float>(tree, matrix, n_threads);
        measure_contraction(matrix, load);
        const bool is_single = precision == FactorPrecision::single_precision;
        if (!(factor_statistics.contraction <=
              (is_single ? 0.5 : largest_contraction)))
          {
            if (is_single)
              fail(load,
                   "corrections in single precision contract by " +
                     text_of(factor_statistics.contraction));
            single_factor.reset();
          }
      }
    if (!single_factor)
      {
        double_factor = factorize<double>(tree, matrix, n_threads);
        check(matrix, load);
      }

    factor_statistics.single_precision = single_factor != nullptr;
    factor_statistics.n_entries        = tree->n_entries();
    factor_statistics.n_bytes =
      single_factor ? single_factor->n_bytes() : double_factor->n_bytes();
    factor_statistics.wall_time = timer.wall_time();
  }



  template <typename Number>
  ShiftedFactorization<Number>::ShiftedFactorization(
    const BodyOperators &body,
    const BlockNodeMatrix &stiffness,
    const Number shift)
    : ShiftedFactorization(body,
                           stiffness,
                           shift,
                           std::make_shared<const EliminationTree>(
                             stiffness.graph()))
  {}



  template <typename Number>
  ShiftedFactorization<Number>::ShiftedFactorization(const BodyOperators &body,
                                                     const Number shift)
    : ShiftedFactorization(body, body.stiffness_matrix, shift)
  {}



  template <typename Number>
  void
  ShiftedFactorization<Number>::solve(Number *vectors,
                                      const unsigned int n_vectors) const
  {
    if (single_factor)
      single_factor->solve(vectors, n_vectors);
    else
      double_factor->solve(vectors, n_vectors);
  }



  template <typename Number>
  void
  ShiftedFactorization<Number>::check(const ShiftedMatrix<Number> &matrix,
                                      const Vector &load)
  {
    Vector solution(load), defect(load);
    solve(solution.data());
    subtract_product(matrix, solution, defect);
    factor_statistics.backward_error =
      maximum_norm(defect) /
      (maximum_norm(matrix) * maximum_norm(solution) + maximum_norm(load));
    if (!(factor_statistics.backward_error < 1e-10))
      fail(load,
           "a test solve has the backward error " +
             text_of(factor_statistics.backward_error));
  }



  template <typename Number>
  void
  ShiftedFactorization<Number>::measure_contraction(
    const ShiftedMatrix<Number> &matrix,
    const Vector &load)
  {
    // The power method finds the largest contraction. It starts with the error
    // of a smooth solution, as those of a simulation are.
    Vector error(load);
    single_factor->solve(error.data(), 1);
    for (unsigned int k = 0; k < 3; ++k)
      {
        Vector defect(error.size());
        subtract_product(matrix, error, defect);
        single_factor->solve(defect.data(), 1);
        const double before = maximum_norm(error);
        for (unsigned int i = 0; i < error.size(); ++i)
          error[i] += defect[i];
        const double ratio = maximum_norm(error) / before;
        factor_statistics.contraction =
          std::isfinite(ratio) ? std::max(factor_statistics.contraction, ratio)
                               : std::numeric_limits<double>::infinity();
      }
  }



  template class ShiftedFactorization<double>;
  template class ShiftedFactorization<std::complex<double>>;
} // namespace ACF
