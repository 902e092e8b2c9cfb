// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/model.h>
#include <acf/time/time_loop.h>

#include <iostream>
using namespace ACF;

struct GreatestEnergy : Observer
{
  GreatestEnergy(const MultibodySystem &system)
    : Observer(0) // looks after every step
    , system(system)
  {}
  void
  observe(const SystemState &state) override
  {
    greatest = std::max(greatest, {system.energy(state).kinetic, state.time});
  }
  const MultibodySystem &system;
  std::pair<double, double> greatest; // J, s
};

int
main(int, char **argv)
{
  const Model model = read_model(ParameterFile(argv[1]));
  const MultibodySystem system(model.system, model.directory);
  Statistics counters;
  FactorizationCache cache(counters);
  const SystemState start = initial_state(
    system, model.start, model.time.first_step(), cache, counters, std::clog);
  GreatestEnergy energy(system);
  Progress progress(std::clog, false, model.time.end_time);
  run_time_loop(system, start, model.time, {&energy}, progress, counters);
  const auto [value, time] = energy.greatest;
  std::cout << value << " J at " << time << " s\n";
}
