// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_multibody_system_h
#define acf_mechanics_multibody_system_h

#include <acf/mechanics/body.h>
#include <acf/mechanics/force_elements.h>
#include <acf/mechanics/joints.h>
#include <acf/mechanics/loads.h>
#include <acf/mechanics/lumped_mass.h>
#include <acf/mechanics/repeated_constraints.h>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include <optional>

namespace ACF
{
  class Archive;

  /** What a model file says of the mechanical system. */
  struct SystemParameters
  {
    std::vector<BodyParameters> bodies;
    std::vector<JointParameters> joints;
    LoadParameters loads;
    std::vector<SurfaceLoadParameters> surface_loads;
    std::vector<ForceElementParameters> force_elements;
    std::vector<LumpedMassParameters> masses;
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

    /** Values of the laws of all force elements; angles are continuous. */
    Eigen::VectorXd law_values;

    /** Saves or loads. */
    void
    exchange(Archive &archive);
  };



  /** Energies of the system, J. */
  struct SystemEnergy
  {
    double kinetic = 0;

    /** Of bodies and springs. */
    double elastic = 0;

    /** Of gravity. */
    double potential = 0;
  };



  /**
   * What joints, force elements and lumped masses add to the linearised
   * equations, on the marker values of the system.
   */
  struct MarkerLinearization
  {
    using Triplets = std::vector<Eigen::Triplet<double>>;

    /** D, constraints x marker values. */
    Triplets constraints;

    /** Marker values x marker values: derivatives by position, velocity and
     * acceleration of minus the forces on the markers. */
    Triplets stiffness;
    Triplets damping;
    Triplets mass;

    /**
     * $E = \mathrm{diag}(c)^{-1} N N^T \mathrm{diag}(c)^{-1}$ with the
     * RepeatedConstraints N and row scales c, constraints x constraints. With
     * $D s - \epsilon E \lambda = g$ in place of $D s = g$ the constraints
     * hold and the multipliers have the smallest norm $|\lambda / c|$.
     */
    Triplets redundancy;
  };



  /**
   * Bodies, joints, force elements, masses and loads: the equations of motion
   * \f[ M \ddot x + f(x, \dot x) + S^T (D^T \lambda + M_L S \ddot x - Q)
   *     = p, \qquad \Phi(S x, t) = 0 \f]
   * (paper Eq. (29)). Joints and force elements see the bodies through the
   * values s = S x of markers only. Constant after construction.
   * See theory (10.1).
   */
  class MultibodySystem
  {
  public:
    /**
     * @param directory where relative mesh file names start
     * @throws InputError if something does not fit
     */
    MultibodySystem(const SystemParameters &parameters,
                    const std::filesystem::path &directory);

    /** Bodies, joints and gravity only. */
    MultibodySystem(const std::vector<BodyParameters> &bodies,
                    const std::vector<JointParameters> &joints,
                    const LoadParameters &loads,
                    const std::filesystem::path &directory);

    MultibodySystem(const MultibodySystem &) = delete;
    MultibodySystem &
    operator=(const MultibodySystem &) = delete;

    const std::vector<Body> &
    bodies() const
    {
      return system_bodies;
    }

    /** Number of different reference bodies. */
    unsigned int
    n_reference_bodies() const
    {
      return reference_bodies.size();
    }

    const std::vector<Joint> &
    joints() const
    {
      return system_joints;
    }

    const std::vector<ForceElement> &
    force_elements() const
    {
      return elements;
    }

    const std::vector<LumpedMass> &
    masses() const
    {
      return lumped_masses;
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
      return n_rows;
    }

    /** The joint to which a row belongs. */
    unsigned int
    joint_of_row(const unsigned int row) const;

    /** Acceleration of gravity, m/s^2. */
    Vector3
    gravity(const double t) const
    {
      return gravity_factor(t) * gravity_acceleration;
    }

    /** Functionals of a body's reference body that are its markers. */
    const std::vector<unsigned int> &
    body_markers(const unsigned int body) const
    {
      return markers[body];
    }

    /** Number of a body's first marker among those of the system. */
    unsigned int
    first_marker(const unsigned int body) const
    {
      return first_markers[body];
    }

    /** Size of S x: three per marker. */
    unsigned int
    n_marker_values() const
    {
      return dim * first_markers.back();
    }

    /** S x for positions, velocities or accelerations. */
    Eigen::VectorXd
    marker_values(const SystemVector &x) const;

    /** Whether joints have a constant D. */
    bool
    has_affine_joints() const
    {
      return affine_joints;
    }

    /** Whether forces depend on velocities. */
    bool
    needs_velocities() const
    {
      return damped;
    }

    /** As the model file says; neither forces nor constraints are checked. */
    SystemState
    initial_state() const;

    /** Positions of the undeformed bodies as they are placed, m. */
    SystemVector
    placement() const;

    /** $\Phi$ for marker values s, m or rad. */
    Eigen::VectorXd
    constraint_residual(const double t, const Eigen::VectorXd &s) const;

    /** $\Phi$ for positions. */
    Eigen::VectorXd
    constraint_residual(const SystemVector &positions,
                        const double t = 0) const;

    /** $\dot \Phi$, m/s or rad/s. */
    Eigen::VectorXd
    constraint_velocity(const double t,
                        const Eigen::VectorXd &s,
                        const Eigen::VectorXd &v) const;

    /**
     * Values of the laws of all force elements, angles on the branch nearest
     * to a reference (if it is not empty).
     */
    Eigen::VectorXd
    law_values(const Eigen::VectorXd &s,
               const Eigen::VectorXd &reference) const;

    /**
     * Forces on the markers, $Q - D^T \lambda + m g - M_L a$.
     * @param v, a velocities and accelerations of the markers; may be empty if
     * needs_velocities() is false, or if there are no lumped masses
     * @param law_reference see law_values()
     * @param load_factor factor of gravity and of actuations
     */
    Eigen::VectorXd
    marker_forces(const double t,
                  const Eigen::VectorXd &s,
                  const Eigen::VectorXd &v,
                  const Eigen::VectorXd &a,
                  const Eigen::VectorXd &multipliers,
                  const Eigen::VectorXd &law_reference,
                  const double load_factor = 1) const;

    /** Derivatives at the markers, see theory (12.2). */
    MarkerLinearization
    linearize(const double t,
              const Eigen::VectorXd &s,
              const Eigen::VectorXd &v,
              const Eigen::VectorXd &multipliers,
              const Eigen::VectorXd &law_reference,
              const double load_factor = 1) const;

    /** Adds $S^T F$ for forces F on the markers to the force on a body. */
    void
    add_marker_forces(const unsigned int body,
                      const Eigen::VectorXd &F,
                      NodalVector &force) const;

    /**
     * Adds $-S^T D^T \lambda$, the forces of all joints on the nodes of a
     * body. Their sum over the nodes of a surface is the force of the joint on
     * it; moments are pairs of such forces. See theory (10.3).
     */
    void
    add_joint_forces(const unsigned int body,
                     const SystemState &state,
                     NodalVector &force) const;

    /** Whether add_surface_loads() adds any. */
    bool
    has_surface_loads(const unsigned int body) const;

    /** Adds surface loads, times a factor. */
    void
    add_surface_loads(const unsigned int body,
                      const double t,
                      const NodalVector &positions,
                      NodalVector &force,
                      const double load_factor = 1) const;

    /** Adds gravity and surface loads, times a factor. */
    void
    add_loads(const unsigned int body,
              const double t,
              const NodalVector &positions,
              NodalVector &force,
              const double load_factor = 1) const;

    /**
     * Gravity's potential is zero at the origin of the world. See theory
     * (18.2).
     */
    SystemEnergy
    energy(const SystemState &state) const;

    /**
     * Linear momentum, kg m/s. See theory (18.2).
     */
    Vector3
    momentum(const SystemState &state) const;

    /**
     * Angular momentum about the origin of the world, kg m^2/s. See theory
     * (18.2).
     */
    Vector3
    angular_momentum(const SystemState &state) const;

    /** Force and moment of a joint on its first side that is a body. */
    struct Reaction
    {
      /** N */
      Vector3 force;

      /** About the mean position of the side's surface, N m. */
      Vector3 moment;
    };

    Reaction
    reaction(const unsigned int joint, const SystemState &state) const;

    /**
     * How far repeated constraints contradict each other at a time, m or rad;
     * zero if there are none.
     */
    double
    contradiction(const double t, const Eigen::VectorXd &s) const;

    /** Names of the joints that repeat constraints, for messages. */
    std::string
    repeating_joints() const;

    /** Number of constraints that repeat others. */
    unsigned int
    n_repeated_constraints() const
    {
      return repeated.null_space.cols();
    }

  private:
    /** Forces of a joint on its markers, $-D^T \lambda$. */
    Eigen::VectorXd
    joint_marker_forces(const unsigned int joint,
                        const Eigen::VectorXd &s,
                        const SystemState &state) const;

    /** @return the joints of the model and those that hold parts together */
    std::vector<JointParameters>
    make_bodies(const SystemParameters &parameters,
                const std::filesystem::path &directory);

    /** Numbers in the system of the markers of a set. */
    std::vector<unsigned int>
    register_markers(const MarkerSet &set);

    void
    number_markers();

    /** Repeated constraints at marker values s. */
    RepeatedConstraints
    repeated_constraints(const Eigen::VectorXd &s) const;

    std::vector<std::shared_ptr<ReferenceBody>> reference_bodies;
    std::vector<Body> system_bodies;
    std::vector<Joint> system_joints;
    std::vector<ForceElement> elements;
    std::vector<LumpedMass> lumped_masses;
    std::vector<SurfaceLoad> surface_loads;
    Vector3 gravity_acceleration;
    TimeFunction gravity_factor;

    std::vector<unsigned int> first_rows;
    unsigned int n_rows = 0;

    /** Per body: functionals of the reference body. */
    std::vector<std::vector<unsigned int>> markers;
    std::vector<unsigned int> first_markers;

    /** Per joint, force element and mass: numbers of its markers. */
    std::vector<std::vector<unsigned int>> joint_markers;
    std::vector<std::vector<unsigned int>> element_markers;
    std::vector<std::vector<unsigned int>> mass_markers;

    bool affine_joints = true;
    bool damped        = false;

    /** At the placement. */
    RepeatedConstraints repeated;
  };
} // namespace ACF

#endif
