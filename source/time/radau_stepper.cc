// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/mechanics/reduced_strain.h>
#include <acf/time/radau_stepper.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ACF
{
  void
  TimeParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Stages",
                      n_stages,
                      "Stages s of the Radau IIA method; positions converge "
                      "with order 2s-1, velocities with s, reactions with s-1. "
                      "Units: none.",
                      Patterns::Integer(2, 3));
    prm.add_parameter("End time",
                      end_time,
                      "Time at which the simulation ends; it starts at zero; "
                      "required, but for a simulation that is over after the "
                      "static equilibrium or the modes at the start. Units: "
                      "s.",
                      Patterns::Double(0));
    prm.add_parameter("Step size",
                      step_size,
                      "Size of the time steps; required. Units: s.",
                      Patterns::Double(0));
    prm.add_parameter(
      "Newton tolerance",
      newton_tolerance,
      "Bound on the predicted error of the positions that the iteration of a "
      "step leaves, relative to the length of a body. Units: none.",
      Patterns::Double(1e-14, 1e-2));
    prm.add_parameter("Maximal Newton iterations",
                      max_newton_iterations,
                      "Iterations after which a step is given up and halved. "
                      "Units: none.",
                      Patterns::Integer(2, 1000));
    prm.add_parameter("Maximal halvings",
                      max_halvings,
                      "How often a step that does not converge is halved "
                      "before the simulation fails. Units: none.",
                      Patterns::Integer(0, 30));
    prm.declare_entry(
      "Stage matrices",
      "diagonalized",
      Patterns::Selection("diagonalized|one-step"),
      "Matrices of the Newton iteration: the exact ones of the stages, "
      "diagonalised (one complex factorisation per conjugate pair), or for "
      "comparison real one-step matrices in the manner of the paper, which "
      "need more iterations. Units: none.");
    prm.add_action("Stage matrices", [this](const std::string &value) {
      one_step_matrices = (value == "one-step");
    });
  }



  void
  TimeParameters::check() const
  {
    const auto require_positive = [](const std::string &entry,
                                     const double value) {
      if (!(value > 0))
        throw InputError("Time integration",
                         entry,
                         "nothing or zero",
                         "a positive number");
    };
    require_positive("End time", end_time);
    require_positive("Step size", step_size);
    if (step_size > end_time)
      throw InputError("Time integration",
                       "Step size",
                       "a step larger than the End time",
                       "a positive number not larger than the End time");
  }



  RadauStepper::RadauStepper(const MultibodySystem &system,
                             const TimeParameters &parameters,
                             Statistics &statistics)
    : system(system)
    , parameters(parameters)
    , statistics(statistics)
    , tableau(radau_iia(parameters.n_stages))
    , A_inverse(tableau.A.inverse())
    , A_inverse_squared(A_inverse * A_inverse)
    , cache(statistics)
  {
    if (parameters.one_step_matrices)
      stage_solver = std::make_unique<OneStepStageSolver>(system,
                                                          tableau,
                                                          cache,
                                                          statistics);
    else
      stage_solver = std::make_unique<DiagonalizedStageSolver>(system,
                                                               tableau,
                                                               cache,
                                                               statistics);
    SystemVector zero;
    for (const Body &body : system.bodies())
      zero.emplace_back(body.operators().n_unknowns());
    stages.assign(tableau.n_stages(), zero);
    stage_multipliers.assign(tableau.n_stages(),
                             Eigen::VectorXd::Zero(system.n_constraints()));
  }



  void
  RadauStepper::predict(const SystemState &state, const double step_size)
  {
    // The collocation polynomial of the accepted step beyond its end, minus
    // u_n + c_i tau v_n; before the first step a motion without acceleration.
    const double ratio =
      accepted_step_size > 0 ? step_size / accepted_step_size : 0;
    const unsigned int last = tableau.n_stages() - 1;
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        const std::vector<double> shape =
          stage_shape(tableau, 1 + tableau.c(i) * ratio);
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          {
            stages[i][b] = 0;
            if (accepted_step_size > 0)
              for (unsigned int j = 0; j <= last; ++j)
                stages[i][b].add(shape[j] - (j == last ? 1. : 0.) -
                                   tableau.c(i) * ratio * A_inverse(last, j),
                                 accepted_stages[j][b]);
          }
        stage_multipliers[i] = state.multipliers;
      }
  }



  NodalVector
  RadauStepper::stage_position(const SystemState &state,
                               const unsigned int stage,
                               const unsigned int body) const
  {
    NodalVector x(state.positions[body]);
    x.add(tableau.c(stage) * tried_step_size,
          state.velocities[body],
          1.,
          stages[stage][body]);
    return x;
  }



  StageRotations
  RadauStepper::predicted_rotations(const SystemState &state) const
  {
    const unsigned int n_stages = tableau.n_stages();
    const unsigned int n_bodies = system.bodies().size();
    StageRotations rotations;
    rotations.mean.resize(n_bodies);
    rotations.stages.assign(n_stages, rotations.mean);
    for (unsigned int b = 0; b < n_bodies; ++b)
      {
        const Body &body     = system.bodies()[b];
        const auto rotate_to = [&body](const Matrix3 &F, Matrix3 &rotation) {
          const std::optional<BodyRotation> frame =
            body_rotation(F, body.rotation_measure());
          if (frame)
            rotation = frame->rotation;
          return frame.has_value();
        };
        Matrix3 start;
        if (!rotate_to(mean_deformation_gradient(body.operators(),
                                                 state.positions[b]),
                       start))
          throw SimulationError("Body '" + body.name() +
                                "' is turned inside out at time " +
                                format_number(state.time) +
                                " s: its mean deformation gradient has a "
                                "determinant that is not positive.");
        // where a prediction is too far off, the start of the step serves
        rotations.mean[b] = start;
        Matrix3 mean;
        for (unsigned int i = 0; i < n_stages; ++i)
          {
            rotations.stages[i][b] = start;
            const Matrix3 F =
              mean_deformation_gradient(body.operators(),
                                        stage_position(state, i, b));
            rotate_to(F, rotations.stages[i][b]);
            mean += F / n_stages;
          }
        rotate_to(mean, rotations.mean[b]);
      }
    return rotations;
  }



  NodalVector
  RadauStepper::stage_velocity(const SystemState &state,
                               const unsigned int stage,
                               const unsigned int body) const
  {
    NodalVector v(state.velocities[body]);
    for (unsigned int j = 0; j < tableau.n_stages(); ++j)
      v.add(A_inverse(stage, j) / tried_step_size, stages[j][body]);
    return v;
  }



  double
  RadauStepper::stage_time(const SystemState &state,
                           const unsigned int stage) const
  {
    return state.time + tableau.c(stage) * tried_step_size;
  }



  void
  RadauStepper::prepare(const SystemState &state)
  {
    MarkerLinearization linearization;
    if (system.n_marker_values() > 0)
      {
        const unsigned int n = tableau.n_stages();
        Eigen::VectorXd s    = Eigen::VectorXd::Zero(system.n_marker_values());
        Eigen::VectorXd v    = s;
        Eigen::VectorXd lambda = Eigen::VectorXd::Zero(system.n_constraints());
        SystemVector work(system.bodies().size());
        for (unsigned int i = 0; i < n; ++i)
          {
            for (unsigned int b = 0; b < work.size(); ++b)
              work[b] = stage_position(state, i, b);
            s += system.marker_values(work) / n;
            lambda += stage_multipliers[i] / n;
            if (!system.needs_velocities())
              continue;
            for (unsigned int b = 0; b < work.size(); ++b)
              work[b] = stage_velocity(state, i, b);
            v += system.marker_values(work) / n;
          }
        linearization = system.linearize(
          state.time + 0.5 * tried_step_size, s, v, lambda, state.law_values);
      }
    stage_solver->prepare(tried_step_size,
                          predicted_rotations(state),
                          linearization);
  }



  bool
  RadauStepper::assemble_body_residual(const SystemState &state,
                                       const unsigned int stage,
                                       const unsigned int b,
                                       const NodalVector &position,
                                       const NodalVector &velocity,
                                       const NodalVector &acceleration,
                                       NodalVector &residual) const
  {
    const Body &body               = system.bodies()[b];
    const BodyOperators &operators = body.operators();
    NodalVector work(operators.n_unknowns());
    ++statistics.force_evaluations;
    const bool success =
      body.is_damped()
        ? damped_reduced_strain_force(operators,
                                      body.rotation_measure(),
                                      position,
                                      velocity,
                                      body.mass_damping(),
                                      body.stiffness_damping(),
                                      residual,
                                      work)
        : reduced_strain_force(
            operators, body.rotation_measure(), position, residual, work)
            .has_value();
    if (!success)
      return false;
    operators.mass_matrix.vmult(work, acceleration);
    residual += work;
    residual *= -1;
    system.add_loads(b, stage_time(state, stage), position, residual);
    return true;
  }



  bool
  RadauStepper::assemble_residual(const SystemState &state,
                                  StageVector &residual,
                                  StageConstraints &constraint_residual,
                                  std::string &failure)
  {
    const double inverse_square = 1 / (tried_step_size * tried_step_size);
    const unsigned int n_bodies = system.bodies().size();
    const bool has_masses       = !system.masses().empty();
    SystemVector positions(n_bodies), velocities(n_bodies),
      accelerations(n_bodies);
    for (unsigned int i = 0; i < tableau.n_stages(); ++i)
      {
        for (unsigned int b = 0; b < n_bodies; ++b)
          {
            positions[b] = stage_position(state, i, b);
            if (system.needs_velocities())
              velocities[b] = stage_velocity(state, i, b);
            accelerations[b].reinit(positions[b].size());
            for (unsigned int j = 0; j < tableau.n_stages(); ++j)
              accelerations[b].add(inverse_square * A_inverse_squared(i, j),
                                   stages[j][b]);
            if (!assemble_body_residual(state,
                                        i,
                                        b,
                                        positions[b],
                                        velocities[b],
                                        accelerations[b],
                                        residual[i][b]))
              {
                failure = "body '" + system.bodies()[b].name() +
                          "' is turned inside out (the determinant of its "
                          "mean deformation gradient is not positive)";
                return false;
              }
          }
        if (system.n_marker_values() == 0)
          continue;
        const double time       = stage_time(state, i);
        const Eigen::VectorXd s = system.marker_values(positions);
        Eigen::VectorXd v, a;
        if (system.needs_velocities())
          v = system.marker_values(velocities);
        if (has_masses)
          a = system.marker_values(accelerations);
        const Eigen::VectorXd F = system.marker_forces(
          time, s, v, a, stage_multipliers[i], state.law_values);
        for (unsigned int b = 0; b < n_bodies; ++b)
          system.add_marker_forces(b, F, residual[i][b]);
        constraint_residual[i] = -system.constraint_residual(time, s);
      }
    return true;
  }



  void
  RadauStepper::correct_constraints(const SystemState &state)
  {
    // three corrections reach round-off from any tolerance of the iteration
    constexpr unsigned int max_corrections = 3;
    double length                          = 0;
    for (const Body &body : system.bodies())
      length = std::max(length, body.operators().length);
    const double tolerance = 1e-14 * std::max(1., length);

    SystemVector positions(system.bodies().size());
    StageVector increment(stages);
    for (unsigned int k = 0; k < max_corrections; ++k)
      {
        StageConstraints constraints(tableau.n_stages());
        double largest = 0;
        for (unsigned int i = 0; i < tableau.n_stages(); ++i)
          {
            for (unsigned int b = 0; b < positions.size(); ++b)
              positions[b] = stage_position(state, i, b);
            constraints[i] =
              -system.constraint_residual(positions, stage_time(state, i));
            largest =
              std::max(largest, constraints[i].lpNorm<Eigen::Infinity>());
          }
        if (!(largest > tolerance))
          return;
        stage_solver->solve_constraints(increment, constraints);
        ++statistics.constraint_corrections;
        for (unsigned int i = 0; i < tableau.n_stages(); ++i)
          {
            for (unsigned int b = 0; b < positions.size(); ++b)
              stages[i][b] += increment[i][b];
            stage_multipliers[i] += constraints[i];
          }
      }
  }



  double
  RadauStepper::increment_norm(const StageVector &increment) const
  {
    double norm = 0;
    for (const SystemVector &stage : increment)
      for (unsigned int b = 0; b < stage.size(); ++b)
        {
          const BodyOperators &operators = system.bodies()[b].operators();
          const double relative          = stage[b].l2_norm() /
                                  std::sqrt(1. * operators.n_nodes) /
                                  operators.length;
          if (!std::isfinite(relative))
            return relative;
          norm = std::max(norm, relative);
        }
    return norm;
  }



  StepReport
  RadauStepper::try_step(const SystemState &state, const double step_size)
  {
    tried_step_size = step_size;
    predict(state, step_size);
    prepare(state);

    // The one-step matrices belong to a non-normal iteration, whose increments
    // may grow at first.
    const unsigned int patience = parameters.one_step_matrices ? 6 : 0;

    StepReport report;
    StageVector increment(stages);
    StageConstraints constraint_increment(stage_multipliers);
    double factor         = std::pow(convergence_factor, 0.8);
    double previous_norm  = 0;
    double previous_ratio = 0;
    while (report.iterations < parameters.max_newton_iterations)
      {
        if (!assemble_residual(
              state, increment, constraint_increment, report.failure))
          return report;
        stage_solver->solve(increment, constraint_increment);
        ++report.iterations;
        ++statistics.newton_iterations;
        for (unsigned int i = 0; i < tableau.n_stages(); ++i)
          {
            for (unsigned int b = 0; b < system.bodies().size(); ++b)
              stages[i][b] += increment[i][b];
            stage_multipliers[i] += constraint_increment[i];
          }

        const double norm = increment_norm(increment);
        if (!std::isfinite(norm))
          {
            report.failure =
              "the iteration produced numbers that are not "
              "finite";
            return report;
          }
        if (report.iterations > 1)
          {
            // the mean of two iterations, as single ones may be misleading
            const double ratio = norm / previous_norm;
            report.contraction =
              (report.iterations == 2 ? ratio
                                      : std::sqrt(ratio * previous_ratio));
            previous_ratio = ratio;
            if (report.contraction >= 0.99 && report.iterations > patience)
              {
                report.failure = "the iteration diverges";
                return report;
              }
            factor = report.contraction < 1
                       ? report.contraction / (1 - report.contraction)
                       : std::numeric_limits<double>::infinity();

            const double predicted =
              factor * norm *
              std::pow(report.contraction,
                       parameters.max_newton_iterations - report.iterations);
            if (predicted > parameters.newton_tolerance &&
                report.iterations > patience)
              {
                report.failure = "the iteration contracts too slowly";
                return report;
              }
          }
        previous_norm         = norm;
        report.error_estimate = factor * norm;
        if (report.error_estimate <= parameters.newton_tolerance)
          {
            convergence_factor =
              std::max(factor, std::numeric_limits<double>::epsilon());
            report.converged = true;
            if (system.n_constraints() > 0)
              correct_constraints(state);
            return report;
          }
      }
    report.failure = "the iteration did not reach its tolerance";
    return report;
  }



  void
  RadauStepper::update_laws(SystemState &state, const SystemState &before) const
  {
    if (!system.force_elements().empty())
      state.law_values =
        system.law_values(system.marker_values(state.positions),
                          before.law_values);
  }



  void
  RadauStepper::accept(SystemState &state)
  {
    step_start           = state;
    accepted_step_size   = tried_step_size;
    accepted_stages      = stages;
    accepted_multipliers = stage_multipliers;

    const unsigned int last = tableau.n_stages() - 1;
    state.time += accepted_step_size;
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        state.positions[b] = stage_position(step_start, last, b);
        for (unsigned int j = 0; j <= last; ++j)
          state.velocities[b].add(A_inverse(last, j) / accepted_step_size,
                                  stages[j][b]);
      }
    state.multipliers = stage_multipliers[last];
    update_laws(state, step_start);
  }



  SystemState
  RadauStepper::interpolate(const double time) const
  {
    const double tau                = accepted_step_size;
    const double c                  = (time - step_start.time) / tau;
    const std::vector<double> shape = stage_shape(tableau, c);
    const unsigned int s            = tableau.n_stages();

    // Lagrange polynomials of the stages, for the multipliers, and of the
    // stages and the start, for the velocities
    Eigen::VectorXd multiplier_shape(s), velocity_shape(s);
    for (unsigned int i = 0; i < s; ++i)
      {
        multiplier_shape(i) = 1;
        for (unsigned int j = 0; j < s; ++j)
          if (j != i)
            multiplier_shape(i) *=
              (c - tableau.c(j)) / (tableau.c(i) - tableau.c(j));
        velocity_shape(i) = multiplier_shape(i) * c / tableau.c(i);
      }
    const Eigen::VectorXd velocity_of_stages =
      A_inverse.transpose() * velocity_shape / tau;

    SystemState state(step_start);
    state.time = time;
    state.multipliers.setZero();
    for (unsigned int i = 0; i < s; ++i)
      state.multipliers += multiplier_shape(i) * accepted_multipliers[i];
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        state.positions[b].add(c * tau, step_start.velocities[b]);
        for (unsigned int i = 0; i < s; ++i)
          {
            state.positions[b].add(shape[i], accepted_stages[i][b]);
            state.velocities[b].add(velocity_of_stages(i),
                                    accepted_stages[i][b]);
          }
      }
    update_laws(state, step_start);
    return state;
  }
} // namespace ACF
