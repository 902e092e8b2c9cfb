// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Orders of convergence, conservation, drift, dense output, comparison of the
// stage solvers, and steps that fail.

#include <acf/base/exceptions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "recorded_run.h"

namespace
{
  using namespace Tests;

  // A soft block of 8 quadratic hexahedra, all of whose vibrations are resolved
  // by the step sizes here.
  std::string
  soft_block(const std::string &body, const std::string &joints)
  {
    return R"(
subsection Bodies
  set Names = block
  subsection block
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = -0.2, 0, -0.1
    set Box to          =  0.2, 1,  0.1
    set Cells           = 1, 2, 1
    set Young's modulus = 2e4
    set Poisson's ratio = 0.3
    set Density         = 1000
)" + body + R"(
  end
end
)" + joints +
           R"(
subsection Time integration
  set Newton tolerance = 1e-14
end
)";
  }

  // It swings about a hinge.
  std::string
  swinging_block()
  {
    return soft_block("", R"(
subsection Joints
  set Names = hinge
  subsection hinge
    set Type    = revolute
    set Between = block: y min, ground
    set Axis    = 1, 0, 0
  end
end
subsection Loads
  set Gravity = 0.1, 0, -2
end
)");
  }

  // It flies and tumbles.
  std::string
  flying_block()
  {
    return soft_block(R"(
    set Velocity         = 0.3, -0.2, 0.5
    set Angular velocity = 1, 2, -0.5
)",
                      "");
  }

  std::vector<std::string>
  options(const unsigned int n_stages,
          const double step_size,
          const double end_time)
  {
    std::ostringstream tau, end;
    tau.precision(17);
    end.precision(17);
    tau << "Time integration/Step size=" << step_size;
    end << "Time integration/End time=" << end_time;
    return {"Time integration/Stages=" + std::to_string(n_stages),
            tau.str(),
            end.str()};
  }

  void
  print(const std::string &label, const std::vector<double> &values)
  {
    std::cout << label;
    for (const double value : values)
      std::cout << ' ' << value;
    std::cout << std::endl;
  }
} // namespace



// Hairer, Lubich and Roche (1989): Radau IIA on index 3 converges at least with
// the orders 2s-1 (positions), s (velocities) and s-1 (multipliers). If the
// constraints are linear with constant coefficients and right-hand sides, as
// all are here, the stages stay in a fixed subspace, in which the method is
// that for an ordinary differential equation: velocities and multipliers then
// also converge with more than the guaranteed orders.
TEST(TimeIntegration, OrdersOfConvergenceOnIndexThree)
{
  const double end_time = 0.32;
  RecordedRun reference(swinging_block(),
                        end_time,
                        options(3, end_time / 512, end_time));
  reference.run();

  for (const unsigned int s : {2U, 3U})
    {
      std::vector<double> position_errors, velocity_errors, multiplier_errors;
      for (const unsigned int n_steps : {8U, 16U, 32U, 64U})
        {
          RecordedRun run(swinging_block(),
                          end_time,
                          options(s, end_time / n_steps, end_time));
          run.run();
          ASSERT_EQ(run.statistics.steps, n_steps);
          position_errors.push_back(
            nodal_difference(run.last().positions[0],
                             reference.last().positions[0]));
          velocity_errors.push_back(
            nodal_difference(run.last().velocities[0],
                             reference.last().velocities[0]));
          multiplier_errors.push_back(
            (run.last().multipliers - reference.last().multipliers).norm() /
            reference.last().multipliers.norm());
        }
      const auto position_orders   = orders(position_errors);
      const auto velocity_orders   = orders(velocity_errors);
      const auto multiplier_orders = orders(multiplier_errors);
      std::cout << s << " stages:" << std::endl;
      print("  position errors  ", position_errors);
      print("  position orders  ", position_orders);
      print("  velocity errors  ", velocity_errors);
      print("  velocity orders  ", velocity_orders);
      print("  multiplier errors", multiplier_errors);
      print("  multiplier orders", multiplier_orders);

      EXPECT_NEAR(position_orders.back(), 2 * s - 1, 0.3);
      EXPECT_GT(velocity_orders.back(), s + 0.5);
      EXPECT_GT(multiplier_orders.back(), s - 1 + 0.5);
    }
}



TEST(TimeIntegration, ConservationInFreeFlight)
{
  for (const unsigned int s : {2U, 3U})
    {
      std::vector<double> angular_errors, energy_errors;
      // The largest slope counts: large steps do not show the order of the
      // energy yet, and with the smallest ones of three stages the tolerance of
      // the iteration, 1e-14 of the length per step, leaves 2e-12 of the
      // angular momentum.
      for (const double refinement : {1, 2, 4, 8})
        {
          const double step_size = (s == 2 ? 0.02 : 0.04) / refinement;
          RecordedRun run(flying_block(), 0.1, options(s, step_size, 0.5));
          run.run();
          EXPECT_EQ(run.statistics.constraint_factorizations, 0U);
          EXPECT_EQ(run.statistics.marker_factorizations, 0U);

          const SystemState &start = run.recorder.states.front();
          const Vector3 p          = run.system.momentum(start);
          const Vector3 l          = run.system.angular_momentum(start);
          const auto total         = [&](const SystemState &state) {
            const SystemEnergy energy = run.system.energy(state);
            return energy.kinetic + energy.elastic;
          };
          double momentum_error = 0, angular_error = 0, energy_error = 0;
          for (const SystemState &state : run.recorder.states)
            {
              momentum_error =
                std::max(momentum_error,
                         (run.system.momentum(state) - p).norm() / p.norm());
              angular_error =
                std::max(angular_error,
                         (run.system.angular_momentum(state) - l).norm() /
                           l.norm());
              energy_error =
                std::max(energy_error,
                         std::abs(total(state) - total(start)) / total(start));
            }
          std::cout << s << " stages, step " << step_size
                    << " s: relative drift of momentum " << momentum_error
                    << ", angular momentum " << angular_error << ", energy "
                    << energy_error << std::endl;
          EXPECT_LT(momentum_error, 1e-12);
          // Radau IIA dissipates; it must not feed the motion
          EXPECT_LT(total(run.last()), total(start) * (1 + 1e-12));
          angular_errors.push_back(angular_error);
          energy_errors.push_back(energy_error);
        }
      print("  orders of angular momentum", orders(angular_errors));
      print("  orders of energy          ", orders(energy_errors));
      for (const auto &errors : {angular_errors, energy_errors})
        {
          const std::vector<double> slopes = orders(errors);
          EXPECT_GT(*std::max_element(slopes.begin(), slopes.end()),
                    2 * s - 1.3);
        }
    }
}



TEST(TimeIntegration, ConstraintsDoNotDrift)
{
  RecordedRun run(swinging_block(), 0.01, options(2, 0.01, 10.));
  run.run();
  ASSERT_EQ(run.statistics.steps, 1000U);
  double position_residual = 0, velocity_residual = 0;
  for (const SystemState &state : run.recorder.states)
    {
      position_residual =
        std::max(position_residual,
                 run.system.constraint_residual(state.positions)
                   .lpNorm<Eigen::Infinity>());
      velocity_residual = std::max(
        velocity_residual,
        run.system
          .constraint_velocity(state.time,
                               run.system.marker_values(state.positions),
                               run.system.marker_values(state.velocities))
          .lpNorm<Eigen::Infinity>());
    }
  std::cout << "residual of positions " << position_residual
            << ", of velocities " << velocity_residual << std::endl;
  EXPECT_LT(position_residual, 1e-14);
  // for constraints with constant right-hand sides the stage velocities, linear
  // combinations of stage positions, satisfy them too
  EXPECT_LT(velocity_residual, 1e-11);
}



TEST(TimeIntegration, OneStepMatricesGiveTheSameSolutionWithMoreIterations)
{
  for (const unsigned int s : {2U, 3U})
    {
      RecordedRun exact(swinging_block(), 0.1, options(s, 0.01, 0.3));
      exact.run();
      auto overrides = options(s, 0.01, 0.3);
      overrides.push_back("Time integration/Stage matrices=one-step");
      overrides.push_back("Time integration/Maximal Newton iterations=100");
      RecordedRun one_step(swinging_block(), 0.1, overrides);
      one_step.run();

      EXPECT_LT(nodal_difference(exact.last().positions[0],
                                 one_step.last().positions[0]),
                1e-12);
      EXPECT_EQ(one_step.statistics.real_factorizations, s);
      EXPECT_EQ(one_step.statistics.complex_factorizations, 0U);
      EXPECT_EQ(exact.statistics.complex_factorizations, 1U);
      EXPECT_EQ(exact.statistics.real_factorizations, s - 2);
      EXPECT_GT(one_step.statistics.newton_iterations,
                exact.statistics.newton_iterations);
      std::cout << s << " stages: " << exact.statistics.newton_iterations
                << " iterations with diagonalised, "
                << one_step.statistics.newton_iterations
                << " with one-step matrices" << std::endl;
    }
}



TEST(TimeIntegration, StartingValuesOfZeroGiveTheSameSolution)
{
  RecordedRun predicted(swinging_block(), 0.1, options(2, 0.01, 0.3));
  predicted.run();
  auto overrides = options(2, 0.01, 0.3);
  overrides.push_back("Time integration/Starting values=zero");
  RecordedRun from_zero(swinging_block(), 0.1, overrides);
  from_zero.run();

  EXPECT_LT(nodal_difference(predicted.last().positions[0],
                             from_zero.last().positions[0]),
            1e-12);
  EXPECT_GT(from_zero.statistics.newton_iterations,
            predicted.statistics.newton_iterations);
  std::cout << predicted.statistics.newton_iterations
            << " iterations with predictions, "
            << from_zero.statistics.newton_iterations << " from zero"
            << std::endl;
}



// In short runs with large steps the iteration may leave more than 1e-10, as
// long as the sum of it stays below 1 % of the error.
TEST(TimeIntegration, LargeStepsOfShortRunsTakeFewerIterations)
{
  RecordedRun exact(swinging_block(), 1, options(3, 0.005, 1));
  exact.run();
  auto overrides = options(2, 0.1, 1);
  overrides.push_back("Time integration/Newton tolerance=0"); // the default
  RecordedRun crude(swinging_block(), 1, overrides);
  crude.run();
  overrides.back() = "Time integration/Newton tolerance=1e-10";
  RecordedRun strict(swinging_block(), 1, overrides);
  strict.run();

  const double error =
    nodal_difference(exact.last().positions[0], strict.last().positions[0]);
  const double change =
    nodal_difference(crude.last().positions[0], strict.last().positions[0]);
  std::cout << crude.statistics.newton_iterations << " iterations instead of "
            << strict.statistics.newton_iterations << ", which changes "
            << change << " of an error of " << error << std::endl;
  EXPECT_LE(crude.statistics.newton_iterations,
            strict.statistics.newton_iterations);
  EXPECT_GT(change, 1e-12); // some steps end earlier
  EXPECT_LT(change, 0.01 * error);
}



// Times that are not ends of steps are interpolated with the collocation
// polynomial; the end of the simulation need not be an end of a step either.
TEST(TimeIntegration, DenseOutput)
{
  RecordedRun reference(swinging_block(), 0.03, options(3, 0.001, 0.31));
  reference.run();
  std::vector<double> position_errors, velocity_errors;
  for (const double step_size : {0.04, 0.02, 0.01})
    {
      RecordedRun run(swinging_block(), 0.03, options(3, step_size, 0.31));
      run.run();
      ASSERT_EQ(run.recorder.states.size(), 11U);
      position_errors.push_back(0);
      velocity_errors.push_back(0);
      for (unsigned int k = 0; k < run.recorder.states.size(); ++k)
        {
          const SystemState &state = run.recorder.states[k];
          const SystemState &exact = reference.recorder.states[k];
          EXPECT_NEAR(state.time, 0.03 * k, 1e-12);
          position_errors.back() =
            std::max(position_errors.back(),
                     nodal_difference(state.positions[0], exact.positions[0]));
          velocity_errors.back() =
            std::max(velocity_errors.back(),
                     nodal_difference(state.velocities[0],
                                      exact.velocities[0]));
        }
    }
  print("errors of interpolated positions ", position_errors);
  print("errors of interpolated velocities", velocity_errors);
  EXPECT_GT(orders(position_errors).back(), 3.5);
  EXPECT_GT(orders(velocity_errors).back(), 2.5);
}



TEST(TimeIntegration, FailedStepsAreHalvedAndRecovered)
{
  // 0.3 s is more than the longest period, and five iterations are few
  auto overrides = options(2, 0.3, 3.);
  overrides.push_back("Time integration/Maximal Newton iterations=5");
  RecordedRun run(flying_block(), 0.3, overrides);
  run.run();
  std::cout << run.statistics.steps << " steps, "
            << run.statistics.rejected_steps << " rejected, "
            << run.statistics.complex_factorizations << " factorisations"
            << std::endl;
  EXPECT_GT(run.statistics.halvings, 0U);
  EXPECT_EQ(run.statistics.halvings, run.statistics.rejected_steps);
  EXPECT_GT(run.statistics.steps, 10U);
  EXPECT_LE(run.statistics.complex_factorizations, 9U);
  ASSERT_EQ(run.recorder.states.size(), 11U);
  EXPECT_NEAR(run.last().time, 3., 1e-12);
}



TEST(TimeIntegration, FailureNamesTheTimeAndKeepsTheResults)
{
  auto overrides = options(2, 0.3, 3.);
  overrides.push_back("Time integration/Maximal Newton iterations=5");
  overrides.push_back("Time integration/Maximal halvings=0");
  RecordedRun run(flying_block(), 0.3, overrides);
  try
    {
      run.run();
      FAIL() << "The step of 0.3 s converged.";
    }
  catch (const SimulationError &error)
    {
      const std::string message = error.what();
      std::cout << message << std::endl;
      EXPECT_NE(message.find("at time"), std::string::npos);
      EXPECT_NE(message.find("after 0 halvings"), std::string::npos);
    }
  EXPECT_EQ(run.statistics.rejected_steps, 1U);
}



TEST(StepController, StaysOnTheLattice)
{
  StepController controller(0.1, 3);
  EXPECT_EQ(controller.step_size(), 0.1);
  controller.accept();
  EXPECT_DOUBLE_EQ(controller.time(), 0.1);

  ASSERT_TRUE(controller.halve());
  ASSERT_TRUE(controller.halve());
  EXPECT_DOUBLE_EQ(controller.step_size(), 0.025);
  controller.accept(); // 0.125: not yet a multiple of 0.05
  EXPECT_DOUBLE_EQ(controller.step_size(), 0.025);
  controller.accept(); // 0.15
  EXPECT_DOUBLE_EQ(controller.step_size(), 0.05);
  controller.accept(); // 0.2: one success is too few
  EXPECT_DOUBLE_EQ(controller.step_size(), 0.05);
  controller.accept(); // 0.25
  EXPECT_DOUBLE_EQ(controller.step_size(), 0.05);
  controller.accept(); // 0.3
  EXPECT_DOUBLE_EQ(controller.step_size(), 0.1);
  EXPECT_DOUBLE_EQ(controller.time(), 0.3);
}



TEST(StepController, WaitsLongerAfterRepeatedFailures)
{
  StepController controller(1., 1);
  ASSERT_TRUE(controller.halve());
  EXPECT_FALSE(controller.halve()) << "only one halving is allowed";
  controller.accept();
  controller.accept();
  EXPECT_EQ(controller.step_size(), 1.);
  ASSERT_TRUE(controller.halve()); // failed again: four successes now
  for (unsigned int k = 0; k < 4; ++k)
    {
      EXPECT_EQ(controller.step_size(), 0.5);
      controller.accept();
    }
  EXPECT_EQ(controller.step_size(), 1.);
  EXPECT_DOUBLE_EQ(controller.time(), 3.);
}



TEST(StepController, TimesDoNotDrift)
{
  StepController controller(1e-3, 8);
  for (unsigned int k = 0; k < 1000000; ++k)
    controller.accept();
  EXPECT_DOUBLE_EQ(controller.time(), 1000.);
}



// 1.06 solves per step were measured: where the motion is smooth the
// iteration needs a second one from time to time only, to measure its
// contraction.
TEST(TimeIntegration, SmoothStepsTakeOneSolve)
{
  for (const unsigned int s : {2U, 3U})
    {
      auto overrides = options(s, 2e-3, 1.);
      overrides.push_back("Time integration/Newton tolerance=0");
      RecordedRun run(swinging_block(), 0.1, overrides);
      run.run();
      const double iterations =
        1. * run.statistics.newton_iterations / run.statistics.steps;
      std::cout << s << " stages: " << iterations << " iterations per step"
                << std::endl;
      EXPECT_LT(iterations, 1.2);
    }
}
