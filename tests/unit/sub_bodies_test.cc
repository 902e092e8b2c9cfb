// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Bodies that are cut into parts, against the whole ones and beam theory.

#include <acf/base/exceptions.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "recorded_run.h"
#include "reference/cantilever.h"
#include "unit/mesh_test.h"

namespace
{
  using namespace Tests;

  void
  report(const std::string &label, const double value)
  {
    std::cout << "[ measured ] " << label << ": " << value << std::endl;
  }

  std::string
  section(const std::string &name, const std::string &entries)
  {
    return "subsection " + name + "\n" + entries + "\nend\n";
  }

  // "Names" and a subsection of each.
  std::string
  objects(const std::string &name,
          const std::vector<std::pair<std::string, std::string>> &entries)
  {
    std::string names, sections;
    for (const auto &[object, text] : entries)
      {
        names += (names.empty() ? "" : ", ") + object;
        sections += section(object, text);
      }
    return section(name, "set Names = " + names + "\n" + sections);
  }

  // A beam along y, 2 m long, 0.1 m wide in x and 0.05 m high in z.
  constexpr double length  = 2;
  constexpr double width   = 0.1;
  constexpr double height  = 0.05;
  constexpr double modulus = 2.07e11;

  std::string
  beam(const std::string &cut,
       const std::string &entries = "",
       const std::string &cells   = "1, 16, 1")
  {
    return R"(
      set Mesh            = box
      set Element         = hexahedron
      set Box from        = -0.05, 0, -0.025
      set Box to          =  0.05, 2,  0.025
      set Young's modulus = 2.07e11
      set Poisson's ratio = 0.3
      set Density         = 7800
      set Cells           = )" +
           cells + "\nset Cut = " + cut + "\n" + entries;
  }

  const std::string clamp =
    objects("Joints",
            {{"clamp", "set Type = fixed\nset Between = beam: y min, ground"}});

  const std::string static_run =
    section("Start", "set Equilibrium = true") +
    section("Time integration", "set End time = 0");

  const std::string tip = objects("Probes", {{"tip", "set Of = beam: y max"}});

  std::string
  tip_force(const double force)
  {
    return objects("Loads",
                   {{"tip",
                     "set Type = force\nset On = beam: y max\nset Value = 0; "
                     "0; -" +
                       std::to_string(force)}});
  }

  // Values of the probes in the static equilibrium.
  std::vector<double>
  equilibrium(const std::string &text)
  {
    RecordedRun run(text + static_run, 0);
    FactorizationCache cache(run.statistics);
    std::ostringstream log;
    run.recorder.observe(initial_state(run.system,
                                       run.model.start,
                                       run.model.time.step_size,
                                       cache,
                                       run.statistics,
                                       log));
    return run.recorder.values.back();
  }

  void
  expect_error(const std::string &text, const std::vector<std::string> &parts)
  {
    Testing::expect_input_error(
      [&]() {
        RecordedRun run(text + section("Time integration",
                                       "set End time = 1\nset Step size = 1"),
                        0);
      },
      parts);
  }
} // namespace



// A cut beam starts and flies like the whole one: placed, turned, bent and
// thrown. Identical cut bodies share the operators of their parts.
TEST(SubBodies, FlyLikeTheWholeBody)
{
  const std::string motion =
    "set Position = 1, 2, 3\nset Rotation = 0.3, -1, 0.5\n"
    "set Velocity = 1, -2, 5\nset Angular velocity = 2, 4, -3\n"
    "set Displacement field = 0; 0; 1e-3*y^2\n"
    "set Velocity field = 0; 0; 0.1*y^2\n";
  const std::string rest =
    section("Loads", "set Gravity = 0, 0, -9.81") +
    section("Time integration", "set End time = 0.2\nset Step size = 2e-3") +
    objects("Probes",
            {{"momentum", "set Type = momentum"},
             {"spin", "set Type = angular momentum"},
             {"energy", "set Type = energy"},
             {"start", "set Of = beam: y min"},
             {"end", "set Of = beam: y max"},
             {"point",
              "set Type = point position\nset Of = beam\n"
              "set Point = 0.05, 1.1, 0"}});
  RecordedRun whole(objects("Bodies", {{"beam", beam("", motion)}}) + rest,
                    0.1);
  RecordedRun cut(objects("Bodies",
                          {{"beam", beam("y: 0.5, 1.25", motion)},
                           {"copy", beam("y: 0.5, 1.25", motion)}}) +
                    rest,
                  0.1);
  ASSERT_EQ(cut.system.bodies().size(), 6);
  EXPECT_EQ(cut.system.n_reference_bodies(), 3);
  EXPECT_EQ(cut.system.bodies()[1].name(), "beam 2");
  EXPECT_EQ(cut.system.bodies()[1].whole(), "beam");
  EXPECT_EQ(cut.system.bodies()[1].section(), "Bodies/beam");
  ASSERT_EQ(cut.system.joints().size(), 4);
  EXPECT_EQ(cut.system.joints()[1].name, "beam 2 + beam 3");
  double mass = 0;
  for (const Body &body : cut.system.bodies())
    mass += body.operators().mass;
  EXPECT_NEAR(mass, 2 * whole.system.bodies()[0].operators().mass, 1e-10);

  whole.run();
  cut.run();
  // Values: momentum, angular momentum, energies (6 to 8), positions.
  double start = 0, conserved = 0, position = 0;
  for (unsigned int k = 0; k < whole.recorder.values.size(); ++k)
    for (unsigned int i = 0; i < whole.recorder.values[0].size(); ++i)
      {
        const double n_beams = (i < 9 ? 2. : 1.);
        const double value   = whole.recorder.values[k][i];
        const double difference =
          std::abs(cut.recorder.values[k][i] / n_beams - value);
        if (k == 0 && i != 7)
          start = std::max(start, difference / std::max(1., std::abs(value)));
        else if (i < 6)
          conserved =
            std::max(conserved, difference / std::max(1., std::abs(value)));
        else if (i > 8)
          position = std::max(position, difference);
      }
  report("relative difference at the start", start);
  report("relative difference of momenta", conserved);
  report("difference of positions, m", position);
  EXPECT_LT(start, 1e-10);
  EXPECT_LT(conserved, 1e-6);
  EXPECT_LT(position, 1e-5); // bending by 4 mm, 0.2 s
}



// A small load. Where the beam is cut, the sections may warp freely: shear
// stresses are spread evenly there instead of like a parabola.
TEST(SubBodies, CutsSoftenACantileverALittle)
{
  const auto deflection = [&](const std::string &cut) {
    return -equilibrium(objects("Bodies", {{"beam", beam(cut)}}) + clamp +
                        tip_force(100) + tip)[2];
  };
  const double whole = deflection("");
  for (const unsigned int n : {2, 4, 8, 16})
    {
      const double softening =
        deflection(std::to_string(n) + " along y") / whole - 1;
      report(std::to_string(n) + " parts: relative softening", softening);
      EXPECT_GT(softening, 0);
      EXPECT_LT(softening, 1e-4); // measured: 5e-5 with 16 parts
    }
}



// A tip force that bends the beam by a third of its length.
TEST(SubBodies, ConvergeToTheElastica)
{
  Reference::PlanarBeam reference;
  reference.length         = length;
  reference.height         = height;
  reference.width          = width;
  reference.youngs_modulus = modulus;
  const double force       = 6.25e4;
  const auto exact         = Reference::cantilever_tip(reference, force);
  report("reference deflection", exact.deflection);
  report("reference shortening", exact.shortening);

  std::vector<double> errors;
  for (const std::string cut :
       {"", "2 along y", "4 along y", "8 along y", "16 along y"})
    {
      const auto values =
        equilibrium(objects("Bodies", {{"beam", beam(cut, "", "1, 32, 1")}}) +
                    clamp + tip_force(force) + tip);
      const double error = std::hypot(-values[2] - exact.deflection,
                                      length - values[1] - exact.shortening);
      report("'" + cut + "': error of the tip, m", error);
      errors.push_back(error);
    }
  for (const double order : orders({errors.begin(), errors.end() - 1}))
    {
      report("order", order);
      EXPECT_GT(order, 1.3);
    }
  EXPECT_LT(errors.back(), 5e-4); // measured: 2.9e-4
}



// The reference against the converged solution that is known of beam elements
// for a cantilever with a height of a quarter of its length.
TEST(SubBodies, ReferenceOfTheElastica)
{
  Reference::PlanarBeam reference;
  reference.length         = 2;
  reference.height         = 0.5;
  reference.width          = 0.1;
  reference.youngs_modulus = 2.07e11;
  const auto exact         = Reference::cantilever_tip(reference, 6.25e7);
  EXPECT_NEAR(exact.deflection, 0.7106, 1e-4);
  EXPECT_NEAR(exact.shortening, 0.1510, 1e-4);
  // small: F L^3 / (3 E I)
  const auto small =
    Reference::cantilever_tip(reference,
                              1e3,
                              Reference::BeamTheory::bernoulli_euler);
  EXPECT_NEAR(small.deflection / (1e3 * 8 * 4 / 2.07e11 / 0.0125), 1, 1e-9);
}



// Surfaces that several parts share carry tractions and pressures; the clamp
// holds the sum, and the joints between parts what is beyond them.
TEST(SubBodies, LoadsOnSharedSurfacesAndReactionsBetweenParts)
{
  const std::string rest =
    objects("Loads",
            {{"top",
              "set Type = pressure\nset On = beam: z max\nset Value = 30"},
             {"side",
              "set Type = traction\nset On = beam: x min\n"
              "set Value = 200; 0; 0"}}) +
    objects("Probes",
            {{"clamp", "set Type = reaction\nset Of = clamp"},
             {"first", "set Type = reaction\nset Of = beam 1 + beam 2"},
             {"second", "set Type = reaction\nset Of = beam 2 + beam 3"}});
  const auto values = equilibrium(
    objects("Bodies", {{"beam", beam("y: 0.5, 1.25")}}) + clamp + rest);
  // 30 Pa on 0.1 m, 200 Pa on 0.05 m; reactions on the parts 1, 1 and 2
  const std::vector<double> lengths = {2, -1.5, -0.75};
  for (unsigned int j = 0; j < 3; ++j)
    {
      EXPECT_NEAR(values[6 * j], -10 * lengths[j], 1e-4);
      EXPECT_NEAR(values[6 * j + 1], 0, 1e-3);
      EXPECT_NEAR(values[6 * j + 2], 3 * lengths[j], 1e-4);
    }
  expect_error(
    objects("Bodies", {{"beam", beam("y: 0.5, 1.25")}}) +
      objects("Loads", {{"top", "set On = beam: z max\nset Value = 1; 0; 0"}}),
    {"Loads/top",
     "'On'",
     "the surface 'z max', which the parts 'beam 1', 'beam 2', "
     "'beam 3' share",
     "'beam 1: z max'"});
}



// Ends of a chord on different parts, and a point on a third one.
TEST(SubBodies, ChordsAcrossParts)
{
  const std::string probes =
    objects("Probes",
            {{"chord",
              "set Type = chord\nset From = beam: y min\nset To = beam: y max\n"
              "set Point = 0, 1, 0"},
             {"frame",
              "set Type = chord frame\nset From = beam: y min\n"
              "set To = beam: y max\nset Point = 0, 1, 0"}});
  const auto values = [&](const std::string &cut) {
    return equilibrium(objects("Bodies", {{"beam", beam(cut)}}) + clamp +
                       tip_force(100) + probes);
  };
  const auto whole = values(""), cut = values("y: 0.5, 1.25");
  for (unsigned int i = 0; i < whole.size(); ++i)
    EXPECT_NEAR(cut[i], whole[i], 1e-3 * std::abs(whole[1])) << i;
  // 3/16 of the deflection F L^3 / (3 E I) of the tip
  EXPECT_NEAR(whole[1], 3. / 16 * 1.24e-3, 1e-5);
}



TEST(SubBodies, NameWhatIsWrong)
{
  const std::string cut = objects("Bodies", {{"beam", beam("2 along y")}});
  const auto hinge = [](const std::string &between, const std::string &name) {
    return objects("Joints",
                   {{name, "set Type = spherical\nset Between = " + between}});
  };
  expect_error(objects("Bodies",
                       {{"beam", beam("2 along y")}, {"beam 2", beam("")}}),
               {"Bodies/beam", "'Cut'", "a part 'beam 2'", "another body"});
  expect_error(cut + hinge("beam: y min, ground", "beam 1 + beam 2"),
               {"'beam 1 + beam 2'", "the joint between two parts"});
  expect_error(cut + hinge("beam: x min, ground", "j"),
               {"Joints/j", "'Between'", "'beam 1', 'beam 2' share"});
  expect_error(cut + hinge("beam: front, ground", "j"),
               {"surface 'front'", "'x max', 'x min', 'y max', 'y min'"});
  expect_error(cut + hinge("beam 3: x min, ground", "j"),
               {"the body 'beam 3'", "beam, beam 1, beam 2"});
  expect_error(cut + hinge("beam 2: y min, ground", "j"),
               {"surface 'y min'", "'cut to 1', 'x max'"});
  expect_error(
    cut + objects("Probes",
                  {{"p",
                    "set Type = point position\nset Of = beam\n"
                    "set Point = 0, 3, 0"}}),
    {"Probes/p", "'Point'", "outside all parts", "a point of the body 'beam'"});
  expect_error(cut + objects("Probes",
                             {{"p",
                               "set Type = point position\nset Of = beam 1\n"
                               "set Point = 0, 1.5, 0"}}),
               {"Probes/p",
                "'Point'",
                "outside the body",
                "a point of the body 'beam 1'"});
  expect_error(objects("Bodies", {{"beam", beam("y: 0.25, 0.3")}}),
               {"Bodies/beam", "'Cut'", "the part 2 from y = 0.25 to y = 0.3"});
}
