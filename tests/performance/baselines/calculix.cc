// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "performance/baselines/calculix.h"

#include <acf/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace Baselines
{
  namespace
  {
    // CalculiX reads at most 20 characters of a number.
    std::string
    number(const double value)
    {
      char text[32];
      std::snprintf(text, sizeof(text), "%.12e", value);
      return text;
    }



    void
    check(const MultibodySystem &system, const SystemState &start)
    {
      check_supported(system);
      double speed = 0;
      for (const NodalVector &v : start.velocities)
        speed = std::max(speed, v.linfty_norm());
      if (system.bodies().size() != 1 ||
          !system.bodies()[0].discretization().mesh().is_simplex() ||
          !system.has_affine_joints() || speed > 0)
        throw SimulationError(
          "CalculiX gets one body of tetrahedra at rest, "
          "with linear joints.");
    }



    // Edges of C3D10 in the order of its nodes 5 to 10.
    constexpr unsigned int edges[6][2] =
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

    // Nodes of a cell in the order of C3D10, counted from 0: on each edge the
    // one that is nearest to its middle.
    std::vector<unsigned int>
    element_nodes(const BodyDiscretization &body,
                  const typename DoFHandler<dim>::active_cell_iterator &cell)
    {
      std::vector<unsigned int> nodes(body.scalar_element().n_dofs_per_cell());
      body.get_nodes(cell, nodes);
      const auto position = [&](const unsigned int k) {
        Vector3 X;
        for (unsigned int i = 0; i < dim; ++i)
          X[i] = body.reference_positions()[dim * nodes[k] + i];
        return X;
      };
      std::vector<unsigned int> result(nodes.begin(), nodes.begin() + 4);
      for (const auto &edge : edges)
        {
          const Vector3 middle = (position(edge[0]) + position(edge[1])) / 2;
          unsigned int nearest = 4;
          for (unsigned int k = 5; k < nodes.size(); ++k)
            if ((position(k) - middle).norm() <
                (position(nearest) - middle).norm())
              nearest = k;
          result.push_back(nodes[nearest]);
        }
      return result;
    }



    // D S, the joints on the displacements, with a unit matrix in the columns
    // of the unknowns that the equations eliminate, which come first in each.
    Eigen::MatrixXd
    eliminated_constraints(const MultibodySystem &system,
                           const SystemState &start,
                           std::vector<unsigned int> &pivots)
    {
      const Body &body  = system.bodies()[0];
      Eigen::MatrixXd B = Eigen::MatrixXd::Zero(system.n_constraints(),
                                                body.operators().n_unknowns());
      const MarkerLinearization linearization =
        system.linearize(0,
                         system.marker_values(start.positions),
                         Eigen::VectorXd(),
                         start.multipliers,
                         start.law_values);
      for (const auto &entry : linearization.constraints)
        {
          const NodalFunctional &marker =
            body.reference()
              .functionals()[system.body_markers(0)[entry.col() / dim]];
          for (unsigned int k = 0; k < marker.nodes.size(); ++k)
            B(entry.row(), dim * marker.nodes[k] + entry.col() % dim) +=
              entry.value() * marker.weights[k];
        }
      for (unsigned int r = 0; r < B.rows(); ++r)
        {
          Eigen::Index pivot;
          B.row(r).cwiseAbs().maxCoeff(&pivot);
          pivots.push_back(pivot);
          B.row(r) /= B(r, pivot);
          for (unsigned int q = 0; q < B.rows(); ++q)
            if (q != r)
              B.row(q) -= B(q, pivot) * B.row(r).eval();
        }
      return B;
    }



    void
    write_equations(const MultibodySystem &system,
                    const SystemState &start,
                    std::ostream &stream)
    {
      std::vector<unsigned int> pivots;
      const Eigen::MatrixXd B = eliminated_constraints(system, start, pivots);
      for (unsigned int r = 0; r < B.rows(); ++r)
        {
          std::vector<unsigned int> unknowns = {pivots[r]};
          for (unsigned int k = 0; k < B.cols(); ++k)
            if (k != pivots[r] && std::abs(B(r, k)) > 1e-12)
              unknowns.push_back(k);
          stream << "*EQUATION\n" << unknowns.size() << "\n";
          for (const unsigned int k : unknowns)
            stream << k / dim + 1 << ", " << k % dim + 1 << ", "
                   << number(B(r, k)) << "\n";
        }
    }



    void
    write_mesh(const Body &body, std::ostream &stream)
    {
      const NodalVector X = body.placement();
      stream << "*NODE, NSET=NODES\n";
      for (unsigned int a = 0; a < body.operators().n_nodes; ++a)
        stream << a + 1 << ", " << number(X[dim * a]) << ", "
               << number(X[dim * a + 1]) << ", " << number(X[dim * a + 2])
               << "\n";
      stream << "*ELEMENT, TYPE=C3D10, ELSET=CELLS\n";
      for (const auto &cell :
           body.discretization().dof_handler().active_cell_iterators())
        {
          stream << cell->active_cell_index() + 1;
          for (const unsigned int node :
               element_nodes(body.discretization(), cell))
            stream << ", " << node + 1;
          stream << "\n";
        }
      stream << "*MATERIAL, NAME=MATERIAL\n*ELASTIC\n"
             << number(body.material().youngs_modulus) << ", "
             << number(body.material().poissons_ratio) << "\n*DENSITY\n"
             << number(body.material().density)
             << "\n*SOLID SECTION, ELSET=CELLS, MATERIAL=MATERIAL\n";
    }
  } // namespace



  void
  write_calculix_model(const Model &model,
                       const MultibodySystem &system,
                       const double alpha,
                       const std::filesystem::path &directory)
  {
    const SystemState start = system.initial_state();
    check(system, start);
    const double step_size = model.time.step_size;
    const unsigned int output =
      std::max(1., std::round(model.output.probe_interval / step_size));
    const Vector3 gravity = system.gravity(0);

    std::ofstream stream(directory / "model.inp");
    stream << "*HEADING\n" << model.title << "\n";
    write_mesh(system.bodies()[0], stream);
    write_equations(system, start, stream);
    stream << "*STEP, NLGEOM, INC=10000000\n*DYNAMIC, DIRECT, ALPHA=" << alpha
           << "\n"
           << number(step_size) << ", " << number(model.time.end_time) << "\n";
    if (gravity.norm() > 0)
      stream << "*DLOAD\nCELLS, GRAV, " << number(gravity.norm()) << ", "
             << number(gravity[0] / gravity.norm()) << ", "
             << number(gravity[1] / gravity.norm()) << ", "
             << number(gravity[2] / gravity.norm()) << "\n";
    stream << "*NODE PRINT, NSET=NODES, FREQUENCY=" << output
           << "\nU\n*END STEP\n"
           << std::flush;
    if (!stream)
      throw SimulationError("Cannot write a file in " + directory.string() +
                            ".");
  }



  void
  run_calculix(const std::filesystem::path &directory, Statistics &statistics)
  {
    {
      const PhaseTimer timer(statistics, "time steps");
      const std::string command =
        "cd '" + directory.string() + "' && ccx -i model > ccx.log 2>&1";
      if (std::system(command.c_str()) != 0)
        throw SimulationError("The command '" + command + "' failed.");
    }
    // step, increment, attempt, iterations, times
    std::ifstream stream(directory / "model.sta");
    std::string line;
    while (std::getline(stream, line))
      {
        std::istringstream words(line);
        unsigned int step, increment, iterations;
        std::string attempt;
        if (words >> step >> increment >> attempt >> iterations)
          {
            ++statistics.steps;
            statistics.newton_iterations += iterations;
            statistics.max_newton_iterations =
              std::max(statistics.max_newton_iterations, iterations);
          }
      }
    statistics.real_factorizations = statistics.newton_iterations;
  }



  void
  read_calculix_results(const MultibodySystem &system,
                        const std::filesystem::path &directory,
                        const std::vector<Observer *> &observers)
  {
    const NodalVector X = system.placement()[0];
    SystemState state   = system.initial_state();
    const auto observe  = [&]() {
      for (Observer *const observer : observers)
        observer->observe(state);
    };
    observe();

    std::ifstream stream(directory / "model.dat");
    std::string line;
    unsigned int n_read = 0;
    while (std::getline(stream, line))
      {
        std::istringstream words(line);
        const std::size_t time = line.find("and time");
        unsigned int node;
        double u[dim];
        if (time != std::string::npos)
          state.time = std::stod(line.substr(time + 8));
        else if (words >> node >> u[0] >> u[1] >> u[2])
          {
            for (unsigned int i = 0; i < dim; ++i)
              state.positions[0][dim * (node - 1) + i] =
                X[dim * (node - 1) + i] + u[i];
            if (++n_read % system.bodies()[0].operators().n_nodes == 0)
              observe();
          }
      }
    if (n_read == 0)
      throw SimulationError("CalculiX has printed nothing, see ccx.log in " +
                            directory.string() + ".");
  }
} // namespace Baselines
