// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_stage_equations_h
#define acf_time_stage_equations_h

#include <acf/mechanics/reduced_strain_residual.h>
#include <acf/solvers/stage_tangent.h>

#include <string>

namespace ACF
{
  /**
   * The equations of the stages of one Radau IIA step from a state
   * $(u_n, v_n)$: with $Z_i = U_i - u_n - c_i \tau v_n$
   * \f[ \tau^{-2} (A_{RK}^{-2} \otimes M) Z + F(U, V) + B(U)^T \Lambda = P,
   *     \qquad \Phi(U_i, t_n + c_i \tau) = 0, \qquad
   *     V_i = v_n + \tau^{-1} \sum_j (A_{RK}^{-1})_{ij} Z_j . \f]
   * See theory (11.1), theory (11.2), theory (11.3).
   */
  class StageEquations
  {
  public:
    StageEquations(const MultibodySystem &system,
                   const ButcherTableau &tableau,
                   Statistics &statistics);

    /**
     * The step that the other functions are about.
     * @param state must live as long as they are called
     */
    void
    start_step(const SystemState &state, const double step_size);

    double
    step_size() const
    {
      return tau;
    }

    /** $U_i$ of a body, m. */
    NodalVector
    position(const unsigned int stage, const unsigned int body) const;

    /** Position and velocity of a body in the last stage, the end of the step,
     * m and m/s. */
    void
    end_state(const unsigned int body, NodalVector &x, NodalVector &v) const;

    double
    time(const unsigned int stage) const;

    /** Sums over $x_n$ of a body. */
    const NodalMoments &
    start_moments(const unsigned int body) const
    {
      return position_moments[body];
    }

    /** Sums over $v_n$. */
    const NodalMoments &
    start_velocity_moments(const unsigned int body) const
    {
      return velocity_moments[body];
    }

    /**
     * Forces that are missing for equilibrium, and minus the residuals of the
     * constraints: the right-hand sides of a Newton iteration.
     * @return false, and why, if a body is turned inside out
     */
    bool
    residual(StageVector &forces,
             StageConstraints &constraints,
             std::string &failure);

    /** $\Phi$ in each stage. */
    StageConstraints
    constraint_residual() const;

    /**
     * Rotations of the bodies in the stages, for the strain of Green and
     * Lagrange of the material at each node; those of the start of the step
     * where a stage has none.
     * @throws SimulationError if the state at the start is turned inside out
     */
    StageRotations
    rotations();

    /**
     * U and B of the reduced strain at the start of the step in the frame of
     * the body, see ReducedStrainTangent. (The prediction may be stretched
     * where the body turns; its stress would make the matrix too stiff.)
     * @param corrected the bodies that get them; others and those with the
     * strain of Green and Lagrange have columns of rank 0
     */
    std::vector<LowRankChange>
    reduced_strain_changes(const std::vector<bool> &corrected) const;

    /** Linearisation of the markers at the mean of the stages. */
    MarkerLinearization
    mean_linearization() const;

    /**
     * The exact derivatives at the stages.
     * @param exact the bodies for which the elastic force is linearised
     * exactly, see StageTangent
     * @return false, and why, if a body is turned inside out
     */
    bool
    linearize(const std::vector<bool> &exact,
              const StageRotations &rotations,
              StageTangent &tangent,
              std::string &failure) const;

    /** Must be called when @p increments have been changed. */
    void
    increments_have_changed();

    /** Sums over increments of a body, which rotations() and residual() need:
     * they may be made while the increments are in the caches. */
    void
    evaluate_moments(const unsigned int body)
    {
      moments_of_increments(body);
    }

    /** Increments Z, m. */
    StageVector increments;

    /** $\Lambda$ */
    StageConstraints multipliers;

  private:
    void
    set_position(const unsigned int stage,
                 const unsigned int body,
                 NodalVector &x) const;

    void
    set_velocity(const unsigned int stage,
                 const unsigned int body,
                 NodalVector &v) const;

    /** Sums over $Z_i$ of all stages. */
    const std::vector<NodalMoments> &
    moments_of_increments(const unsigned int body);

    /** Sums over $U_i$. */
    NodalMoments
    moments(const unsigned int stage, const unsigned int body);

    /**
     * What a body and its loads alone give to the residual.
     * @return false if the body is turned inside out
     */
    bool
    body_residual(const unsigned int body, StageVector &residual);

    /** That of a body with the reduced strain. */
    bool
    reduced_residual(const unsigned int body, StageVector &residual);

    /** That of a body with the strain of Green and Lagrange. */
    bool
    green_lagrange_residual(const unsigned int body, StageVector &residual);

    void
    add_material_rotations(const unsigned int body,
                           StageRotations &rotations) const;

    /** $S Z_i$ of all stages: only nodes of markers. */
    std::vector<Eigen::VectorXd>
    marker_increments() const;

    /** $S U_i = S x_n + c_i \tau S v_n + S Z_i$ */
    Eigen::VectorXd
    marker_positions(const std::vector<Eigen::VectorXd> &increments,
                     const unsigned int stage) const;

    /** $S V_i$ */
    Eigen::VectorXd
    marker_velocities(const std::vector<Eigen::VectorXd> &increments,
                      const unsigned int stage) const;

    /** $S \dot V_i$ */
    Eigen::VectorXd
    marker_accelerations(const std::vector<Eigen::VectorXd> &increments,
                         const unsigned int stage) const;

    const MultibodySystem &system;
    const ButcherTableau &tableau;
    Statistics &statistics;
    const Eigen::MatrixXd A_inverse;
    const Eigen::MatrixXd A_inverse_squared;

    /** Nodes of markers, for bodies with the strain of Green and Lagrange. */
    std::vector<NodeSets> marker_nodes;

    const SystemState *state = nullptr;
    double tau               = 0;

    /** $S x_n$ and $S v_n$ */
    Eigen::VectorXd start_markers, start_marker_rates;

    /** See start_moments(). */
    std::vector<NodalMoments> position_moments, velocity_moments;

    /** Sums over the increments, of each body and stage; none for a body where
     * they have not been needed yet. */
    std::vector<std::vector<NodalMoments>> increment_moments;

    /** Work space of each body, as far as it is used. */
    struct Work
    {
      NodalVector position, velocity, scratch;
      std::vector<NodalVector> accelerations, inertia;
    };
    std::vector<Work> work;
  };
} // namespace ACF

#endif
