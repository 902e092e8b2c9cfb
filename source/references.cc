// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/parameter_patterns.h>
#include <acf/mechanics/mesh_division.h>
#include <acf/mechanics/side_names.h>
#include <acf/references.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    // Of the shapes whose surfaces need no mesh; empty for others.
    std::vector<std::string>
    known_surfaces(const MeshParameters &mesh)
    {
      if (mesh.mirror != "none" || !mesh.cut.empty() || !mesh.surfaces.empty())
        return {};
      if (mesh.mesh == "box")
        return {"x max", "x min", "y max", "y min", "z max", "z min"};
      if (mesh.mesh == "cylinder")
        return {"end", "side", "start"};
      return {};
    }



    template <typename Objects>
    std::string
    list_names(const Objects &objects, const std::string &mark = "")
    {
      std::vector<std::string> names;
      for (const auto &object : objects)
        names.push_back(object.name);
      return list_words(names, mark);
    }



    bool
    contains(const std::vector<std::string> &list, const std::string &text)
    {
      return std::find(list.begin(), list.end(), text) != list.end();
    }



    class ReferenceChecker
    {
    public:
      ReferenceChecker(const Model &model,
                       const ParameterFile &file,
                       InputProblems &problems)
        : model(model)
        , file(file)
        , problems(problems)
      {}

      // "BODY: SURFACE, BODY: SURFACE" or with "ground"
      void
      sides(const std::string &text, const std::string &section) const
      {
        check([&]() {
          for (const std::string &side : split_sides(text, section))
            if (side != "ground")
              find_surface(side, section, "Between");
        });
      }

      // "BODY: SURFACE"
      void
      surface(const std::string &text,
              const std::string &section,
              const std::string &entry) const
      {
        check([&]() { find_surface(text, section, entry); });
      }

      void
      body(const std::string &name,
           const std::string &section,
           const std::string &entry) const
      {
        check([&]() { find_body(name, section, entry); });
      }

      void
      joint(const std::string &name, const std::string &section) const
      {
        const auto &joints = model.system.joints;
        const bool exists =
          std::any_of(joints.begin(), joints.end(), [&](const auto &joint) {
            return joint.name == name;
          });
        // joints between the parts of bodies are called "A 1 + A 2"
        if (exists || problems.is_doubtful("Joints", "Names") ||
            name.find(" + ") != std::string::npos)
          return;
        check([&]() {
          throw InputError(section,
                           "Of",
                           "the joint '" + name + "', which does not exist",
                           joints.empty() ? "nothing, as there are no joints"
                                          : list_names(joints));
        });
      }

    private:
      void
      check(const std::function<void()> &function) const
      {
        file.check(function, problems);
      }

      // Null if the body may exist, but nothing is known of it.
      const BodyParameters *
      find_body(const std::string &name,
                const std::string &section,
                const std::string &entry) const
      {
        if (problems.is_doubtful("Bodies", "Names"))
          return nullptr;
        for (const BodyParameters &body : model.system.bodies)
          {
            if (body.name == name)
              return &body;
            if (is_part(name, body))
              return nullptr;
          }
        throw InputError(section,
                         entry,
                         "the body '" + name + "', which does not exist",
                         list_names(model.system.bodies));
      }

      static bool
      is_part(const std::string &name, const BodyParameters &body)
      {
        return !body.mesh.cut.empty() && name.rfind(body.name + " ", 0) == 0;
      }

      void
      find_surface(const std::string &text,
                   const std::string &section,
                   const std::string &entry) const
      {
        const SurfaceName name = parse_surface_name(text, section, entry);
        const BodyParameters *const body = find_body(name.body, section, entry);
        if (body == nullptr || is_doubtful(*body))
          return;
        const auto surfaces = known_surfaces(body->mesh);
        if (!surfaces.empty() && !contains(surfaces, name.surface))
          throw InputError(section,
                           entry,
                           "surface '" + name.surface +
                             "', which the mesh does not have",
                           list_words(surfaces, "'"));
      }

      bool
      is_doubtful(const BodyParameters &body) const
      {
        for (const char *const entry : {"Mesh", "Mirror", "Cut"})
          if (problems.is_doubtful(body.section(), entry))
            return true;
        return false;
      }

      const Model &model;
      const ParameterFile &file;
      InputProblems &problems;
    };
  } // namespace



  void
  check_references(const Model &model,
                   const ParameterFile &file,
                   InputProblems &problems)
  {
    const ReferenceChecker checker(model, file, problems);
    for (const JointParameters &joint : model.system.joints)
      checker.sides(joint.between, joint.section());
    for (const ForceElementParameters &element : model.system.force_elements)
      checker.sides(element.between, element.section());
    for (const LumpedMassParameters &mass : model.system.masses)
      checker.surface(mass.on, mass.section(), "On");
    for (const SurfaceLoadParameters &load : model.system.surface_loads)
      checker.surface(load.on, load.section(), "On");
    for (const ProbeParameters &probe : model.probes)
      if (!problems.is_doubtful(probe.section(), "Type"))
        {
          const auto is = [&probe](const char *const begin) {
            return probe.type.rfind(begin, 0) == 0;
          };
          // what is missing has been found before
          if (!probe.of.empty() && is("mean"))
            checker.surface(probe.of, probe.section(), "Of");
          if (!probe.of.empty() &&
              (is("point") || is("stress") || is("largest")))
            checker.body(probe.of, probe.section(), "Of");
          if (!probe.of.empty() && (is("reaction") || is("joint")))
            checker.joint(probe.of, probe.section());
          if (!probe.from.empty() && is("chord"))
            checker.surface(probe.from, probe.section(), "From");
          if (!probe.to.empty() && is("chord"))
            checker.surface(probe.to, probe.section(), "To");
        }
  }
} // namespace ACF
