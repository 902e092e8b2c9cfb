// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef tests_reference_gauss_method_h
#define tests_reference_gauss_method_h

#include <Eigen/Dense>

namespace Reference
{
  /** Equations of motion M(t, Q) Q'' + f(t, Q, Q') = 0. */
  class EquationsOfMotion
  {
  public:
    virtual ~EquationsOfMotion() = default;

    /** The left-hand side for Q'' = A; affine in A. */
    virtual Eigen::VectorXd
    residual(const double time,
             const Eigen::VectorXd &Q,
             const Eigen::VectorXd &V,
             const Eigen::VectorXd &A) const = 0;

    /** Constant part of df/dQ that may be large. */
    virtual const Eigen::MatrixXd &
    stiffness() const = 0;

    /** M(t, Q), from differences of the residual, thus with rounding errors. */
    Eigen::MatrixXd
    mass_matrix(const double time, const Eigen::VectorXd &Q) const;

    /** Q''. */
    Eigen::VectorXd
    acceleration(const double time,
                 const Eigen::VectorXd &Q,
                 const Eigen::VectorXd &V) const;
  };

  /**
   * The Gauss method with five stages: order 10, A-stable, conserves the energy
   * of linear systems. The high order serves the vibrations: a release excites
   * all of them, none is damped, and the errors of their phases accumulate.
   */
  class GaussMethod
  {
  public:
    /**
     * @param equations must live as long as this object
     * @param position at time zero
     * @param velocity at time zero
     * @param scale magnitude of the positions: the iteration of a step stops
     *   with a correction less than 1e-14 of it, or of the largest position
     */
    GaussMethod(const EquationsOfMotion &equations,
                const Eigen::VectorXd &position,
                const Eigen::VectorXd &velocity,
                const double scale = 1);

    /**
     * Integrates until end_time with equal steps of at most step_size.
     * @throws std::invalid_argument if end_time is before time()
     * @throws std::runtime_error if the nonlinear iteration fails
     */
    void
    advance(const double end_time, const double step_size);

    double
    time() const;

    const Eigen::VectorXd &
    position() const;

    const Eigen::VectorXd &
    velocity() const;

  private:
    static constexpr Eigen::Index n_stages = 5;
    using StageMatrix = Eigen::Matrix<double, n_stages, n_stages>;

    void
    step(const double step_size);

    void
    factorize(const double step_size);

    const EquationsOfMotion &equations;
    const double scale;
    double now = 0;
    Eigen::VectorXd Q;
    Eigen::VectorXd V;
    Eigen::MatrixXd stage_accelerations;

    // The coefficients c, b and A of the method
    Eigen::Matrix<double, n_stages, 1> nodes;
    Eigen::Matrix<double, n_stages, 1> weights;
    StageMatrix coefficients;
    Eigen::PartialPivLU<Eigen::MatrixXd> factors;
    double factorized_step = 0;
    bool slow              = false;
  };
} // namespace Reference

#endif
