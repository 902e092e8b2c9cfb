// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_performance_vibration_h
#define acf_tests_performance_vibration_h

#include "stress.h"

namespace Stress
{
  /**
   * A vibration in a mode of frequency omega, released from a deflection at
   * rest: after n steps \f$\mathrm{Re}\, R(i \omega \tau)^n\f$ with the
   * stability function R of Radau IIA and, for the velocity divided by
   * \f$-\omega\f$, its imaginary part. The first probe is the position, the
   * second the velocity, of which one component is meant.
   *
   * @param rest position without vibration, m
   * @param amplitude m
   * @param omega rad/s
   * @param tolerance bound of the error, relative to the largest change
   * @param growth bound of the growth of the energy, relative to the energy
   */
  void
  check_mode(Row &row,
             const std::string &model_file,
             const double rest,
             const double amplitude,
             const double omega,
             const double tolerance,
             const unsigned int stages = 2,
             const double growth       = 1e-9);
} // namespace Stress

#endif
