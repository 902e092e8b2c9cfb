// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_probes_h
#define acf_io_probes_h

#include <acf/time/time_loop.h>

#include <filesystem>
#include <fstream>
#include <memory>

namespace ACF
{
  /** What a model file says of a probe. */
  struct ProbeParameters
  {
    std::string name;

    /** See add_parameters(). */
    std::string type = "mean position";

    /** "BODY: SURFACE", "BODY" or "JOINT", depending on the type. */
    std::string of;

    /** Ends of a chord, "BODY: SURFACE". */
    std::string from;
    std::string to;

    /** Material point in the coordinates of the mesh, m. */
    std::vector<double> point;

    /** World axis about which the angle of a chord is measured: x, y, z. */
    std::string axis = "x";

    /** Components of a vector that are written: some of x, y, z; empty: all. */
    std::vector<std::string> selected;

    /** Whether a reaction is written in the axes of its joint. */
    bool in_joint_axes = false;

    void
    add_parameters(ParameterHandler &prm);

    /** @throws InputError for values that the patterns cannot exclude */
    void
    check() const;

    std::string
    section() const
    {
      return "Probes/" + name;
    }
  };



  /** A quantity of the system with one or several named numbers. */
  class Probe
  {
  public:
    virtual ~Probe() = default;

    /** Names and units of the numbers, "angle [rad]". */
    virtual std::vector<std::string>
    columns() const = 0;

    /** The numbers; called with increasing times. */
    virtual std::vector<double>
    evaluate(const SystemState &state) = 0;
  };

  /**
   * @throws InputError naming bodies, surfaces, joints or points that do not
   * exist
   */
  std::unique_ptr<Probe>
  make_probe(const ProbeParameters &parameters, const MultibodySystem &system);



  /**
   * Writes all probes to a file of comma-separated values, `probes.csv`: a
   * header "time [s],PROBE.QUANTITY [UNIT],..." and one line per observation,
   * which is complete on the disk's side of the program when observe() returns.
   */
  class ProbeOutput : public Observer
  {
  public:
    /**
     * @throws SimulationError if the file cannot be written
     */
    ProbeOutput(const MultibodySystem &system,
                const std::vector<ProbeParameters> &parameters,
                const double interval,
                const std::filesystem::path &directory,
                Statistics &statistics);

    void
    observe(const SystemState &state) override;

  private:
    void
    write_line(const std::string &line);

    std::vector<std::unique_ptr<Probe>> probes;
    std::filesystem::path file;
    std::ofstream stream;
    Statistics &statistics;
  };
} // namespace ACF

#endif
