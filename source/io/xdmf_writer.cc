// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/base/hdf5_image.h>
#include <acf/io/xdmf_writer.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <sstream>
#include <type_traits>

#include "vtk_cells.h"

namespace ACF
{
  namespace
  {
    std::string
    group_of(const unsigned int body)
    {
      return "body" + std::to_string(body);
    }



    template <typename Number>
    const H5::PredType &
    type_of()
    {
      if constexpr (std::is_same<Number, double>::value)
        return H5::PredType::NATIVE_DOUBLE;
      else if constexpr (std::is_same<Number, float>::value)
        return H5::PredType::NATIVE_FLOAT;
      else
        {
          static_assert(std::is_same<Number, std::int32_t>::value);
          return H5::PredType::NATIVE_INT32;
        }
    }



    // Rows of values, compressed as those of VTU files are.
    template <typename Number, typename Values>
    void
    write_array(const H5::Group &group,
                const std::string &name,
                const unsigned int n_components,
                const Values &values)
    {
      const std::vector<Number> numbers(values.begin(), values.end());
      const std::array<hsize_t, 2> size = {
        {numbers.size() / n_components, n_components}};
      H5::DSetCreatPropList properties;
      properties.setChunk(size.size(), size.data());
      if (H5Zfilter_avail(H5Z_FILTER_SHUFFLE) > 0)
        properties.setShuffle();
      if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0)
        properties.setDeflate(1);
      // no time of creation: the same results shall be the same bytes
      H5Pset_obj_track_times(properties.getId(), false);
      group
        .createDataSet(name,
                       type_of<Number>(),
                       H5::DataSpace(size.size(), size.data()),
                       properties)
        .write(numbers.data(), type_of<Number>());
    }



    std::string
    escaped(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        if (c == '&')
          result += "&amp;";
        else if (c == '<')
          result += "&lt;";
        else if (c == '>')
          result += "&gt;";
        else if (c == '"')
          result += "&quot;";
        else
          result += c;
      return result;
    }



    // Where an array is, and what it contains.
    std::string
    data_item(const std::string &file,
              const unsigned int body,
              const std::string &array,
              const unsigned int n_rows,
              const unsigned int n_components,
              const std::string &number_type,
              const unsigned int precision)
    {
      return "<DataItem Dimensions=\"" + std::to_string(n_rows) + " " +
             std::to_string(n_components) + "\" NumberType=\"" + number_type +
             "\" Precision=\"" + std::to_string(precision) +
             "\" Format=\"HDF\">" + file + ":/" + group_of(body) + "/" + array +
             "</DataItem>";
    }



    std::string
    attribute(const FieldKind &kind, const std::string &data)
    {
      // six components are no Tensor6 here, whose order is another one
      const char *const type = kind.n_components == 1     ? "Scalar"
                               : kind.n_components == dim ? "Vector"
                                                          : "Matrix";
      return "<Attribute Name=\"" + kind.name + "\" AttributeType=\"" + type +
             "\" Center=\"" +
             (kind.place == FieldKind::Place::nodes ? "Node" : "Cell") + "\">" +
             data + "</Attribute>\n";
    }



    // Points, cells and the index of the body, which do not depend on time.
    std::string
    geometry(const BodyDiscretization &body,
             const unsigned int index,
             const std::string &mesh)
    {
      const Vtk::Cells cells = Vtk::cells_of(body);
      return std::string("<Topology TopologyType=\"") +
             (body.mesh().is_simplex() ? "Tetrahedron_10" : "Hexahedron_27") +
             "\" NumberOfElements=\"" + std::to_string(cells.n_cells) + "\">" +
             data_item(mesh,
                       index,
                       "cells",
                       cells.n_cells,
                       cells.n_nodes_per_cell,
                       "Int",
                       4) +
             "</Topology>\n<Geometry GeometryType=\"XYZ\">" +
             data_item(mesh, index, "points", body.n_nodes(), dim, "Float", 8) +
             "</Geometry>\n" +
             attribute(
               {"body", 1, false, FieldKind::Place::cells},
               data_item(mesh, index, "body", cells.n_cells, 1, "Int", 4));
    }
  } // namespace



  XdmfWriter::XdmfWriter(const MultibodySystem &system,
                         const SystemVector &points,
                         const std::filesystem::path &directory,
                         const std::string &name)
    : system(system)
    , points(points)
    , directory(directory)
    , name(name)
  {
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      geometries.push_back(
        geometry(system.bodies()[b].discretization(), b, name + "-mesh.h5"));
  }



  void
  XdmfWriter::write(const std::string &file_name,
                    const std::vector<OutputField> &fields,
                    const double time)
  {
    if (!mesh_is_written)
      write_mesh();
    mesh_is_written = true;

    const std::filesystem::path file = directory / (file_name + ".h5");
    write_file(file,
               hdf5_image(
                 file,
                 [&](H5::H5File &h5) {
                   for (unsigned int b = 0; b < system.bodies().size(); ++b)
                     {
                       const H5::Group group = h5.createGroup(group_of(b));
                       for (const auto &[kind, values] : fields)
                         if (kind.double_precision)
                           write_array<double>(group,
                                               kind.name,
                                               kind.n_components,
                                               values[b]);
                         else
                           write_array<float>(group,
                                              kind.name,
                                              kind.n_components,
                                              values[b]);
                     }
                 },
                 true));

    std::vector<FieldKind> layout;
    for (const OutputField &field : fields)
      layout.push_back(field.kind);
    if (layouts.empty() || !(layouts.back() == layout))
      layouts.push_back(layout);
    entries.push_back(
      {time, file.filename().string(), unsigned(layouts.size() - 1)});
    const std::size_t n_characters = descriptions.size();
    descriptions += description(entries.back());
    try
      {
        write_list();
      }
    catch (const SimulationError &)
      {
        // so that the same state can be written again later
        entries.pop_back();
        descriptions.resize(n_characters);
        throw;
      }
  }



  void
  XdmfWriter::write_mesh() const
  {
    const std::filesystem::path file = directory / (name + "-mesh.h5");
    const auto fill                  = [&](H5::H5File &h5) {
      for (unsigned int b = 0; b < system.bodies().size(); ++b)
        {
          const Vtk::Cells cells =
            Vtk::cells_of(system.bodies()[b].discretization());
          const H5::Group group = h5.createGroup(group_of(b));
          write_array<double>(group, "points", dim, points[b]);
          write_array<std::int32_t>(group,
                                    "cells",
                                    cells.n_nodes_per_cell,
                                    cells.nodes);
          write_array<std::int32_t>(
            group, "body", 1, std::vector<std::int32_t>(cells.n_cells, b));
        }
    };
    write_file(file, hdf5_image(file, fill, true));
  }



  std::string
  XdmfWriter::description(const Entry &entry) const
  {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << "<Grid Name=\"bodies\" GridType=\"Collection\" "
            "CollectionType=\"Spatial\">\n<Time Value=\""
         << entry.time << "\"/>\n";
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const BodyDiscretization &body = system.bodies()[b].discretization();
        text << "<Grid Name=\"" << escaped(system.bodies()[b].name())
             << "\" GridType=\"Uniform\">\n"
             << geometries[b];
        for (const FieldKind &kind : layouts[entry.layout])
          text << attribute(
            kind,
            data_item(entry.file,
                      b,
                      kind.name,
                      kind.place == FieldKind::Place::nodes
                        ? body.n_nodes()
                        : body.mesh().triangulation().n_active_cells(),
                      kind.n_components,
                      "Float",
                      kind.double_precision ? 8 : 4));
        text << "</Grid>\n";
      }
    text << "</Grid>\n";
    return text.str();
  }



  void
  XdmfWriter::write_list() const
  {
    write_file(directory / (name + ".xdmf"),
               "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
               "<Grid Name=\"" +
                 name +
                 "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" +
                 descriptions + "</Grid>\n</Domain>\n</Xdmf>\n");
  }



  void
  XdmfWriter::exchange(Archive &archive)
  {
    std::vector<double> times;
    std::vector<std::string> files;
    std::vector<unsigned int> layout_indices;
    for (const Entry &entry : entries)
      {
        times.push_back(entry.time);
        files.push_back(entry.file);
        layout_indices.push_back(entry.layout);
      }
    archive("times", times);
    archive("names", files);
    archive("layouts", layouts);
    archive("layout indices", layout_indices);
    if (!archive.is_loading())
      return;
    entries.clear();
    descriptions.clear();
    for (unsigned int k = 0; k < times.size(); ++k)
      if (std::filesystem::exists(directory / files.at(k)))
        {
          entries.push_back({times[k], files[k], layout_indices.at(k)});
          descriptions += description(entries.back());
        }
    if (!mesh_is_written)
      write_mesh();
    mesh_is_written = true;
    write_list();
  }
} // namespace ACF
