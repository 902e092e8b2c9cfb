// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_shifted_factorization_h
#define acf_solvers_shifted_factorization_h

#include <acf/mechanics/body_operators.h>
#include <acf/solvers/multifrontal.h>
#include <acf/solvers/supernodal_factor.h>

#include <memory>

namespace ACF
{
  /** How the numbers of a factor are kept. */
  enum class FactorPrecision
  {
    /** Single where the test solves allow it, otherwise double. */
    automatic,
    single_precision,
    double_precision
  };



  /** What a factorisation cost. */
  struct FactorizationStatistics
  {
    /** Entries of the triangular factor, including the diagonal. */
    std::size_t n_entries = 0;

    /** Bytes that a solve reads twice. */
    std::size_t n_bytes = 0;

    /** s */
    double wall_time = 0;

    /**
     * Backward error
     * $|K y - r|_\infty / (|K|_\infty |y|_\infty + |r|_\infty)$ of a test
     * solve after the factorisation.
     */
    double backward_error = 0;

    /**
     * Contraction $|(I - \tilde K^{-1} K) e| / |e|$ of corrections with the
     * factor in single precision, if it was measured.
     */
    double contraction = 0;

    bool single_precision = false;
  };



  /**
   * Factorisation $K = L D L^T$ of a body's shifted matrix
   * $K = \sigma\, m \otimes I_3 + A$ in the body's frame. For a complex shift
   * K is complex symmetric (not Hermitian).
   *
   * Contract: the constructor factorises; solve() may be called any number of
   * times. No pivoting, so the factor's size is known in advance: K is positive
   * definite for $\sigma > 0$, and for a complex shift of a Radau method its
   * numerical range excludes zero. Test solves check the residual.
   *
   * The factor is computed in double precision. Kept in single precision it has
   * half the bytes, and solves need half the time; their relative error is then
   * about the contraction, which is good enough inside an iteration that
   * corrects it. FactorPrecision::automatic tries that first, and factorises
   * again where it is not good enough.
   * See theory (12.4).
   *
   * @tparam Number double or std::complex<double>
   */
  template <typename Number>
  class ShiftedFactorization
  {
  public:
    /** Contractions up to this one are good enough for single precision: in the
     * worst case they take one more solve, of half the bytes. */
    static constexpr double largest_contraction = 0.03;

    /**
     * @param body provides the mass
     * @param stiffness A of the body, or another matrix in its place
     * @param shift $\sigma$, 1/s^2
     * @param tree of the body's graph
     * @throws SimulationError if the matrix is singular, memory runs out, or
     * the test solve has a backward error of more than 1e-10 (a matrix that is
     * singular up to round-off, as for the shift zero, may pass); for single
     * precision, if corrections do not contract
     */
    ShiftedFactorization(
      const BodyOperators &body,
      const BlockNodeMatrix &stiffness,
      const Number shift,
      const std::shared_ptr<const EliminationTree> &tree,
      const FactorPrecision precision = FactorPrecision::double_precision);

    /** In double precision, with a new analysis of the graph. */
    ShiftedFactorization(const BodyOperators &body,
                         const BlockNodeMatrix &stiffness,
                         const Number shift);

    /** The same with the stiffness of the body. */
    ShiftedFactorization(const BodyOperators &body, const Number shift);

    ShiftedFactorization(const ShiftedFactorization &) = delete;
    ShiftedFactorization &
    operator=(const ShiftedFactorization &) = delete;

    /**
     * Replaces right-hand sides by solutions.
     * @param vectors @p n_vectors vectors, each of size 3 n_nodes, one after
     * the other
     */
    void
    solve(Number *vectors, const unsigned int n_vectors = 1) const;

    const FactorizationStatistics &
    statistics() const
    {
      return factor_statistics;
    }

  private:
    using Vector = std::vector<Number>;

    /** Checks the backward error of a solve in double precision. */
    void
    check(const ShiftedMatrix<Number> &matrix, const Vector &load);

    /** How much corrections in single precision contract. */
    void
    measure_contraction(const ShiftedMatrix<Number> &matrix,
                        const Vector &load);

    /** One of the two. */
    std::unique_ptr<SupernodalFactor<Number, double>> double_factor;
    std::unique_ptr<SupernodalFactor<Number, float>> single_factor;

    FactorizationStatistics factor_statistics;
  };
} // namespace ACF

#endif
