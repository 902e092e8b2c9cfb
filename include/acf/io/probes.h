// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_io_probes_h
#define acf_io_probes_h

#include <acf/base/files.h>
#include <acf/time/time_loop.h>

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

    /** Axes of a reaction or a stress: world, joint, body. */
    std::string axes = "world";

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

    /** How often evaluate() evaluates the stress of a body. */
    virtual unsigned int
    n_stress_evaluations() const
    {
      return 0;
    }

    /** Saves or loads what it remembers of earlier times. */
    virtual void
    exchange(Archive & /*archive*/)
    {}
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
   * which is with the system when observe() returns (LogFile).
   */
  class ProbeOutput : public Observer
  {
  public:
    /**
     * Writes nothing before the first observation.
     */
    ProbeOutput(const MultibodySystem &system,
                const std::vector<ProbeParameters> &parameters,
                const double interval,
                const std::filesystem::path &directory,
                Statistics &statistics);

    /** @throws SimulationError if the file cannot be written */
    void
    observe(const SystemState &state) override;

    std::string
    name() const override
    {
      return "probes";
    }

    /**
     * Saves or loads; what was written later than what is loaded is cut off. If
     * there is no file, a new one begins.
     * @throws InputError if the file is not the one that was saved
     */
    void
    exchange(Archive &archive) override;

  private:
    std::vector<std::unique_ptr<Probe>> probes;
    void
    append(const std::string &text);

    const std::filesystem::path file;
    std::string header;

    /** Null before something is written. */
    std::unique_ptr<LogFile> log;

    /** Sum (CRC-32) of what is written. */
    unsigned long sum = 0;
    Statistics &statistics;
  };
} // namespace ACF

#endif
