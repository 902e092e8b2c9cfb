// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_solvers_coupled_system_h
#define acf_solvers_coupled_system_h

#include <acf/mechanics/multibody_system.h>
#include <acf/mechanics/node_rotations.h>
#include <acf/solvers/constraint_system.h>
#include <acf/solvers/factorization_cache.h>
#include <acf/solvers/marker_system.h>

namespace ACF
{
  /** The matrix of a body: $K = \text{scale}\ (\text{shift}\, M + A)$. */
  template <typename Number>
  struct BodyMatrix
  {
    Number shift;
    Number scale;
  };

  /**
   * Coefficients of a linear system on the markers,
   * $H = \text{mass}\, M_L + \text{damping}\, C + \text{stiffness}\, G$.
   */
  template <typename Number>
  struct MarkerCoefficients
  {
    Number mass;
    Number damping;
    Number stiffness;
  };



  /** A change $U B U^T$ of a body's matrix, in its frame. */
  struct LowRankChange
  {
    /** U, unknowns times rank; the rank may be 0. */
    Eigen::MatrixXd columns;

    /** B, invertible. */
    Eigen::MatrixXd coefficients;
  };



  /**
   * Solves the equations of all bodies coupled by joints, force elements and
   * lumped masses, in frames of the bodies' nodes,
   * \f[ K_b w_b + S_b^T R_b^T \phi_b = r_b, \qquad \phi = H s + D^T \mu, \qquad
   *     D s = g, \qquad s_b = R_b S_b w_b, \f]
   * where $R_b$ has a block for each marker: all nodes of a marker turn alike.
   * With $w = K^{-1} r - Y R^T \phi$ and the compliances $C = S Y$ only a small
   * sparse system in the marker values s and the multipliers remains,
   * \f[ s + R C R^T (H s + D^T \mu) = R S K^{-1} r, \qquad
   *     D s - \epsilon E \mu = g, \f]
   * where E serves repeated constraints only (see MarkerLinearization). Its
   * cost grows with the number of bodies like that of their joints' graph:
   * linearly for chains. Without markers nothing is done for it.
   *
   * The forces of joints make H so small in most steps that the smaller system
   * of the multipliers is enough, the Schur complement of paper Eq. (32):
   * \f[ (D C D^T + \epsilon E)\, \mu_k = D u_k - g, \qquad
   *     s_k = u_k - C D^T \mu_k, \qquad u_{k + 1} = u - C H s_k \f]
   * (C here with its rotations). This is repeated until a further $s_k$ would
   * change by less than 1e-10 of it. If that would not contract by a tenth each
   * time, the system above is factorised instead.
   *
   * Matrices $K_b + U B U^T$ add the unknowns $\zeta = B U^T w$ to the small
   * system, with $Y_U = K^{-1} U$,
   * \f[ s + R C R^T \phi + R S Y_U \zeta = R S K^{-1} r, \qquad
   *     (R S Y_U)^T \phi + (B^{-1} + U^T Y_U)\, \zeta = U^T K^{-1} r. \f]
   * See theory (12.7), theory (12.8), theory (16.3).
   */
  template <typename Number>
  class CoupledSystem
  {
  public:
    using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

    CoupledSystem(const MultibodySystem &system,
                  FactorizationCache &cache,
                  Statistics &statistics);

    /**
     * Factorises what the cache does not have, and the system of the markers.
     * @param matrices of each body
     * @param rotations of each body; one for the nodes of a marker
     * @param changes of each body's matrix, or nothing; takes one solve per
     * column
     * @throws SimulationError if the system of the markers is singular
     */
    void
    prepare(const std::vector<BodyMatrix<Number>> &matrices,
            const std::vector<NodeRotations> &rotations,
            const MarkerLinearization &linearization,
            const MarkerCoefficients<Number> &coefficients,
            const std::vector<LowRankChange> &changes = {});

    /** Right-hand side $r_b$ of a body, in its frame, and then the solution. */
    Number *
    body(const unsigned int b)
    {
      return values.data() + offsets[b];
    }

    /**
     * Solves for the $r_b$ that body() was given.
     * @param g right-hand side of the constraints
     * @return $\mu$; the $w_b$ are left to solution()
     */
    Vector
    solve(const Vector &g);

    /** The same for $r_b = 0$: no solves with factors of the bodies. */
    Vector
    solve_constraints(const Vector &g);

    /**
     * Completes $w_b$ by what joints do to a body: once after each solve, for
     * different bodies possibly in parallel.
     * @return body(), or null if all of $w_b$ is zero
     */
    const Number *
    solution(const unsigned int body);

  private:
    /** Of an iteration that is worth while. */
    static constexpr double largest_contraction = 0.1;

    using Triplets = typename RepeatedPattern<Number>::Triplets;

    void
    group_bodies();

    /** Factorises the system of all unknowns.
     * @throws SimulationError if it is singular */
    void
    factorize_all();

    void
    prepare_changes(const std::vector<LowRankChange> &terms);

    void
    solve_bodies();

    /** R S w of the bodies' vectors. */
    void
    evaluate_markers(const unsigned int body,
                     const Number *w,
                     Eigen::Ref<Vector> s) const;

    /** $R C R^T \phi$ */
    Vector
    marker_displacements(const Vector &phi) const;

    /** The largest value of a marker, relative to the size of its compliance.
     */
    double
    largest_displacement(const Vector &s) const;

    /** Whether the Schur complement may do: what each marker's own compliance
     * times its own stiffness says of C H. */
    bool
    stiffness_is_small() const;

    /**
     * Solves by the Schur complement of the constraints.
     * @param uncoupled $R S K^{-1} r$
     * @param[out] mu, phi forces of constraints and on the markers
     * @return whether that converged
     */
    bool
    eliminate_markers(const Vector &uncoupled,
                      const Vector &g,
                      Vector &mu,
                      Vector &phi);

    /**
     * Solves the small system.
     * @param uncoupled, changes what the uncoupled bodies give to its first and
     * its last rows
     */
    Vector
    couple(const Vector &uncoupled, const Vector &g, const Vector &changes);

    const MultibodySystem &system;
    FactorizationCache &cache;
    Statistics &statistics;

    std::vector<JointedFactorization<Number> *> factors;
    std::vector<Number> scales;

    /** Per marker of the system. */
    std::vector<Eigen::Matrix3d> rotations;

    /** Right-hand sides, those with the same factor one after the other. */
    std::vector<Number> values;
    std::vector<std::size_t> offsets;
    std::vector<std::vector<unsigned int>> groups;

    /** Work space: entries of a matrix. */
    Triplets triplets;

    /** Per body, and the number of its first marker value. */
    std::vector<MarkerCompliance<Number>> compliances;
    std::vector<unsigned int> first_values;

    /** Per marker, see MarkerCompliance; without H nothing. */
    std::vector<double> marker_sizes;

    RepeatedPattern<Number> H_transposed;
    RepeatedPattern<double> D;
    MarkerLinearization::Triplets redundancy;
    bool is_first = true;

    /** Unless there are changes. */
    ConstraintSystem<Number> constraint_system;

    /** All unknowns; whether it is factorised since prepare(). */
    MarkerSystem<Number> marker_system;
    bool is_complete = false;

    /** Per body, if there are any. */
    std::vector<MatrixChange<Number>> changes;
    unsigned int n_change_unknowns = 0;

    /** Of the last solve, for solution(): $\phi$, all unknowns if there are
     * changes, and whether the $r_b$ are zero. */
    Vector marker_forces;
    Vector unknowns;
    bool right_hand_sides_are_zero = false;
  };
} // namespace ACF

#endif
