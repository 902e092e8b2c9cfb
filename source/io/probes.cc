// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/input_problems.h>
#include <acf/io/probe_types.h>

#include <deal.II/base/parameter_handler.h>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace ACF
{
  std::vector<double>
  components(const Vector3 &v)
  {
    return {v[0], v[1], v[2]};
  }



  std::vector<std::string>
  vector_columns(const std::string &unit, const std::string &prefix)
  {
    std::vector<std::string> names;
    for (const char axis : {'x', 'y', 'z'})
      names.push_back(prefix + axis + " [" + unit + "]");
    return names;
  }



  namespace
  {
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



    // Some components of a vector.
    class SelectedProbe : public Probe
    {
    public:
      SelectedProbe(std::unique_ptr<Probe> probe,
                    const std::vector<std::string> &selected)
        : probe(std::move(probe))
      {
        const auto names = this->probe->columns();
        for (unsigned int k = 0; k < names.size(); ++k)
          {
            const std::string name = names[k].substr(0, names[k].find(" ["));
            // "x" or, of a force or a moment, "force x"; of a stress "xx"
            const std::string component = name.substr(name.rfind(' ') + 1);
            if (std::find(selected.begin(), selected.end(), component) !=
                selected.end())
              indices.push_back(k);
          }
      }

      std::vector<std::string>
      columns() const override
      {
        return select(probe->columns());
      }

      std::vector<double>
      evaluate(const SystemState &state) override
      {
        return select(probe->evaluate(state));
      }

      unsigned int
      n_stress_evaluations() const override
      {
        return probe->n_stress_evaluations();
      }

      void
      exchange(Archive &archive) override
      {
        probe->exchange(archive);
      }

    private:
      template <typename T>
      std::vector<T>
      select(const std::vector<T> &all) const
      {
        std::vector<T> some;
        for (const unsigned int k : indices)
          some.push_back(all[k]);
        return some;
      }

      std::unique_ptr<Probe> probe;
      std::vector<unsigned int> indices;
    };



    std::unique_ptr<Probe>
    make_whole_probe(const ProbeParameters &parameters,
                     const MultibodySystem &system)
    {
      const std::string &type = parameters.type;
      if (type == "reaction" || type.rfind("joint", 0) == 0)
        return make_joint_probe(parameters, system);
      if (type == "energy" || type == "momentum" || type == "angular momentum")
        return std::make_unique<SystemProbe>(system, type);
      return make_body_probe(parameters, system);
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
      "point from it; 'chord frame', the change of length of that line and the "
      "displacement of the point along it, across it (along Axis x line) and "
      "normal to both; 'energy' (kinetic, elastic, potential), 'momentum' or "
      "'angular momentum' (about the origin) of all bodies; 'reaction', the "
      "force and the moment of a joint on its first side that is a body; "
      "'joint angle', the angle of the first side relative to the second about "
      "the joint's z axis and its rate; 'joint displacement' and 'joint "
      "rotation' (small angles), relative motion of the first side in the "
      "joint's axes, which turn with the second side; 'stress' at a material "
      "point; 'largest stress', the largest von Mises stress at the nodes of a "
      "body. Units: none.",
      Patterns::Selection("mean position|mean velocity|point position|point "
                          "velocity|chord|chord frame|energy|momentum|angular "
                          "momentum|reaction|joint angle|joint "
                          "displacement|joint rotation|stress|largest "
                          "stress"));
    prm.add_parameter("Of",
                      of,
                      "What the probe belongs to: 'BODY: SURFACE' for a mean, "
                      "'BODY' for a point or a stress, the name of a joint for "
                      "a reaction or a joint's motion. "
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
    prm.add_parameter(
      "Components",
      selected,
      "Which components of a vector are written: some of x, y, "
      "z separated by ','; of a stress some of xx, yy, zz, xy, "
      "yz, xz; all if nothing is given. Units: none.",
      Patterns::List(Patterns::Selection("x|y|z|xx|yy|zz|xy|yz|xz"), 0, 6));
    prm.add_parameter("Axes",
                      axes,
                      "Axes of a reaction: those of the world, or of the joint "
                      "(turning with its second side). Axes of a stress: those "
                      "of the world, or of the mesh, which turn with the body. "
                      "Units: none.",
                      Patterns::Selection("world|joint|body"));
  }



  void
  ProbeParameters::check() const
  {
    const bool is_chord  = (type.rfind("chord", 0) == 0);
    const bool is_point  = (type.rfind("point", 0) == 0);
    const bool is_joint  = (type == "reaction" || type.rfind("joint", 0) == 0);
    const bool is_stress = (type == "stress");
    const bool has_subject = is_point || type.rfind("mean", 0) == 0 ||
                             is_joint || is_stress || type == "largest stress";

    InputProblems problems;
    const auto check_entry = [&](const std::string &entry,
                                 const bool given,
                                 const bool required,
                                 const bool possible) {
      if (required && !given)
        problems.add(
          InputError(section(),
                     entry,
                     "nothing",
                     "a value, as the type '" + type + "' needs it"));
      if (!possible && given)
        problems.add(
          InputError(section(),
                     entry,
                     "a value",
                     "nothing, as the type '" + type + "' does not use it"));
    };
    check_entry("Of", !of.empty(), has_subject, has_subject);
    check_entry("From", !from.empty(), is_chord, is_chord);
    check_entry("To", !to.empty(), is_chord, is_chord);
    check_entry("Point",
                !point.empty(),
                is_point || is_stress || type == "chord frame",
                is_point || is_stress || is_chord);
    check_entry("Components",
                !selected.empty(),
                false,
                !is_chord && type != "energy" && type != "joint angle" &&
                  type != "largest stress");
    for (const std::string &component : selected)
      if ((component.size() == 2) != is_stress)
        problems.add(InputError(section(),
                                "Components",
                                "'" + component + "'",
                                std::string(is_stress ? "xx, yy, zz, xy, yz, xz"
                                                      : "x, y, z") +
                                  " for the type '" + type + "'"));
    const bool can_turn = (type == "reaction" || is_stress);
    check_entry("Axes", axes != "world", false, can_turn);
    if (can_turn && axes == (is_stress ? "joint" : "body"))
      problems.add(InputError(section(),
                              "Axes",
                              "'" + axes + "'",
                              std::string("world, ") +
                                (is_stress ? "body" : "joint") +
                                " for the type '" + type + "'"));
    if (!point.empty() && point.size() != dim)
      problems.add(InputError(section(),
                              "Point",
                              std::to_string(point.size()) + " numbers",
                              "three numbers"));
    problems.throw_all();
  }



  std::unique_ptr<Probe>
  make_probe(const ProbeParameters &parameters, const MultibodySystem &system)
  {
    auto probe = make_whole_probe(parameters, system);
    if (parameters.selected.empty())
      return probe;
    return std::make_unique<SelectedProbe>(std::move(probe),
                                           parameters.selected);
  }



  namespace
  {
    unsigned long
    sum_of(const unsigned long start, const std::string &text)
    {
      return crc32_z(start,
                     reinterpret_cast<const Bytef *>(text.data()),
                     text.size());
    }



    struct KeptProbe
    {
      Probe &probe;

      void
      exchange(Archive &archive)
      {
        probe.exchange(archive);
      }
    };
  } // namespace



  ProbeOutput::ProbeOutput(const MultibodySystem &system,
                           const std::vector<ProbeParameters> &parameters,
                           const double interval,
                           const std::filesystem::path &directory,
                           Statistics &statistics)
    : Observer(interval)
    , file(directory / "probes.csv")
    , statistics(statistics)
  {
    header = "time [s]";
    for (const ProbeParameters &probe : parameters)
      {
        probes.push_back(make_probe(probe, system));
        for (const std::string &column : probes.back()->columns())
          header += "," + probe.name + "." + column;
      }
    header += "\n";
  }



  void
  ProbeOutput::append(const std::string &text)
  {
    log->append(text);
    sum = sum_of(sum, text);
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
      {
        for (const double value : probe->evaluate(state))
          {
            line += ",";
            append(value);
          }
        statistics.stress_evaluations += probe->n_stress_evaluations();
      }
    if (!log)
      {
        log = std::make_unique<LogFile>(file, 0);
        this->append(header);
      }
    this->append(line + "\n");
    ++statistics.probe_rows;
  }



  void
  ProbeOutput::exchange(Archive &archive)
  {
    Observer::exchange(archive);
    for (unsigned int k = 0; k < probes.size(); ++k)
      {
        KeptProbe kept{*probes[k]};
        archive("probe " + std::to_string(k), kept);
      }
    std::uintmax_t n_bytes = log ? log->size() : 0;
    if (log && !archive.is_loading())
      log->synchronize();
    archive("bytes", n_bytes);
    archive("sum", sum);
    if (!archive.is_loading())
      return;
    if (n_bytes == 0 || !std::filesystem::exists(file))
      {
        sum = 0;
        return;
      }
    const std::string content = read_file(file).substr(0, n_bytes);
    if (content.size() < n_bytes || sum_of(0, content) != sum)
      throw InputError(
        file.string() + ": found " +
        (content.size() < n_bytes
           ? "only " + std::to_string(content.size()) + " bytes"
           : std::string("other values")) +
        "; allowed: what was there when the checkpoint was written (" +
        std::to_string(n_bytes) + " bytes), or another output directory");
    log = std::make_unique<LogFile>(file, n_bytes);
  }
} // namespace ACF
