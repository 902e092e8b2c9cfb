// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include "bulky_problems.h"

#include <acf/mechanics/stress.h>

#include <unistd.h>

#include <fstream>
#include <map>

namespace Tests
{
  namespace
  {
    /** The ring or the sphere, with Lame's solutions. */
    struct Vessel
    {
      bool sphere     = false;
      double pressure = 1e-4 * youngs_modulus;

      Vector3
      displacement(const Point<dim> &X, const double nu) const
      {
        const double a3 = 1, b3 = sphere ? 8 : 4; // radii to the power 3 or 2
        const double scale = pressure * a3 / (youngs_modulus * (b3 - a3));
        if (sphere)
          return scale *
                 ((1 - 2 * nu) + (1 + nu) * b3 / 2 / std::pow(X.norm(), 3)) *
                 Vector3(X);
        const double r = std::hypot(X[0], X[1]);
        Vector3 u = scale * ((1 - nu) + (1 + nu) * b3 / (r * r)) * Vector3(X);
        u[2]      = -2 * nu * scale * X[2];
        return u;
      }

      double
      von_mises(const Point<dim> &X) const
      {
        if (sphere)
          return 1.5 * pressure * 8 / (7 * std::pow(X.norm(), 3));
        return pressure / 3 *
               std::sqrt(1 + 48 / std::pow(std::hypot(X[0], X[1]), 4));
      }
    };

    /** A script of gmsh in the temporary folder, as long as the object lives.
     */
    class Geometry
    {
    public:
      explicit Geometry(const std::string &script)
        : file(std::filesystem::temp_directory_path() /
               ("acf-locking-" + std::to_string(getpid()) + "-" +
                std::to_string(std::hash<std::string>()(script)) + ".geo"))
      {
        std::ofstream(file) << script;
      }

      Geometry(const Geometry &) = delete;
      Geometry &
      operator=(const Geometry &) = delete;

      ~Geometry()
      {
        std::filesystem::remove(file);
      }

      std::string
      mesh() const
      {
        return "  set Mesh = " + file.string();
      }

    private:
      const std::filesystem::path file;
    };


    /** Root mean square errors over the nodes. */
    Figures
    inflate(const Vessel &vessel,
            const Geometry &geometry,
            const std::string &element,
            const double poissons_ratio)
    {
      const Solution solution(
        {geometry.mesh(),
         "outer",
         "  set Type = pressure\n  set On = body: inner\n  set Value = " +
           number(vessel.pressure),
         element,
         poissons_ratio});
      const Body &body    = solution.body();
      const NodalVector X = body.placement(), &x = solution.state.positions[0];
      const auto stresses = StressEvaluation(body, x, 0).nodal_values();
      double difference = 0, size = 0, stress_difference = 0, stress_size = 0;
      for (unsigned int a = 0; a < X.size() / dim; ++a)
        {
          Point<dim> node;
          Vector3 u;
          for (unsigned int i = 0; i < dim; ++i)
            {
              node[i] = X[dim * a + i];
              u[i]    = x[dim * a + i] - node[i];
            }
          const Vector3 expected = vessel.displacement(node, poissons_ratio);
          difference += (u - expected).norm_square();
          size += expected.norm_square();
          stress_difference += std::pow(von_mises_stress(stresses[a].stress) -
                                          vessel.von_mises(node),
                                        2);
          stress_size += std::pow(vessel.von_mises(node), 2);
        }
      return Figures(solution,
                     std::sqrt(difference / size),
                     std::sqrt(stress_difference / stress_size));
    }

    /** See inflate_ring(). */
    std::string
    ring_script(const unsigned int n, const bool hexahedra)
    {
      const std::string recombine = hexahedra ? " Recombine;" : "";
      return "n = " + std::to_string(n) + R"(;
Point(1) = {0, 0, -0.5};
For r In {1:2}
  Point(4 * r + 0) = {r, 0, -0.5};
  Point(4 * r + 1) = {0, r, -0.5};
  Point(4 * r + 2) = {-r, 0, -0.5};
  Point(4 * r + 3) = {0, -r, -0.5};
  For k In {0:3}
    Circle(4 * r + k) = {4 * r + k, 1, 4 * r + (k + 1) % 4};
  EndFor
EndFor
For k In {0:3}
  Line(20 + k) = {4 + k, 8 + k};
EndFor
Transfinite Curve{4:11} = 2 * n + 1;
Transfinite Curve{20:23} = n + 1;
For k In {0:3}
  Curve Loop(k + 1) = {20 + k, 8 + k, -(20 + (k + 1) % 4), -(4 + k)};
  Plane Surface(k + 1) = {k + 1};
  Transfinite Surface{k + 1};
)" + (hexahedra ? "  Recombine Surface{k + 1};\n" : "") +
             R"(EndFor
inner[] = {};
outer[] = {};
volumes[] = {};
For k In {1:4}
  made[] = Extrude{0, 0, 1}{ Surface{k}; Layers{n};)" +
             recombine + R"( };
  volumes[] += made[1];
  outer[] += made[3];
  inner[] += made[5];
EndFor
Physical Volume("ring") = volumes[];
Physical Surface("inner") = inner[];
Physical Surface("outer") = outer[];
)";
    }

    std::string
    sphere_script(const double mesh_size)
    {
      return R"(SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 1};
Sphere(2) = {0, 0, 0, 2};
BooleanDifference(3) = { Volume{2}; Delete; }{ Volume{1}; Delete; };
all[] = Boundary{ Volume{3}; };
inner[] = Surface In BoundingBox{-1.1, -1.1, -1.1, 1.1, 1.1, 1.1};
all[] -= inner[];
Physical Volume("shell") = {3};
Physical Surface("inner") = inner[];
Physical Surface("outer") = all[];
Mesh.MeshSizeMax = )" +
             number(mesh_size) + ";\n";
    }



    /** See bend_panel(). */
    std::string
    panel_script(const unsigned int n, const bool hexahedra)
    {
      return "n = " + std::to_string(n) + R"(;
Point(1) = {0, 0, -6};
Point(2) = {48, 44, -6};
Point(3) = {48, 60, -6};
Point(4) = {0, 44, -6};
For k In {0:3}
  Line(k + 1) = {k + 1, (k + 1) % 4 + 1};
EndFor
Transfinite Curve{1:4} = 2 * n + 1;
Curve Loop(1) = {1:4};
Plane Surface(1) = {1};
Transfinite Surface{1};
)" + (hexahedra ? "Recombine Surface{1};\n" : "") +
             "made[] = Extrude{0, 0, 12}{ Surface{1}; Layers{n};" +
             (hexahedra ? " Recombine;" : "") + R"( };
Physical Volume("panel") = {made[1]};
Physical Surface("loaded") = {made[3]};
Physical Surface("held") = {made[5]};
)";
    }

    Problem
    panel(const Geometry &geometry, const std::string &element, const double nu)
    {
      return {
        geometry.mesh(),
        "held",
        "  set Type = traction\n  set On = body: loaded\n  set Value = 0; " +
          number(1e-5 * youngs_modulus) + "; 0",
        element,
        nu};
    }

    /** A square bar, n cells across. */
    Problem
    bar(const unsigned int n, const std::string &element, const double nu)
    {
      const std::string across = std::to_string(n);
      return {
        "  set Mesh = box\n  set Box from = -0.5, 0, -0.5\n"
        "  set Box to = 0.5, 3, 0.5\n  set Cells = " +
          across + ", " + std::to_string(3 * n) + ", " + across,
        "y min",
        "  set Type = torque\n  set On = body: y max\n  set Value = 0; " +
          number(1e-5 * youngs_modulus) + "; 0",
        element,
        nu};
    }


    /** A square plate of 1 m, n x n cells. */
    Problem
    plate(const unsigned int n, const std::string &element, const double nu)
    {
      const std::string cells = std::to_string(n);
      return {
        "  set Mesh = box\n  set Box from = 0, 0, -0.005\n"
        "  set Box to = 1, 1, 0.005\n  set Cells = " +
          cells + ", " + cells + ", 1",
        "y min",
        "  set Type = force\n  set On = body: y max\n  set Value = 0; 0; " +
          number(2.5e-11 * youngs_modulus),
        element,
        nu};
    }

    /** Compared with the same on fine hexahedra, computed once. */
    Figures
    compare(const Problem &problem, const Problem &fine)
    {
      static std::map<std::string, double> energies;
      const std::string key = model_file(fine);
      if (energies.count(key) == 0)
        energies[key] = Solution(fine).energy();
      const Solution solution(problem);
      return Figures(solution, 1 - solution.energy() / energies[key]);
    }
  } // namespace



  Figures
  inflate_ring(const unsigned int n,
               const std::string &element,
               const double poissons_ratio)
  {
    return inflate(Vessel(),
                   Geometry(ring_script(n, element == "hexahedron")),
                   element,
                   poissons_ratio);
  }



  Figures
  inflate_sphere(const double mesh_size, const double poissons_ratio)
  {
    return inflate(Vessel{true},
                   Geometry(sphere_script(mesh_size)),
                   "tetrahedron",
                   poissons_ratio);
  }



  Figures
  bend_panel(const unsigned int n,
             const unsigned int n_fine,
             const std::string &element,
             const double poissons_ratio)
  {
    const Geometry geometry(panel_script(n, element == "hexahedron")),
      fine(panel_script(n_fine, true));
    return compare(panel(geometry, element, poissons_ratio),
                   panel(fine, "hexahedron", poissons_ratio));
  }



  Figures
  twist_bar(const unsigned int n,
            const unsigned int n_fine,
            const std::string &element,
            const double poissons_ratio)
  {
    return compare(bar(n, element, poissons_ratio),
                   bar(n_fine, "hexahedron", poissons_ratio));
  }



  Figures
  bend_plate(const unsigned int n,
             const unsigned int n_fine,
             const std::string &element,
             const double poissons_ratio)
  {
    return compare(plate(n, element, poissons_ratio),
                   plate(n_fine, "hexahedron", poissons_ratio));
  }
} // namespace Tests
