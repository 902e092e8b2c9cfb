// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Do the elements become too stiff (lock) where cells are long and thin, where
// Poisson's ratio approaches 0.5, or where deflections are large? Static
// solutions and first frequencies against beam theory, Lame's solutions and
// fine meshes, as comma-separated values; locking.md explains them. Fails if an
// error is larger than its bound.
//
// Usage: locking [--quick]

#include <acf/time/modes.h>

#include <mpi.h>

#include "bulky_problems.h"
#include "reference/cantilever.h"

namespace
{
  using namespace Tests;

  struct Cantilever
  {
    double slenderness     = 10; // length / height; the length is 1 m
    unsigned int n_along   = 10;
    unsigned int n_through = 1;
    std::string element    = "hexahedron";
    std::string strain     = "reduced";

    std::string
    name() const
    {
      const std::string cells = std::to_string(n_through);
      return "cantilever " + number(slenderness) + ' ' + strain + ',' +
             element + ',' + cells + " x " + std::to_string(n_along) + " x " +
             cells;
    }
  };

  Reference::PlanarBeam
  beam(const Cantilever &cantilever, const double nu)
  {
    Reference::PlanarBeam beam;
    beam.length         = 1;
    beam.height         = 1 / cantilever.slenderness;
    beam.width          = beam.height;
    beam.youngs_modulus = youngs_modulus;
    beam.poissons_ratio = nu;
    beam.density        = density;
    beam.gravity        = 0;
    return beam;
  }

  /** @param load the force at the tip times L^2 / (E I) */
  Problem
  cantilever_problem(const Cantilever &cantilever,
                     const double nu,
                     const double load)
  {
    const double h         = 1 / cantilever.slenderness;
    const std::string half = number(h / 2),
                      n    = std::to_string(cantilever.n_through);
    return {"  set Mesh = box\n  set Box from = -" + half + ", 0, -" + half +
              "\n  set Box to = " + half + ", 1, " + half + "\n  set Cells = " +
              n + ", " + std::to_string(cantilever.n_along) + ", " + n,
            "y min",
            "  set Type = force\n  set On = body: y max\n  set Value = 0; 0; " +
              number(load * youngs_modulus * std::pow(h, 4) / 12),
            cantilever.element,
            nu,
            cantilever.strain};
  }

  /** First frequency of Timoshenko's cantilever, rad/s, by Ritz's method. */
  double
  timoshenko_frequency(const Reference::PlanarBeam &beam)
  {
    const unsigned int n = 8; // of deflection and rotation: x, x^2, ...
    const double area    = beam.width * beam.height,
                 inertia = area * beam.height * beam.height / 12,
                 shear   = Reference::cowper_coefficient(beam.poissons_ratio) *
                         area * beam.youngs_modulus /
                         (2 * (1 + beam.poissons_ratio));
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * n, 2 * n), M = K;
    for (int i = 1; i <= static_cast<int>(n); ++i)
      for (int j = 1; j <= static_cast<int>(n); ++j)
        {
          const unsigned int w = i - 1, v = j - 1; // w, then the rotation
          const double product = 1. / (i + j + 1),
                       slopes  = i * j / (i + j - 1.);
          K(w, v)              = shear * slopes;
          K(w, n + v)          = -shear * i / (i + j);
          K(n + v, w)          = K(w, n + v);
          K(n + w, n + v) =
            beam.youngs_modulus * inertia * slopes + shear * product;
          M(w, v)         = beam.density * area * product;
          M(n + w, n + v) = beam.density * inertia * product;
        }
    return std::sqrt(
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M)
        .eigenvalues()(0));
  }

  /** A small deflection, and the first frequency. */
  Figures
  bend(const Cantilever &cantilever, const double nu)
  {
    const double load = 3e-4; // deflection 1e-4 of the length
    const Solution solution(cantilever_problem(cantilever, nu, load));
    const Reference::PlanarBeam reference = beam(cantilever, nu);
    const double inertia                  = std::pow(reference.height, 4) / 12,
                 kappa_ga = Reference::cowper_coefficient(nu) * youngs_modulus /
                            (2 * (1 + nu)) * std::pow(reference.height, 2);
    const double expected = load * youngs_modulus * inertia *
                            (1 / (3 * youngs_modulus * inertia) + 1 / kappa_ga);

    double frequency = std::numeric_limits<double>::quiet_NaN();
    Statistics statistics;
    try
      {
        const MultibodySystem &system = solution.run.system;
        frequency = natural_modes(system, system.initial_state(), 2, statistics)
                      .modes[0]
                      .angular_frequency();
      }
    catch (const SimulationError &)
      {} // modes that are not accurate
    return Figures(solution,
                   1 - solution.displacement("y max")[2] / expected,
                   frequency / timoshenko_frequency(reference) - 1);
  }

  /** A large deflection with the strain of Green and Lagrange. */
  Figures
  bend_far(const Cantilever &cantilever, const double nu)
  {
    const double load = 1.5;
    const Solution solution(cantilever_problem(cantilever, nu, load));
    const Reference::PlanarBeam reference   = beam(cantilever, nu);
    const Reference::CantileverTip expected = Reference::cantilever_tip(
      reference, load * youngs_modulus * std::pow(reference.height, 4) / 12);
    const Vector3 tip = solution.displacement("y max");
    return Figures(solution,
                   1 - tip[2] / expected.deflection,
                   1 + tip[1] / expected.shortening);
  }



  // --- the study ---

  const double unbounded = std::numeric_limits<double>::infinity();
  const std::vector<std::string> elements = {"hexahedron", "tetrahedron"};

  /**
   * Elements of pieces of constant curvature are too stiff by 1 / (4 n^2) under
   * a force at the tip, whatever the slenderness; at the slenderness 10 beam
   * theory differs by 1.2e-3.
   */
  bool
  study_bending(const Cantilever &cantilever,
                const std::vector<double> &poissons_ratios)
  {
    const double n      = cantilever.n_along;
    const bool is_short = cantilever.slenderness <= 30;
    return print(cantilever.name(),
                 poissons_ratios,
                 cantilever.slenderness <= 300 ? 1.3e-3 + 1.3 / (4 * n * n)
                                               : unbounded,
                 is_short ? 3 : unbounded,
                 [&](const double nu) { return bend(cantilever, nu); });
  }

  /**
   * The error is at most the square of the sagitta of a cell with the largest
   * curvature, relative to its thickness; strains of the slenderness 10 are 7 %
   * at the clamp, where the material makes 2.2e-3 of difference to the beam.
   */
  bool
  study_large_deflection(const Cantilever &cantilever)
  {
    const double n       = cantilever.n_along;
    const double sagitta = 1.5 / (8 * n * n) * cantilever.slenderness;
    return print(cantilever.name(),
                 {0.3},
                 2.5e-3 + 1.1 * sagitta * sagitta,
                 unbounded,
                 [&](const double nu) { return bend_far(cantilever, nu); });
  }

  /** Errors of straight edges and of coarse meshes. */
  bool
  study_bulky(const unsigned int n,
              const unsigned int n_fine,
              const std::string &element,
              const std::vector<double> &poissons_ratios)
  {
    const std::string cells = ',' + element + ',' + std::to_string(n);
    bool success            = true;
    if (n > 1)
      success &= print("ring" + cells,
                       poissons_ratios,
                       0.1 / (n * n),
                       2,
                       [&](double nu) { return inflate_ring(n, element, nu); });
    success &=
      print("panel" + cells, poissons_ratios, 0.1 / (n * n), 3, [&](double nu) {
        return bend_panel(n, n_fine, element, nu);
      });
    success &=
      print("torsion" + cells,
            poissons_ratios,
            0.2 / (n * n),
            1.5,
            [&](double nu) { return twist_bar(n, n_fine, element, nu); });
    return success;
  }

  bool
  study_all()
  {
    const std::vector<double> ratios = {0.3, 0.45, 0.49, 0.499, 0.4999};
    std::vector<double> more_ratios  = ratios;
    more_ratios.push_back(0.49999);
    bool success = true;
    for (const std::string &element : elements)
      {
        for (const double slenderness : {10., 30., 100., 300., 1000.})
          for (const unsigned int n_through : {1U, 2U})
            for (const unsigned int n : {5U, 10U, 20U})
              if (n_through == 1 || slenderness == 100)
                success &=
                  study_bending({slenderness, n, n_through, element, "reduced"},
                                ratios);
        for (const double slenderness : {10., 100., 1000.})
          for (const unsigned int n : {5U, 10U, 20U, 40U})
            success &= study_large_deflection(
              {slenderness, n, 1, element, "Green-Lagrange"});
        for (const unsigned int n : {1U, 2U, 4U})
          success &= study_bulky(n, 6, element, more_ratios);
        for (const unsigned int n : {3U, 5U, 10U})
          success &=
            print("plate," + element + ',' + std::to_string(n),
                  ratios,
                  0.35 / (n * n),
                  unbounded,
                  [&](double nu) { return bend_plate(n, 20, element, nu); });
      }
    for (const double size : {0.7, 0.35})
      success &= print("sphere,tetrahedron," + number(size),
                       more_ratios,
                       0.45 * size * size,
                       3,
                       [&](double nu) { return inflate_sphere(size, nu); });
    return success;
  }

  bool
  study_few()
  {
    bool success = true;
    for (const std::string &element : elements)
      {
        success &=
          study_bending({30, 10, 1, element, "reduced"}, {0.3, 0.4999});
        success &= study_bending({300, 10, 1, element, "reduced"}, {0.3});
        success &= study_bulky(2, 3, element, {0.3, 0.4999});
      }
    success &=
      study_large_deflection({100, 20, 1, "hexahedron", "Green-Lagrange"});
    return success;
  }
} // namespace



int
main(int argc, char **argv)
{
  const bool quick = (argc > 1 && std::string(argv[1]) == "--quick");
  int provided;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  print_header();
  const bool success = quick ? study_few() : study_all();
  MPI_Finalize();
  return success ? 0 : 1;
}
