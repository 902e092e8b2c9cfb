// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/statistics.h>

#include <algorithm>

#include <sys/resource.h>

namespace ACF
{
  std::size_t
  peak_memory()
  {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024 * static_cast<std::size_t>(usage.ru_maxrss);
  }



  void
  Statistics::exchange(Archive &archive)
  {
    const auto sum = [&](const std::string &name, auto &value) {
      auto kept = value;
      archive(name, kept);
      if (archive.is_loading())
        value += kept;
    };
    const auto largest = [&](const std::string &name, auto &value) {
      auto kept = value;
      archive(name, kept);
      value = std::max(value, kept);
    };

    // a step size of its own has only a run that has made steps
    archive("smallest step size", min_step_size);
    largest("largest step size", max_step_size);
    sum("steps", steps);
    sum("rejected steps", rejected_steps);
    sum("rejected by error", rejected_by_error);
    sum("step size changes", step_size_changes);
    sum("estimated error", estimated_error);
    sum("halvings", halvings);
    sum("newton iterations", newton_iterations);
    sum("corrected tangent steps", corrected_tangent_steps);
    sum("exact tangent steps", exact_tangent_steps);
    sum("krylov iterations", krylov_iterations);
    sum("factor refreshes", factor_refreshes);
    sum("equilibrium iterations", equilibrium_iterations);
    largest("newton iterations max", max_newton_iterations);
    sum("real factorisations", real_factorizations);
    sum("complex factorisations", complex_factorizations);
    sum("single factorisations", single_factorizations);
    sum("evicted factors", evicted_factors);
    sum("real solves", real_solves);
    sum("complex solves", complex_solves);
    sum("setup solves", setup_solves);
    sum("force evaluations", force_evaluations);
    sum("constraint factorisations", constraint_factorizations);
    sum("marker factorisations", marker_factorizations);
    sum("constraint corrections", constraint_corrections);
    largest("constraint residual", constraint_residual);
    largest("constraint velocity residual", constraint_velocity_residual);
    sum("stress evaluations", stress_evaluations);
    sum("validity checks", validity_checks);
    sum("vtu files", vtu_files);
    sum("hdf5 files", hdf5_files);
    sum("probe rows", probe_rows);
    sum("checkpoints", checkpoints);
    sum("restarts", restarts);
    largest("factor backward error", factor_backward_error);
    largest("factor contraction", factor_contraction);

    std::vector<std::string> phases;
    for (const auto &phase : wall_times)
      phases.push_back(phase.first);
    archive("phases", phases);
    for (unsigned int k = 0; k < phases.size(); ++k)
      sum("wall time " + std::to_string(k), wall_times[phases[k]]);
  }
} // namespace ACF
