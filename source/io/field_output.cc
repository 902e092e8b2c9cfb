// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/io/field_output.h>
#include <acf/io/vtu_writer.h>
#include <acf/io/xdmf_writer.h>
#include <acf/mechanics/stress.h>

#include <deal.II/base/utilities.h>

#include <algorithm>

namespace ACF
{
  namespace
  {
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
  FieldOutputParameters::add_parameters(ParameterHandler &prm)
  {
    prm.declare_entry("Format",
                      "VTU",
                      Patterns::Selection("VTU|XDMF"),
                      "Of the files for ParaView with the motion: 'VTU', each "
                      "with the mesh, and a list of them, solution.pvd; "
                      "'XDMF', HDF5 files with the fields only, one with the "
                      "mesh, and a list of them, solution.xdmf, which take "
                      "less space. Files of modes are VTU files. Units: none.");
    prm.add_action("Format", [this](const std::string &value) {
      format = value == "XDMF" ? Format::xdmf : Format::vtu;
    });
    prm.add_parameter("VTU interval",
                      interval,
                      "Time between two files for ParaView, in either Format; "
                      "0: no such files. Units: s.",
                      Patterns::Double(0));
    prm.add_parameter(
      "VTU fields",
      fields,
      "What the files for ParaView, in either Format, contain besides the "
      "displacement, separated "
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
  FieldOutputParameters::contain(const std::string &field) const
  {
    return std::find(fields.begin(), fields.end(), field) != fields.end();
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



    std::unique_ptr<FieldWriter>
    make_writer(const MultibodySystem &system,
                const SystemVector &points,
                const std::filesystem::path &directory,
                const FieldOutputParameters::Format format)
    {
      if (format == FieldOutputParameters::Format::xdmf)
        return std::make_unique<XdmfWriter>(system,
                                            points,
                                            directory,
                                            "solution");
      return std::make_unique<VtuWriter>(system,
                                         points,
                                         directory,
                                         "solution.pvd");
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



  FieldOutput::FieldOutput(const MultibodySystem &system,
                           const std::filesystem::path &directory,
                           const FieldOutputParameters &parameters,
                           StressPeaks *const peaks,
                           Statistics &statistics)
    : Observer(parameters.interval)
    , system(system)
    , parameters(parameters)
    , peaks(peaks)
    , statistics(statistics)
    , initial_positions(positions_of_model(system))
    , writer(
        make_writer(system, initial_positions, directory, parameters.format))
  {
    Assert(parameters.interval > 0,
           ExcMessage("Without an interval there are no files."));
    Assert(peaks != nullptr || !parameters.contain("peak von Mises stress"),
           ExcMessage("There are no peaks to be written."));
  }



  void
  FieldOutput::add_stress_fields(const SystemState &state,
                                 std::vector<OutputField> &fields)
  {
    const bool with_von_mises = parameters.contain("von Mises stress");
    const bool with_peaks     = parameters.contain("peak von Mises stress");
    const bool with_stress    = parameters.contain("stress");
    const bool with_strain    = parameters.contain("strain");
    if (!with_von_mises && !with_peaks && !with_stress && !with_strain)
      return;

    constexpr auto cells    = FieldKind::Place::cells;
    OutputField von_mises   = {{"von_mises_stress", 1, false}};
    OutputField largest     = {{"largest_von_mises_stress", 1, false, cells}};
    OutputField peak        = {{"peak_von_mises_stress", 1, false}};
    OutputField stress      = {{"stress", 6, false}};
    OutputField cell_stress = {{"cell_stress", 6, false, cells}};
    OutputField strain      = {{"strain", 6, false}};
    for (unsigned int b = 0; b < system.bodies().size(); ++b)
      {
        const StressEvaluation evaluation(system.bodies()[b],
                                          state.positions[b],
                                          state.time);
        ++statistics.stress_evaluations;
        if (with_von_mises)
          largest.values.emplace_back();
        const auto nodal_values = evaluation.nodal_values(
          with_von_mises ? &largest.values.back() : nullptr);
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
        if (with_stress)
          {
            cell_stress.values.emplace_back();
            for (const Symmetric3 &mean : evaluation.cell_means())
              append(cell_stress.values.back(), mean);
          }
      }

    const auto add = [&](const bool is_wanted, OutputField &field) {
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
  FieldOutput::observe(const SystemState &state)
  {
    std::vector<OutputField> fields = {{{"displacement", dim, true}}};
    if (parameters.contain("velocity"))
      fields.push_back({{"velocity", dim, false}});
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
        fields.push_back({{"joint_force", dim, false}});
        for (unsigned int b = 0; b < system.bodies().size(); ++b)
          {
            NodalVector force(state.positions[b].size());
            system.add_joint_forces(b, state, force);
            fields.back().values.emplace_back(force.begin(), force.end());
          }
      }
    writer->write("solution-" + Utilities::int_to_string(n_files, 6),
                  fields,
                  state.time);
    ++n_files;
    if (parameters.format == FieldOutputParameters::Format::xdmf)
      ++statistics.hdf5_files;
    else
      ++statistics.vtu_files;
  }



  void
  FieldOutput::exchange(Archive &archive)
  {
    Observer::exchange(archive);
    archive("files", n_files);
    writer->exchange(archive);
  }
} // namespace ACF
