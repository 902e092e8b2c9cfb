// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_multibody_system_h
#define acf_mechanics_multibody_system_h

#include <acf/mechanics/body.h>
#include <acf/mechanics/joints.h>

#include <Eigen/Dense>

#include <optional>

namespace ACF
{
  /** What a model file says of the loads. */
  struct LoadParameters
  {
    /** m/s^2 */
    Vector3 gravity;

    void
    add_parameters(ParameterHandler &prm);
  };



  /** One nodal vector per body. */
  using SystemVector = std::vector<NodalVector>;



  /** State of all bodies at one time. */
  struct SystemState
  {
    /** s */
    double time = 0;

    /** m */
    SystemVector positions;

    /** m/s */
    SystemVector velocities;

    /** Multipliers of the constraints, N or N m. */
    Eigen::VectorXd multipliers;
  };



  /** Energies of the system, J. */
  struct SystemEnergy
  {
    double kinetic   = 0;
    double elastic   = 0;
    double potential = 0;
  };



  /**
   * Bodies, joints and loads: the equations of motion
   * \f[ M \ddot x + f(x) + B^T \lambda = p, \qquad B x = b \f]
   * (paper Eq. (29)). Constant after construction.
   */
  class MultibodySystem
  {
  public:
    /**
     * Constraints of one body: rows of the system's constraints and their
     * coefficients $D_b$ on the values of the body's joint functionals.
     */
    struct BodyConstraints
    {
      std::vector<unsigned int> rows;

      /** Size rows x 3 Body::joint_functionals(). */
      Eigen::MatrixXd matrix;
    };

    /**
     * @param directory where relative mesh file names start
     * @throws InputError if joints do not fit to the bodies, repeat constraints
     * of other joints, or the initial velocities violate a constraint
     */
    MultibodySystem(const std::vector<BodyParameters> &bodies,
                    const std::vector<JointParameters> &joints,
                    const LoadParameters &loads,
                    const std::filesystem::path &directory);

    const std::vector<Body> &
    bodies() const
    {
      return system_bodies;
    }

    const std::vector<Joint> &
    joints() const
    {
      return system_joints;
    }

    /** First row of a joint among all constraints. */
    unsigned int
    first_constraint(const unsigned int joint) const
    {
      return first_rows[joint];
    }

    unsigned int
    n_constraints() const
    {
      return right_hand_side.size();
    }

    const BodyConstraints &
    constraints(const unsigned int body) const
    {
      return body_constraints[body];
    }

    const Vector3 &
    gravity() const
    {
      return gravity_acceleration;
    }

    SystemState
    initial_state() const;

    /**
     * Values of the joint functionals of a body, size 3 n.
     */
    Eigen::VectorXd
    functional_values(const unsigned int body, const NodalVector &x) const;

    /** $B x - b$, m or rad. */
    Eigen::VectorXd
    constraint_residual(const SystemVector &positions) const;

    /** $B v$, m/s or rad/s. */
    Eigen::VectorXd
    constraint_velocity(const SystemVector &velocities) const;

    /**
     * Adds $p - B^T \lambda$ to the force on a body.
     */
    void
    add_external_and_joint_forces(const unsigned int body,
                                  const Eigen::VectorXd &multipliers,
                                  NodalVector &force) const;

    /** Gravity's potential is zero at the origin of the world. */
    SystemEnergy
    energy(const SystemState &state) const;

    /** Linear momentum, kg m/s. */
    Vector3
    momentum(const SystemState &state) const;

    /** Angular momentum about the origin of the world, kg m^2/s. */
    Vector3
    angular_momentum(const SystemState &state) const;

    /** Force and moment of a joint on its body. */
    struct Reaction
    {
      /** N */
      Vector3 force;

      /** About the mean position of the joint's surface, N m. */
      Vector3 moment;
    };

    Reaction
    reaction(const unsigned int joint, const SystemState &state) const;

  private:
    void
    check_initial_velocities(const std::vector<JointParameters> &joints) const;

    void
    check_redundant_constraints(
      const std::vector<JointParameters> &joints) const;

    Eigen::VectorXd
    apply_constraints(const SystemVector &x) const;

    std::vector<Body> system_bodies;
    std::vector<Joint> system_joints;
    std::vector<unsigned int> first_rows;
    std::vector<BodyConstraints> body_constraints;
    Eigen::VectorXd right_hand_side;
    Vector3 gravity_acceleration;
  };
} // namespace ACF

#endif
