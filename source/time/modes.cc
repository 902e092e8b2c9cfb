// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/time/modes.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/parameter_handler.h>

#include <deal.II/lac/arpack_solver.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace ACF
{
  void
  ModeParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Number",
                      number,
                      "How many natural modes are computed; 0: none. "
                      "Units: none.",
                      Patterns::Integer(0, 1000));
    prm.declare_entry("At",
                      "start",
                      Patterns::Selection("start|end"),
                      "The state about which the system is linearised: at the "
                      "start (after the equilibrium, if there is one) or at "
                      "the end of the simulation. Units: none.");
    prm.add_action("At", [this](const std::string &value) {
      at_end = (value == "end");
    });
  }



  double
  Mode::angular_frequency() const
  {
    return std::copysign(std::sqrt(std::abs(eigenvalue)), eigenvalue);
  }



  double
  Mode::frequency() const
  {
    return angular_frequency() / (2 * numbers::PI);
  }



  namespace
  {
    // Largest error that a mode may have, besides round-off.
    constexpr double max_error = 1e-6;

    // Vectors of all bodies, one after the other.
    using FlatVector = Vector<double>;



    // The operators of the eigenvalue problem in flat vectors.
    class ModeOperators
    {
    public:
      ModeOperators(const MultibodySystem &system,
                    const SystemState &state,
                    Statistics &statistics)
        : shift(slow_squared_rate(system))
        , tangent(system, statistics)
        , n_constraints(system.n_constraints())
      {
        for (const Body &body : system.bodies())
          {
            source.emplace_back(body.operators().n_unknowns());
            n += body.operators().n_unknowns();
          }
        target = source;
        if (!tangent.linearize(state))
          throw SimulationError(
            "The modes at time " + format_number(state.time) +
            " s cannot be computed: body '" +
            system.bodies()[tangent.inverted_body()].name() +
            "' is turned inside out.");
        tangent.factorize(shift);
      }

      std::size_t
      size() const
      {
        return n;
      }

      void
      apply_stiffness(FlatVector &y, const FlatVector &x) const
      {
        split(x, source);
        tangent.apply_stiffness(target, source);
        join(target, y);
      }

      void
      apply_mass(FlatVector &y, const FlatVector &x) const
      {
        split(x, source);
        tangent.apply_mass(target, source);
        join(target, y);
      }

      // (K_T + sigma M)^-1 on the motions that the constraints allow
      void
      solve(FlatVector &y, const FlatVector &x) const
      {
        split(x, source);
        Eigen::VectorXd constraints = Eigen::VectorXd::Zero(n_constraints);
        tangent.solve(source, constraints);
        join(source, y);
      }

      void
      split(const FlatVector &x, SystemVector &bodies) const
      {
        auto it = x.begin();
        for (NodalVector &body : bodies)
          for (double &value : body)
            value = *it++;
      }

      const double shift;

    private:
      void
      join(const SystemVector &bodies, FlatVector &x) const
      {
        auto it = x.begin();
        for (const NodalVector &body : bodies)
          it = std::copy(body.begin(), body.end(), it);
      }

      mutable TangentSystem tangent;
      mutable SystemVector source, target;
      std::size_t n = 0;
      unsigned int n_constraints;
    };



    struct MassMatrix
    {
      void
      vmult(FlatVector &y, const FlatVector &x) const
      {
        operators.apply_mass(y, x);
      }

      const ModeOperators &operators;
    };



    struct ShiftedInverse
    {
      void
      vmult(FlatVector &y, const FlatVector &x) const
      {
        operators.solve(y, x);
      }

      const ModeOperators &operators;
    };



    // The same numbers on all machines.
    void
    fill_randomly(FlatVector &x, std::mt19937 &generator)
    {
      for (double &value : x)
        value = generator() / double(std::mt19937::max()) - 0.5;
    }



    // Rotations of undeformed bodies, whose quotients would be zero.
    double
    largest_round_off(const MultibodySystem &system)
    {
      double largest = 0;
      for (const Body &body : system.bodies())
        {
          const BodyOperators &operators = body.operators();
          NodalVector turned(operators.n_unknowns()), product(turned);
          for (unsigned int j = 0; j < dim; ++j)
            {
              for (unsigned int a = 0; a < operators.n_nodes; ++a)
                for (unsigned int i = 0; i < dim; ++i)
                  {
                    const auto arm = [&](const unsigned int k) {
                      return operators.reference_positions[dim * a + k] -
                             operators.centre[k];
                    };
                    const unsigned int next = (j + 1) % dim;
                    const unsigned int last = (j + 2) % dim;
                    turned[dim * a + i]     = i == next   ? -arm(last)
                                              : i == last ? arm(next)
                                                          : 0.;
                  }
              operators.stiffness_matrix.vmult(product, turned);
              const double stiffness = std::abs(turned * product);
              operators.mass_matrix.vmult(product, turned);
              largest = std::max(largest, stiffness / (turned * product));
            }
        }
      return 10 * largest;
    }



    std::vector<FlatVector>
    lanczos(const ModeOperators &operators,
            const unsigned int number,
            const unsigned int n_free,
            std::mt19937 &generator)
    {
      const unsigned int n_basis = std::min(2 * number + 20, n_free - 1);
      SolverControl control(1000, 1e-10, false, false);
      ArpackSolver solver(control,
                          ArpackSolver::AdditionalData(
                            n_basis, ArpackSolver::largest_magnitude, true));
      solver.set_shift(-operators.shift);

      FlatVector start(operators.size()), product(start);
      fill_randomly(start, generator);
      operators.solve(product, start);
      solver.set_initial_vector(product);

      std::vector<std::complex<double>> eigenvalues(number);
      std::vector<FlatVector> vectors(number, start);
      const MassMatrix mass{operators};
      const ShiftedInverse inverse{operators};
      try
        {
          solver.solve(mass, mass, inverse, eigenvalues, vectors, number);
        }
      catch (const SolverControl::NoConvergence &)
        {
          throw SimulationError(
            "The modes were not found: ARPACK did not "
            "converge.");
        }
      return vectors;
    }



    // phi^T M phi = 1 and zero between different ones, by Gram and Schmidt:
    // again until no vector gets much shorter, which has cancelled nothing
    // then.
    void
    orthonormalize(const ModeOperators &operators,
                   std::vector<FlatVector> &vectors)
    {
      constexpr unsigned int max_passes = 10;

      FlatVector product(operators.size());
      const auto normalize = [&](FlatVector &x) {
        operators.apply_mass(product, x);
        const double length = std::sqrt(x * product);
        if (!(length > 0)) // or not a number
          throw SimulationError(
            "The modes were not found: vectors that are "
            "linearly dependent or not finite.");
        x /= length;
        product /= length;
        return length;
      };
      for (unsigned int j = 0; j < vectors.size(); ++j)
        {
          double length       = normalize(vectors[j]);
          unsigned int passes = 0;
          do
            {
              for (unsigned int i = 0; i < j; ++i)
                vectors[j].add(-(vectors[i] * product), vectors[i]);
              length = normalize(vectors[j]);
          } while (j > 0 && length < 0.7 && ++passes < max_passes);
          if (j > 0 && length < 0.7)
            throw SimulationError(
              "The modes were not found: vectors that are "
              "linearly dependent.");
        }
    }



    // The best approximations in the span of orthonormal vectors, by distance
    // of the eigenvalues to the shift.
    std::vector<double>
    rayleigh_ritz(const ModeOperators &operators,
                  std::vector<FlatVector> &vectors)
    {
      const unsigned int p = vectors.size();
      Eigen::MatrixXd K(p, p);
      FlatVector product(operators.size());
      for (unsigned int j = 0; j < p; ++j)
        {
          operators.apply_stiffness(product, vectors[j]);
          for (unsigned int i = 0; i <= j; ++i)
            K(i, j) = K(j, i) = vectors[i] * product;
        }
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K);
      if (solver.info() != Eigen::Success)
        throw SimulationError(
          "The modes were not found: the Rayleigh-Ritz "
          "values did not converge.");

      std::vector<unsigned int> order(p);
      std::iota(order.begin(), order.end(), 0);
      const auto distance = [&](const unsigned int k) {
        return std::abs(solver.eigenvalues()(k) + operators.shift);
      };
      std::sort(order.begin(), order.end(), [&](const auto i, const auto j) {
        return distance(i) < distance(j);
      });
      std::vector<FlatVector> result(p, FlatVector(operators.size()));
      std::vector<double> eigenvalues;
      for (unsigned int k = 0; k < p; ++k)
        {
          for (unsigned int j = 0; j < p; ++j)
            result[k].add(solver.eigenvectors()(j, order[k]), vectors[j]);
          eigenvalues.push_back(solver.eigenvalues()(order[k]));
        }
      vectors.swap(result);
      return eigenvalues;
    }



    // Until the first eigenvalues stay; three iterations bring out what Lanczos
    // has missed. Slow modes grow by many orders of magnitude in a single
    // solve: the vectors have to be orthogonal before, or what is left of the
    // others is round-off.
    std::vector<double>
    iterate_subspace(const ModeOperators &operators,
                     const unsigned int number,
                     const double round_off,
                     std::vector<FlatVector> &vectors)
    {
      constexpr unsigned int min_iterations = 3, max_iterations = 20;

      orthonormalize(operators, vectors);
      std::vector<double> eigenvalues;
      FlatVector product(operators.size());
      for (unsigned int k = 1; k <= max_iterations; ++k)
        {
          for (FlatVector &vector : vectors)
            {
              operators.apply_mass(product, vector);
              operators.solve(vector, product);
            }
          orthonormalize(operators, vectors);
          const std::vector<double> previous = eigenvalues;
          eigenvalues  = rayleigh_ritz(operators, vectors);
          bool settled = (k >= min_iterations);
          for (unsigned int i = 0; i < number && settled; ++i)
            settled =
              std::abs(eigenvalues[i] - previous[i]) <=
              1e-9 * std::abs(eigenvalues[i] + operators.shift) + round_off;
          if (settled)
            break;
        }
      return eigenvalues;
    }



    // |(K_T + sigma M)^-1 (K_T - lambda M) phi|_M
    double
    mode_error(const ModeOperators &operators,
               const double eigenvalue,
               const FlatVector &phi)
    {
      FlatVector residual(phi.size()), product(phi.size());
      operators.apply_stiffness(residual, phi);
      operators.apply_mass(product, phi);
      residual.add(-eigenvalue, product);
      operators.solve(product, residual);
      operators.apply_mass(residual, product);
      return std::sqrt(residual * product);
    }



    // Signs are arbitrary: the largest component is positive.
    void
    fix_sign(FlatVector &phi)
    {
      const auto largest =
        std::max_element(phi.begin(), phi.end(), [](double a, double b) {
          return std::abs(a) < std::abs(b) * (1 - 1e-9);
        });
      if (*largest < 0)
        phi *= -1;
    }
  } // namespace



  namespace
  {
    // Beyond the modes that are asked for, for those next to the last.
    constexpr unsigned int n_more = 2, n_random = 4;

    unsigned int
    n_motions(const MultibodySystem &system)
    {
      unsigned int n = system.n_repeated_constraints();
      for (const Body &body : system.bodies())
        n += body.operators().n_unknowns();
      return n - std::min(n, system.n_constraints());
    }
  } // namespace



  void
  check_number_of_modes(const MultibodySystem &system,
                        const unsigned int number)
  {
    const unsigned int most =
      std::max(n_motions(system) / 2, n_more + n_random) - n_more - n_random;
    if (number > most)
      throw InputError("Modes",
                       "Number",
                       std::to_string(number),
                       "at most " + std::to_string(most) +
                         ", as the bodies have " +
                         std::to_string(n_motions(system)) +
                         " unknowns less constraints");
  }



  NaturalModes
  natural_modes(const MultibodySystem &system,
                const SystemState &state,
                const unsigned int number,
                Statistics &statistics)
  {
    check_number_of_modes(system, number);
    const ModeOperators operators(system, state, statistics);
    std::mt19937 generator;
    std::vector<FlatVector> vectors =
      lanczos(operators, number + n_more, n_motions(system), generator);
    for (unsigned int k = 0; k < n_random; ++k)
      {
        vectors.emplace_back(operators.size());
        fill_randomly(vectors.back(), generator);
      }

    NaturalModes result;
    result.round_off = largest_round_off(system);
    const std::vector<double> eigenvalues =
      iterate_subspace(operators, number, result.round_off, vectors);
    for (unsigned int k = 0; k < number; ++k)
      {
        Mode mode;
        mode.eigenvalue = eigenvalues[k];
        mode.error      = mode_error(operators, eigenvalues[k], vectors[k]);
        const double distance = std::abs(eigenvalues[k] + operators.shift);
        if (!(mode.error < max_error + result.round_off / distance))
          throw SimulationError("A mode with the frequency " +
                                format_number(mode.frequency()) +
                                " Hz is not accurate: its residual is " +
                                format_number(mode.error) + ".");
        fix_sign(vectors[k]);
        mode.shape = state.positions;
        operators.split(vectors[k], mode.shape);
        result.modes.push_back(std::move(mode));
      }
    std::sort(result.modes.begin(),
              result.modes.end(),
              [](const Mode &a, const Mode &b) {
                return a.eigenvalue < b.eigenvalue;
              });
    return result;
  }
} // namespace ACF
