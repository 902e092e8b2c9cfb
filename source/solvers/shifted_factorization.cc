// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/solvers/shifted_factorization.h>

#include <deal.II/base/timer.h>

#include <dmumps_c.h>
#include <mpi.h>
#include <zmumps_c.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace ACF
{
  namespace
  {
    // The C interfaces of MUMPS for real and for complex numbers.
    template <typename Number>
    struct MumpsInterface;

    template <>
    struct MumpsInterface<double>
    {
      using Structure = DMUMPS_STRUC_C;
      using Entry     = double;

      static void
      call(Structure &structure)
      {
        dmumps_c(&structure);
      }
    };

    template <>
    struct MumpsInterface<std::complex<double>>
    {
      using Structure = ZMUMPS_STRUC_C;
      using Entry     = mumps_double_complex;

      static void
      call(Structure &structure)
      {
        zmumps_c(&structure);
      }
    };

    // values of the parameter JOB
    constexpr int job_initialize            = -1;
    constexpr int job_terminate             = -2;
    constexpr int job_analyze_and_factorize = 4;
    constexpr int job_solve                 = 3;
  } // namespace



  // One instance of MUMPS; the index arguments are those of its manual.
  template <typename Number>
  class ShiftedFactorization<Number>::Mumps
  {
  public:
    Mumps()
    {
      structure.par          = 1;
      structure.sym          = 2;
      structure.comm_fortran = MPI_Comm_c2f(MPI_COMM_SELF);
      structure.job          = job_initialize;
      MumpsInterface<Number>::call(structure);
      for (unsigned int i = 1; i <= 4; ++i)
        icntl(i) = (i == 4 ? 0 : -1); // silent
      icntl(6)  = 0;                  // no permutation of columns
      icntl(8)  = 0;                  // no scaling
      icntl(12) = 1;                  // no compressed ordering
      icntl(13) = 1;                  // no parallel root
      // Ordering: the choice of MUMPS, which is PORD for all but small bodies;
      // asked for by number, PORD quits the program on small dense ones.
      icntl(7)          = 7;
      structure.cntl[0] = 0; // no pivoting
    }

    ~Mumps()
    {
      structure.job = job_terminate;
      MumpsInterface<Number>::call(structure);
    }

    int &
    icntl(const unsigned int i)
    {
      return structure.icntl[i - 1];
    }

    int
    infog(const unsigned int i) const
    {
      return structure.infog[i - 1];
    }

    // INFOG entries above 2^31 are given as negative millions.
    std::size_t
    large_infog(const unsigned int i) const
    {
      return infog(i) >= 0 ? infog(i)
                           : 1000000 * static_cast<std::size_t>(-infog(i));
    }

    void
    call(const int job)
    {
      structure.job = job;
      MumpsInterface<Number>::call(structure);
    }

    typename MumpsInterface<Number>::Structure structure = {};
  };



  template <typename Number>
  ShiftedFactorization<Number>::ShiftedFactorization(const BodyOperators &body,
                                                     const Number shift)
    : ShiftedFactorization(body, body.stiffness_matrix, shift)
  {}



  template <typename Number>
  ShiftedFactorization<Number>::ShiftedFactorization(
    const BodyOperators &body,
    const BlockNodeMatrix &stiffness,
    const Number shift)
    : n_unknowns(body.n_unknowns())
    , mumps(std::make_unique<Mumps>())
  {
    Timer timer;

    // lower triangle by coordinates, counted from 1
    const NodeGraph &graph = body.mass_matrix.graph();
    std::vector<int> rows, columns;
    std::vector<Number> values;
    const std::size_t estimate = 5 * graph.column.size();
    rows.reserve(estimate);
    columns.reserve(estimate);
    values.reserve(estimate);
    for (unsigned int a = 0; a < graph.n_nodes(); ++a)
      for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1]; ++e)
        {
          const unsigned int b = graph.column[e];
          if (b > a)
            continue;
          const double *const block = stiffness.block(e);
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int j = 0; j < dim; ++j)
              if (b < a || j <= i)
                {
                  rows.push_back(dim * a + i + 1);
                  columns.push_back(dim * b + j + 1);
                  values.push_back(block[dim * i + j]);
                  if (i == j)
                    values.back() += shift * body.mass_matrix.value(e);
                }
        }

    auto &structure = mumps->structure;
    structure.n     = n_unknowns;
    structure.nnz   = values.size();
    structure.irn   = rows.data();
    structure.jcn   = columns.data();
    structure.a =
      reinterpret_cast<typename MumpsInterface<Number>::Entry *>(values.data());
    mumps->icntl(15) = -static_cast<int>(dim); // analysis by nodes

    // -8, -9: the estimate of the work space was too small
    for (int extra_space = 30; extra_space <= 480; extra_space *= 2)
      {
        mumps->icntl(14) = extra_space;
        mumps->call(job_analyze_and_factorize);
        if (mumps->infog(1) != -8 && mumps->infog(1) != -9)
          break;
      }
    structure.irn = structure.jcn = nullptr;
    structure.a                   = nullptr;

    if (mumps->infog(1) == -10)
      throw SimulationError("The shifted matrix of a body is singular.");
    if (mumps->infog(1) == -13)
      throw SimulationError(
        "Not enough memory for the factorisation of a body "
        "with " +
        std::to_string(n_unknowns) + " unknowns.");
    if (mumps->infog(1) < 0)
      throw SimulationError("The factorisation of a body failed with error " +
                            std::to_string(mumps->infog(1)) + " (" +
                            std::to_string(mumps->infog(2)) + ") of MUMPS.");

    factor_statistics.n_entries = mumps->large_infog(29);
    factor_statistics.n_bytes   = factor_statistics.n_entries * sizeof(Number);
    check(body, stiffness, shift);
    factor_statistics.wall_time = timer.wall_time();
  }



  template <typename Number>
  ShiftedFactorization<Number>::~ShiftedFactorization() = default;



  template <typename Number>
  void
  ShiftedFactorization<Number>::solve(Number *vectors,
                                      const unsigned int n_vectors)
  {
    auto &structure = mumps->structure;
    structure.rhs =
      reinterpret_cast<typename MumpsInterface<Number>::Entry *>(vectors);
    structure.nrhs = n_vectors;
    structure.lrhs = n_unknowns;
    mumps->call(job_solve);
    structure.rhs = nullptr;
    if (mumps->infog(1) < 0)
      throw SimulationError("A solve failed with error " +
                            std::to_string(mumps->infog(1)) + " (" +
                            std::to_string(mumps->infog(2)) + ") of MUMPS.");
  }



  template <typename Number>
  void
  ShiftedFactorization<Number>::check(const BodyOperators &body,
                                      const BlockNodeMatrix &stiffness,
                                      const Number shift)
  {
    // r = the masses as load in all directions, which every body has
    std::vector<Number> solution(n_unknowns);
    for (unsigned int k = 0; k < n_unknowns; ++k)
      solution[k] = body.nodal_masses[k / dim] * (1. + k % dim);
    const std::vector<Number> right_hand_side(solution);
    solve(solution.data());

    const NodeGraph &graph = body.mass_matrix.graph();
    double defect = 0, matrix_norm = 0, y_norm = 0, r_norm = 0;
    for (unsigned int a = 0; a < graph.n_nodes(); ++a)
      for (unsigned int i = 0; i < dim; ++i)
        {
          const unsigned int k = dim * a + i;
          Number product       = 0;
          double row_sum       = 0;
          for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1];
               ++e)
            for (unsigned int j = 0; j < dim; ++j)
              {
                Number entry = stiffness.block(e)[dim * i + j];
                if (i == j)
                  entry += shift * body.mass_matrix.value(e);
                product += entry * solution[dim * graph.column[e] + j];
                row_sum += std::abs(entry);
              }
          // std::max alone ignores not-a-number
          const double row_defect = std::abs(product - right_hand_side[k]);
          defect                  = std::isfinite(row_defect)
                                      ? std::max(defect, row_defect)
                                      : std::numeric_limits<double>::infinity();
          matrix_norm             = std::max(matrix_norm, row_sum);
          y_norm                  = std::max(y_norm, std::abs(solution[k]));
          r_norm = std::max(r_norm, std::abs(right_hand_side[k]));
        }

    factor_statistics.backward_error = defect / (matrix_norm * y_norm + r_norm);
    if (!(factor_statistics.backward_error < 1e-10))
      {
        std::ostringstream text;
        text << "The factorisation of a body with " << n_unknowns
             << " unknowns is inaccurate: a test solve has the backward error "
             << factor_statistics.backward_error << ".";
        throw SimulationError(text.str());
      }
  }



  template class ShiftedFactorization<double>;
  template class ShiftedFactorization<std::complex<double>>;
} // namespace ACF
