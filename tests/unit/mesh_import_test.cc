// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh_generation.h>

#include <gmsh.h>

#include <cmath>
#include <filesystem>

#include <unit/mesh_files.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** Two tetrahedra with a common face and a vertex 9 that nobody uses. */
  const std::vector<std::string> two_tetrahedra_nodes =
    {"1 0 0 0", "2 1 0 0", "3 0 1 0", "4 0 0 1", "5 1 1 1", "9 7 7 7"};
  const std::vector<std::string> two_tetrahedra = {"11 4 2 1 1 1 2 3 4",
                                                   "12 4 2 1 1 2 5 3 4"};

  const std::string hexahedra = "set Element = hexahedron\n";
} // namespace

TEST_F(MeshFiles, ScriptAndItsMeshFilesAgree)
{
  std::map<std::string, unsigned int> n_cells;
  convert("two_boxes.geo", "v22.msh", 3, 2.2);
  convert("two_boxes.geo", "v22_binary.msh", 3, 2.2, true);
  convert("two_boxes.geo", "v41.msh", 3, 4.1);
  convert("two_boxes.geo", "v41_binary.msh", 3, 4.1, true);
  std::filesystem::copy(std::string(ACF_TEST_DATA) + "/two_boxes.geo", folder);
  for (const std::string name : {"two_boxes.geo",
                                 "v22.msh",
                                 "v22_binary.msh",
                                 "v41.msh",
                                 "v41_binary.msh"})
    {
      const auto mesh = mesh_of("set Mesh = " + name, folder);
      n_cells[name]   = mesh->triangulation().n_active_cells();
      EXPECT_EQ(n_cells[name], n_cells.begin()->second) << name;
      EXPECT_NEAR(volume(*mesh), 2, 1e-12) << name;
      EXPECT_EQ(names(mesh->surfaces()), "ends|start|surface 5") << name;
      EXPECT_EQ(names(mesh->regions()), "all|left") << name;
      EXPECT_NEAR(area(*mesh, "start"), 1, 1e-12);
      EXPECT_NEAR(area(*mesh, "ends"), 2, 1e-12);
      EXPECT_NEAR(area(*mesh, "surface 5"), 2, 1e-12);
      const auto [normal, surface_area] =
        integrate_normal(*mesh, mesh->surface("start", "", ""));
      EXPECT_NEAR(normal[0], -1, 1e-12);
      EXPECT_NEAR(surface_area, 1, 1e-12);

      double volume_left = 0, volume_all = 0;
      for (const auto &cell : mesh->triangulation().active_cell_iterators())
        {
          if (mesh->region("left", "", "").count(cell->material_id()) > 0)
            volume_left += cell->measure();
          if (mesh->region("all", "", "").count(cell->material_id()) > 0)
            volume_all += cell->measure();
        }
      EXPECT_NEAR(volume_left, 1, 1e-12);
      EXPECT_NEAR(volume_all, 2, 1e-12);
    }
}

TEST_F(MeshFiles, MeshSizeRefinesGeometries)
{
  const auto coarse = mesh_of("set Mesh = two_boxes.geo");
  const auto fine = mesh_of("set Mesh = two_boxes.geo\n set Mesh size = 0.12");
  EXPECT_GT(fine->triangulation().n_active_cells(),
            4 * coarse->triangulation().n_active_cells());
  EXPECT_NEAR(volume(*fine), 2, 1e-12);
  // no option survives from one file to the next
  EXPECT_EQ(mesh_of("set Mesh = two_boxes.geo")->triangulation().n_vertices(),
            coarse->triangulation().n_vertices());
  const auto cylinder = mesh_of("set Mesh = cylinder.geo\n set Mesh size = .1");
  EXPECT_NEAR(volume(*cylinder), numbers::PI / 4, 0.01);

  // also if the script has made a mesh already
  write("meshed.geo",
        "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 1, 1, 1};"
        "Mesh.MeshSizeMax = 1; Mesh 3;\n");
  const auto as_is = mesh_of("set Mesh = meshed.geo", folder);
  const auto refined =
    mesh_of("set Mesh = meshed.geo\n set Mesh size = 0.1", folder);
  EXPECT_GT(refined->triangulation().n_active_cells(),
            as_is->triangulation().n_active_cells());
}

TEST_F(MeshFiles, Hexahedra)
{
  convert("bar_hexahedra.geo", "second_order.msh", 3, 4.1, false, 2);
  convert("bar_hexahedra.geo", "v22.msh", 3, 2.2);
  std::filesystem::copy(std::string(ACF_TEST_DATA) + "/bar_hexahedra.geo",
                        folder);
  for (const std::string name :
       {"bar_hexahedra.geo", "second_order.msh", "v22.msh"})
    {
      const auto mesh = mesh_of(hexahedra + "set Mesh = " + name, folder);
      EXPECT_EQ(mesh->triangulation().n_active_cells(), 24);
      EXPECT_EQ(mesh->triangulation().n_used_vertices(), 5 * 3 * 4);
      EXPECT_FALSE(mesh->is_simplex());
      EXPECT_NEAR(volume(*mesh), 2, 1e-13);
      EXPECT_NEAR(area(*mesh, "bottom"), 2, 1e-13);
      EXPECT_EQ(names(mesh->regions()), "bar");
      expect_mesh_error(
        "set Mesh = " + name,
        {"'Element'", "24 hexahedra", name, "allowed: hexahedron"},
        folder);
    }
  expect_mesh_error("set Element = hexahedron\n set Mesh = two_boxes.geo",
                    {"'Element'", "tetrahedra", "allowed: tetrahedron"});
}

TEST_F(MeshFiles, CurvedElements)
{
  convert("cylinder.geo", "curved.msh", 3, 4.1, false, 2);
  expect_mesh_error("set Mesh = curved.msh",
                    {"curved element ", "node ", "Mesh.ElementOrder = 1"},
                    folder);
  convert("two_boxes.geo", "straight.msh", 3, 4.1, false, 2);
  EXPECT_NEAR(volume(*mesh_of("set Mesh = straight.msh", folder)), 2, 1e-12);
}

TEST_F(MeshFiles, ComputerAidedDesign)
{
  write("box.geo",
        "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 2, 1, 1};\n");
  // gmsh writes numbers as millimetres to .step, and without unit to .brep
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(folder + "/box.geo");
  testing::internal::CaptureStdout();
  gmsh::write(folder + "/box.step");
  gmsh::write(folder + "/box.brep");
  testing::internal::GetCapturedStdout();
  gmsh::finalize();
  std::filesystem::copy(std::string(ACF_TEST_DATA) + "/box.igs", folder);

  for (const std::string name : {"box.brep", "box.step", "box.igs"})
    {
      const double unit = (name == "box.brep" ? 1. : 1e-3);
      const auto mesh   = mesh_of("set Mesh = " + name + "\n set Mesh size = " +
                                  std::to_string(0.5 * unit),
                                folder);
      EXPECT_NEAR(volume(*mesh) / std::pow(unit, 3), 2, 1e-9) << name;
      EXPECT_EQ(names(mesh->surfaces()),
                "surface 1|surface 2|surface 3|surface 4|surface 5|surface 6");
      EXPECT_EQ(names(mesh->regions()), "volume 1");
      std::multiset<long> areas;
      for (const auto &surface : mesh->surfaces())
        areas.insert(
          std::lround(1e6 * area(*mesh, surface.first) / unit / unit));
      EXPECT_EQ(areas,
                (std::multiset<long>{
                  1000000, 1000000, 2000000, 2000000, 2000000, 2000000}))
        << name;
      const auto finer = mesh_of("set Mesh = " + name + "\n set Mesh size = " +
                                   std::to_string(0.12 * unit),
                                 folder);
      EXPECT_GT(finer->triangulation().n_active_cells(),
                2 * mesh->triangulation().n_active_cells());
    }

  testing::internal::CaptureStdout();
  expect_error("broken.step",
               read("box.step").substr(0, 60),
               {"gmsh says", "Could not read file", "unexpected end of file"});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST_F(MeshFiles, MirrorMakesSymmetricBodies)
{
  for (const std::string axis : {"x", "y", "z"})
    for (const std::string element : {"tetrahedron", "hexahedron"})
      {
        const unsigned int normal = axis[0] - 'x';
        const std::string from = "0, 0, 0", to = "-1, -2, -3";
        const auto mesh = mesh_of(
          "set Mesh = box\n set Cells = 2, 2, 2\n set Element = " + element +
          "\n set Box from = " + to + "\n set Box to = " + from +
          "\n set Mirror = " + axis);
        EXPECT_NEAR(volume(*mesh), 12, 1e-12);
        EXPECT_NEAR(integrate(*mesh, [&](const auto &p) { return p[normal]; }),
                    0,
                    1e-12);
        // the side at the plane is gone, the others have images
        EXPECT_EQ(mesh->surfaces().size(), 15);
        EXPECT_EQ(mesh->surfaces().count(axis + " max"), 0);
        EXPECT_EQ(mesh->surfaces().count(axis + " max mirrored"), 0);
        const auto [vector, surface_area] =
          integrate_normal(*mesh,
                           mesh->surface(axis + " min mirrored", "", ""));
        EXPECT_NEAR(surface_area, 6. / (normal + 1), 1e-12);
        EXPECT_NEAR(vector[normal], 6. / (normal + 1), 1e-12);
        const auto [sum, both_area] =
          integrate_normal(*mesh, mesh->surface(axis + " min both", "", ""));
        EXPECT_NEAR(both_area, 12. / (normal + 1), 1e-12);
        EXPECT_NEAR(sum.norm(), 0, 1e-12);
        EXPECT_EQ(names(mesh->regions()), "body");
      }

  const auto mesh = mesh_of("set Mesh = two_boxes.geo\n set Mirror = x");
  EXPECT_NEAR(volume(*mesh), 4, 1e-12);
  EXPECT_EQ(names(mesh->surfaces()),
            "ends|ends both|ends mirrored|surface 5|surface 5 both|"
            "surface 5 mirrored");
  std::set<std::array<double, 3>> vertices;
  for (const Point<dim> &p : mesh->triangulation().get_vertices())
    vertices.insert(std::array<double, 3>{{p[0], p[1], p[2]}});
  for (const std::array<double, 3> &p : vertices)
    {
      const std::array<double, 3> image = {{-p[0], p[1], p[2]}};
      EXPECT_EQ(vertices.count(image), 1);
    }
}

TEST_F(MeshFiles, MirrorErrors)
{
  const std::string box =
    "set Mesh = box\n set Cells = 1, 1, 1\n"
    "set Element = hexahedron\n set Mirror = x\n";
  expect_mesh_error(box + "set Box from=-1,-1,-1\n set Box to=2,1,1",
                    {"'Mirror'", "both sides", "x = 0", "(-1, ", "(2, "});
  expect_mesh_error(box + "set Box from=1,-1,-1\n set Box to=2,1,1",
                    {"'Mirror'", "0 vertices on the plane x = 0"});

  MeshData data                   = generate_box(Point<dim>(0, 0, 0),
                               Point<dim>(1, 1, 1),
                               {{1, 1, 1}},
                               ReferenceCells::Hexahedron);
  data.surfaces["x max mirrored"] = {3};
  expect_input_error(
    [&]() {
      mirror_mesh(data, 0, {"Bodies/b", "box"});
    },
    {"'Mirror'", "'x max mirrored'"});
}

TEST_F(MeshFiles, UnusedVerticesAreDropped)
{
  write("good.msh", msh(two_tetrahedra_nodes, two_tetrahedra));
  const auto mesh = mesh_of("set Mesh = good.msh", folder);
  EXPECT_EQ(mesh->triangulation().n_vertices(), 5);
  EXPECT_NEAR(volume(*mesh), 0.5, 1e-14); // 1/6 + 1/3
  EXPECT_EQ(names(mesh->regions()), "volume 1");
}

TEST_F(MeshFiles, FilesThatCannotBeRead)
{
  expect_mesh_error("set Mesh = nowhere/b.msh",
                    {"'Mesh'", "nowhere/b.msh", "no such file"});
  std::filesystem::create_directory(folder + "/folder.msh");
  expect_mesh_error("set Mesh = folder.msh", {"a directory"}, folder);
  expect_error("empty.msh", "", {"empty"});
  expect_error("text.msh", "hello\n", {"no line $MeshFormat", "2.2 or 4.1"});
  expect_error("old.msh",
               "$MeshFormat\n1.0 0 8\n$EndMeshFormat\n",
               {"format '1.0'", "2.2 or 4.1"});
  const std::string good = msh(two_tetrahedra_nodes, two_tetrahedra);
  expect_error("end.msh",
               good.substr(0, good.find("$EndElements")),
               {"truncated"});
  expect_error("elements.msh",
               good.substr(0, good.find("12 4 2")) + "$EndElements\n",
               {"line 16", "'$EndElements' instead of"});
  convert("two_boxes.geo", "v41.msh");
  const std::string long_file = read("v41.msh");
  expect_error("half.msh",
               long_file.substr(0, long_file.size() / 2),
               {"truncated"});
  expect_error("last_line.geo",
               "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};",
               {"no line break at the end"});
  expect_error("script.geo",
               "Box(1) = {0, 0;\n",
               {"gmsh says", "syntax error"});
  expect_error("unknown_node.msh",
               msh(two_tetrahedra_nodes, {"11 4 2 1 1 1 2 3 77"}),
               {"77"});
}

TEST_F(MeshFiles, FilesThatPromiseTooMuch)
{
  const std::string head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n";
  expect_error("nodes.msh",
               head + "1 1000000000000 1 2\n3 1 0 1\n1\n0 0 0\n$EndNodes\n",
               {"line 5",
                "1000000000000 nodes",
                "more than the file can hold"});
  expect_error("block.msh",
               head + "1 1 1 1\n3 1 0 4000000000\n1\n0 0 0\n$EndNodes\n",
               {"line 6", "4000000000 nodes", "more than the file can hold"});
  expect_error("negative.msh",
               head + "1 -1 1 1\n3 1 0 1\n1\n0 0 0\n$EndNodes\n",
               {"line 5", "'-1' instead of a count of nodes"});
  expect_error("more.msh",
               head + "1 1 1 1\n3 1 0 2\n1 2\n0 0 0\n1 1 1\n$EndNodes\n",
               {"line 9", "1 nodes announced, but 2"});
  expect_error("dimension.msh",
               head + "1 1 1 1\n7 1 0 1\n1\n0 0 0\n$EndNodes\n",
               {"line 6", "the dimension 7"});

  const auto &nodes = two_tetrahedra_nodes;
  expect_error("type.msh",
               msh(nodes, {"11 999 2 1 1 1 2 3 4"}),
               {"line 15", "type 999"});
  expect_error("polygon.msh",
               msh(nodes, {"11 34 2 1 1 1 2 3 4"}),
               {"line 15", "type 34", "Polygon"});
  expect_error("infinite.msh",
               msh({"1 0 0 inf"}, two_tetrahedra),
               {"line 6", "node 1", "not finite"});
  expect_error("huge.msh",
               msh({"1 0 0 1e999"}, two_tetrahedra),
               {"line 6", "'1e999' instead of a coordinate"});
  expect_error("twice.msh",
               msh({"1 0 0 0", "1 0 0 1"}, two_tetrahedra),
               {"line 7", "the node 1 a second time"});
  expect_error("no_elements.msh",
               head + "1 1 1 1\n3 1 0 1\n1\n0 0 0\n$EndNodes\n",
               {"without a section $Elements"});
  expect_error("name.msh",
               msh(nodes, two_tetrahedra, "$PhysicalNames\n1\n3 1 solid\n"),
               {"line 6", "without a name"});
  expect_error("junk.msh",
               msh(nodes, two_tetrahedra, "junk\n"),
               {"line 4", "'junk' instead of a section"});
  write("comment.msh",
        msh(nodes, two_tetrahedra, "$Comments\n7\n$EndComments\n"));
  EXPECT_NEAR(volume(*mesh_of("set Mesh = comment.msh", folder)), 0.5, 1e-14);

  // every binary file that is cut short
  convert("two_boxes.geo", "binary.msh", 3, 4.1, true);
  const std::string binary = read("binary.msh");
  for (std::size_t n = 40; n < binary.size() - 13; n += binary.size() / 20)
    expect_error("cut.msh", binary.substr(0, n), {"found"});
}

TEST_F(MeshFiles, CellsOfTheWrongKind)
{
  std::filesystem::copy(std::string(ACF_TEST_DATA) + "/flat_square.geo",
                        folder);
  convert("flat_square.geo", "flat.msh", 2);
  for (const std::string name : {"flat_square.geo", "flat.msh"})
    expect_mesh_error("set Mesh = " + name,
                      {"without volume elements", "2 triangles"},
                      folder);
  const std::vector<std::string> nodes = {"1 0 0 0",
                                          "2 1 0 0",
                                          "3 0 1 0",
                                          "4 0 0 1",
                                          "5 1 0 1",
                                          "6 0 1 1",
                                          "7 0 0 2"};
  const std::string wedge              = "1 6 2 1 1 1 2 3 4 5 6";
  const std::string tetrahedron        = "2 4 2 1 1 4 5 6 7";
  expect_error("wedge.msh",
               msh(nodes, {wedge}),
               {"1 wedges", "tetrahedra or hexahedra"});
  expect_error("mixed.msh",
               msh(nodes, {wedge, tetrahedron}),
               {"1 tetrahedra and 1 wedges"});
  expect_error("pyramid.msh",
               msh(nodes, {"1 7 2 1 1 1 2 5 4 6"}),
               {"1 pyramids"});
}

TEST_F(MeshFiles, BadCells)
{
  const auto &nodes = two_tetrahedra_nodes;
  expect_error("inverted.msh",
               msh(nodes, {two_tetrahedra[0], "12 4 2 1 1 5 2 3 4"}),
               {"1 inverted cells", "element 12 at (0.5, 0.5, 0.5)"});
  expect_error("flat.msh",
               msh({"1 0 0 0", "2 1 0 0", "3 0 1 0", "4 1 1 0"},
                   {"3 4 2 1 1 1 2 3 4"}),
               {"1 degenerate cells", "element 3 at (0.5, 0.5, 0)"});
  expect_error("double_node.msh",
               msh(nodes, {"3 4 2 1 1 1 2 3 3"}),
               {"1 degenerate cells", "element 3 at"});
  expect_error("duplicate.msh",
               msh(nodes, {two_tetrahedra[0], "12 4 2 1 1 2 3 1 4"}),
               {"duplicate cells", "element 11", "element 12"});
  expect_error("overlap.msh",
               msh({"1 0 0 0", "2 1 0 0", "3 0 1 0", "4 0 0 1", "5 0 0 2"},
                   {"1 4 2 1 1 1 2 3 4", "2 4 2 1 1 1 2 3 5"}),
               {"overlapping cells", "element 1", "element 2"});
  expect_error(
    "three.msh",
    msh({"1 0 0 0", "2 1 0 0", "3 0 1 0", "4 0 0 1", "5 0 0 2", "6 0 0 -1"},
        {"1 4 2 1 1 1 2 3 4", "2 4 2 1 1 1 2 3 5", "3 4 2 1 1 2 1 3 6"}),
    {"three cells with one common face"});

  // a hexahedron with one corner pushed in beyond the diagonal of its faces:
  // its volume stays positive
  MeshData data                            = generate_box(Point<dim>(0, 0, 0),
                               Point<dim>(1, 1, 1),
                               {{2, 1, 1}},
                               ReferenceCells::Hexahedron);
  data.vertices[data.cells[1].vertices[7]] = Point<dim>(0.6, 0.2, 0.2);
  expect_input_error(
    [&]() {
      BodyMesh(data, {"Bodies/b", "box"});
    },
    {"1 inverted cells", "element 2"});
}

TEST_F(MeshFiles, PartsThatAreNotConnected)
{
  const auto &nodes = two_tetrahedra_nodes;
  expect_error("edge.msh", // an edge in common is not enough
               msh(nodes, {two_tetrahedra[0], "12 4 2 1 1 3 5 9 4"}),
               {"2 parts",
                "1 cells from element 11",
                "1 cells from element 12",
                "Coherence"});
  expect_error("apart.geo",
               "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 1, 1, 1};"
               "Box(2) = {1, 0, 0, 1, 1, 1}; Mesh.MeshSizeMax = 1;\n",
               {"2 parts", "BooleanFragments"});
}

TEST_F(MeshFiles, Groups)
{
  const auto &nodes = two_tetrahedra_nodes;
  const std::string names =
    "$PhysicalNames\n3\n3 1 \"solid\"\n2 7 \"skin\"\n2 8 \"hull\"\n"
    "$EndPhysicalNames\n";
  auto elements = two_tetrahedra;
  elements.insert(elements.end(), {"1 2 2 7 1 1 2 3", "2 2 2 8 2 1 2 4"});
  write("good.msh", msh(nodes, elements, names));
  EXPECT_NEAR(area(*mesh_of("set Mesh = good.msh", folder), "skin"),
              0.5,
              1e-14);

  elements[3] = "2 2 2 7 1 1 2 4";
  expect_error("empty_group.msh",
               msh(nodes, elements, names),
               {"'hull'", "surface 8", "without cells"});
  elements[3] = "2 2 2 8 2 2 3 4";
  expect_error("inside.msh",
               msh(nodes, elements, names),
               {"surface 'hull'", "inside the body", "(0.333333, 0.333333, "});
  elements[3] = "2 2 2 8 2 1 2 9";
  expect_error("outside.msh",
               msh(nodes, elements, names),
               {"surface 'hull'", "no face of a cell"});
  elements[3] = "2 2 2 8 2 3 2 1";
  expect_error("twice.msh",
               msh(nodes, elements, names),
               {"'skin' and 'hull'", "listed twice"});
  elements[3] = "2 2 2 8 1 1 2 4";
  expect_error("same_entity.msh",
               msh(nodes, elements, names),
               {"'hull', 'skin'", "elementary entity 1", "format 4.1"});
}
