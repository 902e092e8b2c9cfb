// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// How far a body is from the assumption of its strain: exact figures of simple
// deformations, and who is told when.

#include <acf/base/exceptions.h>
#include <acf/time/validity_monitor.h>

#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  using Map = std::function<Vector3(const Vector3 &)>;

  const std::vector<std::string> meshes = {box_mesh, cylinder_mesh};

  /** A long bar about the origin, L = 2, b = 0.2, h = 0.1 m along x, y, z. */
  const std::string bar_mesh =
    "set Mesh = box\n set Box from = -1, -0.1, -0.05\n"
    "set Box to = 1, 0.1, 0.05\n set Cells = 5, 1, 1\n"
    "set Element = hexahedron\n";

  BodyParameters
  parameters_of(const std::string &mesh,
                const RotationMeasure measure,
                const double poissons_ratio = 0.3)
  {
    BodyParameters parameters          = body_parameters("body", mesh);
    parameters.rotation_measure        = measure;
    parameters.material.poissons_ratio = poissons_ratio;
    return parameters;
  }

  Body
  make_body(const BodyParameters &parameters)
  {
    return Body(parameters, std::make_shared<ReferenceBody>(parameters, "."));
  }

  /** The figures after a map of the reference positions. */
  StrainValidity
  figures_after(const Body &body, const Map &map)
  {
    return *strain_validity(body,
                            CellGradients(body.discretization()),
                            transformed(body.operators().reference_positions,
                                        map));
  }
} // namespace



// Against those of the finite element library, for straight and curved cells.
TEST(CellGradients, AreThoseOfTheElements)
{
  Random random;
  std::vector<std::string> all = meshes;
  all.push_back(
    "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
    "set Cylinder to = 0, 0, 1\n set Cylinder radius = 0.5\n"
    "set Cells = 3, 2\n set Element = tetrahedron\n"
    "set Geometry = quadratic\n");
  for (const std::string &mesh : all)
    {
      const Body body = make_body(parameters_of(mesh, RotationMeasure::polar));
      const BodyDiscretization &space = body.discretization();
      const CellGradients gradients(space);
      NodalVector q(body.operators().n_unknowns());
      for (double &value : q)
        value = random.number(1);
      FEValues<dim> values(space.mesh().mapping(),
                           space.scalar_element(),
                           space.mesh().cell_quadrature(2),
                           update_gradients | update_JxW_values);
      ASSERT_EQ(gradients.n_points(), values.n_quadrature_points);
      std::vector<unsigned int> nodes(values.dofs_per_cell);
      std::vector<Matrix3> found;
      std::size_t cell_number = 0;
      double error = 0, volume = 0;
      for (const auto &cell : space.dof_handler().active_cell_iterators())
        {
          values.reinit(
            typename Triangulation<dim>::active_cell_iterator(cell));
          space.get_nodes(cell, nodes);
          gradients.evaluate(q, cell_number, found);
          for (const unsigned int point : values.quadrature_point_indices())
            {
              Matrix3 H;
              for (const unsigned int a : values.dof_indices())
                for (unsigned int i = 0; i < dim; ++i)
                  H[i] += q[dim * nodes[a] + i] * values.shape_grad(a, point);
              error = std::max(error, (found[point] - H).norm() / H.norm());
              volume += gradients.volume(cell_number, point);
            }
          ++cell_number;
        }
      EXPECT_EQ(cell_number, gradients.n_cells());
      EXPECT_LT(error, 1e-12);
      EXPECT_NEAR(volume, body.operators().volume, 1e-12 * volume);
    }
}



TEST(StrainValidity, RigidMotion)
{
  Random random;
  for (const std::string &mesh : meshes)
    for (const RotationMeasure measure :
         {RotationMeasure::polar, RotationMeasure::three_points})
      {
        const Body body = make_body(parameters_of(mesh, measure));
        const RigidMotion motion{random.vector(1),
                                 random.vector(100),
                                 random.rotation()};
        const StrainValidity found = figures_after(body, motion);
        // positions of about 100 m in bodies of about 1 m: 1e-14 m each
        for (const double figure :
             {found.strain, found.rotation, found.deflection})
          EXPECT_LT(figure, 2e-12);
        EXPECT_LT(found.neglected_strain, 1e-12);
        EXPECT_LT(found.neglected_energy, 1e-12);
        report("strain, rotation, deflection of a rigid motion",
               Vector3({found.strain, found.rotation, found.deflection}));
      }
}



// F = Q U with a given U: the polar rotation takes Q, and U - I is left.
TEST(StrainValidity, Stretch)
{
  Random random;
  const double a = 0.03, b = -0.01;
  for (const std::string &mesh : meshes)
    {
      const Body body =
        make_body(parameters_of(mesh, RotationMeasure::polar, 0.25));
      const Matrix3 axes = random.rotation(), Q = random.rotation();
      Matrix3 H;
      H[0][0]                    = a;
      H[1][1]                    = b;
      H                          = axes * H * transpose(axes);
      const StrainValidity found = figures_after(body, [&](const Vector3 &X) {
        return Q * (X + H * X) + Vector3({1, 2, 3});
      });

      // lambda = mu for this Poisson's ratio
      const double strain = (a + b) * (a + b) + 2 * (a * a + b * b);
      const double sum    = (a * a + b * b) / 2;
      const double neglected =
        sum * sum + (std::pow(a, 4) + std::pow(b, 4)) / 2;
      const double mixed = (a + b) * sum + a * a * a + b * b * b;
      EXPECT_NEAR(found.strain, a, 1e-12);
      EXPECT_NEAR(found.rotation, 0, 1e-12);
      EXPECT_NEAR(found.neglected_strain, std::sqrt(neglected / strain), 1e-12);
      EXPECT_NEAR(found.neglected_energy, 2 * mixed / strain, 1e-12);
    }
}



// With three points the frame stays where a shear turns the material.
TEST(StrainValidity, Shear)
{
  Random random;
  const double gamma = 0.2;
  for (const std::string &mesh : meshes)
    {
      const Body body =
        make_body(parameters_of(mesh, RotationMeasure::three_points));
      const Matrix3 Q            = random.rotation();
      const StrainValidity found = figures_after(body, [&](const Vector3 &X) {
        return Q * (X + Vector3({gamma * X[1], 0, 0}));
      });
      const double ratio =
        (body.material().lambda() + 2 * body.material().mu()) /
        body.material().mu();
      EXPECT_NEAR(found.strain, gamma / 2, 1e-12);
      EXPECT_NEAR(found.rotation, std::atan(gamma / 2), 1e-12);
      EXPECT_NEAR(found.neglected_strain, gamma / 2 * std::sqrt(ratio), 1e-12);
      EXPECT_NEAR(found.neglected_energy, 0, 1e-12);
    }
}



// A bar under tension, e, that is bent to w = k x^2 / 2 without lateral strain
// (Poisson's ratio zero): the axial strain is e - k z, the slope k x. Quadratic
// elements represent it.
TEST(StrainValidity, BentBar)
{
  const double L = 2, h = 0.1, e = 1e-4, k = 0.02;
  const Body body =
    make_body(parameters_of(bar_mesh, RotationMeasure::polar, 0));
  Random random;
  const RigidMotion motion   = random_motion(random);
  const StrainValidity found = figures_after(body, [&](const Vector3 &X) {
    return motion(X + Vector3({(e - k * X[2]) * X[0], 0, k * X[0] * X[0] / 2}));
  });

  // outermost of two integration points in the last of five cells and in the
  // height; the slope there is turned a little more by the axial strain
  const double g = 1 / std::sqrt(3.);
  const double x = L / 2 - L / 5 * (1 - g) / 2, z = h / 2 * g;
  const double slope = k * x;
  EXPECT_NEAR(found.strain, e + k * z, 1e-12);
  EXPECT_NEAR(found.rotation, slope, slope * (k * h + e));
  report("rotation of the bar against its slope", found.rotation / slope - 1);

  // 2 int E (e - k z) ((e - k z)^2 + (k x)^2) / 2 dV against
  // int E (e - k z)^2 dV: of a slender bar the tension against Euler's load
  const double strain = e * e + k * k * h * h / 12;
  const double energy =
    (e * e * e + e * k * k * (3 * h * h + L * L) / 12) / strain;
  EXPECT_NEAR(found.neglected_energy, energy, 1e-9);
  report("neglected energy of the bar", found.neglected_energy);
  report("neglected strain of the bar", found.neglected_strain);

  // cells of the length L/5
  EXPECT_NEAR(found.cell_bending,
              k * L * L / 200 / h,
              1e-4 * found.cell_bending);
  report("sagitta of a cell", found.cell_bending);

  // the end goes up by w(L/2) less the mean of w, and in or out by the turned
  // section
  const double up = (k * L * L / 8 - k * L * L / 24) / h;
  EXPECT_GT(found.deflection, up);
  EXPECT_LT(found.deflection, up + (e + k * h / 2) * L / 2 / L);
}



TEST(StrainValidity, NoRotation)
{
  const Body body = make_body(parameters_of(box_mesh, RotationMeasure::polar));
  NodalVector mirrored = body.operators().reference_positions;
  mirrored *= -1;
  EXPECT_FALSE(
    strain_validity(body, CellGradients(body.discretization()), mirrored));
}



namespace
{
  SystemParameters
  two_bodies()
  {
    SystemParameters system;
    system.bodies = {body_parameters("first", box_mesh),
                     body_parameters("second", box_mesh)};
    return system;
  }

  /** The first body stretched by e, the second in its reference positions. */
  SystemState
  state_at(const MultibodySystem &system, const double time, const double e)
  {
    SystemState state;
    state.time = time;
    for (const Body &body : system.bodies())
      state.positions.push_back(body.operators().reference_positions);
    state.positions[0] *= 1 + e;
    return state;
  }

  struct Watch
  {
    const MultibodySystem system{two_bodies(), "."};
    std::ostringstream warnings;
    Statistics statistics;
    ValidityMonitor monitor;

    Watch(const ValidityParameters &parameters, const double end_time)
      : monitor(system, parameters, end_time, warnings, statistics)
    {}

    std::string
    description() const
    {
      std::ostringstream stream;
      monitor.describe(stream);
      return stream.str();
    }
  };
} // namespace



TEST(ValidityMonitor, WarnsOnce)
{
  Watch watch({}, 1);
  watch.monitor.observe(state_at(watch.system, 0, 0.01));
  EXPECT_EQ(watch.warnings.str(), "");
  EXPECT_NE(watch.description().find("all bodies stayed"), std::string::npos);

  watch.monitor.observe(state_at(watch.system, 0.2, 0.03));
  const std::string warning = watch.warnings.str();
  EXPECT_EQ(warning.find("acf-dealii: warning: the body 'first' at time 0.2 s"),
            0U)
    << warning;
  EXPECT_NE(warning.find("strain 0.03 (limit 0.02)"), std::string::npos)
    << warning;
  EXPECT_EQ(std::count(warning.begin(), warning.end(), '\n'), 1);

  watch.monitor.observe(state_at(watch.system, 0.4, 0.05));
  watch.monitor.observe(state_at(watch.system, 0.6, 0.04));
  EXPECT_EQ(watch.warnings.str(), warning);

  ASSERT_EQ(ValidityMonitor::names()[0], "strain");
  EXPECT_NEAR(watch.monitor.maxima(0)[0].value, 0.05, 1e-12);
  EXPECT_EQ(watch.monitor.maxima(0)[0].time, 0.4);
  EXPECT_LT(watch.monitor.maxima(1)[0].value, 1e-12);
  const std::string description = watch.description();
  EXPECT_EQ(std::count(description.begin(), description.end(), '\n'), 1);
  EXPECT_NE(description.find("'first' passed the limits of its strain at 0.2"),
            std::string::npos)
    << description;
  EXPECT_EQ(watch.statistics.validity_checks, 8U);
}



TEST(ValidityMonitor, AZeroLimitIsNone)
{
  ValidityParameters parameters;
  parameters.limits        = StrainValidity();
  parameters.limits.strain = 0.02;
  Watch watch(parameters, 1);
  watch.monitor.observe(state_at(watch.system, 0, 0.019));
  EXPECT_EQ(watch.warnings.str(), "");
  parameters.limits.strain = 0;
  Watch blind(parameters, 1);
  blind.monitor.observe(state_at(blind.system, 0, 0.5));
  EXPECT_EQ(blind.warnings.str(), "");
}



TEST(ValidityMonitor, BentCellsCountWithGreenLagrange)
{
  ValidityParameters limits;
  limits.limits              = StrainValidity();
  limits.limits.cell_bending = 0.1;
  for (const auto measure :
       {StrainMeasure::reduced, StrainMeasure::green_lagrange})
    for (const double k : {0.4, 0.6})
      {
        SystemParameters parameters;
        parameters.bodies = {parameters_of(bar_mesh, RotationMeasure::polar)};
        parameters.bodies[0].strain_measure = measure;
        const MultibodySystem system(parameters, ".");
        SystemState state = system.initial_state();
        NodalVector &x    = state.positions[0];
        for (unsigned int a = 0; a < x.size() / dim; ++a)
          {
            const double axial = x[dim * a];
            x[dim * a] -= k * axial * x[dim * a + 2];
            x[dim * a + 2] += k * axial * axial / 2;
          }
        std::ostringstream warnings;
        Statistics statistics;
        ValidityMonitor monitor(system, limits, 1, warnings, statistics);
        monitor.observe(state);
        // cells of a fifth of the length 2, height 0.1: 0.2 k
        const bool warns =
          warnings.str().find("cell bending 0.1") != std::string::npos;
        EXPECT_EQ(warns, measure == StrainMeasure::green_lagrange && k > 0.5)
          << warnings.str();
      }
}



TEST(ValidityMonitor, Stops)
{
  ValidityParameters parameters;
  parameters.action = ValidityParameters::Action::stop;
  Watch watch(parameters, 1);
  EXPECT_NO_THROW(watch.monitor.observe(state_at(watch.system, 0, 0.019)));
  try
    {
      watch.monitor.observe(state_at(watch.system, 0.3, 0.025));
      FAIL() << "the limit of 0.02 is passed";
    }
  catch (const SimulationError &error)
    {
      const std::string message = error.what();
      for (const std::string part :
           {"Validity/Action", "'first'", "0.3 s", "strain 0.025 (limit 0.02)"})
        EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  EXPECT_EQ(watch.warnings.str(), "");
}



// Of 1000 steps to the end at 1 s every tenth is checked, and the end, which
// the last step may pass.
TEST(ValidityMonitor, FewChecks)
{
  Watch watch({}, 0.9999);
  for (unsigned int n = 0; n <= 1000; ++n)
    watch.monitor.observe(
      state_at(watch.system, n < 1000 ? 1e-3 * n : 0.9999, 0));
  EXPECT_EQ(watch.statistics.validity_checks, 2 * 101U);
  watch.monitor.observe(state_at(watch.system, 0.9999, 0.03));
  EXPECT_NE(watch.warnings.str(), "");

  // nothing but a static equilibrium
  Watch at_start({}, 0);
  at_start.monitor.observe(state_at(at_start.system, 0, 0.03));
  EXPECT_NE(at_start.warnings.str(), "");
}
