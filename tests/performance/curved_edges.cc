// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// What are curved edges of tetrahedra worth in bodies with round holes? A ring
// under pressure against Lame's solution, and a link with two eyes against a
// fine mesh, each with straight and with curved edges on the same meshes of
// gmsh, as comma-separated values; curved_edges.md explains them. Fails if an
// error with curved edges is larger than its bound.
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
    std::string name;
    std::string script;

    /** Entry 'Surfaces'; one is called "held" and one "loaded". */
    std::string surfaces;

    /** Entries of the load on "loaded". */
    std::string load;
  };

  const double pressure = 1e-4 * youngs_modulus;

  // Radii 1 m and 2 m, 1 m thick.
  const Shape ring = {"ring",
                      "Cylinder(1) = {0, 0, 0, 0, 0, 1, 2};"
                      "Cylinder(2) = {0, 0, 0, 0, 0, 1, 1};"
                      "BooleanDifference{ Volume{1}; Delete; }"
                      "{ Volume{2}; Delete; }",
                      "held: plane 0 0 0 0 0 1; loaded: cylinder 0 0 0 0 0 1 1",
                      "  set Type = pressure\n  set Value = " +
                        number(pressure)};

  // Eyes with radii 12 mm and 16 mm, 100 mm apart, 10 mm thick; the bar between
  // them is 16 mm wide.
  const Shape link = {
    "link",
    "Cylinder(1) = {0, 0, 0, 0, 0, 0.01, 0.016};"
    "Cylinder(2) = {0.1, 0, 0, 0, 0, 0.01, 0.016};"
    "Box(3) = {0, -0.008, 0, 0.1, 0.016, 0.01};"
    "BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };"
    "Cylinder(5) = {0, 0, 0, 0, 0, 0.01, 0.012};"
    "Cylinder(6) = {0.1, 0, 0, 0, 0, 0.01, 0.012};"
    "BooleanDifference(7) = { Volume{4}; Delete; }{ Volume{5, 6}; Delete; };",
    "held: cylinder 0 0 0 0 0 1 0.012; loaded: cylinder 0.1 0 0 0 0 1 0.012",
    "  set Type = force\n  set Value = 10; 0; 0"};

  /** What is measured of a mesh. */
  struct Measured
  {
    Measured(const Shape &shape, const std::string &geometry, const double size)
      : name(shape.name + ',' + geometry + ',' + number(size))
    {
      const Script script(shape.script);
      Problem problem;
      problem.mesh = "  set Mesh = " + script.file.string() +
                     "\n  set Geometry = " + geometry +
                     "\n  set Mesh size = " + number(size) +
                     "\n  set Surfaces = " + shape.surfaces;
      problem.held    = "held";
      problem.load    = shape.load + "\n  set On = body: loaded";
      problem.element = "tetrahedron";
      const Solution solution(problem);
      if (!solution.found)
        throw SimulationError("no equilibrium of " + name);
      const BodyDiscretization &space = solution.body().discretization();
      n_cells    = space.mesh().triangulation().n_active_cells();
      n_unknowns = solution.body().operators().n_unknowns();
      volume     = solution.body().operators().volume;
      compliance = solution.energy();
      stress     = mean_hoop_stress(solution);
      Statistics statistics;
      const MultibodySystem &system = solution.run.system;
      frequency = natural_modes(system, system.initial_state(), 2, statistics)
                    .modes[0]
                    .frequency();
    }

    /** Mean over the loaded surface of the stress around the z axis, which is
     * that of the hole of the ring, Pa. */
    static double
    mean_hoop_stress(const Solution &solution)
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
      double sum = 0, area = 0;
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
                t[0]              = -x[1] / std::hypot(x[0], x[1]);
                t[1]              = x[0] / std::hypot(x[0], x[1]);
                const double hoop = material.lambda() * trace(strain) +
                                    2 * material.mu() * (t * (strain * t));
                sum += hoop * values.JxW(q);
                area += values.JxW(q);
              }
          }
      return sum / area;
    }

    std::string name;
    unsigned int n_cells    = 0;
    unsigned int n_unknowns = 0;
    double volume           = 0; // m^3
    double compliance       = 0; // elastic energy, J
    double stress           = 0; // Pa
    double frequency        = 0; // the first one of the held body, Hz
  };

  /** Relative errors; not a number where there is no reference. */
  struct Errors
  {
    Errors(const Measured &found, const Measured &exact)
      : volume(found.volume / exact.volume - 1)
      , compliance(found.compliance / exact.compliance - 1)
      , stress(found.stress / exact.stress - 1)
      , frequency(found.frequency / exact.frequency - 1)
    {}

    double volume, compliance, stress, frequency;
  };

  void
  print_errors(const Measured &found, const Errors &errors)
  {
    std::cout << found.name << ',' << found.n_cells << ',' << found.n_unknowns
              << ',' << errors.volume << ',' << errors.compliance << ','
              << errors.stress << ',' << errors.frequency << std::endl;
  }

  /** Curved edges must make the errors this many times smaller. */
  struct Bounds
  {
    double volume, compliance, stress, frequency;
  };

  bool
  study(const Shape &shape,
        const std::vector<double> &sizes,
        const Measured &exact,
        const Bounds &bounds)
  {
    bool success = true;
    for (const double size : sizes)
      {
        const Measured straight(shape, "straight", size);
        const Measured curved(shape, "quadratic", size);
        const Errors before(straight, exact), after(curved, exact);
        print_errors(straight, before);
        print_errors(curved, after);
        const auto is_smaller =
          [](const double a, const double b, const double factor) {
            return std::isnan(b) || factor * std::abs(a) <= std::abs(b);
          };
        success =
          success && is_smaller(after.volume, before.volume, bounds.volume) &&
          is_smaller(after.compliance, before.compliance, bounds.compliance) &&
          is_smaller(after.stress, before.stress, bounds.stress) &&
          is_smaller(after.frequency, before.frequency, bounds.frequency);
      }
    if (!success)
      std::cerr << shape.name << ": curved edges are not as much better as "
                << "they were" << std::endl;
    return success;
  }

  /** Lame's solution in place of a measurement: radii a = 1, b = 2. */
  Measured
  lame(Measured any)
  {
    const double nu = 0.3;
    any.volume      = 3 * numbers::PI;
    any.stress      = pressure * 5 / 3;
    any.compliance  = 0.5 * pressure * 2 * numbers::PI * pressure /
                     youngs_modulus * (5. / 3 + nu);
    any.frequency = std::numeric_limits<double>::quiet_NaN();
    return any;
  }

  /** Figures that have no meaning for the link are left out. */
  Measured
  without_stress(Measured measured)
  {
    measured.stress = std::numeric_limits<double>::quiet_NaN();
    return measured;
  }

  bool
  run_study(const bool quick)
  {
    std::cout << "body,geometry,mesh size,cells,unknowns,volume,compliance,"
                 "mean stress at the hole,first frequency"
              << std::endl;
    std::cout.precision(3);
    const std::vector<double> ring_sizes =
      quick ? std::vector<double>{0.8} : std::vector<double>{0.8, 0.4, 0.2};
    bool success = study(ring,
                         ring_sizes,
                         lame(Measured(ring, "straight", 0.8)),
                         {10, 5, 2, 1});
    if (quick)
      return success;
    const Measured fine(link, "quadratic", 0.002);
    return study(link,
                 {0.008, 0.006, 0.004},
                 without_stress(fine),
                 {10, 1, 1, 1}) &&
           success;
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
