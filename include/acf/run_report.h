// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_run_report_h
#define acf_run_report_h

#include <acf/base/statistics.h>
#include <acf/mechanics/multibody_system.h>

#include <iosfwd>

namespace ACF
{
  class ValidityMonitor;

  /** Prints what the bodies and joints are. */
  void
  describe_bodies(const MultibodySystem &system, std::ostream &stream);

  /** Prints what a run took. */
  void
  describe_run(const Statistics &statistics, std::ostream &stream);

  /**
   * The statistics of a run as JSON text.
   * @param validity of the bodies; null if nobody has watched it
   */
  std::string
  statistics_json(const Statistics &statistics,
                  const MultibodySystem &system,
                  const ValidityMonitor *const validity,
                  const bool finished);
} // namespace ACF

#endif
