// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/io/vtu_output.h>
#include <acf/mechanics/stress.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "vtk_arrays.h"

namespace ACF
{
  using Vtk::data_array;

  namespace
  {
    /** A cell type of VTK and its nodes, in half edges of the unit cell. */
    struct VtkCell
    {
      std::uint8_t type;
      std::vector<std::array<unsigned int, dim>> nodes;
    };



    // VTK_QUADRATIC_TETRA and VTK_LAGRANGE_HEXAHEDRON: corners, edges,
    // faces (-x, +x, -y, +y, -z, +z), centre. VTK_TRIQUADRATIC_HEXAHEDRON has
    // the same order, but many versions of VTK cannot integrate over it.
    VtkCell
    vtk_cell(const bool is_simplex)
    {
      if (is_simplex)
        return {24,
                {{{0, 0, 0}},
                 {{2, 0, 0}},
                 {{0, 2, 0}},
                 {{0, 0, 2}},
                 {{1, 0, 0}},
                 {{1, 1, 0}},
                 {{0, 1, 0}},
                 {{0, 0, 1}},
                 {{1, 0, 1}},
                 {{0, 1, 1}}}};
      return {72,
              {{{0, 0, 0}}, {{2, 0, 0}}, {{2, 2, 0}}, {{0, 2, 0}}, {{0, 0, 2}},
               {{2, 0, 2}}, {{2, 2, 2}}, {{0, 2, 2}}, {{1, 0, 0}}, {{2, 1, 0}},
               {{1, 2, 0}}, {{0, 1, 0}}, {{1, 0, 2}}, {{2, 1, 2}}, {{1, 2, 2}},
               {{0, 1, 2}}, {{0, 0, 1}}, {{2, 0, 1}}, {{2, 2, 1}}, {{0, 2, 1}},
               {{0, 1, 1}}, {{2, 1, 1}}, {{1, 0, 1}}, {{1, 2, 1}}, {{1, 1, 0}},
               {{1, 1, 2}}, {{1, 1, 1}}}};
    }



    // For each node of VTK's cell, the index of the shape function that belongs
    // to it: found by its place, not to depend on deal.II's numbering.
    std::vector<unsigned int>
    shape_functions_in_vtk_order(const VtkCell &vtk,
                                 const FiniteElement<dim> &element)
    {
      const std::vector<Point<dim>> &support =
        element.get_unit_support_points();
      AssertDimension(support.size(), vtk.nodes.size());
      std::vector<unsigned int> order;
      for (const auto &node : vtk.nodes)
        {
          const Point<dim> point(node[0] / 2., node[1] / 2., node[2] / 2.);
          const auto it =
            std::find_if(support.begin(), support.end(), [&](const auto &p) {
              return p.distance(point) < 1e-6;
            });
          Assert(it != support.end(), ExcInternalError());
          order.push_back(it - support.begin());
        }
      return order;
    }



    // Points and cells of a piece, which do not depend on time.
    std::string
    geometry(const BodyDiscretization &body,
             const NodalVector &initial_positions)
    {
      const VtkCell vtk = vtk_cell(body.mesh().is_simplex());
      const std::vector<unsigned int> order =
        shape_functions_in_vtk_order(vtk, body.scalar_element());
      const unsigned int n_cells = body.mesh().triangulation().n_active_cells();

      std::vector<std::int64_t> connectivity, offsets;
      connectivity.reserve(n_cells * order.size());
      std::vector<unsigned int> nodes(order.size());
      for (const auto &cell : body.dof_handler().active_cell_iterators())
        {
          body.get_nodes(cell, nodes);
          for (const unsigned int i : order)
            connectivity.push_back(nodes[i]);
          offsets.push_back(connectivity.size());
        }

      return "<Points>\n" +
             data_array<double>("Points", dim, initial_positions) +
             "</Points>\n<Cells>\n" +
             data_array("connectivity", 1, connectivity) +
             data_array("offsets", 1, offsets) +
             data_array("types",
                        1,
                        std::vector<std::uint8_t>(n_cells, vtk.type)) +
             "</Cells>\n";
    }



    // Those of the fields that are at one place, of a body.
    std::string
    field_arrays(const std::vector<VtuField> &fields,
                 const VtuField::Place place,
                 const unsigned int body)
    {
      std::string content;
      for (const VtuField &field : fields)
        if (field.place == place)
          content +=
            field.double_precision
              ? data_array(field.name, field.n_components, field.values[body])
              : data_array<float>(field.name,
                                  field.n_components,
                                  field.values[body]);
      return content;
    }



    // The order that ParaView names XX, YY, ZZ, XY, YZ, XZ.
    void
    append(std::vector<double> &values, const Symmetric3 &tensor)
    {
      for (const auto &[i, j] :
           {std::pair<int, int>(0, 0), {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}})
        values.push_back(tensor[i][j]);
    }



    std::vector<double>
    von_mises_stresses(const std::vector<StressAndStrain> &nodal_values)
    {
      std::vector<double> result;
      result.reserve(nodal_values.size());
      for (const StressAndStrain &value : nodal_values)
        result.push_back(von_mises_stress(value.stress));
      return result;
    }
  } // namespace



  void
  VtuParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("VTU interval",
                      interval,
                      "Time between two files for ParaView; 0: no such files. "
                      "Units: s.",
                      Patterns::Double(0));
    prm.add_parameter(
      "VTU fields",
      fields,
      "What the files for ParaView contain besides the displacement, separated "
      "by ',': 'velocity'; 'von Mises stress', at nodes and its largest value "
      "in cells; 'peak von Mises stress', the largest one since the start at "
      "nodes, which needs the stress after every step; 'stress', at nodes and "
      "its mean in cells; 'strain'; 'joint forces', the forces on the nodes of "
      "surfaces of joints. Units: none.",
      Patterns::List(
        Patterns::Selection("velocity|von Mises stress|peak von Mises "
                            "stress|stress|strain|joint forces")));
  }



  bool
  VtuParameters::contain(const std::string &field) const
  {
    return std::find(fields.begin(), fields.end(), field) != fields.end();
  }



  VtuWriter::VtuWriter(const MultibodySystem &system,
                       const SystemVector &points,
                       const std::filesystem::path &directory)
    : system(system)
    , directory(directory)
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
                   const std::vector<VtuField> &fields,
                   const double time,
                   const std::string &list)
  {
    std::string content = Vtk::file_begin();
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const BodyDiscretization &body = system.bodies()[b].discretization();
        content +=
          "<Piece NumberOfPoints=\"" + std::to_string(body.n_nodes()) +
          "\" NumberOfCells=\"" +
          std::to_string(body.mesh().triangulation().n_active_cells()) +
          "\">\n<PointData Vectors=\"" + fields[0].name + "\">\n";
        content += field_arrays(fields, VtuField::Place::nodes, b);
        content += "</PointData>\n" + geometries[b] +
                   "<CellData Scalars=\"body\">\n" + indices[b];
        content += field_arrays(fields, VtuField::Place::cells, b);
        content += "</CellData>\n</Piece>\n";
      }
    content += Vtk::file_end();
    write_file(directory / (name + ".vtu"), content);

    times_and_names.emplace_back(time, name + ".vtu");
    try
      {
        write_list(list);
      }
    catch (const SimulationError &)
      {
        // so that the same state can be written again later
        times_and_names.pop_back();
        throw;
      }
  }



  void
  VtuWriter::write_list(const std::string &list) const
  {
    std::ostringstream record;
    DataOutBase::write_pvd_record(record, times_and_names);
    write_file(directory / list, record.str());
  }



  void
  VtuWriter::exchange(Archive &archive, const std::string &list)
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
    write_list(list);
  }



  namespace
  {
    SystemVector
    positions_of_model(const MultibodySystem &system)
    {
      SystemVector positions;
      for (const Body &body : system.bodies())
        positions.push_back(body.initial_positions());
      return positions;
    }
  } // namespace



  StressPeaks::StressPeaks(const MultibodySystem &system,
                           Statistics &statistics)
    : Observer(0)
    , system(system)
    , statistics(statistics)
  {
    for (const Body &body : system.bodies())
      peaks.emplace_back(body.discretization().n_nodes(), 0.);
  }



  void
  StressPeaks::observe(const SystemState &state)
  {
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const StressEvaluation evaluation(system.bodies()[b],
                                          state.positions[b],
                                          state.time);
        include(b, von_mises_stresses(evaluation.nodal_values()));
        ++statistics.stress_evaluations;
      }
  }



  void
  StressPeaks::include(const unsigned int body,
                       const std::vector<double> &stresses)
  {
    for (unsigned int a = 0; a < stresses.size(); ++a)
      peaks[body][a] = std::max(peaks[body][a], stresses[a]);
  }



  void
  StressPeaks::exchange(Archive &archive)
  {
    Observer::exchange(archive);
    for (unsigned int b = 0; b < peaks.size(); ++b)
      archive("peaks " + std::to_string(b), peaks[b]);
  }



  VtuOutput::VtuOutput(const MultibodySystem &system,
                       const std::filesystem::path &directory,
                       const VtuParameters &parameters,
                       StressPeaks *const peaks,
                       Statistics &statistics)
    : Observer(parameters.interval)
    , system(system)
    , parameters(parameters)
    , peaks(peaks)
    , statistics(statistics)
    , initial_positions(positions_of_model(system))
    , writer(system, initial_positions, directory)
  {
    Assert(parameters.interval > 0,
           ExcMessage("Without an interval there are no VTU files."));
    Assert(peaks != nullptr || !parameters.contain("peak von Mises stress"),
           ExcMessage("There are no peaks to be written."));
  }



  void
  VtuOutput::add_stress_fields(const SystemState &state,
                               std::vector<VtuField> &fields)
  {
    const bool with_von_mises = parameters.contain("von Mises stress");
    const bool with_peaks     = parameters.contain("peak von Mises stress");
    const bool with_stress    = parameters.contain("stress");
    const bool with_strain    = parameters.contain("strain");
    if (!with_von_mises && !with_peaks && !with_stress && !with_strain)
      return;

    constexpr auto cells = VtuField::Place::cells;
    VtuField von_mises   = {"von_mises_stress", 1, false};
    VtuField largest     = {"largest_von_mises_stress", 1, false, cells};
    VtuField peak        = {"peak_von_mises_stress", 1, false};
    VtuField stress      = {"stress", 6, false};
    VtuField cell_stress = {"cell_stress", 6, false, cells};
    VtuField strain      = {"strain", 6, false};
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const StressEvaluation evaluation(system.bodies()[b],
                                          state.positions[b],
                                          state.time);
        ++statistics.stress_evaluations;
        const auto nodal_values = evaluation.nodal_values();
        if (with_von_mises || with_peaks)
          von_mises.values.push_back(von_mises_stresses(nodal_values));
        if (with_peaks)
          {
            peaks->include(b, von_mises.values.back());
            peak.values.push_back(peaks->of(b));
          }
        stress.values.emplace_back();
        strain.values.emplace_back();
        for (const StressAndStrain &value : nodal_values)
          {
            if (with_stress)
              append(stress.values.back(), value.stress);
            if (with_strain)
              append(strain.values.back(), value.strain);
          }
        if (!with_von_mises && !with_stress)
          continue;
        largest.values.emplace_back();
        cell_stress.values.emplace_back();
        for (const auto &value : evaluation.cell_values())
          {
            largest.values.back().push_back(value.largest_von_mises_stress);
            append(cell_stress.values.back(), value.mean_stress);
          }
      }

    const auto add = [&](const bool is_wanted, VtuField &field) {
      if (is_wanted)
        fields.push_back(std::move(field));
    };
    add(with_von_mises, von_mises);
    add(with_von_mises, largest);
    add(with_peaks, peak);
    add(with_stress, stress);
    add(with_stress, cell_stress);
    add(with_strain, strain);
  }



  void
  VtuOutput::observe(const SystemState &state)
  {
    std::vector<VtuField> fields = {{"displacement", dim, true}};
    if (parameters.contain("velocity"))
      fields.push_back({"velocity", dim, false});
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        NodalVector displacement = state.positions[b];
        displacement -= initial_positions[b];
        fields[0].values.emplace_back(displacement.begin(), displacement.end());
        if (fields.size() > 1)
          fields[1].values.emplace_back(state.velocities[b].begin(),
                                        state.velocities[b].end());
      }
    add_stress_fields(state, fields);
    if (parameters.contain("joint forces"))
      {
        fields.push_back({"joint_force", dim, false});
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          {
            NodalVector force(state.positions[b].size());
            system.add_joint_forces(b, state, force);
            fields.back().values.emplace_back(force.begin(), force.end());
          }
      }
    writer.write("solution-" + Utilities::int_to_string(n_files, 6),
                 fields,
                 state.time,
                 "solution.pvd");
    ++n_files;
    ++statistics.vtu_files;
  }



  void
  VtuOutput::exchange(Archive &archive)
  {
    Observer::exchange(archive);
    archive("files", n_files);
    writer.exchange(archive, "solution.pvd");
  }
} // namespace ACF
