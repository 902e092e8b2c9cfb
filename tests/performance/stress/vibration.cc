// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "vibration.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace Stress
{
  namespace
  {
    // Of Radau IIA with 2 or 3 stages (Hairer and Wanner, Sec. IV.5).
    std::complex<double>
    stability_function(const unsigned int n_stages,
                       const std::complex<double> z)
    {
      if (n_stages == 2)
        return (1. + z / 3.) / (1. - 2. * z / 3. + z * z / 6.);
      return (1. + 2. * z / 5. + z * z / 20.) /
             (1. - 3. * z / 5. + 3. * z * z / 20. - z * z * z / 60.);
    }
  } // namespace



  void
  check_mode(Row &row,
             const std::string &model_file,
             const double rest,
             const double amplitude,
             const double omega,
             const double tolerance,
             const unsigned int stages,
             const double growth)
  {
    Simulation simulation(model_file);
    const std::complex<double> factor =
      stability_function(stages, {0, omega * simulation.model.time.step_size});
    std::complex<double> expected = 1;
    double error = 0, change = 0, n = 0;
    EnergyWatch energy(simulation);
    const bool done = simulation.run([&](const SystemState &state) {
      const auto values = simulation.probes(state);
      const std::complex<double> found((values[0] - rest) / amplitude,
                                       -values[1] / (amplitude * omega));
      if (state.time < simulation.model.time.end_time * (1 - 1e-9))
        {
          if (n > 0)
            expected *= factor;
          error  = std::max(error, std::abs(found - expected));
          change = std::max(change, std::abs(expected - 1.));
        }
      n += 1;
      energy(state);
    });
    row.require("end reached", done, done ? "yes" : simulation.failure, "");
    row.below("error against powers of R(i w tau), relative to the change " +
                shown(change),
              error / change,
              tolerance,
              "analytic mode, stability function");
    row.below("growth of energy / energy",
              energy.growth / energy.first,
              growth,
              "dissipative scheme; round-off");
    simulation.finish(row);
  }
} // namespace Stress
