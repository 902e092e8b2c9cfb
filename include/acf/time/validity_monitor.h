// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_time_validity_monitor_h
#define acf_time_validity_monitor_h

#include <acf/mechanics/strain_validity.h>
#include <acf/time/time_loop.h>

#include <iosfwd>
#include <map>

namespace ACF
{
  /** What a model file says of the assumption of the strain. */
  struct ValidityParameters
  {
    enum class Action
    {
      warn,
      stop,
      ignore
    };

    Action action = Action::warn;

    /** Limits of the figures; zero: none. */
    StrainValidity limits{0.02, 0.1, 0, 0.1, 0, 0.1};

    /** Declares the entries in the current subsection. */
    void
    add_parameters(ParameterHandler &prm);
  };



  /**
   * Watches whether the bodies keep to the assumption of their strain: at the
   * start, at ends of steps that are at least a 100th of the simulated time
   * apart, and at the end. What swings faster is seen by chance only.
   *
   * Says once for each body when it has passed a limit, or ends the simulation.
   */
  class ValidityMonitor : public Observer
  {
  public:
    /** The largest value of a figure, and when it was found. */
    struct Maximum
    {
      double value = 0;
      double time  = 0;

      void
      exchange(Archive &archive);
    };

    /**
     * @param system lives longer than this object
     * @param end_time of the simulation, s
     * @param warnings where they go; lives longer than this object
     * @param statistics counts the checks; lives longer than this object
     */
    ValidityMonitor(const MultibodySystem &system,
                    const ValidityParameters &parameters,
                    const double end_time,
                    std::ostream &warnings,
                    Statistics &statistics);

    /** @throws SimulationError if a body passes a limit and that is asked for
     */
    void
    observe(const SystemState &state) override;

    std::string
    name() const override
    {
      return "validity";
    }

    void
    exchange(Archive &archive) override;

    /** Names of the figures as in the model file, with units in statistics. */
    static const std::vector<std::string> &
    names();

    /** Maxima of a body in the order of names(). */
    const std::vector<Maximum> &
    maxima(const unsigned int body) const
    {
      return bodies[body].maxima;
    }

    /** Prints one line for each body that has passed a limit, or one for all.
     */
    void
    describe(std::ostream &stream) const;

  private:
    struct Record
    {
      std::vector<Maximum> maxima;
      bool has_left  = false;
      double left_at = 0;

      void
      exchange(Archive &archive);
    };

    void
    check(const unsigned int body, const SystemState &state);

    const MultibodySystem &system;
    const ValidityParameters parameters;
    const double end_time;
    std::ostream &warnings;
    Statistics &statistics;
    std::vector<Record> bodies;

    /** Of each reference body; made when they are needed first. */
    std::map<const ReferenceBody *, CellGradients> gradients;

    double next_check = 0;
  };
} // namespace ACF

#endif
