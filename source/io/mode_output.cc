// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/files.h>
#include <acf/io/mode_output.h>
#include <acf/io/vtu_writer.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace ACF
{
  namespace
  {
    void
    write_table(const NaturalModes &modes, const std::filesystem::path &file)
    {
      std::ostringstream stream;
      stream.precision(std::numeric_limits<double>::max_digits10);
      stream << "number,eigenvalue [rad^2/s^2],angular frequency [rad/s],"
                "frequency [Hz]\n";
      for (unsigned int k = 0; k < modes.modes.size(); ++k)
        stream << k + 1 << ',' << modes.modes[k].eigenvalue << ','
               << modes.modes[k].angular_frequency() << ','
               << modes.modes[k].frequency() << '\n';
      write_file(file, stream.str());
    }



    double
    largest_displacement(const SystemVector &shape)
    {
      double largest = 0;
      for (const NodalVector &x : shape)
        for (unsigned int a = 0; a < x.size() / dim; ++a)
          largest =
            std::max(largest,
                     std::hypot(x[dim * a], x[dim * a + 1], x[dim * a + 2]));
      return largest;
    }
  } // namespace



  void
  write_modes(const MultibodySystem &system,
              const SystemState &state,
              const NaturalModes &modes,
              const std::filesystem::path &directory,
              Statistics &statistics)
  {
    write_table(modes, directory / "modes.csv");
    double length = 0;
    for (const Body &body : system.bodies())
      length = std::max(length, body.operators().length);

    VtuWriter writer(system, state.positions, directory, "modes.pvd");
    for (unsigned int k = 0; k < modes.modes.size(); ++k)
      {
        const SystemVector &shape = modes.modes[k].shape;
        const double scale        = 0.1 * length / largest_displacement(shape);
        std::vector<OutputField> fields = {{{"displacement", dim, true}},
                                           {{"mode_shape", dim, false}}};
        for (const NodalVector &values : shape)
          {
            fields[1].values.emplace_back(values.begin(), values.end());
            fields[0].values.push_back(fields[1].values.back());
            for (double &value : fields[0].values.back())
              value *= scale;
          }
        writer.write("mode-" + Utilities::int_to_string(k + 1, 4),
                     fields,
                     k + 1);
        ++statistics.vtu_files;
      }
  }



  void
  describe_modes(const SystemState &state,
                 const NaturalModes &modes,
                 std::ostream &stream)
  {
    stream << "Natural modes at time " << format_number(state.time)
           << " s, without damping\n";
    if (std::any_of(state.velocities.begin(),
                    state.velocities.end(),
                    [](const NodalVector &v) { return v.linfty_norm() > 0; }))
      stream << "  the bodies move: gyroscopic and centrifugal terms are "
                "neglected\n";
    for (unsigned int k = 0; k < modes.modes.size(); ++k)
      {
        const Mode &mode = modes.modes[k];
        stream << "  mode " << k + 1 << ": ";
        if (std::abs(mode.eigenvalue) <= modes.round_off)
          stream << "0 Hz (no stiffness)\n";
        else if (mode.eigenvalue < 0)
          stream << "unstable, grows with "
                 << format_number(-mode.angular_frequency()) << " 1/s\n";
        else
          stream << format_number(mode.frequency()) << " Hz\n";
      }
    stream << std::flush;
  }
} // namespace ACF
