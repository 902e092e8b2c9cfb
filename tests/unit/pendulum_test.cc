// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// The pendulum of Gerstmayr and Schoeberl (2006), Sec. 8, against an
// independent planar beam in a floating frame of reference.

#include <gtest/gtest.h>

#include <iostream>

#include "recorded_run.h"
#include "reference/planar_pendulum.h"

namespace
{
  using namespace Tests;

  std::string
  pendulum(const std::string &cells)
  {
    return R"(
subsection Bodies
  set Names = pendulum
  subsection pendulum
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = -0.00125, 0, -0.025
    set Box to          =  0.00125, 1,  0.025
    set Cells           = )" +
           cells + R"(
    set Young's modulus = 2.1e8
    set Poisson's ratio = 0.3
    set Density         = 7800
  end
end
subsection Joints
  set Names = hinge
  subsection hinge
    set Type    = revolute
    set Between = pendulum: y min, ground
    set Axis    = 1, 0, 0
  end
end
subsection Loads
  set Gravity = 0, 0, -9.81
end
subsection Time integration
  set End time  = 1
  set Step size = 1e-3
end
subsection Probes
  set Names = chord
  subsection chord
    set Type  = chord
    set From  = pendulum: y min
    set To    = pendulum: y max
    set Point = 0, 0.5, 0
  end
end
)";
  }

  struct Difference
  {
    double angle      = 0;
    double deflection = 0;
  };

  // Largest differences to a history of the reference, deflections relative to
  // the largest one of the reference.
  Difference
  largest_difference(const RecordedRun &run,
                     const std::vector<Reference::PendulumState> &reference)
  {
    Difference difference;
    double largest_deflection = 0;
    for (unsigned int k = 0; k < reference.size(); ++k)
      {
        difference.angle = std::max(difference.angle,
                                    std::abs(run.recorder.values[k][0] -
                                             reference[k].chord_angle));
        difference.deflection =
          std::max(difference.deflection,
                   std::abs(run.recorder.values[k][1] -
                            reference[k].mid_span_deflection));
        largest_deflection =
          std::max(largest_deflection,
                   std::abs(reference[k].mid_span_deflection));
      }
    difference.deflection /= largest_deflection;
    return difference;
  }

  std::vector<Reference::PendulumState>
  reference_history(const Reference::BeamTheory theory)
  {
    std::vector<double> times;
    for (unsigned int k = 0; k <= 1000; ++k)
      times.push_back(1e-3 * k);
    Reference::BeamOptions options;
    options.theory            = theory;
    options.extensible        = (theory == Reference::BeamTheory::timoshenko);
    options.n_shape_functions = 12;
    return Reference::swing_pendulum(Reference::PlanarBeam(), options, times);
  }
} // namespace



TEST(Pendulum, AgreesWithTheBeamTheoryAndConverges)
{
  const auto timoshenko = reference_history(Reference::BeamTheory::timoshenko);
  const auto bernoulli_euler =
    reference_history(Reference::BeamTheory::bernoulli_euler);

  std::vector<Difference> differences;
  for (const std::string cells : {"1, 10, 1", "1, 20, 2", "1, 40, 4"})
    {
      RecordedRun run(pendulum(cells), 1e-3);
      run.run();
      ASSERT_EQ(run.recorder.values.size(), 1001U);
      differences.push_back(largest_difference(run, timoshenko));
      const Difference other = largest_difference(run, bernoulli_euler);
      std::cout << "cells " << cells << ": chord angle differs by "
                << differences.back().angle << " rad, deflection by "
                << 100 * differences.back().deflection
                << " % of its maximum from Timoshenko; " << other.angle
                << " rad, " << 100 * other.deflection
                << " % from Bernoulli-Euler; "
                << run.statistics.newton_iterations << " iterations, drift "
                << run.recorder.states.back().positions[0].linfty_norm()
                << std::endl;

      // two iterations per step and one factorisation
      EXPECT_EQ(run.statistics.steps, 1000U);
      EXPECT_EQ(run.statistics.rejected_steps, 0U);
      EXPECT_LE(run.statistics.max_newton_iterations, 2U);
      EXPECT_EQ(run.statistics.complex_factorizations, 1U);
      EXPECT_EQ(run.statistics.real_factorizations, 0U);
      EXPECT_EQ(run.statistics.complex_solves,
                run.statistics.newton_iterations);
      EXPECT_EQ(run.statistics.force_evaluations,
                2 * run.statistics.newton_iterations);
      EXPECT_EQ(run.statistics.schur_complements, 1000U);
    }
  EXPECT_LT(differences[1].angle, 1e-3);
  EXPECT_LT(differences[1].deflection, 0.02);
  for (unsigned int k = 1; k < differences.size(); ++k)
    {
      EXPECT_LT(differences[k].angle, differences[k - 1].angle);
      EXPECT_LT(differences[k].deflection, differences[k - 1].deflection);
    }
}
