// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_recorded_run_h
#define acf_tests_recorded_run_h

#include <acf/base/console.h>
#include <acf/io/probes.h>
#include <acf/model.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace Tests
{
  using namespace ACF;

  /** Keeps all states, and the values of the probes of a model at them. */
  class Recorder : public Observer
  {
  public:
    Recorder(const MultibodySystem &system,
             const std::vector<ProbeParameters> &parameters,
             const double interval)
      : Observer(interval)
    {
      for (const ProbeParameters &probe : parameters)
        probes.push_back(make_probe(probe, system));
    }

    void
    observe(const SystemState &state) override
    {
      states.push_back(state);
      values.emplace_back();
      for (const auto &probe : probes)
        for (const double value : probe->evaluate(state))
          values.back().push_back(value);
    }

    std::vector<SystemState> states;
    std::vector<std::vector<double>> values;

  private:
    std::vector<std::unique_ptr<Probe>> probes;
  };

  /** A model file without files: its system, its run and what was recorded. */
  class RecordedRun
  {
  public:
    /** @param interval between two recorded states, s */
    RecordedRun(const ParameterFile &file, const double interval)
      : model(read_model(file))
      , system(model.system, model.directory)
      , recorder(system, model.probes, interval)
    {}

    RecordedRun(const std::string &model_file,
                const double interval,
                const std::vector<std::string> &overrides = {})
      : RecordedRun(ParameterFile::from_text(model_file, overrides), interval)
    {}

    void
    run()
    {
      std::ostringstream nowhere;
      Progress progress(nowhere, false, model.time.end_time);
      FactorizationCache cache(statistics);
      const SystemState start = initial_state(system,
                                              model.start,
                                              model.time.first_step(),
                                              cache,
                                              statistics,
                                              nowhere);
      run_time_loop(
        system, start, model.time, {&recorder}, progress, statistics);
    }

    const SystemState &
    last() const
    {
      return recorder.states.back();
    }

    Model model;
    const MultibodySystem system;
    Recorder recorder;
    Statistics statistics;
  };

  /** Root mean square difference of nodal vectors of the first body. */
  inline double
  nodal_difference(const NodalVector &a, const NodalVector &b)
  {
    NodalVector difference(a);
    difference -= b;
    return difference.l2_norm() / std::sqrt(1. * a.size());
  }

  /** Slope of log(error) against log(step size), by halved steps. */
  inline std::vector<double>
  orders(const std::vector<double> &errors)
  {
    std::vector<double> result;
    for (unsigned int k = 1; k < errors.size(); ++k)
      result.push_back(std::log2(errors[k - 1] / errors[k]));
    return result;
  }
} // namespace Tests

#endif
