// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Time integration of mechanisms with joints that move and that are driven:
// orders of convergence and drift.

#include <gtest/gtest.h>

#include <iostream>

#include "recorded_run.h"

namespace
{
  using namespace Tests;

  std::string
  block(const std::string &name,
        const std::string &youngs_modulus,
        const std::string &entries)
  {
    return "subsection " + name + R"(
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = -0.1, 0, -0.1
    set Box to          =  0.1, 0.6, 0.1
    set Cells           = 1, 1, 1
    set Young's modulus = )" +
           youngs_modulus + R"(
    set Poisson's ratio = 0.3
    set Density         = 1000
)" + entries +
           "end\n";
  }

  // A driven block carries a second one by a hinge whose axis it turns, so that
  // the constraints are nonlinear and depend on time.
  std::string
  driven_blocks(const std::string &youngs_modulus, const std::string &drive)
  {
    return "subsection Bodies\n set Names = first, second\n" +
           block("first", youngs_modulus, "") +
           block("second", youngs_modulus, "set Position = 0, 0.6, 0\n") +
           R"(end
subsection Joints
  set Names = motor, hinge
  subsection motor
    set Type    = revolute
    set Between = first: y min, ground
    set Axis    = 1, 0, 0
    )" + drive +
           R"(
  end
  subsection hinge
    set Type    = revolute
    set Between = second: y min, first: y max
    set Axis    = 0, 0, 1
  end
end
subsection Loads
  set Gravity = 0.5, 0, -0.5
end
subsection Time integration
  set Newton tolerance = 1e-14
end
)";
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

  double
  relative_difference(const Eigen::VectorXd &a, const Eigen::VectorXd &b)
  {
    return (a - b).norm() / b.norm();
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



// All vibrations of the soft blocks are resolved by the step sizes.
// Hairer, Lubich and Roche (1989): 2s-1 for positions, s for velocities, s-1
// for multipliers.
TEST(DrivenMechanism, OrdersOfConvergenceOnIndexThree)
{
  const double end_time = 0.32;
  const std::string model =
    driven_blocks("4e4", "set Angle = 0.2*(1-cos(4*t))^2");
  RecordedRun reference(model, end_time, options(3, end_time / 512, end_time));
  reference.run();
  ASSERT_FALSE(reference.system.has_affine_joints());

  for (const unsigned int s : {2U, 3U})
    {
      std::vector<double> position_errors, velocity_errors, multiplier_errors;
      for (const unsigned int n_steps : {16U, 32U, 64U, 128U})
        {
          RecordedRun run(model,
                          end_time,
                          options(s, end_time / n_steps, end_time));
          run.run();
          EXPECT_EQ(run.statistics.steps, n_steps);
          position_errors.push_back(
            nodal_difference(run.last().positions[1],
                             reference.last().positions[1]));
          velocity_errors.push_back(
            nodal_difference(run.last().velocities[1],
                             reference.last().velocities[1]));
          multiplier_errors.push_back(
            relative_difference(run.last().multipliers,
                                reference.last().multipliers));
        }
      std::cout << s << " stages:" << std::endl;
      print("  position errors  ", position_errors);
      print("  position orders  ", orders(position_errors));
      print("  velocity errors  ", velocity_errors);
      print("  velocity orders  ", orders(velocity_errors));
      print("  multiplier errors", multiplier_errors);
      print("  multiplier orders", orders(multiplier_errors));
      EXPECT_GT(orders(position_errors).back(), 2 * s - 1 - 0.3);
      EXPECT_GT(orders(velocity_errors).back(), s - 0.3);
      EXPECT_GT(orders(multiplier_errors).back(), s - 1 - 0.3);
    }
}



TEST(DrivenMechanism, ConstraintsDoNotDrift)
{
  RecordedRun run(driven_blocks("1e7", "set Angular velocity = 2*sin(t)"),
                  0.5,
                  options(2, 0.005, 50.));
  run.run();
  ASSERT_EQ(run.statistics.steps, 10000U);
  std::cout << "10000 steps: residual of positions "
            << run.statistics.constraint_residual << ", of velocities "
            << run.statistics.constraint_velocity_residual << ", "
            << run.statistics.newton_iterations << " iterations, "
            << run.statistics.constraint_corrections << " corrections"
            << std::endl;
  EXPECT_LT(run.statistics.constraint_residual, 1e-13);
}
