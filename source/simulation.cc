// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/io/mode_output.h>
#include <acf/io/probes.h>
#include <acf/io/vtu_output.h>
#include <acf/mechanics/accuracy.h>
#include <acf/model.h>
#include <acf/simulation.h>
#include <acf/version.h>

#include <deal.II/base/multithread_info.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <ostream>
#include <sstream>

namespace ACF
{
  namespace
  {
    // Complete or not at all under its final name.
    void
    write_file(const std::filesystem::path &file, const std::string &text)
    {
      const std::filesystem::path temporary = file.string() + ".tmp";
      std::ofstream stream(temporary);
      stream << text << std::flush;
      stream.close();
      std::error_code error;
      if (stream)
        std::filesystem::rename(temporary, file, error);
      if (!stream || error)
        throw SimulationError("Cannot write the file " + file.string() + ".");
    }



    void
    make_directory(const std::filesystem::path &directory)
    {
      std::error_code error;
      std::filesystem::create_directories(directory, error);
      if (error || !std::filesystem::is_directory(directory))
        throw SimulationError("Cannot make the output directory " +
                              directory.string() + ": " + error.message() +
                              ".");
    }



    // Components that are only round-off of the scale are shown as zero.
    std::string
    format_vector(const Vector3 &v, const double scale)
    {
      std::string text;
      for (unsigned int i = 0; i < dim; ++i)
        text += (i == 0 ? "(" : ", ") +
                format_number(std::abs(v[i]) < 1e-12 * scale ? 0. : v[i]);
      return text + ")";
    }



    std::string
    counted(const unsigned long n, const std::string &noun)
    {
      return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
    }



    void
    describe_whole(const MultibodySystem &system,
                   const std::string &name,
                   std::ostream &stream)
    {
      unsigned int n_parts = 0;
      double volume = 0, mass = 0;
      for (const Body &body : system.bodies())
        if (body.whole() == name)
          {
            ++n_parts;
            volume += body.operators().volume;
            mass += body.operators().mass;
          }
      stream << "Body '" << name << "': " << counted(n_parts, "part")
             << ", volume " << format_number(volume) << " m^3, mass "
             << format_number(mass) << " kg\n";
    }



    void
    describe_bodies(const MultibodySystem &system, std::ostream &stream)
    {
      std::string whole;
      for (const Body &body : system.bodies())
        {
          if (body.whole() != whole && !body.whole().empty())
            describe_whole(system, body.whole(), stream);
          whole                          = body.whole();
          const BodyOperators &operators = body.operators();
          const auto &mesh               = body.discretization().mesh();
          const Matrix3 &inertia         = operators.inertia;
          stream << "Body '" << body.name()
                 << "': " << mesh.triangulation().n_active_cells()
                 << " quadratic "
                 << (mesh.is_simplex() ? "tetrahedra" : "hexahedra") << ", "
                 << operators.n_unknowns() << " unknowns\n"
                 << "  volume " << format_number(operators.volume)
                 << " m^3, mass " << format_number(operators.mass)
                 << " kg, centre of mass in the mesh "
                 << format_vector(operators.centre, operators.length) << " m\n"
                 << "  inertia about it xx, yy, zz "
                 << format_vector(
                      Vector3({inertia[0][0], inertia[1][1], inertia[2][2]}),
                      inertia.norm())
                 << ", yz, zx, xy "
                 << format_vector(
                      Vector3({inertia[1][2], inertia[2][0], inertia[0][1]}),
                      inertia.norm())
                 << " kg m^2\n";
        }
      if (system.n_constraints() > 0)
        stream << counted(system.joints().size(), "joint") << " with "
               << counted(system.n_constraints(), "constraint") << "\n";
      stream << std::flush;
    }



    void
    print_accuracy_warnings(const MultibodySystem &system,
                            std::ostream &warnings)
    {
      for (const std::string &warning : accuracy_warnings(system))
        print_warning(warnings, warning);
    }



    void
    describe_run(const Statistics &statistics, std::ostream &stream)
    {
      const auto time = [&](const std::string &phase) {
        const auto it = statistics.wall_times.find(phase);
        return it == statistics.wall_times.end() ? 0. : it->second;
      };
      stream << counted(statistics.steps, "step") << " ("
             << statistics.rejected_steps << " rejected) with "
             << counted(statistics.newton_iterations, "iteration") << ", "
             << counted(statistics.real_factorizations +
                          statistics.complex_factorizations,
                        "factorisation")
             << " (" << format_bytes(statistics.factor_bytes) << "), "
             << counted(statistics.real_solves + statistics.complex_solves,
                        "solve")
             << "\n"
             << "Time: assembly " << format_duration(time("assembly"))
             << ", factorisation " << format_duration(time("factorisation"))
             << ", time steps "
             << format_duration(
                  std::max(0., time("time steps") - time("factorisation")))
             << " (solves " << format_duration(time("solves")) << "), output "
             << format_duration(time("output")) << "; peak memory "
             << format_bytes(peak_memory()) << std::endl;
    }
  } // namespace



  std::string
  statistics_json(const Statistics &statistics,
                  const MultibodySystem &system,
                  const ValidityMonitor *const validity,
                  const bool finished)
  {
    nlohmann::ordered_json json;
    json["version"]           = ACF_VERSION;
    json["finished"]          = finished;
    json["steps"]             = statistics.steps;
    json["rejected steps"]    = statistics.rejected_steps;
    json["rejected by error"] = statistics.rejected_by_error;
    json["rejected by convergence"] =
      statistics.rejected_steps - statistics.rejected_by_error;
    json["halvings"]          = statistics.halvings;
    json["step size changes"] = statistics.step_size_changes;
    json["step size [s]"]     = {{"min", statistics.min_step_size},
                                 {"max", statistics.max_step_size}};
    json["estimated error"]   = statistics.estimated_error;
    if (statistics.steps > 0)
      json["iterations per step"] =
        1. * statistics.newton_iterations / statistics.steps;
    json["corrected tangent steps"] = statistics.corrected_tangent_steps;
    json["exact tangent steps"]     = statistics.exact_tangent_steps;
    json["krylov iterations"]       = statistics.krylov_iterations;
    json["factor refreshes"]        = statistics.factor_refreshes;
    json["newton iterations"]       = statistics.newton_iterations;
    json["newton iterations max"]   = statistics.max_newton_iterations;
    json["equilibrium iterations"]  = statistics.equilibrium_iterations;
    json["factorisations"]          = {{"real", statistics.real_factorizations},
                                       {"complex", statistics.complex_factorizations},
                                       {"single precision",
                                        statistics.single_factorizations},
                                       {"evicted", statistics.evicted_factors}};
    json["solves"]                  = {{"real", statistics.real_solves},
                                       {"complex", statistics.complex_solves},
                                       {"setup", statistics.setup_solves}};
    json["force evaluations"]       = statistics.force_evaluations;
    json["marker factorisations"]   = statistics.marker_factorizations;
    json["constraint corrections"]  = statistics.constraint_corrections;
    json["stress evaluations"]      = statistics.stress_evaluations;
    json["validity checks"]         = statistics.validity_checks;
    json["vtu files"]               = statistics.vtu_files;
    json["probe rows"]              = statistics.probe_rows;
    json["constraints"]             = system.n_constraints();
    json["repeated constraints"]    = system.n_repeated_constraints();
    json["constraint residual"]     = {
          {"positions [m or rad]", statistics.constraint_residual},
          {"velocities [m/s or rad/s]", statistics.constraint_velocity_residual}};
    json["different bodies"] = system.n_reference_bodies();
    for (const Body &body : system.bodies())
      json["bodies"][body.name()] = {
        {"cells",
         body.discretization().mesh().triangulation().n_active_cells()},
        {"unknowns", body.operators().n_unknowns()},
        {"mass [kg]", body.operators().mass},
        {"volume [m^3]", body.operators().volume},
        {"operator memory [B]", body.operators().memory_consumption()}};
    if (validity != nullptr)
      for (unsigned int b = 0; b < system.bodies().size(); ++b)
        for (unsigned int k = 0; k < ValidityMonitor::names().size(); ++k)
          json["bodies"][system.bodies()[b].name()]["validity"]
              [ValidityMonitor::names()[k]] = {
                {"maximum", validity->maxima(b)[k].value},
                {"time [s]", validity->maxima(b)[k].time}};
    json["factor entries"]          = statistics.factor_entries;
    json["factor memory [B]"]       = statistics.factor_bytes;
    json["joint column memory [B]"] = statistics.joint_column_bytes;
    json["factor backward error"]   = statistics.factor_backward_error;
    json["factor contraction"]      = statistics.factor_contraction;
    json["threads"]                 = MultithreadInfo::n_threads();
    json["peak memory [B]"]         = peak_memory();
    for (const auto &[phase, seconds] : statistics.wall_times)
      json["wall time [s]"][phase] = seconds;
    return json.dump(2) + "\n";
  }



  namespace
  {
    // With a factorisation of its own only if something must be projected.
    SystemState
    start_state(const MultibodySystem &system,
                const Model &model,
                Statistics &statistics,
                std::ostream &log)
    {
      const PhaseTimer timer(statistics, "start");
      FactorizationCache cache(statistics);
      return initial_state(
        system, model.start, model.time.first_step(), cache, statistics, log);
    }



    // Keeps the state at the end of the simulation.
    class LastState : public Observer
    {
    public:
      LastState()
        : Observer(0)
      {}

      void
      observe(const SystemState &state) override
      {
        last = state;
      }

      SystemState last;
    };



    void
    find_modes(const MultibodySystem &system,
               const SystemState &state,
               const unsigned int number,
               const std::filesystem::path &directory,
               Statistics &statistics,
               std::ostream &log)
    {
      const PhaseTimer timer(statistics, "modes");
      const NaturalModes modes =
        natural_modes(system, state, number, statistics);
      write_modes(system, state, modes, directory, statistics);
      describe_modes(state, modes, log);
    }



    // Modes about the start, the simulation if there is one, and modes about
    // its end.
    void
    run_phases(const MultibodySystem &system,
               const SystemState &state,
               const Model &model,
               std::vector<Observer *> observers,
               const std::filesystem::path &directory,
               Statistics &statistics,
               std::ostream &stream,
               const bool quiet)
    {
      std::ostringstream nowhere;
      std::ostream &log      = quiet ? nowhere : stream;
      const auto modes_about = [&](const SystemState &about) {
        find_modes(
          system, about, model.modes.number, directory, statistics, log);
      };
      if (model.modes.number > 0 && !model.modes.at_end)
        modes_about(state);
      LastState end;
      if (model.modes.number > 0 && model.modes.at_end)
        observers.push_back(&end);
      if (model.time.end_time > 0)
        {
          Progress progress(stream,
                            !quiet && standard_output_is_terminal(),
                            model.time.end_time);
          run_time_loop(
            system, state, model.time, observers, progress, statistics);
        }
      else
        for (Observer *const observer : observers)
          observer->observe(state);
      if (model.modes.number > 0 && model.modes.at_end)
        modes_about(end.last);
    }
  } // namespace



  void
  run_model(const Model &model,
            const std::filesystem::path &output_directory,
            std::ostream &stream,
            std::ostream &warnings,
            const bool quiet)
  {
    Statistics statistics;
    std::unique_ptr<const MultibodySystem> system;
    {
      const PhaseTimer timer(statistics, "assembly");
      system =
        std::make_unique<const MultibodySystem>(model.system, model.directory);
    }
    check_number_of_modes(*system, model.modes.number);
    print_accuracy_warnings(*system, warnings);
    if (!quiet)
      describe_bodies(*system, stream);

    std::ostringstream log;
    const SystemState state =
      start_state(*system, model, statistics, quiet ? log : stream);
    make_directory(output_directory);
    std::vector<std::unique_ptr<Observer>> observers;
    if (!model.probes.empty())
      observers.push_back(
        std::make_unique<ProbeOutput>(*system,
                                      model.probes,
                                      model.output.probe_interval,
                                      output_directory,
                                      statistics));
    if (model.output.vtu.interval > 0)
      observers.push_back(std::make_unique<VtuOutput>(
        *system, output_directory, model.output.vtu, statistics));
    ValidityMonitor *validity = nullptr;
    if (model.validity.action != ValidityParameters::Action::ignore)
      {
        // the last one: when it stops a run, the others have seen the state
        auto monitor = std::make_unique<ValidityMonitor>(
          *system, model.validity, model.time.end_time, warnings, statistics);
        validity = monitor.get();
        observers.push_back(std::move(monitor));
      }
    write_file(output_directory / "used_parameters.prm", model.used_parameters);

    const auto write_statistics = [&](const bool finished) {
      write_file(output_directory / "statistics.json",
                 statistics_json(statistics, *system, validity, finished));
    };
    try
      {
        std::vector<Observer *> pointers;
        for (const auto &observer : observers)
          pointers.push_back(observer.get());
        run_phases(*system,
                   state,
                   model,
                   pointers,
                   output_directory,
                   statistics,
                   stream,
                   quiet);
      }
    catch (...)
      {
        write_statistics(false);
        throw;
      }
    write_statistics(true);
    if (!quiet)
      {
        describe_run(statistics, stream);
        if (validity != nullptr)
          validity->describe(stream);
        stream << "Results are in " << output_directory.string() << std::endl;
      }
  }



  void
  run_command(const CommandLine &command_line,
              std::ostream &stream,
              std::ostream &warnings)
  {
    switch (command_line.action)
      {
        case CommandLine::Action::help:
          stream << help_text();
          return;
        case CommandLine::Action::version:
          stream << "acf-dealii " << ACF_VERSION << std::endl;
          return;
        case CommandLine::Action::print_parameters:
          stream << default_model_file();
          return;
        case CommandLine::Action::validate:
        case CommandLine::Action::run:
          break;
      }

    if (command_line.n_threads > 0)
      MultithreadInfo::set_thread_limit(command_line.n_threads);

    const ParameterFile file(command_line.model, command_line.overrides);
    const Model model = read_model(file);
    const std::filesystem::path output_directory =
      command_line.output_directory.value_or(model.output.directory);
    try
      {
        if (command_line.action == CommandLine::Action::run)
          {
            if (!command_line.quiet && !model.title.empty())
              stream << model.title << std::endl;
            run_model(
              model, output_directory, stream, warnings, command_line.quiet);
          }
        else
          {
            const MultibodySystem system(model.system, model.directory);
            for (const ProbeParameters &probe : model.probes)
              make_probe(probe, system);
            check_number_of_modes(system, model.modes.number);
            std::ostringstream log;
            check_start(system, model.start, model.time.first_step(), log);
            print_accuracy_warnings(system, warnings);
            if (!command_line.quiet)
              {
                describe_bodies(system, stream);
                stream << log.str() << command_line.model.string()
                       << " is valid." << std::endl;
              }
          }
      }
    catch (const InputError &error)
      {
        throw file.locate(error);
      }
  }
} // namespace ACF
