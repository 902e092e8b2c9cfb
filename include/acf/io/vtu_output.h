// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_vtu_output_h
#define acf_io_vtu_output_h

#include <acf/base/statistics.h>
#include <acf/mechanics/multibody_system.h>
#include <acf/time/time_loop.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ACF
{
  /** What a model file says of the output for ParaView. */
  struct VtuParameters
  {
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



  /** Values at the nodes or in the cells of all bodies, for one file. */
  struct VtuField
  {
    enum class Place
    {
      nodes,
      cells
    };

    std::string name;
    unsigned int n_components;
    bool double_precision;
    Place place = Place::nodes;

    /** Of each body. */
    std::vector<std::vector<double>> values = {};
  };



  /**
   * Writes files for ParaView. A body is a piece of quadratic cells (10-node
   * tetrahedra or 27-node hexahedra) that share their nodes; the value `body`
   * of cells is its index. ParaView reads the files from version 5.10 on (VTK
   * 9.1). A file gets its name when it is complete; before that, it ends in
   * `.tmp`.
   */
  class VtuWriter
  {
  public:
    /**
     * @param points of the nodes of all bodies, m
     * @param directory where to write; exists
     */
    VtuWriter(const MultibodySystem &system,
              const SystemVector &points,
              const std::filesystem::path &directory);

    /**
     * Writes NAME.vtu with fields, the first one as the vectors that warp, and
     * makes it the last entry of a list of files with times.
     * @throws SimulationError if a file cannot be written
     */
    void
    write(const std::string &name,
          const std::vector<VtuField> &fields,
          const double time,
          const std::string &list);

    /**
     * Saves or loads the entries of the list; loaded ones count if the file is
     * there, and the list is written.
     */
    void
    exchange(Archive &archive, const std::string &list);

  private:
    void
    write_list(const std::string &list) const;

    const MultibodySystem &system;
    const std::filesystem::path directory;

    /** Of each body: the XML elements that are the same in all files, points
     * and cells, and the index of the body in each cell. */
    std::vector<std::string> geometries;
    std::vector<std::string> indices;

    std::vector<std::pair<double, std::string>> times_and_names;
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
   * and `solution.pvd` with the times of these files.
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
  class VtuOutput : public Observer
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
    VtuOutput(const MultibodySystem &system,
              const std::filesystem::path &directory,
              const VtuParameters &parameters,
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
      return "vtu";
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
    add_stress_fields(const SystemState &state, std::vector<VtuField> &fields);

    const MultibodySystem &system;
    const VtuParameters parameters;
    StressPeaks *const peaks;
    Statistics &statistics;

    /** Of each body: nodal positions at the start, m. */
    const SystemVector initial_positions;

    VtuWriter writer;
    unsigned int n_files = 0;
  };
} // namespace ACF

#endif
