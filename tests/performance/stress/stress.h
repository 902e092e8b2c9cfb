// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_performance_stress_h
#define acf_tests_performance_stress_h

#include <acf/io/probes.h>
#include <acf/model.h>

#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace Stress
{
  using namespace ACF;

  /** A row of the table: figures with their bounds, and statistics. */
  class Row
  {
  public:
    /** |value - reference| <= tolerance; source says where the reference is
     * from. */
    void
    near(const std::string &what,
         const double value,
         const double reference,
         const double tolerance,
         const std::string &source);

    /** value <= bound */
    void
    below(const std::string &what,
          const double value,
          const double bound,
          const std::string &source);

    /** A condition; got says what was found. */
    void
    require(const std::string &what,
            const bool holds,
            const std::string &got,
            const std::string &source);

    /** An error nobody expected. */
    void
    fail(const std::string &message);

    /** The row as a line of Markdown. */
    std::string
    line(const std::string &name) const;

    bool
    passed() const
    {
      return all_hold;
    }

    /** Of all runs of the case. */
    Statistics statistics;

  private:
    void
    add(const std::string &expected_text,
        const std::string &got_text,
        const bool holds);

    std::string expected, got;
    bool all_hold = true;
  };

  struct Case
  {
    std::string name;

    /** Whether the test suite runs it. */
    bool quick;

    std::function<void(Row &)> run;
  };

  /** Sizes of the steps, spins. */
  std::vector<Case>
  step_cases();

  /** Ratios of stiffness and mass, slenderness. */
  std::vector<Case>
  scale_cases();

  /** Dead centres and change points. */
  std::vector<Case>
  mechanism_cases();

  /** Inverted starts, impacts, many steps. */
  std::vector<Case>
  motion_cases();

  /** Buckling, snap-through, loads and releases far from equilibrium. */
  std::vector<Case>
  deflection_cases();

  /** Thin pendulum on unsymmetric meshes, spin-up beam. */
  std::vector<Case>
  model_cases();

  /**
   * A model that runs with a bound on its steps, whose states are looked at as
   * they come. Errors of the simulation are kept as text; anything that is not
   * finite is an error.
   */
  class Simulation
  {
  public:
    using Observe = std::function<void(const SystemState &)>;

    explicit Simulation(const std::string &model_file,
                        const std::vector<std::string> &overrides = {});

    /** From a model file. */
    Simulation(const std::filesystem::path &file,
               const std::vector<std::string> &overrides);

    /** State at the start, after the equilibrium if the model asks for it. */
    SystemState
    start();

    /**
     * @param observe is shown the start and all ends of steps, the last one at
     * the end time
     * @return whether the end time was reached; otherwise see failure
     */
    bool
    run(const Observe &observe);

    /** Values of all probes of the model. */
    std::vector<double>
    probes(const SystemState &state) const;

    /** Sum of all energies, J. */
    double
    energy(const SystemState &state) const;

    /** Adds the statistics to those of a row, and the bound on residuals of
     * the constraints, if there are any. */
    void
    finish(Row &row) const;

    Model model;
    const MultibodySystem system;
    Statistics statistics;

    /** Warnings of the run, see ValidityMonitor. */
    std::ostringstream warnings;

    /** Message of the SimulationError that ended the run. */
    std::string failure;

    /** Time of the last state that was seen, s. */
    double time_reached = 0;

  private:
    std::vector<std::unique_ptr<Probe>> model_probes;
  };

  /** Largest increase of the energy from its smallest value before. */
  class EnergyWatch
  {
  public:
    explicit EnergyWatch(const Simulation &simulation)
      : simulation(simulation)
    {}

    void
    operator()(const SystemState &state);

    double first = 0, last = 0, growth = 0, largest_kinetic = 0;

  private:
    const Simulation &simulation;
    double smallest = 0;
    bool empty      = true;
  };

  /** 17 digits. */
  std::string
  exact(const double value);

  /** A few digits. */
  std::string
  shown(const double value);

  /** A section of named subsections: name and entries, one "A = b" a line. */
  std::string
  section(const std::string &name,
          const std::vector<std::pair<std::string, std::string>> &subsections,
          const std::string &more = "");

  /** Entries of a body that is a box of hexahedra. */
  std::string
  box(const std::vector<double> &from,
      const std::vector<double> &to,
      const std::string &cells,
      const double youngs_modulus,
      const double poissons_ratio,
      const double density);

  std::string
  time_section(const double end, const double step, const unsigned stages = 2);
} // namespace Stress

#endif
