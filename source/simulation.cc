// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/estimate.h>
#include <acf/inspection.h>
#include <acf/io/checkpoint.h>
#include <acf/io/field_output.h>
#include <acf/io/mode_output.h>
#include <acf/io/probes.h>
#include <acf/io/result_directory.h>
#include <acf/mechanics/accuracy.h>
#include <acf/model.h>
#include <acf/plausibility.h>
#include <acf/run_report.h>
#include <acf/simulation.h>
#include <acf/version.h>

#include <deal.II/base/multithread_info.h>

#include <chrono>
#include <ostream>
#include <sstream>

namespace ACF
{
  namespace
  {
    void
    print_warnings(const MultibodySystem &system, std::ostream &warnings)
    {
      for (const std::string &warning : size_warnings(system))
        print_warning(warnings, warning);
      for (const std::string &warning : accuracy_warnings(system))
        print_warning(warnings, warning);
    }



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



    // The observers of a run.
    struct Observers
    {
      std::vector<std::unique_ptr<Observer>> all;

      // Null if nobody watches.
      ValidityMonitor *validity = nullptr;

      // Null unless modes about the end are asked for.
      LastState *end = nullptr;

      template <typename T>
      T *
      add(std::unique_ptr<T> observer)
      {
        T *const added = observer.get();
        all.push_back(std::move(observer));
        return added;
      }

      std::vector<Observer *>
      pointers() const
      {
        std::vector<Observer *> result;
        for (const auto &observer : all)
          result.push_back(observer.get());
        return result;
      }
    };



    Observers
    make_observers(const MultibodySystem &system,
                   const Model &model,
                   const std::filesystem::path &directory,
                   std::ostream &warnings,
                   Statistics &statistics)
    {
      Observers observers;
      if (!model.probes.empty())
        observers.add(std::make_unique<ProbeOutput>(system,
                                                    model.probes,
                                                    model.output.probe_interval,
                                                    directory,
                                                    statistics));
      if (model.output.fields.interval > 0)
        {
          std::unique_ptr<StressPeaks> peaks;
          if (model.output.fields.contain("peak von Mises stress"))
            peaks = std::make_unique<StressPeaks>(system, statistics);
          observers.add(std::make_unique<FieldOutput>(
            system, directory, model.output.fields, peaks.get(), statistics));
          if (peaks) // later than the files, which contain no later times
            observers.add(std::move(peaks));
        }
      // when it stops a run, the others have seen the state
      if (model.validity.action != ValidityParameters::Action::ignore)
        observers.validity = observers.add(std::make_unique<ValidityMonitor>(
          system, model.validity, model.time.end_time, warnings, statistics));
      if (model.modes.number > 0 && model.modes.at_end)
        observers.end = observers.add(std::make_unique<LastState>());
      return observers;
    }



    // Prepares the folder of the results, and says what was there.
    void
    prepare_directory(const RunOptions &options, std::ostream &warnings)
    {
      EarlierResults earlier =
        options.overwrite ? EarlierResults::remove : EarlierResults::set_aside;
      std::error_code error;
      if (options.restart &&
          std::filesystem::equivalent(
            std::filesystem::absolute(*options.restart).parent_path(),
            options.output_directory,
            error))
        earlier = EarlierResults::keep;
      const auto aside =
        prepare_result_directory(options.output_directory, earlier);
      if (!aside.empty())
        print_warning(warnings,
                      "results of an earlier run in " +
                        options.output_directory.string() + " were moved to " +
                        aside.string());
    }



    // The simulation from its beginning or from a checkpoint to its end.
    void
    simulate(const MultibodySystem &system,
             const SystemState &state,
             const Model &model,
             const RunOptions &options,
             const Observers &observers,
             Statistics &statistics,
             std::ostream &stream,
             std::ostream &warnings)
    {
      TimeLoop loop(
        system, state, model.time, observers.pointers(), statistics);
      const CheckpointedModel checkpointed{system,
                                           model.used_parameters,
                                           model.time.end_time};
      if (options.restart)
        {
          const unsigned int n_threads = load_checkpoint(
            *options.restart,
            checkpointed,
            [&] { prepare_directory(options, warnings); },
            loop,
            statistics);
          if (n_threads != MultithreadInfo::n_threads())
            print_warning(warnings,
                          "the checkpoint was written with " +
                            counted(n_threads, "thread") +
                            "; with another number the results agree up to "
                            "round-off only");
          if (observers.end != nullptr)
            observers.end->observe(loop.state());
          if (!options.quiet)
            stream << "Continues at time " << format_number(loop.state().time)
                   << " s from " << options.restart->string() << std::endl;
        }
      write_file(options.output_directory / "used_parameters.prm",
                 model.used_parameters);

      Checkpoints checkpoints;
      checkpoints.interval      = model.output.checkpoint_interval;
      checkpoints.wall_interval = model.output.checkpoint_wall_interval;
      checkpoints.file = (options.output_directory / checkpoint_file).string();
      checkpoints.save = [&] {
        save_checkpoint(options.output_directory,
                        checkpointed,
                        loop,
                        statistics);
      };
      Progress progress(stream,
                        !options.quiet && standard_output_is_terminal(),
                        model.time.end_time,
                        loop.state().time);
      loop.run(progress, checkpoints);
    }
  } // namespace



  void
  run_model(const Model &model,
            const RunOptions &options,
            std::ostream &stream,
            std::ostream &warnings)
  {
    const auto &directory = options.output_directory;
    check_writable(directory);
    if (options.restart && model.time.end_time == 0)
      throw InputError("Time integration",
                       "End time",
                       "0 with --restart",
                       "an end after the checkpoint");
    Statistics statistics;
    std::unique_ptr<const MultibodySystem> system;
    {
      const PhaseTimer timer(statistics, "assembly");
      system =
        std::make_unique<const MultibodySystem>(model.system, model.directory);
    }
    check_number_of_modes(*system, model.modes.number);
    print_warnings(*system, warnings);
    if (!options.quiet)
      describe_bodies(*system, stream);

    std::ostringstream nowhere;
    std::ostream &log = options.quiet ? nowhere : stream;
    const Observers observers =
      make_observers(*system, model, directory, warnings, statistics);
    const SystemState state = options.restart
                                ? system->initial_state()
                                : start_state(*system, model, statistics, log);
    const auto modes_about  = [&](const SystemState &about) {
      find_modes(
        *system, about, model.modes.number, directory, statistics, log);
    };
    const auto write_statistics = [&](const bool finished) {
      write_file(
        directory / "statistics.json",
        statistics_json(statistics, *system, observers.validity, finished));
    };

    if (!options.restart)
      {
        prepare_directory(options, warnings);
        write_file(directory / "used_parameters.prm", model.used_parameters);
      }
    try
      {
        if (model.modes.number > 0 && !model.modes.at_end && !options.restart)
          modes_about(state);
        if (model.time.end_time > 0)
          simulate(*system,
                   state,
                   model,
                   options,
                   observers,
                   statistics,
                   stream,
                   warnings);
        else
          for (const auto &observer : observers.all)
            observer->observe(state);
        if (observers.end != nullptr)
          modes_about(observers.end->last);
      }
    catch (const InputError &)
      {
        throw; // of a checkpoint: nothing was computed
      }
    catch (...)
      {
        try
          {
            write_statistics(false);
          }
        catch (const SimulationError &)
          {} // the first error is the cause
        throw;
      }
    write_statistics(true);
    if (!options.quiet)
      {
        describe_run(statistics, stream);
        if (observers.validity != nullptr)
          observers.validity->describe(stream);
        stream << "Results are in " << directory.string() << std::endl;
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
        case CommandLine::Action::inspect:
        case CommandLine::Action::validate:
        case CommandLine::Action::estimate:
        case CommandLine::Action::run:
          break;
      }

    if (command_line.n_threads > 0)
      MultithreadInfo::set_thread_limit(command_line.n_threads);
    if (command_line.action == CommandLine::Action::inspect)
      {
        inspect(command_line, stream, warnings);
        return;
      }

    const ParameterFile file(command_line.model, command_line.overrides);
    const Model model = read_model(file);
    for (const std::string &warning : model.warnings)
      print_warning(warnings, warning);
    const std::filesystem::path output_directory =
      command_line.output_directory.value_or(model.output.directory);
    try
      {
        if (command_line.action == CommandLine::Action::run)
          {
            if (!command_line.quiet && !model.title.empty())
              stream << model.title << std::endl;
            run_model(model,
                      {output_directory,
                       command_line.quiet,
                       command_line.restart,
                       command_line.overwrite},
                      stream,
                      warnings);
          }
        else
          {
            const auto start = std::chrono::steady_clock::now();
            const MultibodySystem system(model.system, model.directory);
            const std::chrono::duration<double> assembly_time =
              std::chrono::steady_clock::now() - start;
            for (const ProbeParameters &probe : model.probes)
              make_probe(probe, system);
            check_number_of_modes(system, model.modes.number);
            std::ostringstream log;
            check_start(system, model.start, model.time.first_step(), log);
            print_warnings(system, warnings);
            if (!command_line.quiet)
              {
                describe_bodies(system, stream);
                stream << log.str();
                if (command_line.action == CommandLine::Action::estimate)
                  estimate_run(model, system, assembly_time.count(), stream);
                else
                  stream << command_line.model.string() << " is valid."
                         << std::endl;
              }
          }
      }
    catch (const InputError &error)
      {
        throw file.locate(error);
      }
  }
} // namespace ACF
