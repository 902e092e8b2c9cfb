// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/files.h>
#include <acf/io/mesh_picture.h>

#include <array>
#include <cstdint>

#include "vtk_arrays.h"

namespace ACF
{
  namespace
  {
    /** Linear cells or faces of one kind. */
    class Cells
    {
    public:
      Cells(const std::uint8_t type, const std::vector<unsigned int> &order)
        : type(type)
        , order(order)
      {}

      /** A cell, by its vertices in deal.II's order. */
      template <typename Accessor>
      void
      add(const Accessor &accessor)
      {
        for (const unsigned int v : order)
          connectivity.push_back(accessor.vertex_index(v));
        offsets.push_back(connectivity.size());
      }

      /** A file of all vertices with these cells and arrays of their values. */
      void
      write(const BodyMesh &mesh,
            const std::string &values,
            const std::filesystem::path &file) const
      {
        std::vector<double> points;
        for (const Point<dim> &vertex : mesh.triangulation().get_vertices())
          for (unsigned int d = 0; d < dim; ++d)
            points.push_back(vertex[d]);
        write_file(
          file,
          Vtk::file_begin() + "<Piece NumberOfPoints=\"" +
            std::to_string(points.size() / dim) + "\" NumberOfCells=\"" +
            std::to_string(offsets.size()) + "\">\n<Points>\n" +
            Vtk::data_array("Points", dim, points) + "</Points>\n<Cells>\n" +
            Vtk::data_array("connectivity", 1, connectivity) +
            Vtk::data_array("offsets", 1, offsets) +
            Vtk::data_array("types",
                            1,
                            std::vector<std::uint8_t>(offsets.size(), type)) +
            "</Cells>\n<CellData>\n" + values + "</CellData>\n</Piece>\n" +
            Vtk::file_end());
      }

    private:
      const std::uint8_t type;
      const std::vector<unsigned int> order;
      std::vector<std::int64_t> connectivity, offsets;
    };



    // For each id: the number of the first of the names that it belongs to,
    // counted from one, and all of them.
    struct IdNames
    {
      std::map<unsigned int, std::pair<std::int32_t, std::string>> names;

      template <typename Survey>
      IdNames(const std::vector<Survey> &surveys,
              const std::map<std::string, std::set<unsigned int>> &ids)
      {
        for (unsigned int k = 0; k < surveys.size(); ++k)
          for (const unsigned int id : ids.at(surveys[k].name))
            {
              const auto [entry, is_new] =
                names.try_emplace(id, k + 1, surveys[k].name);
              if (!is_new)
                entry->second.second += ", " + surveys[k].name;
            }
      }

      void
      add(const unsigned int id)
      {
        const auto found = names.find(id);
        numbers.push_back(found != names.end() ? found->second.first : 0);
        texts.push_back(found != names.end() ? found->second.second : "");
      }

      std::string
      arrays(const std::string &name) const
      {
        return Vtk::data_array(name, 1, numbers) +
               Vtk::text_array(name + "_name", texts);
      }

      std::vector<std::int32_t> numbers;
      std::vector<std::string> texts;
    };
  } // namespace



  void
  write_surface_picture(const BodyMesh &mesh,
                        const MeshSurvey &survey,
                        const std::filesystem::path &file)
  {
    // VTK_TRIANGLE, VTK_QUAD
    Cells faces =
      mesh.is_simplex() ? Cells(5, {0, 1, 2}) : Cells(9, {0, 1, 3, 2});
    IdNames names(survey.surfaces, mesh.surfaces());
    for (const auto &face : mesh.triangulation().active_face_iterators())
      if (face->at_boundary())
        {
          faces.add(*face);
          names.add(face->boundary_id());
        }
    faces.write(mesh, names.arrays("surface"), file);
  }



  void
  write_mesh_picture(const BodyMesh &mesh,
                     const MeshSurvey &survey,
                     const std::filesystem::path &file)
  {
    // VTK_TETRA, VTK_HEXAHEDRON
    Cells cells = mesh.is_simplex() ? Cells(10, {0, 1, 2, 3})
                                    : Cells(12, {0, 1, 3, 2, 4, 5, 7, 6});
    IdNames names(survey.regions, mesh.regions());
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      {
        cells.add(*cell);
        names.add(cell->material_id());
      }
    cells.write(mesh,
                Vtk::data_array<float>("quality", 1, survey.qualities) +
                  names.arrays("region"),
                file);
  }
} // namespace ACF
