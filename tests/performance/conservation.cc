// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// What the time integration does to energy and momenta of free motions, as
// comma-separated values (see conservation.md):
// - how fast it damps a vibration, against the stability function of the
// method;
// - how energy, linear and angular momentum drift in long motions with large
//   rotations, and by how much energy ever rises.
// Fails if the damping is not that of the method, or if energy rises by more
// than the bounds below.
//
// Usage: conservation [--quick]

#include <acf/time/modes.h>

#include <mpi.h>

#include <algorithm>
#include <complex>
#include <iostream>
#include <regex>

#include "pendulum_model.h"
#include "recorded_run.h"

namespace
{
  using namespace Tests;

  std::string
  number(const double value)
  {
    std::ostringstream stream;
    stream.precision(17);
    stream << value;
    return stream.str();
  }

  /** Watches what a system without loads or with gravity should keep. */
  class Invariants : public Observer
  {
  public:
    explicit Invariants(const MultibodySystem &system)
      : Observer(0)
      , system(system)
    {}

    void
    observe(const SystemState &state) override
    {
      const SystemEnergy parts = system.energy(state);
      last_energy     = parts.kinetic + parts.elastic + parts.potential;
      const Vector3 p = system.momentum(state);
      const Vector3 l = system.angular_momentum(state);
      if (n_states == 0)
        {
          first_energy = lowest_energy = last_energy;
          first_momentum               = p;
          first_angular_momentum       = l;
        }
      ++n_states;
      lowest_energy   = std::min(lowest_energy, last_energy);
      rise            = std::max(rise, last_energy - lowest_energy);
      momentum_change = std::max(momentum_change, (p - first_momentum).norm());
      angular_momentum_change =
        std::max(angular_momentum_change, (l - first_angular_momentum).norm());
    }

    /** J; negative if energy was gained. */
    double
    loss() const
    {
      return first_energy - last_energy;
    }

    double first_energy = 0, last_energy = 0;

    /** Largest rise of energy above any earlier value, J. */
    double rise = 0;

    /** Largest changes, kg m/s and kg m^2/s. */
    double momentum_change = 0, angular_momentum_change = 0;

    Vector3 first_momentum, first_angular_momentum;

  private:
    const MultibodySystem &system;
    double lowest_energy   = 0;
    unsigned long n_states = 0;
  };



  // --- the vibration of a bar ---

  /** $|R(i y)|^2$ of Radau IIA (Hairer and Wanner, Table IV.3.1 with
   * k = s - 1, j = s). */
  double
  energy_factor(const unsigned int n_stages, const double y)
  {
    const std::complex<double> z(0, y);
    return std::norm(
      n_stages == 2
        ? (1. + z / 3.) / (1. - 2. / 3. * z + z * z / 6.)
        : (1. + 2. / 5. * z + z * z / 20.) /
            (1. - 3. / 5. * z + 3. / 20. * z * z - z * z * z / 60.));
  }

  std::string
  free_bar(const std::string &strain)
  {
    return R"(
subsection Bodies
  set Names = bar
  subsection bar
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = -0.1, -0.5, -0.1
    set Box to          =  0.1,  0.5,  0.1
    set Cells           = 1, 6, 1
    set Young's modulus = 1e8
    set Density         = 1000
    set Strain          = )" +
           strain + R"(
  end
end
subsection Time integration
  set Newton tolerance = 1e-14
  set End time         = 1
  set Step size        = 1
end
)";
  }

  /** The mode that is most like the first longitudinal one of a bar. */
  Mode
  longitudinal_mode(RecordedRun &run)
  {
    const Body &body    = run.system.bodies()[0];
    const NodalVector X = body.placement();
    NodalVector field(X.size()), product(X.size());
    for (unsigned int a = 0; a < X.size() / dim; ++a)
      field[dim * a + 1] = std::sin(numbers::PI * X[dim * a + 1]);
    body.operators().mass_matrix.vmult(product, field);
    NaturalModes modes =
      natural_modes(run.system, run.system.initial_state(), 14, run.statistics);
    return *std::max_element(modes.modes.begin(),
                             modes.modes.end(),
                             [&](const Mode &a, const Mode &b) {
                               return std::abs(a.shape[0] * product) <
                                      std::abs(b.shape[0] * product);
                             });
  }

  /** Simulates from a state; what is watched has seen the start. */
  Invariants
  simulate(RecordedRun &run, const SystemState &start)
  {
    Invariants invariants(run.system);
    std::ostringstream nowhere;
    Progress progress(nowhere, false, run.model.time.end_time);
    run_time_loop(run.system,
                  start,
                  run.model.time,
                  {&invariants},
                  progress,
                  run.statistics);
    return invariants;
  }

  /** Ten periods of a vibration, or fewer if nothing is left of it earlier. */
  bool
  damp(const std::string &strain,
       const unsigned int n_stages,
       const double steps_per_period)
  {
    const bool is_reduced = (strain == "reduced");
    RecordedRun still(free_bar(strain), 1.);
    SystemState start      = still.system.initial_state();
    const Mode mode        = longitudinal_mode(still);
    const double omega     = mode.angular_frequency();
    const double step_size = 2 * numbers::PI / omega / steps_per_period;
    // the reduced strain is linear here, the other one for small strains
    start.positions[0].add((is_reduced ? 1e-3 : 1e-6) /
                             mode.shape[0].linfty_norm(),
                           mode.shape[0]);

    const double factor = energy_factor(n_stages, omega * step_size);
    const double n_steps =
      std::max(1.,
               std::min(10 * steps_per_period,
                        std::floor(std::log(1e-4) / std::log(factor))));
    RecordedRun run(free_bar(strain),
                    1.,
                    {"Time integration/Stages=" + std::to_string(n_stages),
                     "Time integration/Step size=" + number(step_size),
                     "Time integration/End time=" +
                       number(n_steps * step_size)});
    const Invariants found = simulate(run, start);
    const double predicted = 1 - std::pow(factor, n_steps);
    const double measured  = found.loss() / found.first_energy;
    const double rise      = found.rise / found.first_energy;
    std::cout << strain << ',' << n_stages << ',' << steps_per_period << ','
              << omega * step_size << ','
              << 1 - std::pow(factor, steps_per_period) << ',' << n_steps << ','
              << predicted << ',' << measured << ',' << measured / predicted - 1
              << ',' << rise << std::endl;

    // what the tolerance of 1e-14 leaves of amplitudes of 1e-3 and 1e-6
    const double noise = is_reduced ? 1e-12 : 1e-9;
    return std::abs(measured - predicted) <=
             noise + (is_reduced ? 1e-6 : 1e-5) * predicted &&
           rise <= noise;
  }



  // --- long motions ---

  /** A rod of 1 m, 50 mm and 40 mm thick; entries of the body and sections. */
  std::string
  rod(const std::string &entries, const std::string &sections)
  {
    return R"(
subsection Bodies
  set Names = rod
  subsection rod
    set Mesh            = box
    set Element         = hexahedron
    set Box from        = -0.025, -0.5, -0.02
    set Box to          =  0.025,  0.5,  0.02
    set Cells           = 1, 4, 1
    set Young's modulus = 1e8
    set Poisson's ratio = 0.3
    set Density         = 1000
)" + entries +
           "\n  end\nend\n" + sections;
  }

  struct Motion
  {
    std::string name;
    std::string model;

    /** Simulated, s. */
    double end_time = 10;

    /** Largest velocity of the first bending mode at the start, m/s. */
    double bending_velocity = 0;

    /** What energies are compared with, J; zero: that of the start. */
    double energy = 0;
  };

  /** It starts with the stretch that its spin causes, which would else make
   * it vibrate faster than the steps resolve. */
  Motion
  spinning_rod()
  {
    return {"spinning rod",
            rod(R"(
    set Velocity           = 0.3, -0.2, 0.1
    set Angular velocity   = 4, 0, 0
    set Displacement field = -2.4e-5*x*(0.25-y^2); 8e-5*(0.25*y-y^3/3); \
                             -2.4e-5*z*(0.25-y^2))",
                ""),
            10,
            0.5};
  }

  /** Falls from the horizontal, on a hinge at its end. */
  Motion
  pendulum()
  {
    return {"pendulum",
            rod("",
                R"(
subsection Joints
  set Names = hinge
  subsection hinge
    set Type    = revolute
    set Between = rod: y min, ground
    set Axis    = 1, 0, 0
  end
end
subsection Loads
  set Gravity = 0, 0, -9.81
end
)"),
            10,
            0,
            2 * 9.81 * 0.5};
  }

  Motion
  pendulum_of_the_paper()
  {
    std::string model = pendulum_model("hexahedron", "1, 20, 2");
    return {"pendulum of the paper",
            std::regex_replace(model, std::regex("pendulum"), "rod"),
            1,
            0,
            7800 * 0.05 * 0.0025 * 9.81 * 0.5};
  }

  /** What the method takes from the first bending mode, J; adds its velocity
   * to the start. */
  double
  start_bending(const Motion &motion,
                const unsigned int n_stages,
                RecordedRun &run,
                SystemState &start)
  {
    if (motion.bending_velocity == 0)
      return 0;
    const Mode mode = natural_modes(run.system, start, 8, run.statistics)
                        .modes[6]; // after six motions of a rigid body
    const double amplitude =
      motion.bending_velocity / mode.shape[0].linfty_norm();
    start.velocities[0].add(amplitude, mode.shape[0]);
    const double step_size = run.model.time.step_size;
    const double factor =
      energy_factor(n_stages, mode.angular_frequency() * step_size);
    return 0.5 * amplitude * amplitude *
           (1 - std::pow(factor, std::round(motion.end_time / step_size)));
  }

  bool
  drift(const Motion &motion,
        const std::string &strain,
        const unsigned int n_stages,
        const double step_size,
        const double tolerance)
  {
    RecordedRun run(motion.model,
                    1.,
                    {"Bodies/rod/Strain=" + strain,
                     "Time integration/Stages=" + std::to_string(n_stages),
                     "Time integration/Step size=" + number(step_size),
                     "Time integration/Newton tolerance=" + number(tolerance),
                     "Time integration/End time=" + number(motion.end_time)});
    SystemState start      = run.system.initial_state();
    const double predicted = start_bending(motion, n_stages, run, start);
    const Invariants found = simulate(run, start);
    const double energy =
      motion.energy > 0 ? motion.energy : found.first_energy;
    std::cout << motion.name << ',' << strain << ',' << n_stages << ','
              << step_size << ',' << tolerance << ','
              << 1. * run.statistics.newton_iterations / run.statistics.steps
              << ',' << found.loss() / energy << ',' << predicted / energy
              << ',' << found.rise / energy << ','
              << found.rise / energy / tolerance << ',';
    const bool is_free    = run.system.n_constraints() == 0;
    const double momentum = found.momentum_change / found.first_momentum.norm();
    if (is_free)
      std::cout << momentum << ','
                << found.angular_momentum_change /
                     found.first_angular_momentum.norm();
    else
      std::cout << ',';
    std::cout << std::endl;

    // what the iterations leave adds up, and rounding errors; with a strict
    // tolerance the method takes more than that
    return found.rise <= (1e5 * tolerance + 1e-8) * energy &&
           (tolerance > 1e-13 || found.rise <= 0.1 * found.loss()) &&
           (!is_free || momentum < 1e-10);
  }



  bool
  study_damping(const std::vector<double> &steps_per_period)
  {
    std::cout << "strain,stages,steps per period,omega tau,predicted loss per "
                 "period,steps,predicted loss,measured loss,relative "
                 "difference,largest rise"
              << std::endl;
    bool success = true;
    for (const std::string strain : {"reduced", "Green-Lagrange"})
      for (const unsigned int n_stages : {2U, 3U})
        for (const double n : steps_per_period)
          success &= damp(strain, n_stages, n);
    return success;
  }

  void
  print_drift_header()
  {
    std::cout << "motion,strain,stages,step size [s],tolerance,iterations per "
                 "step,loss,predicted loss of the bending,largest rise,rise by "
                 "tolerance,change of momentum,change of angular "
                 "momentum"
              << std::endl;
  }

  bool
  study_all()
  {
    bool success = study_damping({1, 2, 3, 5, 10, 20, 50, 100, 200});
    print_drift_header();
    for (Motion motion : {spinning_rod(), pendulum()})
      {
        for (const unsigned int n_stages : {2U, 3U})
          {
            const double strict = n_stages == 2 ? 1e-13 : 1e-14;
            for (const double step_size : {4e-3, 2e-3, 1e-3})
              success &= drift(motion, "reduced", n_stages, step_size, strict);
            for (const double tolerance : {1e-8, 1e-10, 1e-12})
              success &= drift(motion, "reduced", n_stages, 1e-3, tolerance);
          }
        motion.end_time = 2;
        for (const unsigned int n_stages : {2U, 3U})
          for (const double step_size : {4e-3, 2e-3, 1e-3})
            success &=
              drift(motion, "Green-Lagrange", n_stages, step_size, 1e-13);
      }
    for (const double tolerance : {1e-9, 1e-10, 1e-11, 1e-12})
      success &=
        drift(pendulum_of_the_paper(), "reduced", 2, 2.5e-4, tolerance);
    return success;
  }

  bool
  study_few()
  {
    bool success = study_damping({5, 20});
    print_drift_header();
    for (Motion motion : {spinning_rod(), pendulum()})
      {
        motion.end_time = 1;
        for (const unsigned int n_stages : {2U, 3U})
          for (const double tolerance : {1e-10, 1e-13})
            success &= drift(motion, "reduced", n_stages, 4e-3, tolerance);
        motion.end_time = 0.2;
        success &= drift(motion, "Green-Lagrange", 2, 4e-3, 1e-13);
      }
    return success;
  }
} // namespace



int
main(int argc, char **argv)
{
  const bool quick = (argc > 1 && std::string(argv[1]) == "--quick");
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  std::cout.precision(4);
  const bool success = quick ? study_few() : study_all();
  MPI_Finalize();
  return success ? 0 : 1;
}
