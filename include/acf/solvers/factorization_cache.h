// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_factorization_cache_h
#define acf_solvers_factorization_cache_h

#include <acf/base/statistics.h>
#include <acf/mechanics/body.h>
#include <acf/solvers/joint_columns.h>
#include <acf/solvers/shifted_factorization.h>

#include <Eigen/Dense>

#include <limits>
#include <map>
#include <memory>

namespace ACF
{
  class Archive;

  /**
   * The factorisation of a body's shifted matrix K with what joints and force
   * elements need of it, all in the body's frame and so independent of its
   * rotation (paper Eq. (32)): the columns $Y_{pj} = K^{-1} (w_p \otimes e_j)$
   * of the functionals and their compliance
   * $C_{pi,qj} = (w_p \otimes e_i)^T Y_{qj}$. Identical bodies share it.
   * See theory (12.6).
   */
  template <typename Number>
  class JointedFactorization
  {
  public:
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    /** @param stiffness A of the body, or a matrix in its place */
    JointedFactorization(const ReferenceBody &body,
                         const BlockNodeMatrix &stiffness,
                         const Number shift,
                         const std::shared_ptr<const EliminationTree> &tree,
                         const FactorPrecision precision);

    ShiftedFactorization<Number> &
    factorization()
    {
      return factor;
    }

    /** C, size 3 n x 3 n for n functionals of the reference body. */
    const Matrix &
    compliance() const
    {
      return joint_compliance;
    }

    /** Value of a functional for a vector of size 3 n_nodes. */
    Eigen::Matrix<Number, dim, 1>
    functional_value(const unsigned int functional, const Number *x) const;

    /** $x \leftarrow x - Y F$ for forces F on the functionals, size 3 n.
     * @param x_is_zero whether x stands for zero, whatever its numbers are */
    void
    subtract_columns(const Vector &F, Number *x, const bool x_is_zero) const;

    std::size_t
    size() const
    {
      return n_unknowns;
    }

    std::size_t
    column_bytes() const
    {
      return columns.n_bytes();
    }

  private:
    ShiftedFactorization<Number> factor;
    const std::vector<NodalFunctional> &functionals;
    std::size_t n_unknowns;
    JointColumns<Number> columns;
    Matrix joint_compliance;
  };



  /**
   * Keeps factorisations: one per reference body and shift, in practice one per
   * kind of body and step size. A body whose stiffness was replaced has
   * factorisations of its own.
   *
   * With a limit of the memory those of the step size that was not used for the
   * longest time are dropped when a new one would pass it, but never those of
   * the present step size, even if they pass it alone.
   */
  class FactorizationCache
  {
  public:
    /** @param max_bytes of the factors and the columns of joints */
    explicit FactorizationCache(
      Statistics &statistics,
      const FactorPrecision precision = FactorPrecision::double_precision,
      const std::size_t max_bytes = std::numeric_limits<std::size_t>::max());

    /** The step size, s, that the following calls of get() are about. What they
     * return is valid until this function is called again. */
    void
    use(const double step_size);

    /** Whether there are factorisations for a step size. */
    bool
    holds(const double step_size) const;

    JointedFactorization<double> &
    get(const Body &body, const double shift);

    JointedFactorization<std::complex<double>> &
    get(const Body &body, const std::complex<double> shift);

    /**
     * Factorises this matrix in the place of A for one body from now on, and
     * drops the factors with the last one.
     * @param stiffness in the frame of the body
     */
    void
    replace_stiffness(const Body &body,
                      std::unique_ptr<const BlockNodeMatrix> stiffness);

    /** Goes back to A. */
    void
    restore_stiffness(const Body &body);

    /**
     * Saves or loads everything but the factors: those that were held count as
     * held, and are factorised again when they are needed first.
     * @param bodies all bodies that factors are held of
     */
    void
    exchange(Archive &archive, const std::vector<Body> &bodies);

  private:
    /** Of a reference body, or of a body with a stiffness of its own. */
    using Key = std::tuple<const void *, double, double>;

    template <typename Number>
    struct Entry
    {
      /** Null if it was only loaded that there is one. */
      std::unique_ptr<JointedFactorization<Number>> factor;

      /** For which it was needed last. */
      double step_size = 0;

      std::size_t n_bytes = 0;
    };

    template <typename Number>
    using Factors = std::map<Key, Entry<Number>>;

    /** What is kept of an entry. */
    struct EntryRecord;

    template <typename Number>
    void
    exchange(Archive &archive,
             const std::string &name,
             const std::vector<Body> &bodies,
             Factors<Number> &factors);

    template <typename Number>
    JointedFactorization<Number> &
    find_or_factorize(Factors<Number> &factors,
                      const Body &body,
                      const Number shift,
                      unsigned long &counter);

    /** Drops the entries that a condition applies to. */
    template <typename Number, typename Condition>
    unsigned int
    drop(Factors<Number> &factors, const Condition &condition);

    /** Drops old step sizes until there is no more than the limit. */
    void
    limit_memory();

    Statistics &statistics;
    const FactorPrecision precision;

    /** Of reference bodies. */
    std::map<const ReferenceBody *, std::shared_ptr<const EliminationTree>>
      trees;

    const std::size_t max_bytes;
    std::size_t n_bytes = 0;

    /** The number of the last call of use(), and for each step size. */
    double present_step_size = 0;
    unsigned long n_uses     = 0;
    std::map<double, unsigned long> last_use;

    Factors<double> real_factors;
    Factors<std::complex<double>> complex_factors;
    std::map<const Body *, std::unique_ptr<const BlockNodeMatrix>> stiffness;
  };
} // namespace ACF

#endif
