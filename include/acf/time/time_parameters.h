// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_time_parameters_h
#define acf_time_time_parameters_h

#include <acf/solvers/shifted_factorization.h>

namespace dealii
{
  class ParameterHandler;
}

namespace ACF
{
  /** What a model file says of the time integration. */
  struct TimeParameters
  {
    unsigned int n_stages = 2;

    /** s */
    double end_time  = 0;
    double step_size = 0;

    /** Bound on the error of the positions at the end, relative to the length
     * of the largest body; 0: steps of a fixed size. */
    double tolerance = 0;

    /** With a tolerance; 0: a tenth of the end time. s */
    double max_step_size = 0;

    /** Of the factorisations of different step sizes, MB. */
    double factor_memory = 4000;

    /** Bound on the predicted error of the iteration, relative to the bodies;
     * 0: a part of the estimated error of the step. */
    double newton_tolerance = 0;

    unsigned int max_newton_iterations = 20;
    unsigned int max_krylov_iterations = 40;
    unsigned int max_halvings          = 8;

    FactorPrecision factor_precision = FactorPrecision::automatic;

    /** Real one-step matrices as in the paper instead of the exact ones. */
    bool one_step_matrices = false;

    /** Whether the iteration starts at increments that are extrapolated from
     * steps before, or at zero. */
    bool extrapolates = true;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError for values that the patterns cannot exclude */
    void
    check() const;

    /** The largest step, s. */
    double
    largest_step() const;

    /** The given one, or one that suits the tolerance, s. */
    double
    first_step() const;
  };
} // namespace ACF

#endif
