// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_mode_output_h
#define acf_io_mode_output_h

#include <acf/time/modes.h>

#include <filesystem>
#include <iosfwd>

namespace ACF
{
  /**
   * Writes natural modes: `modes.csv` with a line
   * "number,eigenvalue [rad^2/s^2],angular frequency [rad/s],frequency [Hz]"
   * per mode, and for ParaView `mode-0001.vtu`, ... with the points of the
   * state and the fields `displacement` (m), the shape with a largest
   * displacement of a tenth of the length of the largest body, and
   * `mode_shape` (kg^(-1/2)), the shape normalised by the mass. `modes.pvd`
   * lists them with the numbers of the modes as times. Counts the files.
   *
   * @param directory where to write; exists
   * @throws SimulationError if a file cannot be written
   */
  void
  write_modes(const MultibodySystem &system,
              const SystemState &state,
              const NaturalModes &modes,
              const std::filesystem::path &directory,
              Statistics &statistics);

  /** Describes the modes in a few lines for people. */
  void
  describe_modes(const SystemState &state,
                 const NaturalModes &modes,
                 std::ostream &stream);
} // namespace ACF

#endif
