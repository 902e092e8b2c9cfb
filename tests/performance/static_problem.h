// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_static_problem_h
#define acf_tests_static_problem_h

#include <acf/base/exceptions.h>
#include <acf/mechanics/accuracy.h>

#include <functional>
#include <iostream>
#include <optional>

#include "recorded_run.h"

/** Static problems of one body whose errors are studied. */
namespace Tests
{
  const double youngs_modulus = 1e9; // Pa
  const double density        = 1e3; // kg/m^3

  inline std::string
  number(const double value)
  {
    std::ostringstream stream;
    stream.precision(17);
    stream << value;
    return stream.str();
  }

  /** A body that one surface holds, and its load. */
  struct Problem
  {
    /** Entries of the body. */
    std::string mesh;

    /** Surface whose mean position and mean rotation are fixed. */
    std::string held;

    /** Entries of the load. */
    std::string load;

    std::string element   = "hexahedron";
    double poissons_ratio = 0.3;
    std::string strain    = "reduced";
  };

  inline std::string
  model_file(const Problem &problem)
  {
    return "subsection Bodies\n set Names = body\n subsection body\n" +
           problem.mesh + "\n  set Element = " + problem.element +
           "\n  set Young's modulus = " + number(youngs_modulus) +
           "\n  set Poisson's ratio = " + number(problem.poissons_ratio) +
           "\n  set Density = " + number(density) +
           "\n  set Strain = " + problem.strain +
           "\n end\nend\nsubsection Joints\n set Names = clamp\n"
           " subsection clamp\n  set Type = fixed\n  set Between = body: " +
           problem.held +
           ", ground\n end\nend\nsubsection Loads\n set Names = load\n"
           " subsection load\n" +
           problem.load +
           "\n end\nend\nsubsection Start\n set Equilibrium = true\nend\n";
  }

  /** The static equilibrium of a problem, or that there is none. */
  class Solution
  {
  public:
    explicit Solution(const Problem &problem)
      : run(model_file(problem), 1.)
    {
      std::ostringstream log;
      FactorizationCache cache(run.statistics);
      try
        {
          state = initial_state(
            run.system, run.model.start, 0, cache, run.statistics, log);
          found = true;
        }
      catch (const SimulationError &)
        {
          state = run.system.initial_state();
        }
    }

    const Body &
    body() const
    {
      return run.system.bodies()[0];
    }

    /** J; under small loads in proportion to the compliance. */
    double
    energy() const
    {
      return run.system.energy(state).elastic;
    }

    /** Mean displacement of a surface, m. */
    Vector3
    displacement(const std::string &surface) const
    {
      const NodalFunctional &mean = body().reference().mean(
        body().discretization().mesh().surface(surface, "", ""));
      return mean(state.positions[0]) - mean(body().placement());
    }

    RecordedRun run;
    SystemState state;
    bool found = false;
  };



  /** What is measured of a problem; not a number where nothing is found. */
  struct Figures
  {
    Figures(
      const Solution &solution,
      const double error,
      const double second_error = std::numeric_limits<double>::quiet_NaN())
      : error(solution.found ? error : std::numeric_limits<double>::quiet_NaN())
      , second_error(second_error)
      , accuracy(body_accuracy(solution.body()))
      , n_unknowns(solution.body().operators().n_unknowns())
      , n_iterations(solution.run.statistics.equilibrium_iterations)
      , backward_error(solution.run.statistics.factor_backward_error)
    {}

    /** Of displacements or of the compliance; relative. */
    double error;

    /** Of another quantity, if the problem has one. */
    double second_error;

    BodyAccuracy accuracy;
    unsigned int n_unknowns;

    /** See Statistics. */
    unsigned long n_iterations;
    double backward_error;
  };

  inline void
  print_header()
  {
    std::cout << "problem,element,cells,Poisson's ratio,unknowns,elongation,"
                 "round-off,error,relative to the first,second error,relative "
                 "to the first,iterations,backward error"
              << std::endl;
    std::cout.precision(5);
  }

  /**
   * Measures and prints for several ratios of Poisson.
   * @param bound of the error for the first of them
   * @param growth bound of the other errors relative to it
   * @return whether the bounds hold
   */
  inline bool
  print(const std::string &name,
        const std::vector<double> &poissons_ratios,
        const double bound,
        const double growth,
        const std::function<Figures(double)> &measure)
  {
    bool success = true;
    std::optional<Figures> first;
    for (const double nu : poissons_ratios)
      {
        const Figures found = measure(nu);
        if (!first)
          first = found;
        std::cout << name << ',' << nu << ',' << found.n_unknowns << ','
                  << found.accuracy.elongation << ','
                  << found.accuracy.round_off << ',' << found.error << ','
                  << found.error / first->error << ',' << found.second_error
                  << ',' << found.second_error / first->second_error << ','
                  << found.n_iterations << ',' << found.backward_error
                  << std::endl;
        // without a bound also not-a-number will do
        success = success &&
                  (std::isinf(bound) || std::abs(first->error) <= bound) &&
                  (std::isinf(growth) ||
                   std::abs(found.error) <= growth * std::abs(first->error));
      }
    if (!success)
      std::cerr << name << ": an error is larger than its bound" << std::endl;
    return success;
  }
} // namespace Tests

#endif
