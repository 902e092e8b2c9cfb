// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/solvers/coupled_system.h>
#include <acf/time/equilibrium.h>
#include <acf/time/start.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>

namespace ACF
{
  void
  StartParameters::add_parameters(ParameterHandler &prm)
  {
    prm.declare_entry(
      "Projection",
      "none",
      Patterns::Selection("none|velocities|positions and velocities"),
      "What is changed at the start so that it fits the joints: nothing (a "
      "state that does not fit is an error), the velocities, or positions and "
      "velocities. Units: none.");
    prm.add_action("Projection", [this](const std::string &value) {
      project_velocities = (value != "none");
      project_positions  = (value == "positions and velocities");
    });
    prm.add_parameter("Equilibrium",
                      equilibrium,
                      "Whether the simulation starts in the static "
                      "equilibrium at t = 0 that is found from the given "
                      "positions; the given velocities stay. Units: none.");
    prm.add_parameter("Load steps",
                      n_load_steps,
                      "In how many equal steps gravity, loads and actuations "
                      "grow on the way to the equilibrium. Units: none.",
                      Patterns::Integer(1, 1000));
  }



  void
  StartParameters::check() const
  {
    if (n_load_steps > 1 && !equilibrium)
      throw InputError("Start",
                       "Load steps",
                       std::to_string(n_load_steps),
                       "1 without 'Equilibrium = true'");
  }



  namespace
  {
    double
    largest_length(const MultibodySystem &system)
    {
      double length = 0;
      for (const Body &body : system.bodies())
        length = std::max(length, body.operators().length);
      return length;
    }



    double
    largest_velocity(const SystemState &state)
    {
      double velocity = 0;
      for (const NodalVector &v : state.velocities)
        velocity = std::max(velocity, v.linfty_norm());
      return velocity;
    }



    // The joint with the largest residual.
    const Joint &
    worst_joint(const MultibodySystem &system, const Eigen::VectorXd &residual)
    {
      Eigen::Index row;
      residual.cwiseAbs().maxCoeff(&row);
      return system.joints()[system.joint_of_row(row)];
    }



    void
    check_repeated_constraints(const MultibodySystem &system,
                               const Eigen::VectorXd &s,
                               std::ostream &log)
    {
      const unsigned int n = system.n_repeated_constraints();
      if (n == 0)
        return;
      const double contradiction = system.contradiction(0, s);
      if (contradiction > 1e-8 * std::max(1., largest_length(system)))
        throw InputError("Joints",
                         "Names",
                         "joints that contradict each other by " +
                           format_number(contradiction) +
                           " m or rad: " + system.repeating_joints(),
                         "joints that can all be satisfied");
      log << n << (n == 1 ? " constraint" : " constraints") << " of the joints "
          << system.repeating_joints()
          << (n == 1 ? " repeats others: its" : " repeat others: their")
          << " multipliers are those of the smallest norm" << std::endl;
    }



    // Projects positions or velocities.
    class Projection
    {
    public:
      Projection(const MultibodySystem &system,
                 const double step_size,
                 FactorizationCache &cache,
                 Statistics &statistics)
        : system(system)
        , squared_rate(step_size > 0 ? 1 / (step_size * step_size)
                                     : slow_squared_rate(system))
        , coupled_system(system, cache, statistics)
      {}

      // Adds the change of x to g at the positions of the state; returns the
      // largest one.
      double
      correct(const SystemState &state,
              const Eigen::VectorXd &g,
              SystemVector &x)
      {
        std::vector<NodeRotations> rotations;
        std::vector<BodyMatrix<double>> matrices;
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          {
            const auto frame = body_rotation(
              mean_deformation_gradient(system.bodies()[b].operators(),
                                        state.positions[b]),
              system.bodies()[b].rotation_measure());
            if (!frame)
              throw SimulationError("Body '" + system.bodies()[b].name() +
                                    "' is turned inside out at the start.");
            rotations.push_back(frame->rotation);
            matrices.push_back({squared_rate, 1.});
          }
        const Eigen::VectorXd s = system.marker_values(state.positions);
        MarkerLinearization linearization =
          system.linearize(0,
                           s,
                           system.marker_values(state.velocities),
                           Eigen::VectorXd::Zero(system.n_constraints()),
                           state.law_values);
        coupled_system.prepare(matrices,
                               rotations,
                               linearization,
                               {squared_rate, 0., 0.});
        coupled_system.solve_constraints(g);
        double largest = 0;
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          if (const double *const solution = coupled_system.solution(b))
            for (unsigned int a = 0; a < x[b].size() / dim; ++a)
              {
                Vector3 w;
                for (unsigned int i = 0; i < dim; ++i)
                  w[i] = solution[dim * a + i];
                w       = rotations[b][a] * w;
                largest = std::max(largest, w.norm());
                for (unsigned int i = 0; i < dim; ++i)
                  x[b][dim * a + i] += w[i];
              }
        return largest;
      }

    private:
      const MultibodySystem &system;
      const double squared_rate;
      CoupledSystem<double> coupled_system;
    };



    void
    project_positions(const MultibodySystem &system,
                      Projection &projection,
                      SystemState &state,
                      std::ostream &log)
    {
      const double tolerance    = 1e-13 * std::max(1., largest_length(system));
      const SystemVector before = state.positions;
      for (unsigned int k = 0; k < 50; ++k)
        {
          const Eigen::VectorXd residual =
            system.constraint_residual(state.positions);
          if (residual.lpNorm<Eigen::Infinity>() <= tolerance)
            {
              double largest = 0;
              for (unsigned int b = 0; b < before.size(); ++b)
                {
                  NodalVector change(state.positions[b]);
                  change -= before[b];
                  largest = std::max(largest, change.linfty_norm());
                }
              log << "Positions at the start were changed by up to "
                  << format_number(largest) << " m to fit the joints"
                  << std::endl;
              return;
            }
          projection.correct(state, -residual, state.positions);
        }
      throw SimulationError(
        "The positions at the start cannot be made to fit the joint '" +
        worst_joint(system, system.constraint_residual(state.positions)).name +
        "'.");
    }



    Eigen::VectorXd
    velocity_residual(const MultibodySystem &system, const SystemState &state)
    {
      return system.constraint_velocity(0,
                                        system.marker_values(state.positions),
                                        system.marker_values(state.velocities));
    }



    void
    check_positions(const MultibodySystem &system, const SystemState &state)
    {
      const Eigen::VectorXd residual =
        system.constraint_residual(state.positions);
      const double distance = residual.lpNorm<Eigen::Infinity>();
      if (distance > 1e-8 * std::max(1., largest_length(system)))
        throw InputError(worst_joint(system, residual).section,
                         "Between",
                         "a state at the start that violates the joint by " +
                           format_number(distance) + " m or rad",
                         "bodies and displacement fields that fit the joint, "
                         "or 'Projection = positions and velocities' in the "
                         "section Start");
    }



    // What moves a body by less than the tolerance of a step is no jump.
    double
    negligible_velocity(const MultibodySystem &system,
                        const SystemState &state,
                        const double step_size)
    {
      const double length   = largest_length(system);
      const double rounding = 1e-7 * largest_velocity(state);
      const double interval =
        step_size > 0 ? step_size : 1 / std::sqrt(slow_squared_rate(system));
      return rounding * std::max(1., 1 / length) + 1e-10 * length / interval;
    }



    void
    check_velocities(const MultibodySystem &system,
                     const SystemState &state,
                     const double step_size)
    {
      const Eigen::VectorXd rate = velocity_residual(system, state);
      const double speed         = rate.lpNorm<Eigen::Infinity>();
      if (speed > negligible_velocity(system, state, step_size))
        throw InputError(worst_joint(system, rate).section,
                         "Between",
                         "velocities at the start that the joint does not "
                         "allow: a jump of " +
                           format_number(speed) + " m/s or rad/s",
                         "a Velocity, an Angular velocity and a Velocity field "
                         "of the bodies that fit the joint and its prescribed "
                         "motion, or 'Projection = velocities' in the section "
                         "Start");
    }



    // The second correction is for round-off.
    void
    project_velocities(const MultibodySystem &system,
                       Projection &projection,
                       SystemState &state,
                       std::ostream &log)
    {
      double change = 0;
      for (unsigned int k = 0; k < 2; ++k)
        change = std::max(change,
                          projection.correct(state,
                                             -velocity_residual(system, state),
                                             state.velocities));
      log << "Velocities at the start were changed by up to "
          << format_number(change) << " m/s to fit the joints" << std::endl;
    }



    void
    find_equilibrium(const MultibodySystem &system,
                     const StartParameters &parameters,
                     SystemState &state,
                     Statistics &statistics,
                     std::ostream &log)
    {
      EquilibriumSolver solver(system, statistics);
      const EquilibriumReport report =
        solver.solve(state, parameters.n_load_steps);
      statistics.equilibrium_iterations = report.iterations;
      log << "Static equilibrium found with " << report.iterations
          << " iterations: positions at the start were changed by up to "
          << format_number(report.displacement) << " m" << std::endl;
    }
  } // namespace



  void
  check_start(const MultibodySystem &system,
              const StartParameters &parameters,
              const double step_size,
              std::ostream &log)
  {
    if (system.n_constraints() == 0)
      return;
    const SystemState state = system.initial_state();
    check_repeated_constraints(system,
                               system.marker_values(state.positions),
                               log);
    if (parameters.project_positions)
      return;
    check_positions(system, state);
    if (!parameters.equilibrium && !parameters.project_velocities)
      check_velocities(system, state, step_size);
  }



  SystemState
  initial_state(const MultibodySystem &system,
                const StartParameters &parameters,
                const double step_size,
                FactorizationCache &cache,
                Statistics &statistics,
                std::ostream &log)
  {
    SystemState state      = system.initial_state();
    const bool has_joints  = system.n_constraints() > 0;
    const auto update_laws = [&]() {
      if (!system.force_elements().empty())
        state.law_values =
          system.law_values(system.marker_values(state.positions),
                            Eigen::VectorXd());
    };
    std::optional<Projection> projection;
    if (has_joints &&
        (parameters.project_positions || parameters.project_velocities))
      projection.emplace(system, step_size, cache, statistics);
    check_start(system, parameters, step_size, log);
    if (has_joints && parameters.project_positions)
      {
        project_positions(system, *projection, state, log);
        update_laws();
      }
    if (parameters.equilibrium)
      find_equilibrium(system, parameters, state, statistics, log);
    if (has_joints)
      {
        if (parameters.project_velocities)
          project_velocities(system, *projection, state, log);
        check_velocities(system, state, step_size);
      }
    return state;
  }
} // namespace ACF
