// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "abaqus_sets.h"

#include <acf/base/parameter_patterns.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_set>
#include <utility>

namespace ACF::Abaqus
{
  namespace
  {
    using Key = std::array<std::size_t, 4>;

    std::vector<SolidType>
    make_types()
    {
      const auto counted = [](const unsigned int n) {
        std::vector<unsigned int> order(n);
        std::iota(order.begin(), order.end(), 0U);
        return order;
      };
      const std::vector<std::vector<unsigned int>> tetrahedron = {{0, 1, 2},
                                                                  {0, 3, 1},
                                                                  {1, 3, 2},
                                                                  {2, 3, 0}};
      const std::vector<std::vector<unsigned int>> hexahedron  = {{0, 1, 2, 3},
                                                                  {4, 7, 6, 5},
                                                                  {0, 4, 5, 1},
                                                                  {1, 5, 6, 2},
                                                                  {2, 6, 7, 3},
                                                                  {3, 7, 4, 0}};
      std::vector<SolidType> types;
      for (const std::string variant : {"", "H"})
        types.push_back(
          {"C3D4" + variant, 4, 4, true, counted(4), tetrahedron, {}});
      for (const std::string variant : {"", "H", "HS", "I", "M", "MH", "R"})
        types.push_back(
          {"C3D10" + variant,
           11,
           4,
           true,
           {0, 1, 2, 3, 4, 5, 6, 7, 9, 8},
           tetrahedron,
           {{{0, 1}}, {{1, 2}}, {{0, 2}}, {{0, 3}}, {{2, 3}}, {{1, 3}}}});
      for (const std::string variant : {"", "H", "I", "IH", "R", "RH"})
        types.push_back(
          {"C3D8" + variant, 5, 8, true, counted(8), hexahedron, {}});
      for (const std::string variant : {"", "H", "R", "RH"})
        types.push_back({"C3D20" + variant,
                         17,
                         8,
                         true,
                         {0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                          16, 9, 17, 10, 18, 19, 12, 15, 13, 14},
                         hexahedron,
                         {{{0, 1}},
                          {{0, 3}},
                          {{0, 4}},
                          {{1, 2}},
                          {{1, 5}},
                          {{2, 3}},
                          {{2, 6}},
                          {{3, 7}},
                          {{4, 5}},
                          {{4, 7}},
                          {{5, 6}},
                          {{6, 7}}}});
      for (const std::string kind : {"CPS", "SFM3D"})
        for (const std::string variant : {"", "R"})
          {
            types.push_back(
              {kind + "3" + variant, 2, 3, false, counted(3), {}, {}});
            types.push_back(
              {kind + "4" + variant, 3, 4, false, counted(4), {}, {}});
            types.push_back(
              {kind + "6" + variant, 9, 3, false, counted(6), {}, {}});
            types.push_back(
              {kind + "8" + variant, 16, 4, false, counted(8), {}, {}});
          }
      return types;
    }



    template <typename Numbers>
    Key
    make_key(const Numbers &corners)
    {
      Key key;
      key.fill(0);
      std::copy(corners.begin(), corners.end(), key.begin());
      std::sort(key.begin(), key.end());
      return key;
    }



    // Makes entities of elements and faces that are in the same sets.
    class Grouping
    {
    public:
      explicit Grouping(GmshMesh::Entities &entities)
        : entities(entities)
      {}

      // The tag of the group of a name.
      int
      group(const std::string &name)
      {
        const auto [entry, is_new] =
          groups.try_emplace(name, static_cast<int>(groups.size()) + 1);
        if (is_new)
          entities.group_names[entry->second] = name;
        return entry->second;
      }

      void
      add(const std::set<int> &element_groups,
          const std::size_t tag,
          const int type,
          const std::vector<std::size_t> &nodes)
      {
        const int entity =
          tags.try_emplace(element_groups, static_cast<int>(tags.size()) + 1)
            .first->second;
        entities.groups[entity] = element_groups;
        ElementBlock &block     = entities.elements[{entity, type}];
        block.entity            = entity;
        block.type              = type;
        block.tags.push_back(tag);
        block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
      }

    private:
      GmshMesh::Entities &entities;
      std::map<std::string, int> groups;
      std::map<std::set<int>, int> tags;
    };



    struct Face
    {
      /** Corners first. */
      std::vector<std::size_t> nodes;
      unsigned int n_corners = 0;
      std::set<std::string> names;
    };



    class MeshMaker
    {
    public:
      MeshMaker(const Contents &contents, const MeshSource &source)
        : contents(contents)
        , source(source)
      {}

      GmshMesh
      make()
      {
        mesh.nodes = contents.nodes;
        mesh.notes = contents.notes;
        check_nodes();
        group_elements();
        find_boundary();
        name_faces_of_surfaces();
        name_faces_of_elements();
        name_faces_of_nodes();
        Grouping surfaces(mesh.entities[dim - 1]);
        for (const auto &[key, face] : faces)
          if (!face.names.empty())
            {
              std::set<int> groups;
              for (const std::string &name : face.names)
                groups.insert(surfaces.group(name));
              surfaces.add(groups,
                           0,
                           face.n_corners == 3 ? 2 : 3,
                           {face.nodes.begin(),
                            face.nodes.begin() + face.n_corners});
            }
        return std::move(mesh);
      }

    private:
      [[noreturn]] void
      fail(const unsigned int line,
           const std::string &found,
           const std::string &allowed) const
      {
        throw source.error("line " + std::to_string(line) + ": " + found,
                           allowed);
      }

      void
      check_nodes() const
      {
        for (const auto &[number, element] : contents.elements)
          for (const std::size_t node : element.nodes)
            if (contents.nodes.count(node) == 0)
              fail(element.line,
                   "element " + std::to_string(number) + " with node " +
                     std::to_string(node) + ", which does not exist",
                   "nodes that the file defines");
      }

      // Calls a function with all members, which exist in @p things.
      template <typename Things, typename Function>
      void
      for_all(const Members &members,
              const Things &things,
              const std::string &kind,
              const Function &function) const
      {
        for (const auto &[range, line] : members)
          {
            const auto [first, last, step] = range;
            for (std::size_t number = first; number <= last; number += step)
              {
                // ends at the first one: also long ranges do not take long
                if (things.count(number) == 0 && kind == "element" &&
                    contents.left_out_elements.count(number) > 0)
                  continue;
                if (things.count(number) == 0)
                  fail(line,
                       kind + " " + std::to_string(number) +
                         ", which does not exist, in a set or surface",
                       kind + "s that the file defines");
                function(number);
              }
          }
      }

      void
      group_elements()
      {
        Grouping volumes(mesh.entities[dim]);
        std::unordered_map<std::size_t, std::set<int>> groups;
        for (const auto &[key, set] : contents.element_sets)
          for_all(set.members,
                  contents.elements,
                  "element",
                  [&, &set = set](const std::size_t number) {
                    if (!set.is_internal &&
                        contents.elements.at(number).type->is_solid)
                      groups[number].insert(volumes.group(set.name));
                  });
        for (const auto &[number, element] : contents.elements)
          if (element.type->is_solid)
            volumes.add(groups[number],
                        number,
                        element.type->gmsh_type,
                        element.nodes);
      }

      Face
      make_face(const Element &element, const unsigned int index) const
      {
        const SolidType &type = *element.type;
        const auto &corners   = type.faces[index];
        Face face;
        face.n_corners = corners.size();
        for (const unsigned int corner : corners)
          face.nodes.push_back(element.nodes[corner]);
        const auto has = [&](const unsigned int corner) {
          return std::find(corners.begin(), corners.end(), corner) !=
                 corners.end();
        };
        for (std::size_t e = 0; e < type.edges.size(); ++e)
          if (has(type.edges[e][0]) && has(type.edges[e][1]))
            face.nodes.push_back(element.nodes[type.n_corners + e]);
        return face;
      }

      static Key
      key_of(const Face &face)
      {
        return make_key(
          std::vector<std::size_t>(face.nodes.begin(),
                                   face.nodes.begin() + face.n_corners));
      }

      void
      find_boundary()
      {
        std::vector<std::tuple<Key, const Element *, unsigned int>> all;
        for (const auto &[number, element] : contents.elements)
          for (unsigned int f = 0; f < element.type->faces.size(); ++f)
            all.emplace_back(key_of(make_face(element, f)), &element, f);
        std::sort(all.begin(), all.end());
        const auto same = [&](const std::size_t i, const std::size_t j) {
          return std::get<0>(all[i]) == std::get<0>(all[j]);
        };
        for (std::size_t i = 0; i < all.size(); ++i)
          if ((i == 0 || !same(i - 1, i)) &&
              (i + 1 == all.size() || !same(i, i + 1)))
            faces[std::get<0>(all[i])] =
              make_face(*std::get<1>(all[i]), std::get<2>(all[i]));
        for (const auto &face : faces)
          boundary.insert(face.first);
      }

      void
      name_faces_of_surfaces()
      {
        for (const auto &[key, surface] : contents.surfaces)
          for (const Surface::Part &part : surface.parts)
            if (!surface.of_nodes)
              for_all(part.members,
                      contents.elements,
                      "element",
                      [&, &surface = surface](const std::size_t number) {
                        name_faces_of_part(surface,
                                           part,
                                           number,
                                           contents.elements.at(number));
                      });
      }

      // Faces inside the body become faces, too, which is an error later.
      void
      name_faces_of_part(const Surface &surface,
                         const Surface::Part &part,
                         const std::size_t number,
                         const Element &element)
      {
        const std::size_t n_faces = element.type->faces.size();
        if (n_faces == 0 || part.face > n_faces)
          fail(part.line,
               "a face of the element " + std::to_string(number) +
                 " of the type " + element.type->name +
                 ", which does not have it",
               "faces of solid elements, S1 to S4 of tetrahedra and S1 to S6 "
               "of hexahedra");
        for (unsigned int f = 0; f < n_faces; ++f)
          {
            if (part.face != 0 && part.face != f + 1)
              continue;
            const Face face = make_face(element, f);
            const Key key   = key_of(face);
            if (part.face != 0 || boundary.count(key) > 0)
              faces.try_emplace(key, face).first->second.names.insert(
                surface.name);
          }
      }

      void
      name_faces_of_elements()
      {
        std::size_t n_inside = 0;
        for (const auto &[key, set] : contents.element_sets)
          if (!set.is_internal)
            for_all(set.members,
                    contents.elements,
                    "element",
                    [&, &set = set](const std::size_t number) {
                      const Element &element = contents.elements.at(number);
                      if (element.type->is_solid)
                        return;
                      const Key face = make_key(
                        std::vector<std::size_t>(element.nodes.begin(),
                                                 element.nodes.begin() +
                                                   element.type->n_corners));
                      if (boundary.count(face) > 0)
                        faces.at(face).names.insert(set.name);
                      else
                        ++n_inside;
                    });
        if (n_inside > 0)
          mesh.notes.push_back(std::to_string(n_inside) +
                               " surface elements that are left out, as they "
                               "are not on the boundary of the body");
      }

      void
      name_faces_of_nodes()
      {
        std::vector<std::string> without_faces;
        const auto name_faces = [&](const std::string &name,
                                    const std::vector<const Members *> &all) {
          std::unordered_set<std::size_t> nodes;
          for (const Members *const members : all)
            for_all(*members,
                    contents.nodes,
                    "node",
                    [&](const std::size_t node) { nodes.insert(node); });
          bool has_faces = false;
          for (const Key &key : boundary)
            {
              Face &face = faces.at(key);
              if (std::all_of(face.nodes.begin(),
                              face.nodes.end(),
                              [&](const std::size_t node) {
                                return nodes.count(node) > 0;
                              }))
                {
                  face.names.insert(name);
                  has_faces = true;
                }
            }
          if (!has_faces)
            without_faces.push_back(name);
        };
        for (const auto &[key, set] : contents.node_sets)
          if (!set.is_internal && contents.surfaces.count(key) == 0)
            name_faces(set.name, {&set.members});
        for (const auto &[key, surface] : contents.surfaces)
          if (surface.of_nodes)
            {
              std::vector<const Members *> all;
              for (const Surface::Part &part : surface.parts)
                all.push_back(&part.members);
              name_faces(surface.name, all);
            }
        constexpr std::size_t enough = 20;
        if (without_faces.size() > enough)
          {
            const std::size_t n_more = without_faces.size() - enough;
            without_faces.resize(enough);
            without_faces.push_back(std::to_string(n_more) + " more");
          }
        if (!without_faces.empty())
          mesh.notes.push_back(
            "sets of nodes that are no surfaces, as they do not have all "
            "nodes of any face: " +
            list_words(without_faces, ""));
      }

      const Contents &contents;
      const MeshSource &source;
      GmshMesh mesh;
      std::map<Key, Face> faces;
      std::set<Key> boundary;
    };
  } // namespace



  const SolidType *
  find_type(const std::string &name)
  {
    static const std::vector<SolidType> types = make_types();
    for (const SolidType &type : types)
      if (type.name == name)
        return &type;
    return nullptr;
  }



  GmshMesh
  make_mesh(const Contents &contents, const MeshSource &source)
  {
    return MeshMaker(contents, source).make();
  }
} // namespace ACF::Abaqus
