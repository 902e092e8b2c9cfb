// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/msh_file.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <sstream>
#include <utility>

#include "msh_contents.h"

// The formats: chapter "Gmsh file formats" of gmsh's reference manual,
// sections "MSH file format" (4.1) and "Legacy formats" (2.2).

namespace ACF
{
  namespace
  {
    /** Collects the sections of a file. */
    class MshReader
    {
    public:
      MshReader(const std::string &text, const MeshSource &source)
        : contents(text, source)
      {}

      GmshMesh
      read();

    private:
      void
      read_header();
      void
      read_section(const std::string &name);
      void
      read_names();
      void
      read_entities(const bool partitioned);
      void
      read_nodes();
      void
      read_nodes_2();
      void
      read_elements();
      void
      read_elements_2();
      void
      read_element_2(const std::size_t number,
                     const int type,
                     const int n_tags);
      void
      add_node(const std::size_t tag);
      void
      add_element(const std::size_t number,
                  const int entity,
                  const int type,
                  const std::size_t *nodes);
      int
      read_dimension();
      int
      read_group();
      std::size_t
      read_count(const std::size_t n_numbers, const std::string &what);
      void
      skip_list(const char *const what);
      const ElementType &
      type_of(const int type);

      MshContents contents;
      bool is_version_4 = false;
      std::set<std::string> known_sections;
      std::map<int, ElementType> types;
      GmshMesh mesh;
    };

    GmshMesh
    MshReader::read()
    {
      read_header();
      mesh.repeats_elements = !is_version_4;
      const bool is_binary  = contents.is_binary;
      while (!contents.at_end())
        {
          contents.is_binary     = false;
          const std::string line = contents.line();
          if (line.size() < 2 || line[0] != '$')
            contents.fail(contents.quoted(line) + " instead of a section");
          const std::string name = line.substr(1);
          contents.is_binary     = is_binary;
          read_section(name);
          contents.is_binary = false;
          if (contents.at_end())
            contents.fail("no line " + contents.quoted("$End" + name) +
                          ", the file is truncated");
          const std::string end = contents.line();
          if (end != "$End" + name)
            contents.fail(contents.quoted(end) + " instead of " +
                          contents.quoted("$End" + name));
          contents.is_binary = is_binary;
        }
      contents.is_binary = false;
      for (const std::string name : {"Nodes", "Elements"})
        if (known_sections.count(name) == 0)
          contents.fail("the end of a file without a section $" + name);
      return std::move(mesh);
    }

    void
    MshReader::read_header()
    {
      contents.at_end();
      if (contents.line() != "$MeshFormat")
        contents.fail("no line $MeshFormat at the start");
      std::istringstream line(contents.line());
      std::string version, kind, size;
      line >> version >> kind >> size;
      if (version != "2.2" && version != "4.1")
        contents.fail("mesh format " + contents.quoted(version));
      if ((kind != "0" && kind != "1") || size != "8")
        contents.fail(contents.quoted(kind + " " + size) + " after the format",
                      "0 or 1 for a text or binary file, and numbers of 8 "
                      "bytes");
      is_version_4 = (version == "4.1");
      if (kind == "1")
        {
          contents.is_binary = true;
          if (contents.number<std::int32_t>("the number 1") != 1)
            contents.fail("bytes in another order",
                          "files of machines that write the lowest byte first");
        }
      const bool is_binary = std::exchange(contents.is_binary, false);
      contents.at_end();
      if (contents.line() != "$EndMeshFormat")
        contents.fail("no line $EndMeshFormat");
      contents.is_binary = is_binary;
    }

    void
    MshReader::read_section(const std::string &name)
    {
      static const std::map<std::string, std::function<void(MshReader &)>>
        readers         = {{"PhysicalNames", &MshReader::read_names},
                           {"Entities",
                            [](MshReader &reader) { reader.read_entities(false); }},
                           {"PartitionedEntities",
                            [](MshReader &reader) { reader.read_entities(true); }},
                           {"Nodes",
                            [](MshReader &reader) {
                      reader.is_version_4 ? reader.read_nodes()
                                          : reader.read_nodes_2();
                    }},
                           {"Elements", [](MshReader &reader) {
                      reader.is_version_4 ? reader.read_elements()
                                          : reader.read_elements_2();
                    }}};
      const auto reader = readers.find(name);
      if (reader == readers.end())
        contents.skip_to("$End" + name);
      else if (!known_sections.insert(name).second)
        contents.fail("a second section $" + name, "one section of each name");
      else
        reader->second(*this);
    }

    void
    MshReader::read_names()
    {
      contents.is_binary = false;
      const auto n = contents.number_in_digits<std::size_t>("a count of names");
      for (std::size_t i = 0; i < n; ++i)
        {
          const int dimension     = read_dimension();
          const int tag           = read_group();
          const std::string line  = contents.line();
          const std::size_t first = line.find('"');
          const std::size_t last  = line.rfind('"');
          const std::string name =
            first < last ? line.substr(first + 1, last - first - 1) : "";
          if (name.empty() || std::any_of(name.begin(), name.end(), [](char c) {
                return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
              }))
            contents.fail("a group without a name of letters in quotes",
                          "for example 3 1 \"solid\"");
          mesh.entities[dimension].group_names[tag] = name;
        }
    }

    void
    MshReader::read_entities(const bool partitioned)
    {
      if (partitioned)
        {
          contents.number<std::uint64_t>("the count of partitions");
          const auto n = read_count(2, "ghost entities");
          for (std::size_t i = 0; i < 2 * n; ++i)
            contents.number<std::int32_t>("a ghost entity");
        }
      std::array<std::uint64_t, dim + 1> n;
      for (std::uint64_t &count : n)
        count = contents.number<std::uint64_t>("a count of entities");
      for (unsigned int d = 0; d <= dim; ++d)
        for (std::uint64_t i = 0; i < n[d]; ++i)
          {
            const auto tag =
              contents.number<std::int32_t>("the number of an entity");
            if (partitioned)
              {
                contents.number<std::int32_t>("the parent's dimension");
                contents.number<std::int32_t>("the parent's number");
                skip_list("a partition");
              }
            // the position of a point, otherwise the bounding box
            for (unsigned int k = 0; k < (d == 0 ? 3 : 6); ++k)
              contents.number<double>("a coordinate of an entity");
            auto &groups        = mesh.entities[d].groups[tag];
            const auto n_groups = read_count(1, "groups of an entity");
            for (std::size_t k = 0; k < n_groups; ++k)
              groups.insert(read_group());
            if (d > 0)
              skip_list("an entity of the boundary");
          }
    }

    void
    MshReader::read_nodes()
    {
      const auto n_blocks =
        contents.number<std::uint64_t>("the count of blocks of nodes");
      const auto n_nodes = read_count(4, "nodes");
      mesh.nodes.reserve(n_nodes);
      contents.number<std::uint64_t>("the smallest number of a node");
      contents.number<std::uint64_t>("the largest number of a node");
      for (std::uint64_t b = 0; b < n_blocks; ++b)
        {
          const int dimension = read_dimension();
          contents.number<std::int32_t>("the number of an entity");
          const bool is_parametric =
            contents.number<std::int32_t>("whether nodes have parameters") != 0;
          std::vector<std::uint64_t> tags(read_count(4, "nodes of a block"));
          for (std::uint64_t &tag : tags)
            tag = contents.number<std::uint64_t>("the number of a node");
          for (const std::uint64_t tag : tags)
            {
              add_node(tag);
              for (int k = 0; is_parametric && k < dimension; ++k)
                contents.number<double>("a parameter of a node");
            }
        }
      if (mesh.nodes.size() != n_nodes)
        contents.fail(std::to_string(n_nodes) + " nodes announced, but " +
                      std::to_string(mesh.nodes.size()) +
                      " in the section $Nodes that ends here");
    }

    void
    MshReader::read_nodes_2()
    {
      const auto n = contents.number_in_digits<std::size_t>("a count of nodes");
      contents.line();
      contents.check_count(n, 4, "nodes");
      mesh.nodes.reserve(n);
      for (std::size_t i = 0; i < n; ++i)
        add_node(contents.number<std::uint32_t>("the number of a node"));
    }

    void
    MshReader::add_node(const std::size_t tag)
    {
      Point<dim> position;
      for (unsigned int d = 0; d < dim; ++d)
        {
          position[d] = contents.number<double>("a coordinate of a node");
          if (!std::isfinite(position[d]))
            contents.fail("a coordinate of the node " + std::to_string(tag) +
                            " that is not finite",
                          "finite coordinates");
        }
      if (!mesh.nodes.try_emplace(tag, position).second)
        contents.fail("the node " + std::to_string(tag) + " a second time",
                      "each node once");
    }

    void
    MshReader::read_elements()
    {
      const auto n_blocks =
        contents.number<std::uint64_t>("the count of blocks of elements");
      read_count(2, "elements");
      contents.number<std::uint64_t>("the smallest number of an element");
      contents.number<std::uint64_t>("the largest number of an element");
      std::vector<std::size_t> nodes;
      for (std::uint64_t b = 0; b < n_blocks; ++b)
        {
          const int dimension = read_dimension();
          const auto entity =
            contents.number<std::int32_t>("the number of an entity");
          const auto type =
            contents.number<std::int32_t>("the type of an element");
          const ElementType &properties = type_of(type);
          if (properties.dimension != dimension)
            contents.fail("elements " + properties.name + " in an entity of " +
                            "dimension " + std::to_string(dimension),
                          "elements of the dimension of their entity");
          mesh.entities[dimension].groups.try_emplace(entity);
          const auto n = read_count(1 + properties.n_nodes, "elements");
          nodes.resize(properties.n_nodes);
          for (std::size_t i = 0; i < n; ++i)
            {
              const auto number =
                contents.number<std::uint64_t>("the number of an element");
              for (std::size_t &node : nodes)
                node = contents.number<std::uint64_t>("a node of an element");
              add_element(number, entity, type, nodes.data());
            }
        }
    }

    void
    MshReader::read_elements_2()
    {
      const auto n =
        contents.number_in_digits<std::size_t>("a count of elements");
      contents.line();
      std::size_t n_in_block = 1;
      for (std::size_t i = 0; i < n; i += n_in_block)
        {
          if (contents.is_binary)
            {
              const auto type =
                contents.number<std::int32_t>("the type of an element");
              const auto block =
                contents.number<std::int32_t>("a count of elements");
              const auto n_tags =
                contents.number<std::int32_t>("a count of tags");
              if (block < 1)
                contents.fail("a block of " + std::to_string(block) +
                                " elements",
                              "blocks that are not empty");
              n_in_block = block;
              for (int k = 0; k < block; ++k)
                read_element_2(contents.number<std::uint32_t>(
                                 "the number of an element"),
                               type,
                               n_tags);
            }
          else
            {
              const auto number =
                contents.number<std::uint32_t>("the number of an element");
              const auto type =
                contents.number<std::int32_t>("the type of an element");
              read_element_2(number,
                             type,
                             contents.number<std::int32_t>("a count of tags"));
            }
        }
    }

    void
    MshReader::read_element_2(const std::size_t number,
                              const int type,
                              const int n_tags)
    {
      int group = 0, entity = 0;
      for (int t = 0; t < n_tags; ++t)
        {
          if (t == 0)
            group = read_group();
          else
            {
              const auto tag = contents.number<std::int32_t>("a tag");
              if (t == 1)
                entity = tag;
            }
        }
      const ElementType &properties = type_of(type);
      std::vector<std::size_t> nodes(properties.n_nodes);
      for (std::size_t &node : nodes)
        node = contents.number<std::uint32_t>("a node of an element");
      auto &groups = mesh.entities[properties.dimension].groups[entity];
      if (group != 0)
        groups.insert(group);
      add_element(number, entity, type, nodes.data());
    }

    void
    MshReader::add_element(const std::size_t number,
                           const int entity,
                           const int type,
                           const std::size_t *const nodes)
    {
      const ElementType &properties = type_of(type);
      ElementBlock &block =
        mesh.entities[properties.dimension].elements[{entity, type}];
      block.entity = entity;
      block.type   = type;
      block.tags.push_back(number);
      block.nodes.insert(block.nodes.end(), nodes, nodes + properties.n_nodes);
    }

    int
    MshReader::read_dimension()
    {
      const auto dimension = contents.number<std::int32_t>("a dimension");
      if (dimension < 0 || dimension > static_cast<int>(dim))
        contents.fail("the dimension " + std::to_string(dimension),
                      "0, 1, 2 or 3");
      return dimension;
    }

    int
    MshReader::read_group()
    {
      // negative ones: the elements are turned over
      const auto tag = contents.number<std::int32_t>("the number of a group");
      if (tag == std::numeric_limits<std::int32_t>::min())
        contents.fail("the group " + std::to_string(tag), "smaller numbers");
      return std::abs(tag);
    }

    std::size_t
    MshReader::read_count(const std::size_t n_numbers, const std::string &what)
    {
      const auto n =
        contents.number<std::uint64_t>(("a count of " + what).c_str());
      contents.check_count(n, n_numbers, what);
      return n;
    }

    void
    MshReader::skip_list(const char *const what)
    {
      const auto n = contents.number<std::uint64_t>("a count");
      for (std::uint64_t i = 0; i < n; ++i)
        contents.number<std::int32_t>(what);
    }

    const ElementType &
    MshReader::type_of(const int type)
    {
      const auto known = types.find(type);
      if (known != types.end())
        return known->second;
      try
        {
          return types[type] = gmsh_element_type(type);
        }
      catch (const std::string &message)
        {
          contents.fail("an element of type " + std::to_string(type) + " (" +
                          message + ")",
                        "points, lines, triangles, quadrilaterals, "
                        "tetrahedra, hexahedra, wedges and pyramids");
        }
    }
  } // namespace

  GmshMesh
  read_msh_file(std::istream &stream, const MeshSource &source)
  {
    // what is no mesh may be of any size
    const std::string begin = "$MeshFormat";
    std::string text(begin.size(), 0);
    stream.read(text.data(), text.size());
    text.resize(stream.gcount());
    if (text == begin)
      {
        std::ostringstream rest;
        rest << stream.rdbuf();
        text += rest.str();
      }
    return MshReader(text, source).read();
  }
} // namespace ACF
