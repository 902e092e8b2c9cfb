// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_division.h>
#include <acf/mechanics/sub_bodies.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
    class BodyMaker
    {
    public:
      explicit BodyMaker(const std::filesystem::path &directory)
        : directory(directory)
      {}

      SystemBodies result;

      void
      add(const BodyParameters &parameters)
      {
        if (parameters.mesh.cut.empty())
          add_body(parameters, [&]() {
            return make_mesh(parameters.mesh, parameters.section(), directory);
          });
        else
          add_parts(parameters);
      }

    private:
      // Calls make_mesh only if no reference body fits.
      template <typename MakeMesh>
      void
      add_body(const BodyParameters &parameters, const MakeMesh &make_mesh)
      {
        auto reference =
          std::find_if(result.references.begin(),
                       result.references.end(),
                       [&](const std::shared_ptr<ReferenceBody> &candidate) {
                         return candidate->fits(parameters);
                       });
        if (reference == result.references.end())
          {
            result.references.push_back(
              std::make_shared<ReferenceBody>(parameters, make_mesh()));
            reference = result.references.end() - 1;
          }
        result.bodies.emplace_back(parameters, *reference);
      }



      void
      add_parts(const BodyParameters &whole)
      {
        const DividedMesh &mesh  = divided_mesh(whole);
        const unsigned int first = result.bodies.size();
        for (unsigned int p = 0; p < mesh.parts.size(); ++p)
          {
            BodyParameters part = whole;
            part.name           = whole.name + " " + mesh.names[p];
            part.whole          = whole.name;
            part.mesh.part      = mesh.names[p];
            add_body(part, [&]() {
              return std::make_unique<const BodyMesh>(
                mesh.parts[p],
                MeshSource{part.section(),
                           whole.mesh.mesh + ", part " + part.name});
            });
          }
        share_centre(first);
        for (const auto &[p, q] : mesh.neighbors)
          result.joints.push_back(
            glue(whole.name, mesh.names[p], mesh.names[q]));
      }



      // Of the bodies from the given one on.
      void
      share_centre(const unsigned int first)
      {
        double mass = 0;
        Vector3 moment;
        for (unsigned int b = first; b < result.bodies.size(); ++b)
          {
            const BodyOperators &operators = result.bodies[b].operators();
            mass += operators.mass;
            moment +=
              operators.mass *
              mass_mean(operators, result.bodies[b].initial_positions());
          }
        for (unsigned int b = first; b < result.bodies.size(); ++b)
          result.bodies[b].set_whole_centre(moment / mass);
      }



      static JointParameters
      glue(const std::string &whole,
           const std::string &first,
           const std::string &second)
      {
        const std::string a = whole + " " + first, b = whole + " " + second;
        JointParameters joint;
        joint.name    = a + " + " + b;
        joint.type    = "fixed";
        joint.between = a + ": " + common_surface(second) + ", " + b + ": " +
                        common_surface(first);
        return joint;
      }



      // Bodies with the same mesh and cut are divided once.
      const DividedMesh &
      divided_mesh(const BodyParameters &body)
      {
        for (const auto &[parameters, mesh] : divided)
          if (parameters == body.mesh)
            return mesh;
        divided.emplace_back(
          body.mesh,
          divide_mesh(make_mesh_data(body.mesh, body.section(), directory),
                      parse_cut(body.mesh.cut, body.section()),
                      MeshSource{body.section(), body.mesh.mesh}));
        return divided.back().second;
      }

      const std::filesystem::path &directory;
      std::list<std::pair<MeshParameters, DividedMesh>> divided;
    };



    // Names of parts must not be those of other bodies.
    void
    check_names(const std::vector<BodyParameters> &parameters,
                const std::vector<Body> &bodies)
    {
      std::map<std::string, std::string> sections;
      for (const BodyParameters &body : parameters)
        sections[body.name] = body.section();
      for (const Body &body : bodies)
        if (!body.whole().empty() &&
            !sections.try_emplace(body.name(), body.section()).second)
          throw InputError(body.section(),
                           "Cut",
                           "a part '" + body.name() +
                             "', which is also the name of another body",
                           "parts and bodies with different names");
    }
  } // namespace



  SystemBodies
  make_bodies(const std::vector<BodyParameters> &parameters,
              const std::filesystem::path &directory)
  {
    BodyMaker maker(directory);
    for (const BodyParameters &body : parameters)
      maker.add(body);
    check_names(parameters, maker.result.bodies);
    return std::move(maker.result);
  }
} // namespace ACF
