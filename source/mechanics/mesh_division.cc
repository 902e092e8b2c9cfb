// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/mechanics/mesh_division.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace ACF
{
  namespace
  {
    const char *const cut_form =
      "nothing, planes across an axis of the mesh ('y: 0.25, 0.5', ascending), "
      "a number of slices of equal thickness ('4 along y', 2 to 10000), or "
      "'volumes'";

    InputError
    cut_error(const MeshSource &source,
              const std::string &found,
              const std::string &allowed)
    {
      return InputError(source.section, "Cut", found, allowed);
    }



    bool
    is_axis(const std::string &text)
    {
      return text == "x" || text == "y" || text == "z";
    }



    // Names of the parts and the part of each cell.
    struct CellParts
    {
      std::vector<std::string> names;
      std::vector<unsigned int> part_of_cell;
    };



    double
    centre(const MeshData &mesh,
           const CellData<dim> &cell,
           const unsigned int axis)
    {
      double sum = 0;
      for (const unsigned int vertex : cell.vertices)
        sum += mesh.vertices[vertex][axis];
      return sum / cell.vertices.size();
    }



    CellParts
    find_slices(const MeshData &mesh,
                const MeshCut &cut,
                const MeshSource &source)
    {
      // some would be empty: said below, but here before it takes memory
      if (cut.n_slices > mesh.cells.size() + 1000)
        throw cut_error(source,
                        std::to_string(cut.n_slices) +
                          " slices of a mesh with " +
                          std::to_string(mesh.cells.size()) + " cells",
                        "not more slices than cells");
      double first = std::numeric_limits<double>::max(), last = -first;
      for (const CellData<dim> &cell : mesh.cells)
        for (const unsigned int vertex : cell.vertices)
          {
            first = std::min(first, mesh.vertices[vertex][cut.axis]);
            last  = std::max(last, mesh.vertices[vertex][cut.axis]);
          }
      std::vector<double> planes = cut.planes;
      for (unsigned int k = 1; k < cut.n_slices; ++k)
        planes.push_back(first + (last - first) * k / cut.n_slices);

      // centres on a plane all belong to one side, whatever the round-off
      const double tolerance = 1e-9 * (last - first);
      CellParts result;
      std::vector<unsigned int> n_cells(planes.size() + 1);
      for (const CellData<dim> &cell : mesh.cells)
        {
          const unsigned int part =
            std::upper_bound(planes.begin(),
                             planes.end(),
                             centre(mesh, cell, cut.axis) + tolerance) -
            planes.begin();
          result.part_of_cell.push_back(part);
          ++n_cells[part];
        }
      for (unsigned int part = 0; part < n_cells.size(); ++part)
        {
          result.names.push_back(std::to_string(part + 1));
          if (n_cells[part] > 0)
            continue;
          const std::string axis(1, "xyz"[cut.axis]);
          std::string range;
          if (part > 0)
            range += " from " + axis + " = " + format_number(planes[part - 1]);
          if (part < planes.size())
            range += " to " + axis + " = " + format_number(planes[part]);
          throw cut_error(source,
                          "the part " + result.names.back() + range +
                            " m, in which no cell has its centre",
                          "planes between " + format_number(first) + " and " +
                            format_number(last) +
                            " m that leave cells in each part");
        }
      return result;
    }



    CellParts
    find_volumes(const MeshData &mesh, const MeshSource &source)
    {
      CellParts result;
      std::map<types::material_id, unsigned int> parts;
      for (const auto &[name, ids] : mesh.regions)
        {
          if (name.find_first_of(":,") != std::string::npos)
            throw cut_error(source,
                            "the volume '" + name + "'",
                            "names of volumes without ':' and ','");
          for (const types::material_id id : ids)
            if (!parts.try_emplace(id, result.names.size()).second)
              throw cut_error(source,
                              "cells in both volumes '" +
                                result.names[parts.at(id)] + "' and '" + name +
                                "'",
                              "each cell in one physical volume");
          result.names.push_back(name);
        }
      if (result.names.size() < 2)
        throw cut_error(source,
                        "'volumes' for a mesh with one volume",
                        "a mesh file with several volumes");
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        {
          const auto part = parts.find(mesh.cells[c].material_id);
          if (part == parts.end())
            throw cut_error(source,
                            "the " + describe_cell(mesh, c) + " in no volume",
                            "each cell in one physical volume");
          result.part_of_cell.push_back(part->second);
        }
      return result;
    }



    // Names of those whose ids occur.
    std::map<std::string, std::set<unsigned int>>
    select(const std::map<std::string, std::set<unsigned int>> &names,
           const std::set<unsigned int> &used)
    {
      std::map<std::string, std::set<unsigned int>> result;
      for (const auto &[name, ids] : names)
        for (const unsigned int id : ids)
          if (used.count(id) > 0)
            result[name].insert(id);
      return result;
    }



    class Division
    {
    public:
      Division(const MeshData &mesh,
               const CellParts &cells,
               const MeshSource &source)
        : source(source)
        , part_of_cell(cells.part_of_cell)
      {
        result.names = cells.names;
        result.parts.resize(result.names.size());
        distribute_cells(mesh);
        distribute_faces(mesh);
        for (MeshData &part : result.parts)
          drop_empty_surfaces(part);
      }

      DividedMesh result;

    private:
      void
      distribute_cells(const MeshData &mesh)
      {
        for (MeshData &part : result.parts)
          {
            part.reference_cell = mesh.reference_cell;
            part.vertices       = mesh.vertices;
            part.curved_edges   = mesh.curved_edges;
            part.notes          = mesh.notes;
            part.surfaces       = mesh.surfaces;
          }
        std::vector<std::set<unsigned int>> used(result.parts.size());
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          {
            MeshData &part = result.parts[part_of_cell[c]];
            part.cells.push_back(mesh.cells[c]);
            part.cell_numbers.push_back(
              mesh.cell_numbers.empty() ? c + 1 : mesh.cell_numbers[c]);
            used[part_of_cell[c]].insert(mesh.cells[c].material_id);
          }
        for (unsigned int p = 0; p < result.parts.size(); ++p)
          result.parts[p].regions = select(mesh.regions, used[p]);
      }



      void
      distribute_faces(const MeshData &mesh)
      {
        for (const auto &[name, ids] : mesh.surfaces)
          next_id = std::max(next_id, *ids.rbegin() + 1);
        const auto table = make_face_table(mesh);
        for (const CellData<dim - 1> &face : mesh.faces)
          {
            const auto entry =
              std::lower_bound(table.begin(),
                               table.end(),
                               std::make_pair(make_face_key(face.vertices),
                                              0U));
            result.parts[part_of_cell[entry->second]].faces.push_back(face);
          }
        std::map<std::pair<unsigned int, unsigned int>, types::boundary_id> ids;
        for (std::size_t i = 1; i < table.size(); ++i)
          if (table[i].first == table[i - 1].first)
            {
              const auto parts = std::minmax(part_of_cell[table[i].second],
                                             part_of_cell[table[i - 1].second]);
              if (parts.first != parts.second)
                add_common_face(table[i].first, parts, ids);
            }
        for (const auto &neighbors : ids)
          result.neighbors.push_back(neighbors.first);
      }



      void
      add_common_face(const FaceKey &key,
                      const std::pair<unsigned int, unsigned int> &parts,
                      std::map<std::pair<unsigned int, unsigned int>,
                               types::boundary_id> &ids)
      {
        const auto [id, is_new] = ids.try_emplace(parts, next_id);
        if (is_new)
          {
            ++next_id;
            name_surface(parts.first, parts.second, id->second);
            name_surface(parts.second, parts.first, id->second);
          }
        CellData<dim - 1> face;
        face.vertices.clear();
        for (const unsigned int vertex : key)
          if (vertex != numbers::invalid_unsigned_int)
            face.vertices.push_back(vertex);
        face.boundary_id = id->second;
        result.parts[parts.first].faces.push_back(face);
        result.parts[parts.second].faces.push_back(face);
      }



      void
      name_surface(const unsigned int part,
                   const unsigned int neighbor,
                   const types::boundary_id id)
      {
        const std::string name = common_surface(result.names[neighbor]);
        if (!result.parts[part].surfaces.try_emplace(name, std::set{id}).second)
          throw cut_error(source,
                          "the surface '" + name + "' of the mesh",
                          "other names, as the common surfaces of parts are "
                          "called so");
      }

      const MeshSource &source;
      const std::vector<unsigned int> &part_of_cell;
      types::boundary_id next_id = 1;
    };
  } // namespace



  MeshCut
  parse_cut(const std::string &text, const std::string &section)
  {
    const InputError error(section, "Cut", "'" + text + "'", cut_form);
    MeshCut cut;
    if (text.empty())
      return cut;
    if (text == "volumes")
      {
        cut.kind = MeshCut::Kind::volumes;
        return cut;
      }

    const std::string along = " along ";
    const auto colon = text.find(':'), middle = text.find(along);
    std::string axis;
    try
      {
        if (colon != std::string::npos)
          {
            cut.kind   = MeshCut::Kind::planes;
            axis       = Utilities::trim(text.substr(0, colon));
            cut.planes = Utilities::string_to_double(
              Utilities::split_string_list(text.substr(colon + 1), ','));
          }
        else if (middle != std::string::npos)
          {
            cut.kind = MeshCut::Kind::slices;
            axis     = Utilities::trim(text.substr(middle + along.size()));
            const int number = Utilities::string_to_int(text.substr(0, middle));
            cut.n_slices     = number > 1 && number <= 10000 ? number : 0;
          }
      }
    catch (const std::exception &)
      {
        throw error;
      }
    const bool ascending =
      std::adjacent_find(cut.planes.begin(),
                         cut.planes.end(),
                         std::greater_equal<double>()) == cut.planes.end() &&
      std::all_of(cut.planes.begin(), cut.planes.end(), [](const double p) {
        return std::isfinite(p);
      });
    if (!is_axis(axis) || !ascending ||
        (cut.planes.empty() && cut.n_slices == 0))
      throw error;
    cut.axis = axis[0] - 'x';
    return cut;
  }



  std::string
  common_surface(const std::string &neighbor)
  {
    return "cut to " + neighbor;
  }



  DividedMesh
  divide_mesh(MeshData mesh, const MeshCut &cut, const MeshSource &source)
  {
    check_cells(mesh, source);
    check_topology(mesh, source);
    const CellParts cells = cut.kind == MeshCut::Kind::volumes
                              ? find_volumes(mesh, source)
                              : find_slices(mesh, cut, source);
    return Division(mesh, cells, source).result;
  }
} // namespace ACF
