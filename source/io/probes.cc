// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/io/probes.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/parameter_handler.h>

#include <array>
#include <charconv>
#include <cmath>

namespace ACF
{
  namespace
  {
    std::vector<double>
    components(const Vector3 &v)
    {
      return {v[0], v[1], v[2]};
    }



    std::vector<std::string>
    vector_columns(const std::string &unit, const std::string &prefix = "")
    {
      std::vector<std::string> names;
      for (const char axis : {'x', 'y', 'z'})
        names.push_back(prefix + axis + " [" + unit + "]");
      return names;
    }



    // Mean of a surface, or a material point: its position or its velocity.
    class FunctionalProbe : public Probe
    {
    public:
      FunctionalProbe(const unsigned int body,
                      const NodalFunctional &functional,
                      const bool velocity)
        : body(body)
        , functional(functional)
        , velocity(velocity)
      {}

      std::vector<std::string>
      columns() const override
      {
        return vector_columns(velocity ? "m/s" : "m");
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        return components(functional(velocity ? state.velocities[body]
                                              : state.positions[body]));
      }

    private:
      const unsigned int body;
      const NodalFunctional functional;
      const bool velocity;
    };



    // Angle of the line between two surfaces and distance of a material point
    // from it, in the plane perpendicular to a world axis.
    class ChordProbe : public Probe
    {
    public:
      struct End
      {
        unsigned int body;
        NodalFunctional functional;
      };

      ChordProbe(const End &from,
                 const End &to,
                 const std::optional<End> &point,
                 const unsigned int axis)
        : from(from)
        , to(to)
        , point(point)
        , first((axis + 1) % dim)
        , second((axis + 2) % dim)
      {}

      std::vector<std::string>
      columns() const override
      {
        if (point)
          return {"angle [rad]", "deflection [m]"};
        return {"angle [rad]"};
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        const Vector3 start  = from.functional(state.positions[from.body]);
        const Vector3 chord  = to.functional(state.positions[to.body]) - start;
        const double wrapped = std::atan2(chord[second], chord[first]);
        if (n_evaluations++ == 0)
          angle = wrapped;
        else // the branch nearest to the angle before
          angle += std::remainder(wrapped - angle, 2 * numbers::PI);

        if (!point)
          return {angle};
        const Vector3 arm =
          point->functional(state.positions[point->body]) - start;
        return {angle,
                std::cos(wrapped) * arm[second] -
                  std::sin(wrapped) * arm[first]};
      }

    private:
      const End from;
      const End to;
      const std::optional<End> point;
      const unsigned int first;
      const unsigned int second;
      unsigned long n_evaluations = 0;
      double angle                = 0;
    };



    // Energies or momenta of the whole system.
    class SystemProbe : public Probe
    {
    public:
      SystemProbe(const MultibodySystem &system, const std::string &type)
        : system(system)
        , type(type)
      {}

      std::vector<std::string>
      columns() const override
      {
        if (type == "energy")
          return {"kinetic [J]", "elastic [J]", "potential [J]"};
        return vector_columns(type == "momentum" ? "kg m/s" : "kg m^2/s");
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        if (type == "energy")
          {
            const SystemEnergy energy = system.energy(state);
            return {energy.kinetic, energy.elastic, energy.potential};
          }
        return components(type == "momentum" ? system.momentum(state)
                                             : system.angular_momentum(state));
      }

    private:
      const MultibodySystem &system;
      const std::string type;
    };



    class ReactionProbe : public Probe
    {
    public:
      ReactionProbe(const MultibodySystem &system, const unsigned int joint)
        : system(system)
        , joint(joint)
      {}

      std::vector<std::string>
      columns() const override
      {
        auto names        = vector_columns("N", "force ");
        const auto moment = vector_columns("N m", "moment ");
        names.insert(names.end(), moment.begin(), moment.end());
        return names;
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        const auto reaction = system.reaction(joint, state);
        auto values         = components(reaction.force);
        const auto moment   = components(reaction.moment);
        values.insert(values.end(), moment.begin(), moment.end());
        return values;
      }

    private:
      const MultibodySystem &system;
      const unsigned int joint;
    };



    ChordProbe::End
    surface_end(const MultibodySystem &system,
                const ProbeParameters &parameters,
                const std::string &text,
                const std::string &entry)
    {
      const SurfaceName name =
        parse_surface_name(text, parameters.section(), entry);
      const unsigned int b =
        find_body(system.bodies(), name.body, parameters.section(), entry);
      const BodyDiscretization &body = system.bodies()[b].discretization();
      return {b,
              surface_mean(body,
                           body.mesh().surface(name.surface,
                                               parameters.section(),
                                               entry))};
    }



    NodalFunctional
    point_functional(const Body &body, const ProbeParameters &parameters)
    {
      try
        {
          return material_point(body.discretization(),
                                Point<dim>(parameters.point[0],
                                           parameters.point[1],
                                           parameters.point[2]));
        }
      catch (const SimulationError &error)
        {
          throw InputError(parameters.section(),
                           "Point",
                           error.what(),
                           "a point of the body '" + body.name() +
                             "' in the coordinates of its mesh");
        }
    }



    unsigned int
    find_joint(const MultibodySystem &system, const ProbeParameters &parameters)
    {
      std::string names;
      for (unsigned int j = 0; j < system.joints().size(); ++j)
        {
          if (system.joints()[j].name == parameters.of)
            return j;
          names += (j > 0 ? ", " : "") + system.joints()[j].name;
        }
      throw InputError(parameters.section(),
                       "Of",
                       "the joint '" + parameters.of +
                         "', which does not exist",
                       names.empty() ? "nothing, as there are no joints"
                                     : names);
    }
  } // namespace



  void
  ProbeParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Type",
      type,
      "What is measured: 'mean position' or 'mean velocity' of a surface; "
      "'point position' or 'point velocity' of a material point; 'chord', the "
      "angle of the line between two surfaces and the distance of a material "
      "point from it; 'energy' (kinetic, elastic, potential), 'momentum' or "
      "'angular momentum' (about the origin) of all bodies; 'reaction', the "
      "force and the moment of a joint on its body. Units: none.",
      Patterns::Selection("mean position|mean velocity|point position|point "
                          "velocity|chord|energy|momentum|angular "
                          "momentum|reaction"));
    prm.add_parameter("Of",
                      of,
                      "What the probe belongs to: 'BODY: SURFACE' for a mean, "
                      "'BODY' for a point, the name of a joint for a reaction. "
                      "Units: none.");
    prm.add_parameter("From",
                      from,
                      "Where a chord starts, 'BODY: SURFACE'. Units: none.");
    prm.add_parameter("To",
                      to,
                      "Where a chord ends, 'BODY: SURFACE'. Units: none.");
    prm.add_parameter("Point",
                      point,
                      "Material point in the coordinates of the mesh; for a "
                      "chord a point of the body where it starts, whose "
                      "deflection is measured. Units: m.",
                      Patterns::List(Patterns::Double(), 0, dim));
    prm.add_parameter("Axis",
                      axis,
                      "World axis perpendicular to the plane in which a chord "
                      "turns; about x the angle is atan2(dz, dy), about y "
                      "atan2(dx, dz), about z atan2(dy, dx), continued beyond "
                      "a half turn. Units: none.",
                      Patterns::Selection("x|y|z"));
  }



  void
  ProbeParameters::check() const
  {
    const bool is_chord = (type == "chord");
    const bool is_point = (type.rfind("point", 0) == 0);
    const bool has_subject =
      is_point || type.rfind("mean", 0) == 0 || type == "reaction";

    const auto check_entry = [&](const std::string &entry,
                                 const bool given,
                                 const bool required,
                                 const bool possible) {
      if (required && !given)
        throw InputError(section(),
                         entry,
                         "nothing",
                         "a value, as the type '" + type + "' needs it");
      if (!possible && given)
        throw InputError(section(),
                         entry,
                         "a value",
                         "nothing, as the type '" + type + "' does not use it");
    };
    check_entry("Of", !of.empty(), has_subject, has_subject);
    check_entry("From", !from.empty(), is_chord, is_chord);
    check_entry("To", !to.empty(), is_chord, is_chord);
    check_entry("Point", !point.empty(), is_point, is_point || is_chord);
    if (!point.empty() && point.size() != dim)
      throw InputError(section(),
                       "Point",
                       std::to_string(point.size()) + " numbers",
                       "three numbers");
  }



  std::unique_ptr<Probe>
  make_probe(const ProbeParameters &parameters, const MultibodySystem &system)
  {
    const std::string &type = parameters.type;
    const bool velocity     = type.find("velocity") != std::string::npos;

    if (type == "mean position" || type == "mean velocity")
      {
        const auto end = surface_end(system, parameters, parameters.of, "Of");
        return std::make_unique<FunctionalProbe>(end.body,
                                                 end.functional,
                                                 velocity);
      }
    if (type == "point position" || type == "point velocity")
      {
        const unsigned int b =
          find_body(system.bodies(), parameters.of, parameters.section(), "Of");
        return std::make_unique<FunctionalProbe>(
          b, point_functional(system.bodies()[b], parameters), velocity);
      }
    if (type == "chord")
      {
        const auto from =
          surface_end(system, parameters, parameters.from, "From");
        const auto to = surface_end(system, parameters, parameters.to, "To");
        std::optional<ChordProbe::End> point;
        if (!parameters.point.empty())
          point = ChordProbe::End{from.body,
                                  point_functional(system.bodies()[from.body],
                                                   parameters)};
        return std::make_unique<ChordProbe>(from,
                                            to,
                                            point,
                                            parameters.axis[0] - 'x');
      }
    if (type == "reaction")
      return std::make_unique<ReactionProbe>(system,
                                             find_joint(system, parameters));
    return std::make_unique<SystemProbe>(system, type);
  }



  ProbeOutput::ProbeOutput(const MultibodySystem &system,
                           const std::vector<ProbeParameters> &parameters,
                           const double interval,
                           const std::filesystem::path &directory,
                           Statistics &statistics)
    : Observer(interval)
    , file(directory / "probes.csv")
    , statistics(statistics)
  {
    std::string header = "time [s]";
    for (const ProbeParameters &probe : parameters)
      {
        probes.push_back(make_probe(probe, system));
        for (const std::string &column : probes.back()->columns())
          header += "," + probe.name + "." + column;
      }
    stream.open(file);
    write_line(header);
  }



  void
  ProbeOutput::write_line(const std::string &line)
  {
    stream << line + "\n" << std::flush;
    if (!stream)
      throw SimulationError("Cannot write the file " + file.string() + ".");
  }



  void
  ProbeOutput::observe(const SystemState &state)
  {
    std::string line;
    std::array<char, 40> buffer;
    const auto append = [&](const double value) {
      const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
      line.append(buffer.data(), end);
    };

    // multiples of an interval are not exact: twelve digits show what is meant
    const auto end = std::to_chars(buffer.data(),
                                   buffer.data() + buffer.size(),
                                   state.time,
                                   std::chars_format::general,
                                   12)
                       .ptr;
    line.append(buffer.data(), end);
    for (const auto &probe : probes)
      for (const double value : probe->evaluate(state))
        {
          line += ",";
          append(value);
        }
    write_line(line);
    ++statistics.probe_rows;
  }
} // namespace ACF
