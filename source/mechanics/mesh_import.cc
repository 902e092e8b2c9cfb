// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/gmsh_model.h>
#include <acf/mechanics/mesh_import.h>

#include <gmsh.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iostream>
#include <sstream>
#include <utility>

namespace ACF
{
  namespace
  {
    constexpr char not_a_mesh[] =
      "a complete mesh file of gmsh, format 2.2 or 4.1";

    /** Keeps what is written to std::cout: the CAD kernel writes its errors
     * there, past gmsh. */
    class CapturedOutput
    {
    public:
      CapturedOutput()
        : original(std::cout.rdbuf(captured.rdbuf()))
      {}

      ~CapturedOutput()
      {
        std::cout.rdbuf(original);
      }

      CapturedOutput(const CapturedOutput &) = delete;
      CapturedOutput &
      operator=(const CapturedOutput &) = delete;

      /** What was captured in one line, without colours and decoration. */
      std::string
      text() const
      {
        std::string result;
        bool escape = false;
        for (const char c : captured.str())
          {
            escape = (escape || c == '\033');
            if (!escape && c != '*')
              {
                if (!std::isspace(static_cast<unsigned char>(c)))
                  result += c;
                else if (!result.empty() && result.back() != ' ')
                  result += ' ';
              }
            if (c == 'm')
              escape = false;
          }
        return result;
      }

    private:
      std::ostringstream captured;
      std::streambuf *original;
    };

    /**
     * The format ("2.2") of a .msh file. gmsh itself would take a file without
     * the header for a script, and does not miss the end of the last section.
     */
    std::string
    check_msh_file(std::ifstream &stream, const MeshSource &source)
    {
      std::string line, first, version, last;
      while (std::getline(stream, line))
        {
          if (line.find_first_not_of(" \t\r") == std::string::npos)
            continue;
          if (first.empty())
            {
              first = line;
              stream >> version;
            }
          last = line;
        }
      if (first.rfind("$MeshFormat", 0) != 0)
        throw source.error("no line $MeshFormat at the start", not_a_mesh);
      if (version != "2.2" && version != "4.1")
        throw source.error("mesh format '" + version + "'", not_a_mesh);
      if (last.rfind("$End", 0) != 0)
        throw source.error("no line $End... at the end: the file is truncated",
                           not_a_mesh);
      return version;
    }

    /** gmsh drops what follows the first statement in a last line that does
     * not end with a line break, and says nothing. */
    void
    check_script_file(std::ifstream &stream, const MeshSource &source)
    {
      stream.seekg(-1, std::ios::end);
      if (stream.get() != '\n')
        throw source.error("no line break at the end of the last line",
                           "scripts whose last line is complete, otherwise "
                           "gmsh may ignore a part of it");
    }

    /** Have gmsh read the file and, unless it is a mesh, mesh it. */
    void
    load(const std::filesystem::path &file,
         const MeshFileKind kind,
         const double mesh_size)
    {
      if (kind == MeshFileKind::cad || kind == MeshFileKind::cad_with_unit)
        {
          gmsh::vectorpair shapes;
          gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
          gmsh::model::occ::importShapes(file.string(), shapes);
          gmsh::model::occ::synchronize();
        }
      else
        gmsh::open(file.string());
      if (kind == MeshFileKind::mesh)
        return;

      // after the script, to override it
      if (mesh_size > 0)
        {
          gmsh::option::setNumber("Mesh.MeshSizeMax", mesh_size);
          gmsh::model::mesh::clear();
        }
      std::vector<int> types;
      std::vector<std::vector<std::size_t>> tags, nodes;
      gmsh::model::mesh::getElements(types, tags, nodes, dim);
      if (types.empty())
        gmsh::model::mesh::generate(dim);
    }

    /** Ids from 1 for the different sets of names. */
    std::map<int, unsigned int>
    assign_ids(const EntityNames &entities,
               std::map<std::string, std::set<unsigned int>> &names)
    {
      std::map<std::set<std::string>, unsigned int> sets;
      std::map<int, unsigned int> ids;
      for (const auto &[entity, entity_names] : entities)
        {
          const unsigned int id =
            sets.try_emplace(entity_names, sets.size() + 1).first->second;
          ids[entity] = id;
          for (const std::string &name : entity_names)
            names[name].insert(id);
        }
      return ids;
    }

    /** Stop unless all cells are of the one family that was asked for. */
    void
    check_element_types(const std::vector<ElementBlock> &cells,
                        const ReferenceCell &reference_cell,
                        const MeshSource &source)
    {
      std::set<std::string> families;
      for (const ElementBlock &block : cells)
        families.insert(element_family(block.type));
      const bool simplex = (reference_cell == ReferenceCells::Tetrahedron);
      const std::string wanted = (simplex ? "tetrahedra" : "hexahedra");
      const std::string other  = (simplex ? "hexahedra" : "tetrahedra");
      if (families == std::set<std::string>{wanted})
        return;
      const std::string contents =
        "'" + source.name + "' contains " + describe_elements(cells);
      if (families == std::set<std::string>{other})
        throw InputError(source.section,
                         "Element",
                         std::string(simplex ? "tetrahedron" : "hexahedron") +
                           ", but " + contents,
                         std::string(simplex ? "hexahedron" : "tetrahedron") +
                           " for this mesh");
      throw source.error(describe_elements(cells),
                         "cells of one kind, tetrahedra or hexahedra");
    }

    /** Convert gmsh's current model. */
    MeshData
    read_model(const ReferenceCell &reference_cell,
               const double scale,
               const bool was_meshed_here,
               const bool repeats_elements,
               const MeshSource &source)
    {
      MeshData data;
      EntityNames volumes  = physical_groups(dim, source);
      EntityNames surfaces = physical_groups(dim - 1, source);
      data.reference_cell  = reference_cell;
      if (volumes.empty())
        volumes = geometric_entities(dim);
      if (surfaces.empty())
        {
          surfaces                  = geometric_entities(dim - 1);
          data.surfaces_of_geometry = true;
        }

      std::vector<ElementBlock> cells = elements_of(dim, volumes);
      std::vector<ElementBlock> faces = elements_of(dim - 1, surfaces);
      if (cells.empty())
        throw source.error(
          "a mesh without volume elements; surface elements: " +
            describe_elements(
              elements_of(dim - 1, geometric_entities(dim - 1))),
          "three-dimensional meshes of solids");
      if (was_meshed_here)
        for (const auto &volume : volumes)
          if (std::none_of(cells.begin(), cells.end(), [&](const auto &block) {
                return block.entity == volume.first;
              }))
            throw source.error("gmsh made no cells in volume " +
                                 std::to_string(volume.first),
                               "geometries that gmsh can mesh");
      if (repeats_elements)
        {
          remove_repetitions(cells, volumes, source);
          remove_repetitions(faces, surfaces, source);
        }
      check_element_types(cells, reference_cell, source);

      const auto cell_ids = assign_ids(volumes, data.regions);
      const auto face_ids = assign_ids(surfaces, data.surfaces);
      read_elements(cells, cell_ids, faces, face_ids, scale, source, data);
      return data;
    }
  } // namespace

  MeshFileKind
  mesh_file_kind(const std::filesystem::path &file)
  {
    std::string extension = file.extension().string();
    for (char &c : extension)
      c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    static const std::map<std::string, MeshFileKind> kinds = {
      {".msh", MeshFileKind::mesh},
      {".geo", MeshFileKind::script},
      {".step", MeshFileKind::cad_with_unit},
      {".stp", MeshFileKind::cad_with_unit},
      {".igs", MeshFileKind::cad_with_unit},
      {".iges", MeshFileKind::cad_with_unit},
      {".brep", MeshFileKind::cad}};
    const auto kind = kinds.find(extension);
    return kind == kinds.end() ? MeshFileKind::unknown : kind->second;
  }

  MeshData
  import_mesh(const std::filesystem::path &file,
              const ReferenceCell &reference_cell,
              const double mesh_size,
              const MeshSource &source)
  {
    const MeshFileKind kind = mesh_file_kind(file);
    std::ifstream stream(file, std::ios::binary);
    // a directory can be opened, but not read
    if (!stream || stream.peek() == std::ifstream::traits_type::eof())
      throw source.error("no such file, or it is empty or cannot be read",
                         "the name of a file that exists, relative to the "
                         "folder of the model file");
    bool repeats_elements = false;
    if (kind == MeshFileKind::mesh)
      repeats_elements = (check_msh_file(stream, source) == "2.2");
    else if (kind == MeshFileKind::script)
      check_script_file(stream, source);

    // CAD is read in the kernel's unit, whose fixed tolerances would be too
    // coarse for small parts in m
    const double scale = (kind == MeshFileKind::cad_with_unit ? 1e-3 : 1.);

    const GmshSession session;
    const CapturedOutput output;
    try
      {
        load(file, kind, mesh_size / scale);
        return read_model(reference_cell,
                          scale,
                          kind != MeshFileKind::mesh,
                          repeats_elements,
                          source);
      }
    catch (const std::string &message) // gmsh throws strings
      {
        throw source.error("gmsh says: " + message +
                             (output.text().empty() ? "" : " " + output.text()),
                           "files that gmsh can read and mesh");
      }
  }
} // namespace ACF
