// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_field_output_h
#define acf_io_field_output_h

#include <acf/base/statistics.h>
#include <acf/io/field_writer.h>
#include <acf/mechanics/multibody_system.h>
#include <acf/time/time_loop.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace ACF
{
  /** What a model file says of the output for ParaView. */
  struct FieldOutputParameters
  {
    enum class Format
    {
      vtu,
      xdmf
    };

    /** Of the files with fields; those with modes are VTU files. */
    Format format = Format::vtu;

    /** Time between files, s; 0: no files. */
    double interval = 0;

    /** What the files contain besides displacements, see add_parameters(). */
    std::vector<std::string> fields = {"velocity"};

    bool
    contain(const std::string &field) const;

    /** Declares the entries in the current subsection. */
    void
    add_parameters(ParameterHandler &prm);
  };



  /**
   * The largest von Mises stress at each node since the start, Pa, after every
   * step.
   */
  class StressPeaks : public Observer
  {
  public:
    /** @param system, statistics live longer than this object */
    StressPeaks(const MultibodySystem &system, Statistics &statistics);

    void
    observe(const SystemState &state) override;

    /** The same with stresses that are known. */
    void
    include(const unsigned int body, const std::vector<double> &stresses);

    /** Of all nodes of a body. */
    const std::vector<double> &
    of(const unsigned int body) const
    {
      return peaks[body];
    }

    std::string
    name() const override
    {
      return "stress peaks";
    }

    void
    exchange(Archive &archive) override;

  private:
    const MultibodySystem &system;
    Statistics &statistics;
    std::vector<std::vector<double>> peaks;
  };



  /**
   * Writes `solution-000000.vtu`, `solution-000001.vtu`, ... with all bodies,
   * and `solution.pvd` with the times of these files; or, as the parameters
   * say, `solution-000000.h5`, ..., `solution-mesh.h5` and `solution.xdmf`, see
   * VtuWriter and XdmfWriter.
   *
   * The points are the positions at the start; warped by `displacement` (m)
   * they are those at the file's time. Other values are those that the
   * parameters ask for:
   * - velocity: `velocity` (m/s);
   * - von Mises stress: `von_mises_stress` (Pa) of the stresses that are
   *   averaged at the nodes, and in cells `largest_von_mises_stress` (Pa) of
   *   those that are not;
   * - peak von Mises stress: `peak_von_mises_stress` (Pa), see StressPeaks;
   * - stress: `stress` (Pa), averaged at the nodes, and in cells `cell_stress`,
   *   their means; xx, yy, zz, xy, yz, xz in the axes of the world;
   * - strain: `strain`, in the same way;
   * - joint forces: `joint_force` (N), how the reactions are spread over the
   *   nodes of surfaces, see MultibodySystem::add_joint_forces().
   *
   * Stresses and strains see StressEvaluation. Points and displacements have
   * double precision, so that small strains survive large displacements; the
   * rest is single.
   */
  class FieldOutput : public Observer
  {
  public:
    /**
     * @param system lives longer than this object
     * @param directory where to write; exists
     * @param peaks lives longer than this object; not null if the parameters
     * ask for peaks
     * @param statistics counts files and stress evaluations; lives longer than
     * this object
     * @pre parameters.interval > 0
     */
    FieldOutput(const MultibodySystem &system,
                const std::filesystem::path &directory,
                const FieldOutputParameters &parameters,
                StressPeaks *peaks,
                Statistics &statistics);

    /**
     * @throws SimulationError if a file cannot be written, or a stress is asked
     * for of a body that has no rotation
     */
    void
    observe(const SystemState &state) override;

    std::string
    name() const override
    {
      return parameters.format == FieldOutputParameters::Format::xdmf ? "xdmf"
                                                                      : "vtu";
    }

    /**
     * Saves or loads; files that were written later are no entries of the list
     * any more.
     */
    void
    exchange(Archive &archive) override;

  private:
    /** Adds the stresses and strains that are asked for. */
    void
    add_stress_fields(const SystemState &state,
                      std::vector<OutputField> &fields);

    const MultibodySystem &system;
    const FieldOutputParameters parameters;
    StressPeaks *const peaks;
    Statistics &statistics;

    /** Of each body: nodal positions at the start, m. */
    const SystemVector initial_positions;

    const std::unique_ptr<FieldWriter> writer;
    unsigned int n_files = 0;
  };
} // namespace ACF

#endif
