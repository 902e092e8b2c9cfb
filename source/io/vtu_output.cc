// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/io/vtu_output.h>
#include <acf/mechanics/reduced_strain.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/utilities.h>

#include <deal.II/fe/fe_values.h>

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



    // Everything of a piece that does not depend on time.
    std::string
    geometry(const BodyDiscretization &body,
             const NodalVector &initial_positions,
             const unsigned int index)
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
             "</Cells>\n<CellData Scalars=\"body\">\n" +
             data_array("body", 1, std::vector<std::int32_t>(n_cells, index)) +
             "</CellData>\n";
    }



    // Stress tensors at the nodes, averaged over the cells.
    std::vector<SymmetricTensor<2, dim>>
    nodal_stresses(const Body &body, const NodalVector &q)
    {
      const BodyDiscretization &space = body.discretization();
      const double lambda             = body.material().lambda();
      const double mu                 = body.material().mu();
      const bool is_reduced = body.strain_measure() == StrainMeasure::reduced;

      FEValues<dim> values(space.mesh().mapping(),
                           space.scalar_element(),
                           Quadrature<dim>(
                             space.scalar_element().get_unit_support_points()),
                           update_gradients);
      std::vector<unsigned int> nodes(values.dofs_per_cell);
      std::vector<unsigned int> n_cells(space.n_nodes(), 0);
      std::vector<SymmetricTensor<2, dim>> stresses(space.n_nodes());

      for (const auto &cell : space.dof_handler().active_cell_iterators())
        {
          values.reinit(
            typename Triangulation<dim>::active_cell_iterator(cell));
          space.get_nodes(cell, nodes);
          for (const unsigned int point : values.quadrature_point_indices())
            {
              Matrix3 gradient;
              for (const unsigned int i : values.dof_indices())
                for (unsigned int c = 0; c < dim; ++c)
                  gradient[c] +=
                    q[dim * nodes[i] + c] * values.shape_grad(i, point);
              SymmetricTensor<2, dim> strain = symmetrize(gradient);
              if (!is_reduced)
                strain += 0.5 * symmetrize(transpose(gradient) * gradient);
              SymmetricTensor<2, dim> stress =
                lambda * trace(strain) * unit_symmetric_tensor<dim>() +
                2 * mu * strain;
              if (!is_reduced)
                {
                  const Matrix3 F =
                    gradient + Matrix3(unit_symmetric_tensor<dim>());
                  stress = symmetrize(F * Matrix3(stress) * transpose(F)) /
                           determinant(F);
                }
              stresses[nodes[point]] += stress;
              ++n_cells[nodes[point]];
            }
        }
      for (unsigned int a = 0; a < space.n_nodes(); ++a)
        stresses[a] /= n_cells[a];
      return stresses;
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
    prm.add_parameter("VTU stress",
                      stress,
                      "Whether the files for ParaView contain the von Mises "
                      "stress. Units: none.");
  }



  std::optional<std::vector<double>>
  von_mises_stress(const Body &body, const NodalVector &positions)
  {
    const std::optional<BodyRotation> frame =
      body_rotation(mean_deformation_gradient(body.operators(), positions),
                    body.rotation_measure());
    if (!frame)
      return {};

    NodalVector q(positions.size());
    co_rotated_displacement(body.operators(), positions, frame->rotation, q);
    std::vector<double> result;
    result.reserve(body.operators().n_nodes);
    for (const SymmetricTensor<2, dim> &stress : nodal_stresses(body, q))
      result.push_back(std::sqrt(1.5) * deviator(stress).norm());
    return result;
  }



  VtuWriter::VtuWriter(const MultibodySystem &system,
                       const SystemVector &points,
                       const std::filesystem::path &directory)
    : system(system)
    , directory(directory)
  {
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      geometries.push_back(
        geometry(system.bodies()[b].discretization(), points[b], b));
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
        for (const VtuField &field : fields)
          content +=
            field.double_precision
              ? data_array(field.name, field.n_components, field.values[b])
              : data_array<float>(field.name,
                                  field.n_components,
                                  field.values[b]);
        content += "</PointData>\n" + geometries[b] + "</Piece>\n";
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



  VtuOutput::VtuOutput(const MultibodySystem &system,
                       const std::filesystem::path &directory,
                       const VtuParameters &parameters,
                       Statistics &statistics)
    : Observer(parameters.interval)
    , system(system)
    , stress(parameters.stress)
    , statistics(statistics)
    , initial_positions(positions_of_model(system))
    , writer(system, initial_positions, directory)
  {
    Assert(parameters.interval > 0,
           ExcMessage("Without an interval there are no VTU files."));
  }



  void
  VtuOutput::observe(const SystemState &state)
  {
    std::vector<VtuField> fields = {{"displacement", dim, true, {}},
                                    {"velocity", dim, false, {}}};
    if (stress)
      fields.push_back({"von_mises_stress", 1, false, {}});
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        NodalVector displacement = state.positions[b];
        displacement -= initial_positions[b];
        fields[0].values.emplace_back(displacement.begin(), displacement.end());
        fields[1].values.emplace_back(state.velocities[b].begin(),
                                      state.velocities[b].end());
        if (!stress)
          continue;
        const Body &body = system.bodies()[b];
        auto values      = von_mises_stress(body, state.positions[b]);
        if (!values)
          throw SimulationError("The body '" + body.name() + "' at time " +
                                format_number(state.time) +
                                " s is so deformed that it has no rotation; "
                                "its stress cannot be evaluated.");
        fields[2].values.push_back(std::move(*values));
        ++statistics.stress_evaluations;
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
