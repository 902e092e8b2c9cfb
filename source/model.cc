// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_import.h>
#include <acf/model.h>
#include <acf/plausibility.h>
#include <acf/references.h>

#include <deal.II/base/utilities.h>

namespace ACF
{
  namespace
  {
    // Declares "Names" and one subsection per object in the current section.
    template <typename Parameters>
    void
    declare_objects(ParameterHandler &prm,
                    const std::string &documentation,
                    const std::vector<std::string> &names,
                    std::vector<Parameters> &objects)
    {
      std::string list;
      for (const std::string &name : names)
        list += (list.empty() ? "" : ", ") + name;
      prm.declare_entry("Names",
                        list,
                        Patterns::List(Patterns::Anything()),
                        documentation + " Units: none.");

      // the handler keeps references to the members
      objects.resize(names.size());
      for (unsigned int k = 0; k < names.size(); ++k)
        {
          objects[k].name = names[k];
          prm.enter_subsection(names[k]);
          objects[k].add_parameters(prm);
          prm.leave_subsection();
        }
    }



    template <typename Parameters>
    void
    declare_named(ParameterHandler &prm,
                  const std::string &section,
                  const std::string &documentation,
                  const std::vector<std::string> &names,
                  std::vector<Parameters> &objects)
    {
      prm.enter_subsection(section);
      declare_objects(prm, documentation, names, objects);
      prm.leave_subsection();
    }



    template <typename Parameters>
    void
    declare_section(ParameterHandler &prm,
                    const std::string &section,
                    Parameters &parameters)
    {
      prm.enter_subsection(section);
      parameters.add_parameters(prm);
      prm.leave_subsection();
    }



    // Names of the objects of the sections that have any.
    struct Names
    {
      std::vector<std::string> bodies, joints, force_elements, masses, loads,
        probes;
    };



    void
    declare_model(ParameterHandler &prm, Model &model, const Names &names)
    {
      prm.add_parameter("Title",
                        model.title,
                        "What the model is, for people. Units: none.");
      declare_named(prm,
                    "Bodies",
                    "Names of the bodies; each has a subsection.",
                    names.bodies,
                    model.system.bodies);
      declare_named(prm,
                    "Joints",
                    "Names of the joints; each has a subsection.",
                    names.joints,
                    model.system.joints);
      declare_named(prm,
                    "Force elements",
                    "Names of springs, dampers and bushings; each has a "
                    "subsection.",
                    names.force_elements,
                    model.system.force_elements);
      declare_named(prm,
                    "Masses",
                    "Names of rigid masses on surfaces; each has a subsection.",
                    names.masses,
                    model.system.masses);
      prm.enter_subsection("Loads");
      model.system.loads.add_parameters(prm);
      declare_objects(prm,
                      "Names of loads on surfaces; each has a subsection.",
                      names.loads,
                      model.system.surface_loads);
      prm.leave_subsection();
      declare_section(prm, "Start", model.start);
      declare_section(prm, "Time integration", model.time);
      declare_section(prm, "Modes", model.modes);
      declare_section(prm, "Validity", model.validity);
      declare_section(prm, "Output", model.output);
      declare_named(prm,
                    "Probes",
                    "Names of the probes; each has a subsection.",
                    names.probes,
                    model.probes);
    }



    // All values that can be relied on.
    void
    check_model(const Model &model,
                const ParameterFile &file,
                InputProblems &problems)
    {
      const auto check_all = [&](const auto &objects) {
        for (const auto &object : objects)
          // most of what is wrong follows from a wrong type
          if (!problems.is_doubtful(object.section(), "Type"))
            file.check([&object]() { object.check(); }, problems);
      };
      file.check(
        [&model]() {
          if (model.system.bodies.empty())
            throw InputError("Bodies", "Names", "nothing", "at least one name");
        },
        problems);
      check_all(model.system.bodies);
      check_all(model.system.joints);
      check_all(model.system.force_elements);
      check_all(model.system.masses);
      check_all(model.system.surface_loads);
      check_all(model.probes);
      file.check(
        [&model]() {
          TimeFunction(model.system.loads.gravity_factor,
                       "Loads",
                       "Gravity factor");
        },
        problems);
      file.check([&model]() { model.start.check(); }, problems);
      // an End time of zero: nothing but the equilibrium or modes
      const bool may_be_static =
        model.start.equilibrium || model.modes.number > 0;
      if (!(may_be_static && model.time.end_time == 0))
        file.check([&model]() { model.time.check(); }, problems);
      file.check([&model]() { check_amounts(model); }, problems);
      check_references(model, file, problems);
    }



    // What depends on where the model file lies, so that the record of the
    // parameters means the same elsewhere.
    void
    record_defaults(Model &model, ParameterHandler &prm)
    {
      prm.enter_subsection("Output");
      prm.set("Directory", model.output.directory);
      prm.leave_subsection();

      prm.enter_subsection("Bodies");
      for (BodyParameters &body : model.system.bodies)
        if (mesh_file_kind(body.mesh.mesh) != MeshFileKind::unknown)
          {
            const std::string name = body.mesh.mesh;
            const std::filesystem::path file =
              std::filesystem::absolute(model.directory / name);
            prm.enter_subsection(body.name);
            prm.set("Mesh", file.lexically_normal().string());
            body.mesh.mesh = name; // messages name the file as the model does
            prm.leave_subsection();
          }
      prm.leave_subsection();
    }
  } // namespace



  void
  OutputParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Directory",
                      directory,
                      "Folder of the results; made if it does not exist. If "
                      "nothing is given, the name of the model file without "
                      "its extension, followed by '-results'. Units: none.");
    prm.add_parameter("Probe interval",
                      probe_interval,
                      "Time between two lines of probes.csv; zero: every "
                      "step. Units: s.",
                      Patterns::Double(0));
    fields.add_parameters(prm);
    prm.add_parameter("Checkpoint interval",
                      checkpoint_interval,
                      "Simulated time between two checkpoints, from which "
                      "--restart goes on; zero: none but those of the wall "
                      "time, and one when the simulation fails or is "
                      "interrupted. Units: s.",
                      Patterns::Double(0));
    prm.add_parameter("Checkpoint wall interval",
                      checkpoint_wall_interval,
                      "Longest time that the program runs between two "
                      "checkpoints; zero: none. Units: s.",
                      Patterns::Double(0));
  }



  Model
  read_model(const ParameterFile &file)
  {
    Model model;
    ParameterHandler prm;
    InputProblems problems = file.problems();
    declare_model(prm,
                  model,
                  {file.names("Bodies", problems),
                   file.names("Joints", problems),
                   file.names("Force elements", problems),
                   file.names("Masses", problems),
                   file.names("Loads", problems),
                   file.names("Probes", problems)});
    file.parse(prm, problems);
    check_model(model, file, problems);
    problems.throw_all();

    model.warnings  = plausibility_warnings(model);
    model.directory = file.path().parent_path();
    if (model.output.directory.empty())
      model.output.directory = file.path().stem().string() + "-results";
    record_defaults(model, prm);
    model.used_parameters = used_parameters(prm);
    return model;
  }



  std::string
  default_model_file()
  {
    Model model;
    ParameterHandler prm;
    declare_model(
      prm,
      model,
      {{"body"}, {"joint"}, {"spring"}, {"mass"}, {"load"}, {"probe"}});
    return documented_parameters(prm);
  }
} // namespace ACF
