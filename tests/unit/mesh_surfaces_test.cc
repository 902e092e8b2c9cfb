// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_surfaces.h>

#include <filesystem>

#include <unit/mesh_files.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  const std::string box =
    "set Mesh = box\n set Box from = 0, 0, 0\n"
    "set Box to = 2, 1, 1\n set Cells = 4, 2, 2\n";

  const std::string cylinder =
    "set Mesh = cylinder\n set Cylinder from = 0, 0, 0\n"
    "set Cylinder to = 0, 0, 2\n set Cylinder radius = 1\n set Cells = 12, 2\n";
} // namespace

TEST_F(MeshFiles, SurfacesByPlace)
{
  for (const std::string element : {"tetrahedron", "hexahedron"})
    {
      const auto mesh = mesh_of(
        box + "set Element = " + element +
        "\n set Surfaces = end: plane 2 0 0 -3 0 0; "
        "corner: box 1 0 0 2 1 1 tolerance 1e-6;"
        "all: box 0 0 0 2 1 1; thick: plane 2.3 0.1 0 1 0 0 tolerance 0.3");
      EXPECT_NEAR(area(*mesh, "end"), 1, 1e-12);
      EXPECT_NEAR(area(*mesh, "thick"), 1, 1e-12);
      EXPECT_NEAR(area(*mesh, "corner"), 1 + 4 * 1, 1e-12);
      EXPECT_NEAR(area(*mesh, "all"), 10, 1e-12);
      // names that the faces had remain
      EXPECT_NEAR(area(*mesh, "x max"), 1, 1e-12);
      EXPECT_NEAR(area(*mesh, "y min"), 2, 1e-12);
      EXPECT_EQ(mesh->surfaces().size(), 10);

      // the end faces of the coarse mesh have all of their vertices on the rim
      const auto round =
        mesh_of(cylinder + "set Element = " + element +
                "\n set Surfaces = lateral: cylinder 0 0 7 0 0 -1 1; "
                "top: plane 0 0 2 0 0 1");
      EXPECT_EQ(area(*round, "lateral"), area(*round, "side"));
      EXPECT_EQ(area(*round, "top"), area(*round, "end"));
    }
}

TEST_F(MeshFiles, SurfacesByPlaceInFiles)
{
  // of the file some faces have names: those and new ones on the same faces
  for (const std::string mirror : {"none", "x"})
    {
      const auto mesh = mesh_of(
        "set Mesh = two_boxes.geo\n set Mirror = " + mirror +
        "\n set Surfaces = start again: plane 0 0 0 1 0 0 ; wall: plane 0 1 0 "
        "0 1 0");
      if (mirror == "none")
        EXPECT_NEAR(area(*mesh, "start again"), area(*mesh, "start"), 1e-12);
      else
        EXPECT_NEAR(area(*mesh, "wall both"), 4, 1e-12);
      EXPECT_NEAR(area(*mesh, "wall"), 2, 1e-12);
      EXPECT_NEAR(area(*mesh, "ends"), mirror == "none" ? 2 : 1, 1e-12);
    }

  // a mesh without any group
  convert("cylinder.geo", "plain.msh");
  const auto mesh = mesh_of(
    "set Mesh = plain.msh\n"
    "set Surfaces = round: cylinder 0 0 0 0 0 1 0.5 tolerance 1e-7",
    folder);
  EXPECT_NEAR(area(*mesh, "round"), numbers::PI, 0.2);
}

TEST_F(MeshFiles, SurfacesByPlaceErrors)
{
  const auto expect = [&](const std::string &surfaces,
                          const std::vector<std::string> &parts) {
    std::vector<std::string> all = parts;
    all.insert(all.end(), {"Bodies/b", "'Surfaces'"});
    expect_mesh_error(box + "set Surfaces = " + surfaces, all);
  };
  expect("end: plane 2.01 0 0 1 0 0",
         {"selects no face", "at (2, ", "up to 0.01 m from it"});
  expect("pin: cylinder 0 0 0 0 0 1 5", {"nearest one", "m from it"});
  expect("x max: plane 2 0 0 1 0 0", {"has already", "'x min'"});
  expect("a: plane 2 0 0 1 0 0; a: plane 0 0 0 1 0 0", {"two surfaces 'a'"});
  expect("plane 2 0 0 1 0 0", {"'NAME: plane x y z nx ny nz'"});
  expect(": plane 2 0 0 1 0 0", {"a name"});
  expect("a: plane 2 0 0 1 0", {"'a: plane 2 0 0 1 0'"});
  expect("a: sphere 2 0 0 1", {"cylinder"});
  expect("a:", {"cylinder"});
  expect("a: plane 2 0 0 1 0 zero", {"numbers", "'zero'"});
  expect("a: plane 2 0 0 1 0 nan", {"numbers", "'nan'"});
  expect("a: plane 2 0 0 0 0 0", {"not zero"});
  expect("a: cylinder 0 0 0 0 0 1 -1", {"positive radius"});
  expect("a: box 1 0 0 0 1 1", {"smaller coordinates first"});
  expect("a: plane 2 0 0 1 0 0 tolerance -1", {"positive tolerance"});
  expect("a: plane 2 0 0 1 0 0 tolerance", {"one number at the end"});
  expect("a: plane 2 0 0 1 0 0;", {"separated by ';'"});
}

TEST_F(MeshFiles, Scale)
{
  convert("two_boxes.geo", "mm.msh");
  const auto mesh = mesh_of(
    "set Mesh = mm.msh\n set Mesh scale = 0.001\n"
    "set Surfaces = wall: plane 0 0.001 0 0 1 0",
    folder);
  EXPECT_NEAR(volume(*mesh), 2e-9, 1e-20);
  EXPECT_NEAR(area(*mesh, "wall"), 2e-6, 1e-17);

  // the size is that of the scaled body
  const auto script = mesh_of(
    "set Mesh = two_boxes.geo\n set Mesh scale = 10\n set Mesh size = 1.2");
  const auto fine = mesh_of("set Mesh = two_boxes.geo\n set Mesh size = 0.12");
  EXPECT_EQ(script->triangulation().n_active_cells(),
            fine->triangulation().n_active_cells());
  EXPECT_NEAR(volume(*script), 2000, 1e-9);

  // IGES has a unit, mm here; the factor comes after it
  const auto cad = mesh_of("set Mesh = box.igs\n set Mesh scale = 2");
  EXPECT_NEAR(volume(*cad), 16e-9, 1e-20);

  expect_mesh_error("set Mesh = mm.msh\n set Mesh scale = 0",
                    {"'Mesh scale'", "a positive number"},
                    folder);
  expect_mesh_error(box + "set Mesh scale = 2",
                    {"'Mesh scale'", "only files are scaled"});
}
