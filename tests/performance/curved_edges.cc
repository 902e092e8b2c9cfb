// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// What are curved edges of tetrahedra worth in bodies with round holes? A ring
// under pressure against Lame's solution, and the first frequency of a thinner
// ring (hoop) against a fine mesh, each with straight and with curved edges on
// the same meshes of gmsh, as comma-separated values; curved_edges.md explains
// them. Fails if an error with curved edges is larger than its bound.
//
// Usage: curved_edges [--quick]

#include <acf/time/modes.h>

#include <deal.II/fe/fe_values.h>

#include <mpi.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "static_problem.h"

namespace
{
  using namespace Tests;

  /** A script of gmsh in the temporary folder, as long as the object lives. */
  class Script
  {
  public:
    explicit Script(const std::string &text)
      : file(std::filesystem::temp_directory_path() /
             ("acf-curved-edges-" + std::to_string(getpid()) + "-" +
              std::to_string(std::hash<std::string>()(text)) + ".geo"))
    {
      std::ofstream(file) << "SetFactory(\"OpenCASCADE\");\n" << text << '\n';
    }

    ~Script()
    {
      std::error_code error;
      std::filesystem::remove(file, error);
    }

    Script(const Script &) = delete;
    Script &
    operator=(const Script &) = delete;

    const std::filesystem::path file;
  };

  /** A body with a round hole in the model file's terms. */
  struct Shape
  {
    std::string script;

    /** Entry 'Surfaces'; one is called "held" and one "loaded". */
    std::string surfaces;

    /** Entries of the load on "loaded". */
    std::string load;
  };

  const double pressure = 1e-4 * youngs_modulus;

  // Radii 1 m and 2 m, 1 m thick.
  const Shape ring = {
    "Cylinder(1) = {0, 0, 0, 0, 0, 1, 2};"
    "Cylinder(2) = {0, 0, 0, 0, 0, 1, 1};"
    "BooleanDifference{ Volume{1}; Delete; }"
    "{ Volume{2}; Delete; }",
    "held: plane 0 0 0 0 0 1; loaded: cylinder 0 0 0 0 0 1 1",
    "  set Type = pressure\n  set Value = " + number(pressure)};

  // Inner radius 1 m, 0.25 m thick in both directions.
  const std::string hoop =
    "Cylinder(1) = {0, 0, 0, 0, 0, 0.25, 1.25};"
    "Cylinder(2) = {0, 0, 0, 0, 0, 0.25, 1};"
    "BooleanDifference{ Volume{1}; Delete; }"
    "{ Volume{2}; Delete; }";

  std::string
  mesh_entries(const Script &script,
               const std::string &geometry,
               const double size)
  {
    return "  set Mesh = " + script.file.string() +
           "\n  set Geometry = " + geometry +
           "\n  set Mesh size = " + number(size);
  }

  /** What is measured of a mesh of the ring. */
  struct RingFigures
  {
    RingFigures(const std::string &geometry, const double size)
    {
      const Script script(ring.script);
      Problem problem;
      problem.mesh = mesh_entries(script, geometry, size) +
                     "\n  set Surfaces = " + ring.surfaces;
      problem.held    = "held";
      problem.load    = ring.load + "\n  set On = body: loaded";
      problem.element = "tetrahedron";
      const Solution solution(problem);
      if (!solution.found)
        throw SimulationError("no equilibrium of the ring");
      n_cells = solution.body()
                  .discretization()
                  .mesh()
                  .triangulation()
                  .n_active_cells();
      n_unknowns = solution.body().operators().n_unknowns();
      volume     = solution.body().operators().volume / (3 * numbers::PI) - 1;
      // Lame's solution with the radii a = 1 and b = 2
      const double energy = 0.5 * pressure * 2 * numbers::PI * pressure /
                            youngs_modulus * (5. / 3 + 0.3);
      compliance  = solution.energy() / energy - 1;
      mean_stress = mean_stress_error(solution);
      stress      = hoop_stress_error(solution);
    }

    /** Error of a third of the trace of the stress, the mean over the body,
     * which is 2/9 of the pressure; relative. */
    static double
    mean_stress_error(const Solution &solution)
    {
      const BodyDiscretization &space = solution.body().discretization();
      const Material &material        = solution.body().material();
      NodalVector u                   = solution.state.positions[0];
      u -= solution.body().placement();
      FEValues<dim> values(space.mesh().mapping(),
                           space.scalar_element(),
                           space.mesh().cell_quadrature(2),
                           update_gradients | update_JxW_values);
      std::vector<unsigned int> nodes(values.dofs_per_cell);
      double sum = 0;
      for (const auto &cell : space.dof_handler().active_cell_iterators())
        {
          values.reinit(
            typename Triangulation<dim>::active_cell_iterator(cell));
          space.get_nodes(cell, nodes);
          for (const unsigned int q : values.quadrature_point_indices())
            for (const unsigned int i : values.dof_indices())
              for (unsigned int c = 0; c < dim; ++c)
                sum += u[dim * nodes[i] + c] * values.shape_grad(i, q)[c] *
                       values.JxW(q);
        }
      return (material.lambda() + 2. / 3 * material.mu()) * sum /
               solution.body().operators().volume / (pressure * 2 / 9) -
             1;
    }

    /** Error of the stress around the hole, at its surface: root mean square,
     * relative to 5/3 of the pressure. */
    static double
    hoop_stress_error(const Solution &solution)
    {
      const Body &body                = solution.body();
      const BodyDiscretization &space = body.discretization();
      const Material &material        = body.material();
      const auto &ids                 = space.mesh().surface("loaded", "", "");
      NodalVector u                   = solution.state.positions[0];
      u -= body.placement();
      FEFaceValues<dim> values(space.mesh().mapping(),
                               space.scalar_element(),
                               space.mesh().face_quadrature(4),
                               update_gradients | update_quadrature_points |
                                 update_JxW_values);
      std::vector<unsigned int> nodes(values.dofs_per_cell);
      double sum_of_squares = 0, area = 0;
      for (const auto &cell : space.dof_handler().active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          {
            if (!cell->face(f)->at_boundary() ||
                ids.count(cell->face(f)->boundary_id()) == 0)
              continue;
            values.reinit(
              typename Triangulation<dim>::active_cell_iterator(cell), f);
            space.get_nodes(cell, nodes);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                Matrix3 gradient;
                for (const unsigned int i : values.dof_indices())
                  for (unsigned int c = 0; c < dim; ++c)
                    gradient[c] +=
                      u[dim * nodes[i] + c] * values.shape_grad(i, q);
                const SymmetricTensor<2, dim> strain = symmetrize(gradient);
                const Point<dim> &x = values.quadrature_point(q);
                Vector3 t;
                t[0]               = -x[1] / std::hypot(x[0], x[1]);
                t[1]               = x[0] / std::hypot(x[0], x[1]);
                const double error = (material.lambda() * trace(strain) +
                                      2 * material.mu() * (t * (strain * t))) /
                                       (pressure * 5 / 3) -
                                     1;
                sum_of_squares += error * error * values.JxW(q);
                area += values.JxW(q);
              }
          }
      return std::sqrt(sum_of_squares / area);
    }

    unsigned int n_cells    = 0;
    unsigned int n_unknowns = 0;

    /** Relative errors. */
    double volume, compliance, mean_stress, stress;
  };

  /** First frequency of the free hoop, which becomes an oval, Hz. */
  struct HoopFigures
  {
    HoopFigures(const std::string &geometry, const double size)
    {
      const Script script(hoop);
      const RecordedRun run(
        "subsection Bodies\n set Names = body\n subsection body\n" +
          mesh_entries(script, geometry, size) + "\n  set Young's modulus = " +
          number(youngs_modulus) + "\n  set Poisson's ratio = 0.3\n" +
          "  set Density = " + number(density) +
          "\n end\nend\nsubsection Start\n set Equilibrium = true\nend\n",
        1.);
      const Body &body = run.system.bodies()[0];
      n_cells = body.discretization().mesh().triangulation().n_active_cells();
      n_unknowns = body.operators().n_unknowns();
      mass       = body.operators().mass;
      Statistics statistics;
      frequency =
        natural_modes(run.system, run.system.initial_state(), 8, statistics)
          .modes[6]
          .frequency();
    }

    unsigned int n_cells    = 0;
    unsigned int n_unknowns = 0;
    double mass             = 0;
    double frequency        = 0;
  };

  /** Curved edges must make errors this many times smaller. */
  bool
  is_smaller(const double curved, const double straight, const double factor)
  {
    return factor * std::abs(curved) <= std::abs(straight);
  }

  bool
  study_ring(const std::vector<double> &sizes)
  {
    std::cout << "ring,geometry,mesh size,cells,unknowns,volume,compliance,"
                 "mean stress,stress at the hole"
              << std::endl;
    bool success = true;
    for (const double size : sizes)
      {
        const RingFigures straight("straight", size), curved("quadratic", size);
        for (const RingFigures *const figures : {&straight, &curved})
          std::cout << "ring,"
                    << (figures == &curved ? "quadratic," : "straight,") << size
                    << ',' << figures->n_cells << ',' << figures->n_unknowns
                    << ',' << figures->volume << ',' << figures->compliance
                    << ',' << figures->mean_stress << ',' << figures->stress
                    << std::endl;
        success = success && is_smaller(curved.volume, straight.volume, 10) &&
                  is_smaller(curved.compliance, straight.compliance, 10) &&
                  is_smaller(curved.mean_stress, straight.mean_stress, 10) &&
                  is_smaller(curved.stress, straight.stress, 1.15);
      }
    return success;
  }

  bool
  study_hoop(const std::vector<double> &sizes, const double reference_size)
  {
    const HoopFigures exact("quadratic", reference_size);
    const double exact_mass = density * numbers::PI * 0.5625 * 0.25;
    std::cout << "hoop,geometry,mesh size,cells,unknowns,mass,frequency\n"
              << "hoop,reference," << reference_size << ',' << exact.n_cells
              << ',' << exact.n_unknowns << ',' << exact.mass / exact_mass - 1
              << ',' << exact.frequency << " Hz" << std::endl;
    bool success = true;
    for (const double size : sizes)
      {
        std::array<double, 2> errors;
        for (const unsigned int is_curved : {0, 1})
          {
            const std::string geometry =
              is_curved == 1 ? "quadratic" : "straight";
            const HoopFigures figures(geometry, size);
            errors[is_curved] = figures.frequency / exact.frequency - 1;
            std::cout << "hoop," << geometry << ',' << size << ','
                      << figures.n_cells << ',' << figures.n_unknowns << ','
                      << figures.mass / exact_mass - 1 << ','
                      << errors[is_curved] << std::endl;
          }
        success = success && is_smaller(errors[1], errors[0], 1.4);
      }
    return success;
  }

  bool
  run_study(const bool quick)
  {
    std::cout.precision(3);
    bool success = study_ring(quick ? std::vector<double>{0.8}
                                    : std::vector<double>{0.8, 0.4, 0.2});
    if (!quick)
      success = study_hoop({0.4, 0.2, 0.1}, 0.06) && success;
    if (!success)
      std::cerr << "curved edges are not as much better as they were"
                << std::endl;
    return success;
  }
} // namespace

int
main(int argc, char **argv)
{
  const bool quick = (argc == 2 && std::string(argv[1]) == "--quick");
  if (argc > 1 && !quick)
    {
      std::cerr << "usage: " << argv[0] << " [--quick]" << std::endl;
      return 2;
    }
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  int status = 1;
  try
    {
      status = run_study(quick) ? 0 : 1;
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
    }
  MPI_Finalize();
  return status;
}
