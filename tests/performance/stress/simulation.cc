// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "stress.h"

namespace Stress
{
  void
  Row::add(const std::string &expected_text,
           const std::string &got_text,
           const bool holds)
  {
    expected += (expected.empty() ? "" : "; ") + expected_text;
    got += (got.empty() ? "" : "; ") + got_text + (holds ? "" : " (!)");
    all_hold = all_hold && holds;
  }



  void
  Row::near(const std::string &what,
            const double value,
            const double reference,
            const double tolerance,
            const std::string &source)
  {
    add(what + " " + shown(reference) + " within " + shown(tolerance) + " (" +
          source + ")",
        shown(value),
        std::abs(value - reference) <= tolerance);
  }



  void
  Row::below(const std::string &what,
             const double value,
             const double bound,
             const std::string &source)
  {
    add(what + " up to " + shown(bound) + " (" + source + ")",
        shown(value),
        value <= bound);
  }



  void
  Row::require(const std::string &what,
               const bool holds,
               const std::string &found,
               const std::string &source)
  {
    add(what + (source.empty() ? "" : " (" + source + ")"), found, holds);
  }



  void
  Row::fail(const std::string &message)
  {
    std::string line = message;
    std::replace(line.begin(), line.end(), '\n', ' ');
    add("no error", line, false);
  }



  std::string
  Row::line(const std::string &name) const
  {
    std::ostringstream text;
    text << "| " << name << " | " << expected << " | " << got << " | "
         << statistics.steps << " | " << statistics.rejected_steps << " | "
         << statistics.newton_iterations;
    if (statistics.equilibrium_iterations > 0)
      text << " + " << statistics.equilibrium_iterations << " static";
    text << " | " << statistics.corrected_tangent_steps << " | "
         << statistics.exact_tangent_steps << " | "
         << statistics.krylov_iterations << " | "
         << statistics.constraint_corrections << " | " << statistics.halvings
         << " | " << statistics.factor_refreshes << " | "
         << (all_hold ? "holds" : "**FAILS**") << " |";
    return text.str();
  }



  namespace
  {
    // Shows states, counts them and refuses what is not finite.
    class Watch : public Observer
    {
    public:
      Watch(const Simulation::Observe &observe_state,
            const unsigned long max_states,
            double &time)
        : Observer(0)
        , observe_state(observe_state)
        , max_states(max_states)
        , time(time)
      {}

      void
      observe(const SystemState &state) override
      {
        for (const SystemVector *vectors :
             {&state.positions, &state.velocities})
          for (const NodalVector &vector : *vectors)
            if (!std::isfinite(vector.l2_norm()))
              throw std::runtime_error("a state that is not finite at " +
                                       shown(state.time) + " s");
        if (++n_states > max_states)
          throw std::runtime_error("more than " + std::to_string(max_states) +
                                   " steps");
        time = state.time;
        if (observe_state)
          observe_state(state);
      }

    private:
      const Simulation::Observe &observe_state;
      const unsigned long max_states;
      double &time;
      unsigned long n_states = 0;
    };
  } // namespace



  Simulation::Simulation(const std::string &model_file,
                         const std::vector<std::string> &overrides)
    : model(read_model(ParameterFile::from_text(model_file, overrides)))
    , system(model.system, model.directory)
  {
    for (const ProbeParameters &probe : model.probes)
      model_probes.push_back(make_probe(probe, system));
  }



  Simulation::Simulation(const std::filesystem::path &file,
                         const std::vector<std::string> &overrides)
    : model(read_model(ParameterFile(file, overrides)))
    , system(model.system, model.directory)
  {
    for (const ProbeParameters &probe : model.probes)
      model_probes.push_back(make_probe(probe, system));
  }



  SystemState
  Simulation::start()
  {
    std::ostringstream log;
    FactorizationCache cache(statistics);
    return initial_state(
      system, model.start, model.time.step_size, cache, statistics, log);
  }



  bool
  Simulation::run(const Observe &observe)
  {
    std::ostringstream nowhere;
    Progress progress(nowhere, false, model.time.end_time);
    const double n_steps = model.time.end_time / model.time.step_size;
    Watch watch(observe, 100 + 20 * n_steps, time_reached);
    std::vector<Observer *> observers = {&watch};
    std::unique_ptr<ValidityMonitor> validity;
    if (model.validity.action != ValidityParameters::Action::ignore)
      {
        validity = std::make_unique<ValidityMonitor>(
          system, model.validity, model.time.end_time, warnings, statistics);
        observers.push_back(validity.get());
      }
    try
      {
        run_time_loop(
          system, start(), model.time, observers, progress, statistics);
      }
    catch (const SimulationError &error)
      {
        failure = error.what();
        return false;
      }
    return true;
  }



  std::vector<double>
  Simulation::probes(const SystemState &state) const
  {
    std::vector<double> values;
    for (const auto &probe : model_probes)
      for (const double value : probe->evaluate(state))
        values.push_back(value);
    return values;
  }



  double
  Simulation::energy(const SystemState &state) const
  {
    const SystemEnergy energy = system.energy(state);
    return energy.kinetic + energy.elastic + energy.potential;
  }



  void
  Simulation::finish(Row &row) const
  {
    Statistics &sum = row.statistics;
    sum.steps += statistics.steps;
    sum.rejected_steps += statistics.rejected_steps;
    sum.newton_iterations += statistics.newton_iterations;
    sum.equilibrium_iterations += statistics.equilibrium_iterations;
    sum.corrected_tangent_steps += statistics.corrected_tangent_steps;
    sum.exact_tangent_steps += statistics.exact_tangent_steps;
    sum.krylov_iterations += statistics.krylov_iterations;
    sum.constraint_corrections += statistics.constraint_corrections;
    sum.halvings += statistics.halvings;
    sum.factor_refreshes += statistics.factor_refreshes;
    if (system.n_constraints() > 0 && statistics.steps > 0)
      row.below("constraint residual",
                statistics.constraint_residual,
                1e-12,
                "round-off");
  }



  void
  EnergyWatch::operator()(const SystemState &state)
  {
    last = simulation.energy(state);
    largest_kinetic =
      std::max(largest_kinetic, simulation.system.energy(state).kinetic);
    if (empty)
      first = smallest = last;
    empty    = false;
    growth   = std::max(growth, last - smallest);
    smallest = std::min(smallest, last);
  }



  std::string
  exact(const double value)
  {
    std::ostringstream text;
    text << std::setprecision(17) << value;
    return text.str();
  }



  std::string
  shown(const double value)
  {
    std::ostringstream text;
    text << std::setprecision(4) << value;
    return text.str();
  }



  std::string
  section(const std::string &name,
          const std::vector<std::pair<std::string, std::string>> &subsections,
          const std::string &more)
  {
    std::string names, text;
    for (const auto &[subsection, entries] : subsections)
      {
        names += (names.empty() ? "" : ", ") + subsection;
        text += "subsection " + subsection + "\n";
        std::istringstream lines(entries);
        for (std::string entry; std::getline(lines, entry);)
          text += "set " + entry + "\n";
        text += "end\n";
      }
    return "subsection " + name + "\nset Names = " + names + "\n" + more +
           text + "end\n";
  }



  std::string
  box(const std::vector<double> &from,
      const std::vector<double> &to,
      const std::string &cells,
      const double youngs_modulus,
      const double poissons_ratio,
      const double density)
  {
    const auto list = [](const std::vector<double> &v) {
      return exact(v[0]) + ", " + exact(v[1]) + ", " + exact(v[2]);
    };
    return "Mesh = box\nElement = hexahedron\nBox from = " + list(from) +
           "\nBox to = " + list(to) + "\nCells = " + cells +
           "\nYoung's modulus = " + exact(youngs_modulus) +
           "\nPoisson's ratio = " + exact(poissons_ratio) +
           "\nDensity = " + exact(density) + "\n";
  }



  std::string
  time_section(const double end, const double step, const unsigned stages)
  {
    return "subsection Time integration\nset End time = " + exact(end) +
           "\nset Step size = " + exact(step) +
           "\nset Stages = " + std::to_string(stages) +
           "\nend\nsubsection Validity\nset Action = ignore\nend\n";
  }
} // namespace Stress
