// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_import.h>
#include <acf/model.h>

#include <deal.II/base/utilities.h>

namespace ACF
{
  namespace
  {
    // Declares "Names" and one subsection per object.
    template <typename Parameters>
    void
    declare_named(ParameterHandler &prm,
                  const std::string &section,
                  const std::string &documentation,
                  const std::vector<std::string> &names,
                  std::vector<Parameters> &objects)
    {
      prm.enter_subsection(section);
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
      prm.leave_subsection();
    }



    void
    declare_model(ParameterHandler &prm,
                  Model &model,
                  const std::vector<std::string> &bodies,
                  const std::vector<std::string> &joints,
                  const std::vector<std::string> &probes)
    {
      prm.add_parameter("Title",
                        model.title,
                        "What the model is, for people. Units: none.");
      declare_named(prm,
                    "Bodies",
                    "Names of the bodies; each has a subsection.",
                    bodies,
                    model.bodies);
      declare_named(prm,
                    "Joints",
                    "Names of the joints; each has a subsection.",
                    joints,
                    model.joints);
      prm.enter_subsection("Loads");
      model.loads.add_parameters(prm);
      prm.leave_subsection();
      prm.enter_subsection("Time integration");
      model.time.add_parameters(prm);
      prm.leave_subsection();
      prm.enter_subsection("Output");
      model.output.add_parameters(prm);
      prm.leave_subsection();
      declare_named(prm,
                    "Probes",
                    "Names of the probes; each has a subsection.",
                    probes,
                    model.probes);
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
      for (BodyParameters &body : model.bodies)
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
    vtu.add_parameters(prm);
  }



  Model
  read_model(const ParameterFile &file)
  {
    Model model;
    ParameterHandler prm;
    declare_model(prm,
                  model,
                  file.names("Bodies"),
                  file.names("Joints"),
                  file.names("Probes"));
    file.parse(prm);
    try
      {
        if (model.bodies.empty())
          throw InputError("Bodies", "Names", "nothing", "at least one name");
        for (const BodyParameters &body : model.bodies)
          body.check();
        for (const JointParameters &joint : model.joints)
          joint.check();
        model.time.check();
        for (const ProbeParameters &probe : model.probes)
          probe.check();
      }
    catch (const InputError &error)
      {
        throw file.locate(error);
      }

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
    declare_model(prm, model, {"body"}, {"joint"}, {"probe"});
    return documented_parameters(prm);
  }
} // namespace ACF
