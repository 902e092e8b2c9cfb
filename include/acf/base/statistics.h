// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_base_statistics_h
#define acf_base_statistics_h

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace ACF
{
  class Archive;

  /** Counters and times of a run; what a scene does not use stays zero. */
  struct Statistics
  {
    /** Accepted steps. */
    unsigned long steps = 0;

    /** Trial steps that were not accepted; those of them whose iteration had
     * converged but whose estimated error was too large. */
    unsigned long rejected_steps    = 0;
    unsigned long rejected_by_error = 0;

    /** Sizes of accepted steps, s, and how often they changed. */
    double min_step_size            = 0;
    double max_step_size            = 0;
    unsigned long step_size_changes = 0;

    /** Sum of the estimated errors of accepted steps, relative to the length of
     * the largest body; only with a Tolerance. */
    double estimated_error = 0;

    /** Halvings of the step size. */
    unsigned long halvings = 0;

    unsigned long newton_iterations = 0;

    /** Bodies times steps that needed the change of low rank of the reduced
     * strain's tangent, and those that needed Newton's method with the exact
     * tangent, the iterations of its linear systems, and factorisations that
     * were replaced by those of a present tangent. */
    unsigned long corrected_tangent_steps = 0;
    unsigned long exact_tangent_steps     = 0;
    unsigned long krylov_iterations       = 0;
    unsigned long factor_refreshes        = 0;

    /** Linear systems solved for the static equilibrium at the start. */
    unsigned long equilibrium_iterations = 0;

    /** Largest number of iterations of an accepted step. */
    unsigned int max_newton_iterations = 0;

    /** Factorisations of real and of complex shifted matrices. */
    unsigned long real_factorizations    = 0;
    unsigned long complex_factorizations = 0;

    /** Those that are kept in single precision. */
    unsigned long single_factorizations = 0;

    /** Factorisations that were dropped to save memory. */
    unsigned long evicted_factors = 0;

    /** Right-hand sides solved in the time loop. */
    unsigned long real_solves    = 0;
    unsigned long complex_solves = 0;

    /** Right-hand sides solved for joints and checks, once per factor. */
    unsigned long setup_solves = 0;

    /** Evaluations of a body's elastic force. */
    unsigned long force_evaluations = 0;

    /** Factorised systems of the joints' multipliers. */
    unsigned long constraint_factorizations = 0;

    /** Factorised systems of multipliers and markers of joints and force
     * elements. */
    unsigned long marker_factorizations = 0;

    /** Corrections of constraints up to round-off, without solves of bodies. */
    unsigned long constraint_corrections = 0;

    /** Largest residual of the constraints at ends of steps: of positions, m or
     * rad, and of velocities, m/s or rad/s. */
    double constraint_residual          = 0;
    double constraint_velocity_residual = 0;

    /** Evaluations of von Mises stresses (bodies times output times). */
    unsigned long stress_evaluations = 0;

    /** Checks of the strain's assumption (bodies times checked states). */
    unsigned long validity_checks = 0;

    /** Files and rows written. */
    unsigned long vtu_files   = 0;
    unsigned long hdf5_files  = 0;
    unsigned long probe_rows  = 0;
    unsigned long checkpoints = 0;

    /** How often the run went on from a checkpoint. */
    unsigned long restarts = 0;

    /** Entries and bytes of all cached factors. */
    std::size_t factor_entries = 0;
    std::size_t factor_bytes   = 0;

    /** Bytes of the columns that joints need per factor. */
    std::size_t joint_column_bytes = 0;

    /** Largest backward error of a test solve after a factorisation. */
    double factor_backward_error = 0;

    /** Largest contraction of corrections in single precision that was
     * measured after a factorisation. */
    double factor_contraction = 0;

    /** Wall time per phase, s. */
    std::map<std::string, double> wall_times;

    /**
     * Saves, or loads in addition to what has been counted since the start of
     * the program. What is held in memory is not kept.
     */
    void
    exchange(Archive &archive);
  };



  /** Adds the time from construction to destruction to a phase. */
  class PhaseTimer
  {
  public:
    PhaseTimer(Statistics &statistics, const char *phase)
      : total(statistics.wall_times[phase])
      , start(std::chrono::steady_clock::now())
    {}

    ~PhaseTimer()
    {
      total +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
    }

    PhaseTimer(const PhaseTimer &) = delete;
    PhaseTimer &
    operator=(const PhaseTimer &) = delete;

  private:
    double &total;
    const std::chrono::steady_clock::time_point start;
  };

  /** Largest resident memory of the process so far, bytes. */
  std::size_t
  peak_memory();
} // namespace ACF

#endif
