// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

// Meshes that are divided into parts.

#include <acf/mechanics/mesh_division.h>
#include <acf/mechanics/mesh_generation.h>

#include <gtest/gtest.h>

#include <unit/mesh_test.h>

namespace
{
  using namespace ACF;
  using namespace ACF::Testing;

  const MeshSource source{"Bodies/b", "test"};

  DividedMesh
  divide(const MeshData &mesh, const std::string &cut)
  {
    return divide_mesh(mesh, parse_cut(cut, source.section), source);
  }

  MeshData
  box(const ReferenceCell &cell, const unsigned int n_along_x)
  {
    return generate_box(Point<dim>(-1, 0, 0),
                        Point<dim>(2, 1, 0.5),
                        {{n_along_x, 2, 1}},
                        cell);
  }

  // The mesh of a file of the test data.
  MeshData
  data_of(const std::string &file)
  {
    return make_mesh_data(parse_mesh("set Mesh = " + file + "\n"),
                          source.section,
                          ACF_TEST_DATA);
  }

  void
  expect_cut_error(const MeshData &mesh,
                   const std::string &cut,
                   std::vector<std::string> parts)
  {
    parts.insert(parts.end(), {"Bodies/b", "'Cut'"});
    expect_input_error([&]() { divide(mesh, cut); }, parts);
  }
} // namespace



TEST(MeshDivision, ReadsTheEntry)
{
  EXPECT_EQ(parse_cut("", "").kind, MeshCut::Kind::none);
  EXPECT_EQ(parse_cut("volumes", "").kind, MeshCut::Kind::volumes);
  const MeshCut planes = parse_cut("z: -0.5,  25e-2", "");
  EXPECT_EQ(planes.kind, MeshCut::Kind::planes);
  EXPECT_EQ(planes.axis, 2);
  EXPECT_EQ(planes.planes, (std::vector<double>{-0.5, 0.25}));
  const MeshCut slices = parse_cut("12 along x", "");
  EXPECT_EQ(slices.kind, MeshCut::Kind::slices);
  EXPECT_EQ(slices.axis, 0);
  EXPECT_EQ(slices.n_slices, 12);
  for (const std::string wrong : {"4",
                                  "y",
                                  "y:",
                                  "a: 1",
                                  "xy: 1",
                                  "y: 1, 1",
                                  "y: 2, 1",
                                  "y: nan",
                                  "y: one",
                                  "1 along y",
                                  "-3 along y",
                                  "2.5 along y",
                                  "4 along",
                                  "4 along r",
                                  "volume"})
    expect_input_error([&]() { parse_cut(wrong, "Bodies/b"); },
                       {"Bodies/b", "'Cut'", "'" + wrong + "'", "'4 along y'"});
}



// Volumes, areas and closed surfaces of slices that are not equally long.
TEST(MeshDivision, SlicesAddUpToTheWhole)
{
  for (const ReferenceCell &cell :
       {ReferenceCells::Hexahedron, ReferenceCells::Tetrahedron})
    {
      const DividedMesh divided = divide(box(cell, 6), "x: -0.5, 1");
      EXPECT_EQ(divided.names, (std::vector<std::string>{"1", "2", "3"}));
      EXPECT_EQ(divided.neighbors,
                (std::vector<std::pair<unsigned int, unsigned int>>{{0, 1},
                                                                    {1, 2}}));
      const std::vector<double> lengths        = {0.5, 1.5, 1};
      const std::vector<std::string> all_names = {
        "cut to 2|x min|y max|y min|z max|z min",
        "cut to 1|cut to 3|y max|y min|z max|z min",
        "cut to 2|x max|y max|y min|z max|z min"};
      for (unsigned int p = 0; p < 3; ++p)
        {
          const BodyMesh mesh(divided.parts[p], source);
          EXPECT_NEAR(volume(mesh), 0.5 * lengths[p], 1e-13);
          EXPECT_EQ(names(mesh.surfaces()), all_names[p]);
          EXPECT_EQ(names(mesh.regions()), "body");
          EXPECT_NEAR(area(mesh, "y max"), 0.5 * lengths[p], 1e-13);
          EXPECT_NEAR(integrate_normal(mesh, {}).first.norm(), 0, 1e-13);
        }
      const BodyMesh middle(divided.parts[1], source);
      EXPECT_NEAR(area(middle, "cut to 1"), 0.5, 1e-13);
      EXPECT_NEAR(
        integrate_normal(middle, middle.surface("cut to 1", "", "")).first[0],
        -0.5,
        1e-13);
      EXPECT_NEAR(
        integrate_normal(middle, middle.surface("cut to 3", "", "")).first[0],
        0.5,
        1e-13);
    }
}



// Centres on the plane: all these cells belong to the slice beyond it.
TEST(MeshDivision, PlanesThroughCentresKeepLayersTogether)
{
  const DividedMesh divided =
    divide(box(ReferenceCells::Hexahedron, 3), "2 along x");
  EXPECT_NEAR(volume(BodyMesh(divided.parts[0], source)), 0.5, 1e-13);
  EXPECT_NEAR(volume(BodyMesh(divided.parts[1], source)), 1, 1e-13);
}



TEST(MeshDivision, VolumesOfAFile)
{
  const DividedMesh divided = divide(data_of("three_volumes.geo"), "volumes");
  EXPECT_EQ(divided.names, (std::vector<std::string>{"disk", "nose", "shaft"}));
  EXPECT_EQ(divided.neighbors,
            (std::vector<std::pair<unsigned int, unsigned int>>{{0, 1},
                                                                {0, 2}}));
  const std::vector<std::string> all_names = {"bottom|cut to nose|cut to shaft",
                                              "bottom|cut to disk",
                                              "bottom|cut to disk|start"};
  const std::vector<double> volumes        = {1, 2, 1};
  for (unsigned int p = 0; p < 3; ++p)
    {
      const BodyMesh mesh(divided.parts[p], source);
      EXPECT_NEAR(volume(mesh), volumes[p], 1e-13);
      EXPECT_EQ(names(mesh.surfaces()), all_names[p]);
      EXPECT_EQ(names(mesh.regions()), divided.names[p]);
      EXPECT_NEAR(area(mesh, "bottom"), volumes[p], 1e-13);
    }
}



TEST(MeshDivision, NamesWhatDoesNotWork)
{
  const MeshData mesh = box(ReferenceCells::Hexahedron, 3);
  expect_cut_error(mesh,
                   "x: -0.8, 0",
                   {"the part 1 to x = -0.8 m, in which no cell has its centre",
                    "between -1 and 2 m"});
  expect_cut_error(mesh,
                   "x: 0.1, 0.2, 1",
                   {"the part 2 from x = 0.1 to x = 0.2 m"});
  expect_cut_error(mesh, "8 along y", {"the part 1 to y = 0.125 m"});
  expect_cut_error(mesh, "volumes", {"one volume", "several volumes"});
  expect_cut_error(data_of("two_boxes.geo"),
                   "volumes",
                   {"cells in both volumes 'all' and 'left'"});

  MeshData named             = mesh;
  named.surfaces["cut to 2"] = named.surfaces.at("y max");
  expect_cut_error(named, "2 along x", {"the surface 'cut to 2'"});

  // the ends of a U are two pieces
  MeshData u = generate_box(Point<dim>(0, 0, 0),
                            Point<dim>(3, 2, 1),
                            {{3, 2, 1}},
                            ReferenceCells::Hexahedron);
  u.cells.erase(u.cells.begin() + 4);
  u.faces.clear();
  u.surfaces.clear();
  const DividedMesh divided = divide(u, "2 along y");
  expect_input_error([&]() { BodyMesh(divided.parts[1], source); },
                     {"2 parts that no common face connects"});
}
