// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_shifted_factorization_h
#define acf_solvers_shifted_factorization_h

#include <acf/mechanics/body_operators.h>

#include <memory>

namespace ACF
{
  /** What a factorisation cost. */
  struct FactorizationStatistics
  {
    /** Entries of the triangular factor, including the diagonal. */
    std::size_t n_entries = 0;

    /** Bytes of the factor. */
    std::size_t n_bytes = 0;

    /** s */
    double wall_time = 0;

    /**
     * Backward error
     * $|K y - r|_\infty / (|K|_\infty |y|_\infty + |r|_\infty)$ of a test
     * solve after the factorisation.
     */
    double backward_error = 0;
  };



  /**
   * Factorisation $K = L D L^T$ of a body's shifted matrix
   * $K = \sigma\, m \otimes I_3 + A$ in the body's frame, with MUMPS. For a
   * complex shift K is complex symmetric (not Hermitian).
   *
   * Contract: the constructor factorises; solve() may be called any number of
   * times. No pivoting across the fill-reducing order, so the factor's size is
   * known in advance: K is positive definite for $\sigma > 0$, and for a
   * complex shift of a Radau method its numerical range excludes zero. A test
   * solve checks the residual.
   *
   * @tparam Number double or std::complex<double>
   * @pre MPI is initialised (MUMPS of Debian is the parallel build)
   */
  template <typename Number>
  class ShiftedFactorization
  {
  public:
    /**
     * @param body provides mass and stiffness
     * @param shift $\sigma$, 1/s^2
     * @throws SimulationError if the matrix is singular, memory runs out, or
     * the test solve has a backward error of more than 1e-10 (a matrix that is
     * singular up to round-off, as for the shift zero, may pass)
     */
    ShiftedFactorization(const BodyOperators &body, const Number shift);

    /** With another matrix in the place of A. */
    ShiftedFactorization(const BodyOperators &body,
                         const BlockNodeMatrix &stiffness,
                         const Number shift);

    ~ShiftedFactorization();

    ShiftedFactorization(const ShiftedFactorization &) = delete;
    ShiftedFactorization &
    operator=(const ShiftedFactorization &) = delete;

    /**
     * Replaces right-hand sides by solutions.
     * @param vectors @p n_vectors vectors, each of size 3 n_nodes, one after
     * the other
     */
    void
    solve(Number *vectors, const unsigned int n_vectors = 1);

    const FactorizationStatistics &
    statistics() const
    {
      return factor_statistics;
    }

  private:
    class Mumps;

    void
    check(const BodyOperators &body,
          const BlockNodeMatrix &stiffness,
          const Number shift);

    unsigned int n_unknowns;
    std::unique_ptr<Mumps> mumps;
    FactorizationStatistics factor_statistics;
  };
} // namespace ACF

#endif
