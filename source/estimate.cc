// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/machine_speed.h>
#include <acf/base/statistics.h>
#include <acf/estimate.h>
#include <acf/mechanics/mesh_limits.h>
#include <acf/model.h>
#include <acf/solvers/factor_estimate.h>
#include <acf/solvers/stage_solver.h>

#include <deal.II/base/multithread_info.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <ostream>
#include <set>

namespace ACF
{
  namespace
  {
    // Fitted to runs of the models in prm (doc/model-file.md): iterations of a
    // step, and work in bytes that the processor reads from its caches in the
    // same time.
    constexpr double n_iterations     = 1.5;
    constexpr double solve_work       = 1;     // per byte that a solve reads
    constexpr double unknown_work     = 2.5e3; // per unknown and iteration
    constexpr double constraint_work  = 4e5;   // per constraint and iteration
    constexpr double integration_work = 250;   // per node of a cell,
                                               // integration point and stage
    constexpr double entry_work = 3.8e3;       // per entry that is factorised

    // Measured times of steps and factorisations over estimated ones.
    constexpr double least_ratio   = 0.5;
    constexpr double largest_ratio = 2.7;

    // The stack of fronts is copied when it grows.
    constexpr double front_copies = 2;

    // What fits into a cache of each processor, bytes.
    constexpr std::size_t cached = 1 << 18;

    // Nodal vectors of a run: states, stages, increments and their history.
    constexpr double n_vectors = 40;

    // Right-hand sides that one reading of a factor serves.
    constexpr unsigned int together = 4;



    // Factorisations that bodies share.
    struct SharedFactor
    {
      FactorEstimate estimate;
      unsigned int n_bodies = 0;
      bool is_real          = true;
    };

    using Key = std::tuple<const ReferenceBody *, double, double, bool>;



    // All that a run makes.
    struct Factors
    {
      std::map<Key, SharedFactor> of_steps;

      // in double precision, not kept
      std::map<Key, SharedFactor> of_start;

      bool single = false;
    };



    Factors
    find_factors(const Model &model, const MultibodySystem &system)
    {
      Factors factors;
      factors.single =
        model.time.factor_precision != FactorPrecision::double_precision;
      std::map<const ReferenceBody *, std::unique_ptr<const EliminationTree>>
        trees;
      const auto add = [&](const Body &body,
                           const StageMatrix &matrix,
                           const bool single,
                           std::map<Key, SharedFactor> &list) {
        auto &tree = trees[&body.reference()];
        if (!tree)
          tree = std::make_unique<const EliminationTree>(
            body.operators().mass_matrix.graph());
        const auto [entry, is_new] = list.try_emplace({&body.reference(),
                                                       matrix.shift.real(),
                                                       matrix.shift.imag(),
                                                       matrix.is_real});
        if (is_new)
          {
            entry->second.estimate =
              estimate_factor(body.reference(), *tree, matrix.is_real, single);
            entry->second.is_real = matrix.is_real;
          }
        ++entry->second.n_bodies;
      };

      const double step_size = model.time.first_step();
      const bool projects =
        model.start.project_positions || model.start.project_velocities;
      for (const Body &body : system.bodies())
        {
          if (model.time.end_time > 0)
            for (const StageMatrix &matrix :
                 stage_matrices(body,
                                radau_iia(model.time.n_stages),
                                model.time.one_step_matrices,
                                step_size))
              add(body, matrix, factors.single, factors.of_steps);
          if (projects && system.n_constraints() > 0 && step_size > 0)
            add(body,
                {1 / (step_size * step_size), true},
                false,
                factors.of_start);
        }
      return factors;
    }



    // Of all factors.
    struct Total
    {
      unsigned long n_real = 0, n_complex = 0;
      std::size_t n_entries = 0, n_bytes = 0, column_bytes = 0, work_bytes = 0;

      // Bytes that an iteration reads, and setup solves.
      double iteration_bytes = 0, setup_bytes = 0;

      double n_operations = 0;

      void
      add(const std::map<Key, SharedFactor> &factors)
      {
        const auto rounds = [](const unsigned int n) {
          return (n + together - 1) / together;
        };
        for (const auto &[key, factor] : factors)
          {
            const FactorEstimate &estimate = factor.estimate;
            ++(factor.is_real ? n_real : n_complex);
            n_entries += estimate.n_entries;
            n_bytes += estimate.n_bytes;
            column_bytes += estimate.column_bytes;
            work_bytes = std::max(work_bytes, estimate.work_bytes);
            iteration_bytes += 2. * estimate.n_bytes * rounds(factor.n_bodies);
            setup_bytes +=
              2. * estimate.n_bytes * rounds(estimate.n_setup_solves);
            n_operations += estimate.n_operations;
          }
      }
    };



    double
    number_of_unknowns(const MultibodySystem &system)
    {
      double n = 0;
      for (const Body &body : system.bodies())
        n += body.operators().n_unknowns();
      return n;
    }



    // Mass and stiffness of all bodies are read in each iteration.
    double
    operator_bytes(const MultibodySystem &system)
    {
      double n = 0;
      for (const Body &body : system.bodies())
        n += body.operators().memory_consumption();
      return n;
    }



    // Of an iteration but for solves and operators, see the constants.
    double
    iteration_work(const MultibodySystem &system, const unsigned int n_stages)
    {
      double work = unknown_work * number_of_unknowns(system) +
                    constraint_work * system.n_constraints();
      for (const Body &body : system.bodies())
        if (body.strain_measure() == StrainMeasure::green_lagrange)
          {
            const BodyDiscretization &space = body.discretization();
            const BodyMesh &mesh            = space.mesh();
            work += integration_work * n_stages *
                    mesh.triangulation().n_active_cells() *
                    space.scalar_element().n_dofs_per_cell() *
                    mesh.cell_quadrature(mesh.is_simplex() ? 2 : 4).size();
          }
      return work;
    }



    void
    print(const std::string &name,
          const std::string &value,
          std::ostream &stream)
    {
      stream << "  " << std::left << std::setw(20) << name << value << "\n";
    }



    std::string
    integer(const double n)
    {
      return std::to_string(static_cast<unsigned long>(n));
    }



    std::string
    bytes(const std::size_t n)
    {
      return format_bytes(n) + " (" + std::to_string(n) + " B)";
    }



    void
    print_sizes(const Model &model,
                const MultibodySystem &system,
                const Factors &factors,
                const Total &total,
                std::ostream &stream)
    {
      print("unknowns",
            integer(number_of_unknowns(system)) + " (bodies: " +
              std::to_string(system.bodies().size()) + ", different ones: " +
              std::to_string(system.n_reference_bodies()) + ")",
            stream);
      print("constraints", std::to_string(system.n_constraints()), stream);
      print("factorisations",
            std::to_string(total.n_complex) + " complex, " +
              std::to_string(total.n_real) + " real" +
              (factors.of_start.empty()
                 ? ""
                 : ", " + std::to_string(factors.of_start.size()) +
                     " of these for the start") +
              (model.time.tolerance > 0
                 ? "; those of the steps again for each step size"
                 : ""),
            stream);
      print("factor entries", std::to_string(total.n_entries), stream);
      print("factor memory",
            bytes(total.n_bytes) + ", " +
              (factors.single ? "single" : "double") + " precision" +
              (model.time.factor_precision == FactorPrecision::automatic
                 ? "; twice that where it is not accurate enough"
                 : ""),
            stream);
      print("joint columns", bytes(total.column_bytes), stream);
      const double vectors =
        n_vectors * sizeof(double) * number_of_unknowns(system);
      const double fronts = front_copies * total.work_bytes;
      const double memory = 1. * peak_memory() + total.n_bytes +
                            total.column_bytes + fronts + vectors;
      print("peak memory",
            "about " + format_bytes(memory) + ": now " +
              format_bytes(peak_memory()) + ", factors and columns " +
              format_bytes(total.n_bytes + total.column_bytes) +
              ", factorising " + format_bytes(fronts) + ", vectors " +
              format_bytes(vectors) + "; this machine has " +
              format_bytes(physical_memory()),
            stream);
    }
  } // namespace



  void
  estimate_run(const Model &model,
               const MultibodySystem &system,
               const double assembly_time,
               std::ostream &stream)
  {
    const TimeParameters &time = model.time;
    const Factors factors      = find_factors(model, system);
    Total total, of_steps;
    total.add(factors.of_start);
    total.add(factors.of_steps);
    of_steps.add(factors.of_steps);

    stream << "Estimate of the run, nothing is factorised:\n";
    print_sizes(model, system, factors, total, stream);

    const double n_threads = MultithreadInfo::n_threads();
    const double core_speed =
      streaming_bandwidth(static_cast<std::size_t>(n_threads * cached));
    const double factor_speed =
      std::min(core_speed, streaming_bandwidth(of_steps.n_bytes));
    const double operator_speed =
      std::min(core_speed,
               streaming_bandwidth(
                 static_cast<std::size_t>(operator_bytes(system))));
    const double product_speed = matrix_product_speed();
    const double solve_time    = 1 / factor_speed + solve_work / core_speed;
    const double factorisation = total.n_operations / product_speed +
                                 entry_work * total.n_entries / core_speed +
                                 total.setup_bytes * solve_time;
    const double step =
      n_iterations * (of_steps.iteration_bytes * solve_time +
                      operator_bytes(system) / operator_speed +
                      iteration_work(system, time.n_stages) / core_speed);
    print("assembly", format_duration(assembly_time) + " (measured)", stream);
    print("factorisations", "about " + format_duration(factorisation), stream);
    if (time.end_time > 0)
      {
        print("a step",
              "about " + format_duration(step) + ", with " +
                format_number(n_iterations) + " iterations",
              stream);
        const bool is_fixed = time.tolerance == 0;
        const double n_steps =
          std::max(1.,
                   std::ceil(time.end_time / (is_fixed ? time.step_size
                                                       : time.largest_step()) -
                             1e-9));
        print("steps",
              (is_fixed ? "" : "at least ") + integer(n_steps) + " of " +
                (is_fixed ? "" : "at most ") +
                format_duration(is_fixed ? time.step_size
                                         : time.largest_step()),
              stream);
        print("the run",
              (is_fixed ? "about " : "at least ") +
                format_duration(assembly_time + factorisation +
                                n_steps * step) +
                ", without output",
              stream);
      }
    if (model.start.equilibrium || model.modes.number > 0)
      print("not included",
            (model.start.equilibrium ? "the equilibrium" : "") +
              std::string(
                model.start.equilibrium && model.modes.number > 0 ? ", " : "") +
              (model.modes.number > 0 ? "modes" : ""),
            stream);
    stream << "Based on reading factors with " << format_bytes(factor_speed)
           << "/s, matrices with " << format_bytes(operator_speed)
           << "/s and caches with " << format_bytes(core_speed)
           << "/s, and products of matrices with " << std::setprecision(3)
           << 1e-9 * product_speed << " Gflop/s, measured now with "
           << counted(MultithreadInfo::n_threads(), "thread")
           << ". Runs of known models took " << least_ratio << " to "
           << largest_ratio << " times as long.\n"
           << std::flush;
  }
} // namespace ACF
