// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_vtu_output_h
#define acf_io_vtu_output_h

#include <acf/base/statistics.h>
#include <acf/mechanics/multibody_system.h>
#include <acf/time/time_loop.h>

#include <filesystem>
#include <optional>
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

    /** Whether the files contain the von Mises stress. */
    bool stress = false;

    /** Declares the entries in the current subsection. */
    void
    add_parameters(ParameterHandler &prm);
  };



  /**
   * Von Mises stress at the nodes of a body, Pa:
   * \f[ \sigma_v = \sqrt{\tfrac32 s : s}, \quad
   *     s = \mathrm{dev}(\lambda\, \mathrm{tr}(\varepsilon) I +
   *                      2 \mu \varepsilon), \quad
   *     \varepsilon = \mathrm{Sym}(\nabla q) \f]
   * with the co-rotated displacement q; with the strain of Green and Lagrange E
   * that of Cauchy's stress
   * \f$(\det F)^{-1} F (\lambda\, \mathrm{tr}(E) I + 2 \mu E) F^T\f$. The
   * stress tensors of the cells at a node are averaged with equal weights
   * before $\sigma_v$ is taken.
   *
   * @param positions $x_a$, m
   * @return one value per node; nothing if the mean deformation gradient has no
   * rotation
   */
  std::optional<std::vector<double>>
  von_mises_stress(const Body &body, const NodalVector &positions);



  /** Values at the nodes of all bodies, for one file. */
  struct VtuField
  {
    std::string name;
    unsigned int n_components;
    bool double_precision;

    /** Of each body. */
    std::vector<std::vector<double>> values;
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

    /** Of each body: the XML elements that are the same in all files. */
    std::vector<std::string> geometries;

    std::vector<std::pair<double, std::string>> times_and_names;
  };



  /**
   * Writes `solution-000000.vtu`, `solution-000001.vtu`, ... with all bodies,
   * and `solution.pvd` with the times of these files.
   *
   * The points are the positions at the start; warped by `displacement` they
   * are those at the file's time. Values at points: `displacement` (m),
   * `velocity` (m/s), and if asked for `von_mises_stress` (Pa), see
   * von_mises_stress(). Points and displacements have double precision, so that
   * small strains survive large displacements; the rest is single.
   */
  class VtuOutput : public Observer
  {
  public:
    /**
     * @param system lives longer than this object
     * @param directory where to write; exists
     * @param statistics counts files and stress evaluations; lives longer than
     * this object
     * @pre parameters.interval > 0
     */
    VtuOutput(const MultibodySystem &system,
              const std::filesystem::path &directory,
              const VtuParameters &parameters,
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
    const MultibodySystem &system;
    const bool stress;
    Statistics &statistics;

    /** Of each body: nodal positions at the start, m. */
    const SystemVector initial_positions;

    VtuWriter writer;
    unsigned int n_files = 0;
  };
} // namespace ACF

#endif
