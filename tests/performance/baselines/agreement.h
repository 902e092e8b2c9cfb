// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_baselines_agreement_h
#define acf_tests_baselines_agreement_h

namespace Baselines
{
  /**
   * Swings a coarse pendulum for a short time with the program and with each
   * baseline (CalculiX only if it is installed) and prints how far their tips
   * are apart, as comma-separated values.
   * @return whether all agree within what their step sizes and the lumped
   * masses explain
   */
  bool
  check_agreement();
} // namespace Baselines

#endif
