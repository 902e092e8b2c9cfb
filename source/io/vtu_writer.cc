// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/io/vtu_writer.h>

#include <deal.II/base/data_out_base.h>

#include <sstream>

#include "vtk_arrays.h"
#include "vtk_cells.h"

namespace ACF
{
  using Vtk::data_array;

  namespace
  {
    // Points and cells of a piece, which do not depend on time.
    std::string
    geometry(const BodyDiscretization &body,
             const NodalVector &initial_positions)
    {
      const Vtk::Cells cells = Vtk::cells_of(body);
      std::vector<std::int64_t> offsets;
      offsets.reserve(cells.n_cells);
      for (unsigned int c = 1; c <= cells.n_cells; ++c)
        offsets.push_back(std::int64_t(c) * cells.n_nodes_per_cell);

      return "<Points>\n" +
             data_array<double>("Points", dim, initial_positions) +
             "</Points>\n<Cells>\n" +
             data_array("connectivity", 1, cells.nodes) +
             data_array("offsets", 1, offsets) +
             data_array("types",
                        1,
                        std::vector<std::uint8_t>(cells.n_cells, cells.type)) +
             "</Cells>\n";
    }



    // Those of the fields that are at one place, of a body.
    std::string
    field_arrays(const std::vector<OutputField> &fields,
                 const FieldKind::Place place,
                 const unsigned int body)
    {
      std::string content;
      for (const auto &[kind, values] : fields)
        if (kind.place == place)
          content +=
            kind.double_precision
              ? data_array(kind.name, kind.n_components, values[body])
              : data_array<float>(kind.name, kind.n_components, values[body]);
      return content;
    }
  } // namespace



  VtuWriter::VtuWriter(const MultibodySystem &system,
                       const SystemVector &points,
                       const std::filesystem::path &directory,
                       const std::string &list)
    : system(system)
    , directory(directory)
    , list(list)
  {
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const BodyDiscretization &body = system.bodies()[b].discretization();
        geometries.push_back(geometry(body, points[b]));
        indices.push_back(
          data_array("body",
                     1,
                     std::vector<std::int32_t>(
                       body.mesh().triangulation().n_active_cells(), b)));
      }
  }



  void
  VtuWriter::write(const std::string &name,
                   const std::vector<OutputField> &fields,
                   const double time)
  {
    std::string content = Vtk::file_begin();
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const BodyDiscretization &body = system.bodies()[b].discretization();
        content +=
          "<Piece NumberOfPoints=\"" + std::to_string(body.n_nodes()) +
          "\" NumberOfCells=\"" +
          std::to_string(body.mesh().triangulation().n_active_cells()) +
          "\">\n<PointData Vectors=\"" + fields[0].kind.name + "\">\n";
        content += field_arrays(fields, FieldKind::Place::nodes, b);
        content += "</PointData>\n" + geometries[b] +
                   "<CellData Scalars=\"body\">\n" + indices[b];
        content += field_arrays(fields, FieldKind::Place::cells, b);
        content += "</CellData>\n</Piece>\n";
      }
    content += Vtk::file_end();
    write_file(directory / (name + ".vtu"), content);

    times_and_names.emplace_back(time, name + ".vtu");
    try
      {
        write_list();
      }
    catch (const SimulationError &)
      {
        // so that the same state can be written again later
        times_and_names.pop_back();
        throw;
      }
  }



  void
  VtuWriter::write_list() const
  {
    std::ostringstream record;
    DataOutBase::write_pvd_record(record, times_and_names);
    write_file(directory / list, record.str());
  }



  void
  VtuWriter::exchange(Archive &archive)
  {
    std::vector<double> times;
    std::vector<std::string> names;
    for (const auto &[time, name] : times_and_names)
      {
        times.push_back(time);
        names.push_back(name);
      }
    archive("times", times);
    archive("names", names);
    if (!archive.is_loading())
      return;
    times_and_names.clear();
    for (unsigned int k = 0; k < times.size(); ++k)
      if (std::filesystem::exists(directory / names.at(k)))
        times_and_names.emplace_back(times[k], names[k]);
    write_list();
  }
} // namespace ACF
