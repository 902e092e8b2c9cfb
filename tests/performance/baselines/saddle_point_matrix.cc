// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "performance/baselines/saddle_point_matrix.h"

#include <acf/base/exceptions.h>

#include <dmumps_c.h>
#include <mpi.h>

namespace Baselines
{
  // One instance of MUMPS; the index arguments are those of its manual.
  class SaddlePointMatrix::Mumps
  {
  public:
    Mumps()
    {
      structure.par          = 1;
      structure.sym          = 2;
      structure.comm_fortran = MPI_Comm_c2f(MPI_COMM_SELF);
      call(-1);
      for (unsigned int i = 1; i <= 4; ++i)
        icntl(i) = (i == 4 ? 0 : -1); // silent
      icntl(14) = 50;                 // additional work space, percent
      // The fastest that was found for bodies: no permutation of columns, no
      // scaling, no compressed ordering.
      icntl(6)  = 0;
      icntl(8)  = 0;
      icntl(12) = 1;
    }

    ~Mumps()
    {
      call(-2);
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

    void
    call(const int job)
    {
      structure.job = job;
      dmumps_c(&structure);
    }

    void
    check() const
    {
      if (infog(1) < 0)
        throw SimulationError("MUMPS failed with the error " +
                              std::to_string(infog(1)) + " (" +
                              std::to_string(infog(2)) + ").");
    }

    DMUMPS_STRUC_C structure = {};
    bool analyzed            = false;
  };



  SaddlePointMatrix::SaddlePointMatrix(const MultibodySystem &system)
    : system(system)
    , mumps(std::make_unique<Mumps>())
  {
    std::size_t n = 0;
    for (const Body &body : system.bodies())
      {
        first_unknown.push_back(n);
        n += body.operators().n_unknowns();
      }
    first_unknown.push_back(n);
    first_marker_value = n + system.n_marker_values();
    first_multiplier   = first_marker_value + system.n_marker_values();
    n_unknowns         = first_multiplier + system.n_constraints();
  }



  SaddlePointMatrix::~SaddlePointMatrix() = default;



  void
  SaddlePointMatrix::add_entry(const std::size_t row,
                               const std::size_t col,
                               const double value)
  {
    rows.push_back(row + 1);
    columns.push_back(col + 1);
    values.push_back(value);
  }



  void
  SaddlePointMatrix::add_body(const unsigned int body,
                              const BlockNodeMatrix *const stiffness,
                              const double shift)
  {
    const ScalarNodeMatrix &mass =
      system.bodies()[body].operators().mass_matrix;
    const NodeGraph &graph  = mass.graph();
    const std::size_t first = first_unknown[body];
    for (unsigned int a = 0; a < graph.n_nodes(); ++a)
      for (std::size_t e = graph.row_start[a]; e < graph.row_start[a + 1]; ++e)
        if (const unsigned int b = graph.column[e]; b <= a)
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int j = 0; j < (b < a ? dim : i + 1); ++j)
              add_entry(first + dim * a + i,
                        first + dim * b + j,
                        (stiffness ? stiffness->block(a, b)(i, j) : 0.) +
                          (i == j ? shift * mass.value(a, b) : 0.));
  }



  void
  SaddlePointMatrix::add_markers(const MarkerLinearization &linearization)
  {
    const std::size_t first_force = first_unknown.back();
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      for (unsigned int p = 0; p < system.body_markers(b).size(); ++p)
        {
          const NodalFunctional &functional =
            system.bodies()[b]
              .reference()
              .functionals()[system.body_markers(b)[p]];
          const std::size_t row =
            first_force + dim * (system.first_marker(b) + p);
          for (unsigned int k = 0; k < functional.nodes.size(); ++k)
            for (unsigned int i = 0; i < dim; ++i)
              add_entry(row + i,
                        first_unknown[b] + dim * functional.nodes[k] + i,
                        functional.weights[k]);
        }
    for (unsigned int k = 0; k < system.n_marker_values(); ++k)
      add_entry(first_marker_value + k, first_force + k, -1);
    for (const auto &entry : linearization.stiffness)
      if (entry.col() <= entry.row())
        add_entry(first_marker_value + entry.row(),
                  first_marker_value + entry.col(),
                  entry.value());
    for (const auto &entry : linearization.constraints)
      add_entry(first_multiplier + entry.row(),
                first_marker_value + entry.col(),
                entry.value());
  }



  void
  SaddlePointMatrix::factorize(
    const std::vector<std::unique_ptr<const BlockNodeMatrix>> &stiffness,
    const double shift,
    const MarkerLinearization &linearization)
  {
    rows.clear();
    columns.clear();
    values.clear();
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      add_body(b, stiffness[b].get(), shift);
    add_markers(linearization);

    auto &structure = mumps->structure;
    structure.n     = n_unknowns;
    structure.nnz   = values.size();
    structure.irn   = rows.data();
    structure.jcn   = columns.data();
    structure.a     = values.data();
    if (!mumps->analyzed)
      {
        mumps->call(1);
        mumps->check();
        mumps->analyzed = true;
      }
    // -8, -9: the estimate of the work space was too small
    mumps->call(2);
    while ((mumps->infog(1) == -8 || mumps->infog(1) == -9) &&
           mumps->icntl(14) < 1000)
      {
        mumps->icntl(14) *= 2;
        mumps->call(2);
      }
    mumps->check();
  }



  void
  SaddlePointMatrix::solve(SystemVector &r, Eigen::VectorXd &g)
  {
    std::vector<double> x(n_unknowns);
    for (unsigned int b = 0; b < r.size(); ++b)
      std::copy(r[b].begin(), r[b].end(), x.begin() + first_unknown[b]);
    std::copy_n(g.data(), g.size(), x.begin() + first_multiplier);

    auto &structure = mumps->structure;
    structure.rhs   = x.data();
    structure.nrhs  = 1;
    structure.lrhs  = n_unknowns;
    mumps->call(3);
    mumps->check();

    for (unsigned int b = 0; b < r.size(); ++b)
      std::copy_n(x.begin() + first_unknown[b], r[b].size(), r[b].begin());
    std::copy_n(x.begin() + first_multiplier, g.size(), g.data());
  }



  std::size_t
  SaddlePointMatrix::n_factor_entries() const
  {
    // entries above 2^31 are given as negative millions
    const int n = mumps->infog(29);
    return n >= 0 ? n : 1000000 * static_cast<std::size_t>(-n);
  }
} // namespace Baselines
