// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/time/equilibrium.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace ACF
{
  namespace
  {
    // Bounds in units of the bodies' lengths.
    constexpr double tolerance       = 1e-12;
    constexpr double round_off       = 1e-11;
    constexpr double max_deformation = 0.3;
    constexpr double small_step      = 1e-4;

    // Bounds of the shift in units of the slow rate.
    constexpr double smallest_shift = 1e-3;
    constexpr double largest_shift  = 1e12;

    constexpr unsigned int max_anchors = 300;
    constexpr unsigned int max_newton  = 12;

    // In units of the extent of the system.
    constexpr double max_distance = 100;



    double
    dot(const SystemVector &x, const SystemVector &y)
    {
      double sum = 0;
      for (unsigned int b = 0; b < x.size(); ++b)
        sum += x[b] * y[b];
      return sum;
    }



    // The first body whose forces cannot be computed; none if all can.
    std::optional<unsigned int>
    find_inverted(const MultibodySystem &system, const SystemVector &positions)
    {
      for (unsigned int b = 0; b < positions.size(); ++b)
        {
          NodalVector force(positions[b].size()), scratch(force);
          if (!elastic_force(system.bodies()[b], positions[b], force, scratch))
            return b;
        }
      return {};
    }



    SystemVector
    difference(const SystemVector &x, const SystemVector &y)
    {
      SystemVector result(x);
      for (unsigned int b = 0; b < x.size(); ++b)
        result[b] -= y[b];
      return result;
    }



    // Diagonal of the bounding box of all bodies.
    double
    system_extent(const SystemVector &positions)
    {
      Vector3 low, high;
      for (unsigned int i = 0; i < dim; ++i)
        {
          low[i]  = std::numeric_limits<double>::max();
          high[i] = -low[i];
          for (const NodalVector &x : positions)
            for (unsigned int a = 0; a < x.size() / dim; ++a)
              {
                low[i]  = std::min(low[i], x[dim * a + i]);
                high[i] = std::max(high[i], x[dim * a + i]);
              }
        }
      return (high - low).norm();
    }
  } // namespace



  EquilibriumSolver::EquilibriumSolver(const MultibodySystem &system,
                                       Statistics &statistics)
    : system(system)
    , tangent(system, statistics)
    , slow_rate(slow_squared_rate(system))
    , shift(slow_rate)
  {}



  EquilibriumReport
  EquilibriumSolver::solve(SystemState &state, const unsigned int n_load_steps)
  {
    start        = state.positions;
    extent       = system_extent(start);
    n_iterations = 0;
    for (unsigned int k = 1; k <= n_load_steps; ++k)
      relax(state, double(k) / n_load_steps);

    EquilibriumReport report;
    report.iterations = n_iterations;
    for (const NodalVector &change : difference(state.positions, start))
      for (unsigned int a = 0; a < change.size() / dim; ++a)
        report.displacement = std::max(report.displacement,
                                       std::hypot(change[dim * a],
                                                  change[dim * a + 1],
                                                  change[dim * a + 2]));
    return report;
  }



  void
  EquilibriumSolver::relax(SystemState &state, const double load_factor)
  {
    double previous_size = 0; // at the same shift
    unsigned int wait    = 0;
    for (unsigned int k = 0; k < max_anchors; ++k)
      {
        const SystemState anchor = state;
        const Step step          = try_step(anchor, state, load_factor);
        if (!step.success)
          {
            state = anchor;
            shift *= step.growth;
            previous_size = 0;
            wait          = 3;
            if (!(shift <= largest_shift * slow_rate))
              fail(state, step.failure);
            continue;
          }
        check_distance(state);
        if (!system.force_elements().empty())
          state.law_values =
            system.law_values(system.marker_values(state.positions),
                              anchor.law_values);

        const bool measured = previous_size > 0;
        const double ratio  = measured ? step.size / previous_size : 1.;
        if (step.size <= 1e-2 * tolerance ||
            (ratio < 1 && step.size * ratio / (1 - ratio) <= tolerance) ||
            (measured && ratio > 0.5 &&
             (step.size <= round_off ||
              (step.deformation < small_step &&
               step.size <= 10 * round_off_step(state, load_factor)))))
          return;
        previous_size = step.size;
        wait -= (wait > 0);
        if (measured && wait == 0 && ratio > 0.1 &&
            step.deformation < 0.1 * max_deformation &&
            shift > smallest_shift * slow_rate)
          {
            shift /= 10;
            previous_size = 0;
          }
      }
    fail(state,
         "after " + std::to_string(max_anchors) +
           " steps it still moves by more than the tolerance");
  }



  bool
  EquilibriumSolver::solve_newton(const SystemState &anchor,
                                  const SystemState &state,
                                  const double load_factor,
                                  Increment &increment)
  {
    SystemVector &force = increment.positions;
    if (!forces(state, state.multipliers, load_factor, force) ||
        !tangent.linearize(state, load_factor))
      return false;
    SystemVector inertia(force);
    tangent.apply_mass(inertia, difference(state.positions, anchor.positions));
    for (unsigned int b = 0; b < force.size(); ++b)
      force[b].add(-shift, inertia[b]);
    const SystemVector r = force;
    const Eigen::VectorXd gap =
      -system.constraint_residual(state.time,
                                  system.marker_values(state.positions));

    increment.multipliers = gap;
    tangent.factorize(shift);
    tangent.solve(increment.positions, increment.multipliers);
    ++n_iterations;
    increment.curvature =
      dot(increment.positions, r) - gap.dot(increment.multipliers);
    return true;
  }



  EquilibriumSolver::Step
  EquilibriumSolver::try_step(const SystemState &anchor,
                              SystemState &state,
                              const double load_factor)
  {
    Step step;
    Increment increment;
    increment.positions = anchor.positions;
    for (unsigned int i = 0; i < max_newton; ++i)
      {
        step.failure = "it is turned inside out";
        if (!solve_newton(anchor, state, load_factor, increment))
          {
            moving_body =
              find_inverted(system, state.positions).value_or(moving_body);
            return step;
          }

        Step newton;
        measure(increment.positions, newton);
        step.failure = "it moves by more than its length at once";
        if (!std::isfinite(newton.size))
          return step;
        if (i == 0 && newton.deformation > max_deformation)
          {
            step.growth = std::pow(
              10, std::ceil(std::log10(newton.deformation / max_deformation)));
            return step;
          }
        step.failure = "it is not stable";
        if (i == 0 && newton.size > 1e3 * round_off &&
            increment.curvature < 0 &&
            newton.size > 10 * round_off_step(state, load_factor))
          return step;

        step.failure = "the iteration does not converge";
        for (unsigned int b = 0; b < state.positions.size(); ++b)
          state.positions[b] += increment.positions[b];
        state.multipliers += increment.multipliers;
        measure(difference(state.positions, anchor.positions), step);
        if (step.deformation > 3 * max_deformation)
          return step;
        // the work of long steps needs relaxed forces
        const bool is_short = (step.deformation < 10 * small_step);
        if (newton.deformation <= (is_short ? 1 : 0.1) * small_step)
          {
            step.failure = "the forces drive it back";
            step.success =
              is_short || relative_work(anchor, state, load_factor) > -0.05;
            return step;
          }
      }
    return step;
  }



  bool
  EquilibriumSolver::forces(const SystemState &state,
                            const Eigen::VectorXd &multipliers,
                            const double load_factor,
                            SystemVector &force) const
  {
    const unsigned int n_markers = system.n_marker_values();
    Eigen::VectorXd F;
    if (n_markers > 0)
      F = system.marker_forces(state.time,
                               system.marker_values(state.positions),
                               Eigen::VectorXd::Zero(n_markers),
                               Eigen::VectorXd::Zero(n_markers),
                               multipliers,
                               state.law_values,
                               load_factor);
    for (unsigned int b = 0; b < force.size(); ++b)
      {
        const Body &body = system.bodies()[b];
        NodalVector scratch(force[b].size());
        if (!elastic_force(body, state.positions[b], force[b], scratch))
          return false;
        force[b] *= -1;
        system.add_loads(
          b, state.time, state.positions[b], force[b], load_factor);
        system.add_marker_forces(b, F, force[b]);
      }
    return true;
  }



  double
  EquilibriumSolver::relative_work(const SystemState &from,
                                   const SystemState &to,
                                   const double load_factor) const
  {
    // by the trapezoidal rule, in which forces across the path cancel
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(system.n_constraints());
    const SystemVector path    = difference(to.positions, from.positions);
    SystemVector force(path);
    double sum = 0, size = 0;
    for (const SystemState *const state : {&from, &to})
      {
        if (!forces(*state, none, load_factor, force))
          return -1;
        const double work = dot(force, path);
        sum += work;
        size += std::abs(work);
      }
    return size > 0 ? sum / size : 0;
  }



  void
  EquilibriumSolver::measure(const SystemVector &displacement, Step &step)
  {
    step.size = step.deformation = 0;
    for (unsigned int b = 0; b < displacement.size(); ++b)
      {
        const BodyOperators &operators = system.bodies()[b].operators();
        const double unit =
          std::sqrt(1. * operators.n_nodes) * operators.length;
        const double size = displacement[b].l2_norm() / unit;
        // keeps not-a-number
        if (!(size <= step.size) && !std::isnan(step.size))
          {
            step.size   = size;
            moving_body = b;
          }
        NodalVector rest(displacement[b]);
        const Vector3 mean = mass_mean(operators, rest);
        for (unsigned int k = 0; k < rest.size(); ++k)
          rest[k] -= mean[k % dim];
        step.deformation = std::max(step.deformation, rest.l2_norm() / unit);
      }
  }



  double
  EquilibriumSolver::round_off_step(const SystemState &state,
                                    const double load_factor)
  {
    SystemState moved(state);
    SystemVector change(state.positions);
    std::minstd_rand random;
    for (unsigned int b = 0; b < change.size(); ++b)
      {
        const double length = system.bodies()[b].operators().length;
        for (unsigned int k = 0; k < change[b].size(); ++k)
          {
            double &x      = moved.positions[b][k];
            const double y = x;
            x += (random() % 2 == 0 ? 4 : -4) *
                 std::numeric_limits<double>::epsilon() * length;
            change[b][k] = x - y;
          }
      }
    SystemVector error(change), force(change);
    tangent.apply_stiffness(error, change);
    Eigen::VectorXd gap = Eigen::VectorXd::Zero(system.n_constraints());
    for (const double sign : {1., -1.})
      {
        if (!forces(
              sign > 0 ? moved : state, state.multipliers, load_factor, force))
          return 0;
        for (unsigned int b = 0; b < force.size(); ++b)
          error[b].add(sign, force[b]);
      }
    tangent.solve(error, gap);
    Step step;
    const unsigned int body = moving_body;
    measure(error, step);
    moving_body = body;
    return step.size;
  }



  void
  EquilibriumSolver::check_distance(const SystemState &state) const
  {
    for (const NodalVector &change : difference(state.positions, start))
      if (!(change.linfty_norm() <= max_distance * extent))
        fail(state, "it moves away from the others without end");
  }



  void
  EquilibriumSolver::fail(const SystemState &state,
                          const std::string &reason) const
  {
    std::string message = "No static equilibrium was found at time " +
                          format_number(state.time) + " s after " +
                          std::to_string(n_iterations) +
                          " iterations. The body that moves most is '" +
                          system.bodies()[moving_body].name() + "': " + reason;
    const Eigen::VectorXd gap =
      system.constraint_residual(state.time,
                                 system.marker_values(state.positions));
    Eigen::Index row;
    if (gap.size() > 0 && gap.cwiseAbs().maxCoeff(&row) > 1e-8 * extent)
      message +=
        "; the joint '" + system.joints()[system.joint_of_row(row)].name +
        "' is violated by " + format_number(std::abs(gap(row))) + " m or rad";
    throw SimulationError(message + ".");
  }
} // namespace ACF
