// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_probe_types_h
#define acf_io_probe_types_h

#include <acf/io/probes.h>

namespace ACF
{
  /** The three components. */
  std::vector<double>
  components(const Vector3 &v);

  /** "PREFIXx [UNIT]", ... */
  std::vector<std::string>
  vector_columns(const std::string &unit, const std::string &prefix = "");

  /** Probes of positions and velocities of surfaces and points, chords. */
  std::unique_ptr<Probe>
  make_body_probe(const ProbeParameters &parameters,
                  const MultibodySystem &system);

  /** Probes of reactions and relative motions of joints. */
  std::unique_ptr<Probe>
  make_joint_probe(const ProbeParameters &parameters,
                   const MultibodySystem &system);
} // namespace ACF

#endif
