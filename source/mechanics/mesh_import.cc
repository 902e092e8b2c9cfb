// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/child_process.h>
#include <acf/base/console.h>
#include <acf/base/input_file.h>
#include <acf/base/parameter_patterns.h>
#include <acf/mechanics/abaqus_file.h>
#include <acf/mechanics/gmsh_model.h>
#include <acf/mechanics/gmsh_sizes.h>
#include <acf/mechanics/mesh_import.h>
#include <acf/mechanics/mesh_limits.h>
#include <acf/mechanics/msh_file.h>

#include <deal.II/base/utilities.h>

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <new>
#include <sstream>
#include <utility>

namespace ACF
{
  namespace
  {
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

    /**
     * Stop if a largest element size leads to too many elements. Lengths, areas
     * and volumes of the present shapes are at least covered by elements of
     * this size. Nothing is known of shapes of gmsh's own kernel but their
     * boxes.
     */
    void
    check_mesh_size(const double mesh_size,
                    const double scale,
                    const MeshSource &source)
    {
      double length = 0, x[2 * dim];
      gmsh::model::getBoundingBox(-1, -1, x[0], x[1], x[2], x[3], x[4], x[5]);
      for (unsigned int i = 0; i < dim; ++i)
        length = std::max(length, x[i + dim] - x[i]);
      double n_elements = length / mesh_size;

      gmsh::vectorpair shapes;
      gmsh::model::occ::getEntities(shapes);
      std::array<double, dim + 1> measures = {{}};
      for (const auto &[dimension, tag] : shapes)
        if (dimension > 0)
          {
            double measure = 0;
            gmsh::model::occ::getMass(dimension, tag, measure);
            measures[dimension] += measure;
          }
      // of a line, a regular triangle and a regular tetrahedron with unit edges
      constexpr std::array<double, dim + 1> units = {{0, 1, 0.433, 0.118}};
      for (unsigned int d = 1; d <= dim; ++d)
        n_elements =
          std::max(n_elements,
                   measures[d] / (units[d] * std::pow(mesh_size, d)));
      check_number_of_cells(n_elements,
                            true,
                            source.section,
                            "Mesh size",
                            "'" + format_number(scale * mesh_size) + "'");
    }

    /**
     * Seconds of computing after which reading a CAD file is given up: wrong
     * ones can keep the kernel busy for ever. A STEP file of 1.6 MB, a plate
     * with 400 holes, took 1 s.
     */
    unsigned int
    reading_time(const std::filesystem::path &file)
    {
      return 5 + 20 * std::filesystem::file_size(file) / 1000000;
    }

    /** Have gmsh read the file of a geometry and mesh it. */
    GmshMesh
    mesh_geometry(const std::filesystem::path &file,
                  const MeshFileKind kind,
                  const ImportOptions &options,
                  const double scale,
                  const MeshSource &source)
    {
      if (kind == MeshFileKind::cad || kind == MeshFileKind::cad_with_unit)
        {
          // in mm, the kernel's unit; setting it fails before the first STEP
          // file
          gmsh::vectorpair shapes;
          const ProcessorTimeLimit limit(reading_time(file));
          gmsh::model::occ::importShapes(file.string(), shapes);
          gmsh::model::occ::synchronize();
        }
      else
        gmsh::open(file.string());

      // after the script, to override it
      if (options.mesh_size > 0)
        {
          const double mesh_size = options.mesh_size / scale;
          check_mesh_size(mesh_size, scale, source);
          gmsh::option::setNumber("Mesh.MeshSizeMax", mesh_size);
          gmsh::model::mesh::clear();
        }
      if (!options.surface_sizes.empty())
        {
          set_surface_sizes(options.surface_sizes,
                            options.selections,
                            scale,
                            source);
          gmsh::model::mesh::clear();
        }
      gmsh::option::setNumber("Mesh.SecondOrderLinear", 0);
      if (options.is_quadratic)
        gmsh::option::setNumber("Mesh.ElementOrder", 2);
      std::vector<int> types;
      std::vector<std::vector<std::size_t>> tags, nodes;
      gmsh::model::mesh::getElements(types, tags, nodes, dim);
      if (types.empty())
        gmsh::model::mesh::generate(dim);
      else if (options.is_quadratic)
        gmsh::model::mesh::setOrder(2); // the script has made a mesh
      return gmsh_mesh();
    }

    /**
     * The same in a process of its own: gmsh and the CAD kernel may crash, a
     * script may end the process, and gmsh does not give back all memory.
     */
    GmshMesh
    mesh_geometry_apart(const std::filesystem::path &file,
                        const MeshFileKind kind,
                        const ImportOptions &options,
                        const double scale,
                        const MeshSource &source)
    {
      const std::string allowed = "files that gmsh can read and mesh";
      const auto task           = [&]() {
        const GmshSession session;
        const CapturedOutput output;
        try
          {
            return Utilities::pack(
              mesh_geometry(file, kind, options, scale, source), false);
          }
        catch (const std::string &message) // gmsh throws strings
          {
            const std::string more = output.text();
            throw source.error("gmsh says: " + message +
                                 (more.empty() ? "" : " " + more),
                               allowed);
          }
      };
      try
        {
          return Utilities::unpack<GmshMesh>(run_in_child_process(task), false);
        }
      catch (const ChildProcessEnded &error)
        {
          throw source.error(
            "gmsh " + std::string(error.what()),
            kind == MeshFileKind::script
              ? "scripts that gmsh can run, without the command 'Exit'"
              : allowed);
        }
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
          if (entity_names.empty())
            {
              ids[entity] = 0;
              continue;
            }
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

    MeshData
    convert(const GmshMesh &mesh,
            const ReferenceCell &reference_cell,
            const double scale,
            const bool is_quadratic,
            const MeshFileKind kind,
            const MeshSource &source)
    {
      MeshData data;
      EntityNames volumes  = physical_groups(mesh, dim, source);
      EntityNames surfaces = physical_groups(mesh, dim - 1, source);
      data.reference_cell  = reference_cell;
      data.notes           = mesh.notes;
      if (kind == MeshFileKind::abaqus)
        for (const auto &entity : mesh.entities[dim].groups)
          volumes.try_emplace(entity.first); // elements in no set
      if (volumes.empty())
        volumes = geometric_entities(mesh, dim);
      if (surfaces.empty() && kind != MeshFileKind::abaqus)
        {
          surfaces                  = geometric_entities(mesh, dim - 1);
          data.surfaces_of_geometry = true;
        }

      std::vector<ElementBlock> cells = elements_of(mesh, dim, volumes);
      std::vector<ElementBlock> faces = elements_of(mesh, dim - 1, surfaces);
      if (cells.empty())
        throw source.error(
          "a mesh without volume elements; surface elements: " +
            describe_elements(
              elements_of(mesh, dim - 1, geometric_entities(mesh, dim - 1))),
          "three-dimensional meshes of solids");
      if (kind != MeshFileKind::mesh && kind != MeshFileKind::abaqus)
        for (const auto &volume : volumes)
          if (std::none_of(cells.begin(), cells.end(), [&](const auto &block) {
                return block.entity == volume.first;
              }))
            throw source.error("gmsh made no cells in volume " +
                                 std::to_string(volume.first),
                               "geometries that gmsh can mesh");
      if (mesh.repeats_elements)
        {
          remove_repetitions(cells, volumes, source);
          remove_repetitions(faces, surfaces, source);
        }
      check_element_types(cells, reference_cell, source);

      const auto cell_ids = assign_ids(volumes, data.regions);
      const auto face_ids = assign_ids(surfaces, data.surfaces);
      read_elements(mesh,
                    cells,
                    cell_ids,
                    faces,
                    face_ids,
                    scale,
                    is_quadratic,
                    source,
                    data);
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
      {".inp", MeshFileKind::abaqus},
      {".geo", MeshFileKind::script},
      {".step", MeshFileKind::cad_with_unit},
      {".stp", MeshFileKind::cad_with_unit},
      {".igs", MeshFileKind::cad_with_unit},
      {".iges", MeshFileKind::cad_with_unit},
      {".brep", MeshFileKind::cad}};
    const auto kind = kinds.find(extension);
    return kind == kinds.end() ? MeshFileKind::unknown : kind->second;
  }

  std::vector<std::pair<std::string, double>>
  parse_surface_sizes(const std::string &text, const std::string &section)
  {
    std::vector<std::pair<std::string, double>> result;
    if (Utilities::trim(text).empty())
      return result;
    for (const std::string &part : split(text, ","))
      {
        const auto colon       = part.rfind(':');
        const std::string name = colon == std::string::npos
                                   ? ""
                                   : Utilities::trim(part.substr(0, colon));
        double size            = 0;
        try
          {
            size = Utilities::string_to_double(
              part.substr(colon == std::string::npos ? 0 : colon + 1));
          }
        catch (const std::exception &)
          {}
        if (name.empty() || !(size > 0 && size < 1e100))
          throw InputError(section,
                           "Surface mesh sizes",
                           in_quotes(part),
                           "a name and a positive number, 'NAME: size', "
                           "separated by ','");
        for (const auto &other : result)
          if (other.first == name)
            throw InputError(section,
                             "Surface mesh sizes",
                             "two sizes for " + in_quotes(name),
                             "one size for each surface");
        result.emplace_back(name, size);
      }
    return result;
  }

  MeshData
  import_mesh(const std::filesystem::path &file,
              const ReferenceCell &reference_cell,
              const ImportOptions &options,
              const MeshSource &source)
  {
    const MeshFileKind kind = mesh_file_kind(file);
    try
      {
        require_regular_file(file);
      }
    catch (const UnreadableFile &error)
      {
        throw source.error(error.what(),
                           "the name of a file that exists, relative to the "
                           "folder of the model file");
      }
    std::ifstream stream(file, std::ios::binary);
    if (kind == MeshFileKind::script)
      check_script_file(stream, source);

    // CAD is read in the kernel's unit, whose fixed tolerances would be too
    // coarse for small parts in m
    const double scale =
      options.scale * (kind == MeshFileKind::cad_with_unit ? 1e-3 : 1.);

    try
      {
        GmshMesh mesh;
        if (kind != MeshFileKind::mesh && kind != MeshFileKind::abaqus)
          mesh = mesh_geometry_apart(file, kind, options, scale, source);
        const GmshSession session; // for the types of elements
        if (kind == MeshFileKind::mesh)
          mesh = read_msh_file(stream, source);
        if (kind == MeshFileKind::abaqus)
          mesh = read_abaqus_file(stream, source);
        return convert(
          mesh, reference_cell, scale, options.is_quadratic, kind, source);
      }
    catch (const std::bad_alloc &)
      {
        throw source.error("it needs more memory than there is",
                           "meshes that fit into the memory");
      }
  }
} // namespace ACF
