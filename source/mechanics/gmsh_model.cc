// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/gmsh_model.h>

#include <gmsh.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace ACF
{
  namespace
  {
    /** Collects vertices and elements. */
    class ElementReader
    {
    public:
      ElementReader(const GmshMesh &mesh,
                    const double scale,
                    const bool is_quadratic,
                    const MeshSource &source,
                    MeshData &data)
        : mesh(mesh)
        , scale(scale)
        , is_quadratic(is_quadratic)
        , source(source)
        , data(data)
      {}

      /** Append cells or faces with their ids. */
      template <int structdim>
      void
      read(const std::vector<ElementBlock> &blocks,
           const std::map<int, unsigned int> &ids,
           std::vector<CellData<structdim>> &elements,
           std::vector<std::size_t> *const numbers)
      {
        for (const ElementBlock &block : blocks)
          {
            const ElementType type = gmsh_element_type(block.type);
            for (std::size_t e = 0; e < block.tags.size(); ++e)
              {
                const std::size_t *const tags = &block.nodes[e * type.n_nodes];
                CellData<structdim> element(type.n_corners);
                for (int c = 0; c < type.n_corners; ++c)
                  element.vertices[c] = vertex(tags[c], block.tags[e]);
                if (structdim == dim)
                  {
                    if (is_quadratic)
                      add_edges(type, tags, element.vertices, block.tags[e]);
                    else if (type.order > 1)
                      check_straight(type, tags, block.tags[e]);
                    element.material_id = ids.at(block.entity);
                    // counter-clockwise -> lexicographic
                    if (type.n_corners == 8)
                      {
                        std::swap(element.vertices[2], element.vertices[3]);
                        std::swap(element.vertices[6], element.vertices[7]);
                      }
                  }
                else
                  element.boundary_id = ids.at(block.entity);
                elements.push_back(element);
                if (numbers != nullptr)
                  numbers->push_back(block.tags[e]);
              }
          }
      }

    private:
      Point<dim>
      node(const std::size_t tag, const std::size_t element) const
      {
        const auto found = mesh.nodes.find(tag);
        if (found == mesh.nodes.end())
          throw source.error("element " + std::to_string(element) +
                               " with node " + std::to_string(tag) +
                               ", which does not exist",
                             "nodes that the file defines");
        return scale * found->second;
      }

      unsigned int
      vertex(const std::size_t tag, const std::size_t element)
      {
        const auto [entry, is_new] =
          vertices.try_emplace(tag, data.vertices.size());
        if (is_new)
          data.vertices.push_back(node(tag, element));
        return entry->second;
      }

      /** Keep the nodes in the middle of edges. */
      void
      add_edges(const ElementType &type,
                const std::size_t *const tags,
                const std::vector<unsigned int> &vertices,
                const std::size_t element)
      {
        if (type.order != 2 || type.n_corners != 4)
          throw source.error(
            "element " + std::to_string(element) + " of the type " + type.name,
            "tetrahedra of second order (10 nodes) for Geometry = quadratic: "
            "save the mesh with Mesh.ElementOrder = 2");
        const auto is_middle = [&](const int n, const int v, const int w) {
          double distance = 0;
          for (unsigned int d = 0; d < dim; ++d)
            distance += std::abs(type.node_coordinates[dim * v + d] +
                                 type.node_coordinates[dim * w + d] -
                                 2 * type.node_coordinates[dim * n + d]);
          return distance < 1e-6;
        };
        for (int n = 4; n < type.n_nodes; ++n)
          for (int v = 0; v < 4; ++v)
            for (int w = 0; w < v; ++w)
              if (is_middle(n, v, w) && vertices[v] != vertices[w] &&
                  !add_edge_node(
                    data, vertices[v], vertices[w], node(tags[n], element)))
                throw source.error(
                  "element " + std::to_string(element) + " with node " +
                    std::to_string(tags[n]) + " at " +
                    describe_point(node(tags[n], element)) +
                    " in the middle of an edge, on which another element has "
                    "a node at another place",
                  "one node on each edge");
      }

      /** Compare nodes of higher order with the linear or trilinear map. */
      void
      check_straight(const ElementType &type,
                     const std::size_t *const tags,
                     const std::size_t element) const
      {
        constexpr double tolerance = 1e-5;
        const double diameter =
          node(tags[0], element)
            .distance(node(tags[type.n_corners - 2], element));
        for (int n = type.n_corners; n < type.n_nodes; ++n)
          {
            const double *const xi = &type.node_coordinates[dim * n];
            Vector3 straight;
            for (int c = 0; c < type.n_corners; ++c)
              {
                const double *const corner = &type.node_coordinates[dim * c];
                double shape               = 1;
                if (type.n_corners == 4)
                  shape = (c == 0 ? 1 - xi[0] - xi[1] - xi[2] : xi[c - 1]);
                else
                  for (unsigned int d = 0; d < dim; ++d)
                    shape *= 0.5 * (1 + corner[d] * xi[d]);
                straight += shape * Vector3(node(tags[c], element));
              }
            const Point<dim> position = node(tags[n], element);
            if ((Vector3(position) - straight).norm() > tolerance * diameter)
              throw source.error(
                "the curved element " + std::to_string(element) +
                  " of second or higher order, node " +
                  std::to_string(tags[n]) + " at " + describe_point(position) +
                  " is not on the straight edge",
                "straight cells: save the mesh with Mesh.ElementOrder = 1; or "
                "Geometry = quadratic for curved tetrahedra of second order");
          }
      }

      const GmshMesh &mesh;
      const double scale;
      const bool is_quadratic;
      const MeshSource &source;
      MeshData &data;
      std::unordered_map<std::size_t, unsigned int> vertices;
    };
  } // namespace

  GmshSession::GmshSession()
  {
    // without the user's option files, so that a model always gives the same
    // mesh
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
  }

  GmshSession::~GmshSession()
  {
    gmsh::finalize();
  }

  ElementType
  gmsh_element_type(const int type)
  {
    ElementType result;
    gmsh::model::mesh::getElementProperties(type,
                                            result.name,
                                            result.dimension,
                                            result.order,
                                            result.n_nodes,
                                            result.node_coordinates,
                                            result.n_corners);
    // polygons, and elements of order zero
    if (result.n_corners < 1 || result.n_nodes < result.n_corners)
      throw "Elements of type " + std::to_string(type) + " (" + result.name +
        ") have no fixed set of nodes";
    return result;
  }

  GmshMesh
  gmsh_mesh()
  {
    GmshMesh mesh;
    std::vector<std::size_t> node_tags;
    std::vector<double> coordinates, parameters;
    gmsh::model::mesh::getNodes(node_tags, coordinates, parameters);
    for (std::size_t i = 0; i < node_tags.size(); ++i)
      mesh.nodes[node_tags[i]] = Point<dim>(coordinates[3 * i],
                                            coordinates[3 * i + 1],
                                            coordinates[3 * i + 2]);

    for (unsigned int d = dim - 1; d <= dim; ++d)
      {
        GmshMesh::Entities &entities = mesh.entities[d];
        gmsh::vectorpair pairs;
        gmsh::model::getEntities(pairs, d);
        for (const auto &[unused, entity] : pairs)
          {
            std::vector<int> types, groups;
            std::vector<std::vector<std::size_t>> tags, nodes;
            gmsh::model::getPhysicalGroupsForEntity(d, entity, groups);
            for (const int group : groups)
              entities.groups[entity].insert(std::abs(group));
            entities.groups.try_emplace(entity);
            gmsh::model::mesh::getElements(types, tags, nodes, d, entity);
            for (std::size_t i = 0; i < types.size(); ++i)
              entities.elements[{entity, types[i]}] = {entity,
                                                       types[i],
                                                       std::move(tags[i]),
                                                       std::move(nodes[i])};
          }

        gmsh::model::getPhysicalGroups(pairs, d);
        int largest_tag = 0;
        for (const auto &[unused, tag] : pairs)
          largest_tag = std::max(largest_tag, tag);
        // gmsh does not list groups that have a name only; tags are usually
        // counted upwards, so that looking a little further finds them
        constexpr int search_range = 100;
        std::string name;
        for (int tag = 1; tag <= largest_tag + search_range; ++tag)
          {
            gmsh::model::getPhysicalName(d, tag, name);
            if (!name.empty())
              entities.group_names[tag] = name;
          }
      }
    return mesh;
  }

  EntityNames
  physical_groups(const GmshMesh &mesh,
                  const int dimension,
                  const MeshSource &source)
  {
    const GmshMesh::Entities &all = mesh.entities[dimension];
    const std::string kind        = (dimension == dim ? "volume" : "surface");
    std::map<int, bool> has_elements; // by the tag of the group
    for (const auto &group : all.group_names)
      has_elements[group.first] = false;
    EntityNames names;
    for (const auto &[entity, groups] : all.groups)
      for (const int tag : groups)
        {
          const auto name = all.group_names.find(tag);
          names[entity].insert(name == all.group_names.end()
                                 ? kind + " " + std::to_string(tag)
                                 : name->second);
          const auto block = all.elements.lower_bound({entity, 0});
          has_elements[tag] |=
            block != all.elements.end() && block->first.first == entity;
        }
    for (const auto &[tag, is_full] : has_elements)
      if (!is_full)
        {
          const auto name = all.group_names.find(tag);
          throw source.error(
            "the physical group " +
              (name == all.group_names.end() ? "" : "'" + name->second + "' ") +
              "(" + kind + " " + std::to_string(tag) + ") without cells",
            "groups that are not empty");
        }
    return names;
  }

  EntityNames
  geometric_entities(const GmshMesh &mesh, const int dimension)
  {
    EntityNames names;
    for (const auto &entity : mesh.entities[dimension].groups)
      names[entity.first] = {(dimension == dim ? "volume " : "surface ") +
                             std::to_string(entity.first)};
    return names;
  }

  std::vector<ElementBlock>
  elements_of(const GmshMesh &mesh,
              const int dimension,
              const EntityNames &names)
  {
    std::vector<ElementBlock> result;
    for (const auto &[place, block] : mesh.entities[dimension].elements)
      if (names.count(place.first) > 0)
        result.push_back(block);
    return result;
  }

  std::string
  element_family(const int type)
  {
    static const std::map<std::string, std::string> plurals = {
      {"Tetrahedron", "tetrahedra"},
      {"Hexahedron", "hexahedra"},
      {"Prism", "wedges"},
      {"Pyramid", "pyramids"},
      {"Triangle", "triangles"},
      {"Quadrilateral", "quadrilaterals"}};
    const std::string name = gmsh_element_type(type).name;
    const auto plural      = plurals.find(name.substr(0, name.find(' ')));
    return plural != plurals.end() ? plural->second : name + " elements";
  }

  std::string
  describe_elements(const std::vector<ElementBlock> &blocks)
  {
    std::map<std::string, std::size_t> counts;
    for (const ElementBlock &block : blocks)
      counts[element_family(block.type)] += block.tags.size();
    std::string result;
    for (const auto &[name, count] : counts)
      result +=
        (result.empty() ? "" : " and ") + std::to_string(count) + " " + name;
    return result.empty() ? "none" : result;
  }

  void
  remove_repetitions(std::vector<ElementBlock> &blocks,
                     const EntityNames &names,
                     const MeshSource &source)
  {
    for (ElementBlock &block : blocks)
      {
        const std::size_t n_groups = names.at(block.entity).size();
        if (n_groups <= 1)
          continue;
        const std::size_t n_nodes = block.nodes.size() / block.tags.size();
        ElementBlock unique{block.entity, block.type, {}, {}};
        std::map<std::vector<std::size_t>, std::size_t> copies;
        for (std::size_t e = 0; e < block.tags.size(); ++e)
          {
            const auto begin = block.nodes.begin() + e * n_nodes;
            const std::vector<std::size_t> nodes(begin, begin + n_nodes);
            if (++copies[nodes] > 1)
              continue;
            unique.tags.push_back(block.tags[e]);
            unique.nodes.insert(unique.nodes.end(), nodes.begin(), nodes.end());
          }
        for (const auto &copy : copies)
          if (copy.second != n_groups)
            {
              std::string groups;
              for (const std::string &name : names.at(block.entity))
                groups += (groups.empty() ? "'" : ", '") + name + "'";
              throw source.error(
                "the groups " + groups + " share the elementary entity " +
                  std::to_string(block.entity) + " but not all elements",
                "in format 2.2, one set of groups per elementary entity; or "
                "format 4.1");
            }
        block = std::move(unique);
      }
  }

  void
  read_elements(const GmshMesh &mesh,
                const std::vector<ElementBlock> &cells,
                const std::map<int, unsigned int> &cell_ids,
                const std::vector<ElementBlock> &faces,
                const std::map<int, unsigned int> &face_ids,
                const double scale,
                const bool is_quadratic,
                const MeshSource &source,
                MeshData &data)
  {
    ElementReader reader(mesh, scale, is_quadratic, source, data);
    reader.read(cells, cell_ids, data.cells, &data.cell_numbers);
    reader.read(faces, face_ids, data.faces, nullptr);
    drop_straight_edges(data);
  }
} // namespace ACF
