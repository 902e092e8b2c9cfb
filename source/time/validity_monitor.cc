// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/archive.h>
#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/time/validity_monitor.h>

#include <deal.II/base/parameter_handler.h>

#include <array>
#include <ostream>

namespace ACF
{
  namespace
  {
    // Checks are at least this part of the simulated time apart.
    constexpr double check_interval = 1. / 100;

    // Times closer than this part of the simulated time are the same.
    constexpr double same_time = 1e-9;



    struct Figure
    {
      const char *entry;
      const char *name;
      const char *unit;
      double StrainValidity::*value;
      const char *documentation;
    };

    const std::array<Figure, 6> &
    figures()
    {
      static const std::array<Figure, 6> all = {
        {{"Strain",
          "strain",
          "",
          &StrainValidity::strain,
          "Largest principal strain that passes as small; 0: no limit. "
          "Units: none."},
         {"Rotation",
          "rotation",
          " rad",
          &StrainValidity::rotation,
          "Largest rotation of the material against the frame of the body "
          "that passes as small; 0: no limit. Units: rad."},
         {"Neglected strain",
          "neglected strain",
          "",
          &StrainValidity::neglected_strain,
          "Largest norm of the quadratic part of the Green-Lagrange strain, "
          "which the strain of the program neglects, against that of the "
          "strain; 0: no limit. Units: none."},
         {"Neglected energy",
          "neglected energy",
          "",
          &StrainValidity::neglected_energy,
          "Largest work of the stress on the neglected part of the strain "
          "against the elastic energy: how much tension or pressure changes "
          "the stiffness; 0: no limit. Units: none."},
         {"Deflection",
          "deflection",
          "",
          &StrainValidity::deflection,
          "Largest displacement in the frame of the body, each component "
          "divided by the thickness of the body along it; 0: no limit. "
          "Units: none."},
         {"Cell bending",
          "cell bending",
          "",
          &StrainValidity::cell_bending,
          "Largest bending of an edge of a cell out of its chord, divided by "
          "the thickness of the body along it; counts with the strain of Green "
          "and Lagrange; 0: no limit. Units: none."}}};
      return all;
    }



    std::string
    list_maxima(const std::vector<ValidityMonitor::Maximum> &maxima)
    {
      std::string text;
      for (unsigned int k = 0; k < maxima.size(); ++k)
        text += (k == 0 ? "" : ", ") + std::string(figures()[k].name) + " " +
                format_number(maxima[k].value) + figures()[k].unit + " at " +
                format_number(maxima[k].time) + " s";
      return text;
    }
  } // namespace



  namespace
  {
    // The strain of Green and Lagrange is limited by its material and by its
    // cells only.
    bool
    is_judged(const Body &body, const Figure &figure)
    {
      if (body.strain_measure() == StrainMeasure::reduced)
        return figure.value != &StrainValidity::cell_bending;
      return figure.value == &StrainValidity::strain ||
             figure.value == &StrainValidity::cell_bending;
    }
  } // namespace



  void
  ValidityParameters::add_parameters(ParameterHandler &prm)
  {
    prm.declare_entry(
      "Action",
      "warn",
      Patterns::Selection("warn|stop|ignore"),
      "What happens when a body passes a limit, beyond which its strain is not "
      "the one that the program computes: a warning, the end of the "
      "simulation, or nothing (and nothing is checked). Units: none.");
    prm.add_action("Action", [this](const std::string &value) {
      action = value == "warn"   ? Action::warn
               : value == "stop" ? Action::stop
                                 : Action::ignore;
    });
    for (const Figure &figure : figures())
      prm.add_parameter(figure.entry,
                        limits.*figure.value,
                        figure.documentation,
                        Patterns::Double(0));
  }



  ValidityMonitor::ValidityMonitor(const MultibodySystem &system,
                                   const ValidityParameters &parameters,
                                   const double end_time,
                                   std::ostream &warnings,
                                   Statistics &statistics)
    : Observer(0)
    , system(system)
    , parameters(parameters)
    , end_time(end_time)
    , warnings(warnings)
    , statistics(statistics)
    , bodies(system.bodies().size())
  {
    Assert(parameters.action != ValidityParameters::Action::ignore,
           ExcMessage("Nothing is to be checked."));
    for (Record &record : bodies)
      record.maxima.resize(figures().size());
  }



  const std::vector<std::string> &
  ValidityMonitor::names()
  {
    static const std::vector<std::string> all = [] {
      std::vector<std::string> names;
      for (const Figure &figure : figures())
        names.push_back(std::string(figure.name) +
                        (*figure.unit == 0 ? "" : " [rad]"));
      return names;
    }();
    return all;
  }



  void
  ValidityMonitor::observe(const SystemState &state)
  {
    const double tolerance = same_time * end_time;
    if (state.time < next_check - tolerance &&
        state.time < end_time - tolerance)
      return;
    next_check = state.time + check_interval * end_time;
    const PhaseTimer timer(statistics, "validity");
    for (unsigned int b = 0; b < bodies.size(); ++b)
      check(b, state);
  }



  void
  ValidityMonitor::check(const unsigned int b, const SystemState &state)
  {
    const Body &body = system.bodies()[b];
    const auto &its_gradients =
      gradients.try_emplace(&body.reference(), body.discretization())
        .first->second;
    const auto found = strain_validity(body, its_gradients, state.positions[b]);
    ++statistics.validity_checks;
    if (!found) // no step ends like this
      return;

    Record &record = bodies[b];
    std::string passed;
    for (unsigned int k = 0; k < figures().size(); ++k)
      {
        const Figure &figure = figures()[k];
        const double value   = (*found).*figure.value;
        const double limit =
          is_judged(body, figure) ? parameters.limits.*figure.value : 0.;
        if (value > record.maxima[k].value)
          record.maxima[k] = {value, state.time};
        if (limit > 0 && value > limit)
          passed += (passed.empty() ? "" : ", ") + std::string(figure.name) +
                    " " + format_number(value) + figure.unit + " (limit " +
                    format_number(limit) + ")";
      }
    if (passed.empty() || record.has_left)
      return;
    record.has_left = true;
    record.left_at  = state.time;

    const std::string message = "the body '" + body.name() + "' at time " +
                                format_number(state.time) +
                                " s passes the limits of its strain: " + passed;
    if (parameters.action == ValidityParameters::Action::stop)
      throw SimulationError(
        "The simulation stops, as 'Validity/Action' asks: " + message + ".");
    print_warning(warnings,
                  message + ". Its results are doubtful from here on");
  }



  void
  ValidityMonitor::describe(std::ostream &stream) const
  {
    bool all_stayed = true;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (bodies[b].has_left)
        {
          all_stayed = false;
          stream << "Validity: the body '" << system.bodies()[b].name()
                 << "' passed the limits of its strain at "
                 << format_number(bodies[b].left_at)
                 << " s; largest values: " << list_maxima(bodies[b].maxima)
                 << "\n";
        }
    if (all_stayed)
      stream
        << "Validity: all bodies stayed within the limits of their strain\n";
  }



  void
  ValidityMonitor::Maximum::exchange(Archive &archive)
  {
    archive("value", value);
    archive("time", time);
  }



  void
  ValidityMonitor::Record::exchange(Archive &archive)
  {
    archive("maxima", maxima);
    archive("has left", has_left);
    archive("left at", left_at);
  }



  void
  ValidityMonitor::exchange(Archive &archive)
  {
    Observer::exchange(archive);
    archive("next check", next_check);
    archive("bodies", bodies);
  }
} // namespace ACF
