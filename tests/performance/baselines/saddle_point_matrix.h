// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_baselines_saddle_point_matrix_h
#define acf_tests_baselines_saddle_point_matrix_h

#include <acf/mechanics/multibody_system.h>

#include <memory>

namespace Baselines
{
  using namespace ACF;

  /**
   * Factorisation with MUMPS of the linearised equations of a system as one
   * sparse symmetric indefinite matrix, as programs for nonlinear structures do
   * it,
   * \f[ (K + \sigma M)\, w + S^T \phi = r, \quad S w - s = 0, \quad
   *     G s + D^T \mu - \phi = 0, \quad D s = g \f]
   * for the displacements w of all nodes, values s and forces \f$\phi\f$ of the
   * markers, and multipliers \f$\mu\f$. The order of elimination is found once
   * and serves all matrices.
   */
  class SaddlePointMatrix
  {
  public:
    explicit SaddlePointMatrix(const MultibodySystem &system);

    ~SaddlePointMatrix();

    SaddlePointMatrix(const SaddlePointMatrix &) = delete;
    SaddlePointMatrix &
    operator=(const SaddlePointMatrix &) = delete;

    /**
     * @param stiffness K of each body in the world; null pointers count as zero
     * @param shift \f$\sigma\f$, 1/s^2
     * @throws SimulationError
     */
    void
    factorize(
      const std::vector<std::unique_ptr<const BlockNodeMatrix>> &stiffness,
      const double shift,
      const MarkerLinearization &linearization);

    /**
     * @param[in,out] r replaced by w
     * @param[in,out] g replaced by \f$\mu\f$
     */
    void
    solve(SystemVector &r, Eigen::VectorXd &g);

    /** Entries of the factor. */
    std::size_t
    n_factor_entries() const;

  private:
    class Mumps;

    void
    add_entry(const std::size_t row, const std::size_t col, const double value);

    void
    add_body(const unsigned int body,
             const BlockNodeMatrix *const stiffness,
             const double shift);

    void
    add_markers(const MarkerLinearization &linearization);

    const MultibodySystem &system;

    /** Numbers of the first unknown of each body, of all s, and of all mu;
     * those of phi come before those of s. */
    std::vector<std::size_t> first_unknown;
    std::size_t first_marker_value;
    std::size_t first_multiplier;
    std::size_t n_unknowns;

    /** Lower triangle by coordinates, counted from 1. */
    std::vector<int> rows;
    std::vector<int> columns;
    std::vector<double> values;

    std::unique_ptr<Mumps> mumps;
  };
} // namespace Baselines

#endif
