// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/run_report.h>
#include <acf/time/validity_monitor.h>
#include <acf/version.h>

#include <deal.II/base/multithread_info.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace ACF
{
  namespace
  {
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
  } // namespace



  void
  describe_bodies(const MultibodySystem &system, std::ostream &stream)
  {
    std::string whole;
    std::set<std::string> known_notes;
    for (const Body &body : system.bodies())
      {
        if (body.whole() != whole && !body.whole().empty())
          describe_whole(system, body.whole(), stream);
        whole                          = body.whole();
        const BodyOperators &operators = body.operators();
        const auto &mesh               = body.discretization().mesh();
        const Matrix3 &inertia         = operators.inertia;
        stream
          << "Body '" << body.name()
          << "': " << mesh.triangulation().n_active_cells() << " quadratic "
          << (mesh.is_simplex() ? "tetrahedra" : "hexahedra")
          << (mesh.is_curved() ? " with curved edges, " : ", ")
          << operators.n_unknowns() << " unknowns\n"
          << "  volume " << format_number(operators.volume) << " m^3, mass "
          << format_number(operators.mass) << " kg, centre of mass in the mesh "
          << format_vector(operators.centre, operators.length) << " m\n"
          << "  inertia about it xx, yy, zz "
          << format_vector(Vector3(
                             {inertia[0][0], inertia[1][1], inertia[2][2]}),
                           inertia.norm())
          << ", yz, zx, xy "
          << format_vector(Vector3(
                             {inertia[1][2], inertia[2][0], inertia[0][1]}),
                           inertia.norm())
          << " kg m^2\n";
        // bodies of the same file have them in common
        for (const std::string &note : mesh.notes())
          if (known_notes.insert(note).second)
            stream << "  note: " << note << "\n";
      }
    if (system.n_constraints() > 0)
      stream << counted(system.joints().size(), "joint") << " with "
             << counted(system.n_constraints(), "constraint") << "\n";
    stream << std::flush;
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
    json["constraint factorisations"] = statistics.constraint_factorizations;
    json["marker factorisations"]     = statistics.marker_factorizations;
    json["constraint corrections"]    = statistics.constraint_corrections;
    json["stress evaluations"]        = statistics.stress_evaluations;
    json["validity checks"]           = statistics.validity_checks;
    json["vtu files"]                 = statistics.vtu_files;
    json["hdf5 files"]                = statistics.hdf5_files;
    json["probe rows"]                = statistics.probe_rows;
    json["checkpoints"]               = statistics.checkpoints;
    json["restarts"]                  = statistics.restarts;
    json["constraints"]               = system.n_constraints();
    json["repeated constraints"]      = system.n_repeated_constraints();
    json["constraint residual"]       = {
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
} // namespace ACF
