// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/plausibility.h>

#include <cmath>

namespace ACF
{
  namespace
  {
    constexpr double max_files = 1e6;
    constexpr double max_rows  = 1e8;

    // s
    constexpr double longest_integral = 2e4;

    constexpr double least_density   = 1e-2;
    constexpr double largest_density = 1e5;

    // Velocities of waves, m/s.
    constexpr double slowest_wave  = 0.3;
    constexpr double fastest_wave  = 1e5;
    constexpr double slow_in_metal = 10;
    constexpr double metal_density = 2000;

    constexpr double largest_gravity = 300;
    constexpr double largest_length  = 100;



    // Why the units of a material are doubtful; empty if they are not.
    std::string
    doubt_of(const Material &material)
    {
      const double E = material.youngs_modulus, rho = material.density;
      const std::string values = " (Young's modulus " + format_number(E) +
                                 " Pa, density " + format_number(rho) +
                                 " kg/m^3; steel has 2.1e11 and 7850)";
      if (rho < least_density)
        return "is lighter than any solid" + values;
      if (rho > largest_density)
        return "is heavier than any solid" + values;
      const double wave = std::sqrt(E / rho);
      if (wave > fastest_wave)
        return "is too stiff for its density" + values;
      if (wave < slowest_wave)
        return "is too soft for its density" + values;
      if (wave < slow_in_metal && rho > metal_density)
        return "is as heavy as a metal but softer than rubber" + values;
      return "";
    }



    // Whether a text is a function of time other than a constant.
    bool
    varies(const std::string &expression)
    {
      try
        {
          return !TimeFunction(expression, "", "").is_constant();
        }
      catch (const InputError &) // which is reported elsewhere
        {
          return false;
        }
    }



    // Bodies of one material have a sentence in common.
    void
    add_materials(const std::vector<BodyParameters> &bodies,
                  std::vector<std::string> &warnings)
    {
      std::map<std::string, std::vector<std::string>> names;
      for (const BodyParameters &body : bodies)
        names[doubt_of(body.material)].push_back(body.name);
      for (const auto &[doubt, some] : names)
        if (!doubt.empty())
          warnings.push_back(
            "the body '" + some[0] + "'" +
            (some.size() > 1
               ? " (like " + std::to_string(some.size() - 1) + " more)"
               : "") +
            " " + doubt);
    }



    void
    add_interval(const std::string &entry,
                 const double interval,
                 const double end_time,
                 std::vector<std::string> &warnings)
    {
      if (end_time > 0 && interval > end_time)
        warnings.push_back("the " + entry + " of " + format_number(interval) +
                           " s is longer than the End time of " +
                           format_number(end_time) +
                           " s: only the start is written");
    }
  } // namespace



  void
  check_amounts(const Model &model)
  {
    InputProblems problems;
    const auto check = [&](const std::string &entry,
                           const double interval,
                           const double limit,
                           const std::string &what) {
      const double n = interval > 0 ? model.time.end_time / interval : 0;
      if (n > limit)
        problems.add(InputError("Output",
                                entry,
                                "'" + format_number(interval) +
                                  "', which makes " + format_number(n) + " " +
                                  what,
                                "0 or an interval that makes at most " +
                                  format_number(limit)));
    };
    check("VTU interval", model.output.fields.interval, max_files, "files");
    check("Probe interval", model.output.probe_interval, max_rows, "lines");
    for (const JointParameters &joint : model.system.joints)
      if (model.time.end_time > longest_integral &&
          varies(joint.angular_velocity))
        problems.add(InputError(joint.section(),
                                "Angular velocity",
                                "a function that would be integrated over " +
                                  format_number(model.time.end_time) + " s",
                                "an Angle in simulations longer than " +
                                  format_number(longest_integral) + " s"));
    problems.throw_all();
  }



  std::vector<std::string>
  plausibility_warnings(const Model &model)
  {
    std::vector<std::string> warnings;
    add_materials(model.system.bodies, warnings);
    const double gravity = model.system.loads.gravity.norm();
    if (gravity > largest_gravity)
      warnings.push_back("the gravity of " + format_number(gravity) +
                         " m/s^2 is more than that of the Sun (the Earth has "
                         "9.81)");
    const double end_time = model.time.end_time;
    if (!model.probes.empty())
      add_interval("Probe interval",
                   model.output.probe_interval,
                   end_time,
                   warnings);
    add_interval("VTU interval",
                 model.output.fields.interval,
                 end_time,
                 warnings);
    return warnings;
  }



  std::vector<std::string>
  size_warnings(const MultibodySystem &system)
  {
    std::vector<std::string> warnings;
    std::set<std::string> names;
    for (const Body &body : system.bodies())
      {
        const std::string &name =
          body.whole().empty() ? body.name() : body.whole();
        const double length = body.operators().length;
        if (length > largest_length && names.insert(name).second)
          warnings.push_back("the body '" + name + "' is " +
                             format_number(length) +
                             " m long, as if its mesh were in mm");
      }
    return warnings;
  }
} // namespace ACF
