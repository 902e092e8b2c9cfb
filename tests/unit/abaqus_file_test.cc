// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <filesystem>

#include <unit/mesh_files.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  /** Two tetrahedra with a common face, the second one twice as large. */
  const std::string nodes =
    "*NODE\n1, 0, 0, 0\n2, 1., 0, 0\n3, 0, +1e0, 0\n"
    "4, 0, 0, 1.D0\n5, 1, 1, 1\n";

  const std::string elements =
    "*ELEMENT, TYPE=C3D4, ELSET=small\n11, 1, 2, 3, 4\n"
    "*Element, type=c3d4\n12, 2, 5, 3, 4\n";

  const std::string mesh = nodes + elements;

  std::string
  joined(const std::vector<std::string> &lines)
  {
    std::string result;
    for (const std::string &line : lines)
      result += line + "\n";
    return result;
  }
} // namespace

TEST_F(MeshFiles, AbaqusSetsAndSurfaces)
{
  write("sets.inp",
        "*Heading\n any text, even 7\n** a comment\n" + mesh +
          joined({"*NSET, NSET=Front",
                  " 1, 2,",
                  "3, 4",
                  "*NSET, NSET=range, GENERATE",
                  "1, 3",
                  "*NSET, NSET=\"two parts\"",
                  "range, 4",
                  "*NSET, NSET=point",
                  "5",
                  "*ELSET, ELSET=all",
                  "SMALL, 12",
                  "*ELSET, ELSET=hidden, INTERNAL",
                  "12",
                  "*SURFACE, NAME=side",
                  "small, S1",
                  "11, S2",
                  "*SURFACE, NAME=skin, TYPE=ELEMENT",
                  "all,",
                  "*SURFACE, TYPE=NODE, NAME=base",
                  "range, 1.",
                  "*STEP",
                  "*BOUNDARY",
                  "front, 1, 3",
                  "*END STEP"}));
  const auto body = mesh_of("set Mesh = sets.inp", folder);
  EXPECT_NEAR(volume(*body), 0.5, 1e-14);
  EXPECT_EQ(names(body->regions()), "all|small");
  EXPECT_EQ(names(body->surfaces()), "Front|base|range|side|skin|two parts");
  // three faces have node 1, and no other face has all nodes in the set
  EXPECT_NEAR(area(*body, "Front"), 1.5, 1e-14);
  EXPECT_NEAR(area(*body, "two parts"), 1.5, 1e-14);
  EXPECT_NEAR(area(*body, "range"), 0.5, 1e-14);
  EXPECT_NEAR(area(*body, "base"), 0.5, 1e-14);
  EXPECT_NEAR(area(*body, "side"), 1, 1e-14);
  EXPECT_NEAR(area(*body, "skin"), integrate_normal(*body, {}).second, 1e-14);
  const auto [normal, side] =
    integrate_normal(*body, body->surface("side", "", ""));
  EXPECT_NEAR(normal[1], -0.5, 1e-14); // S2 is the face 1, 2, 4
  EXPECT_NEAR(normal[2], -0.5, 1e-14); // and S1 the face 1, 2, 3
  ASSERT_EQ(body->notes().size(), 2);
  EXPECT_NE(body->notes()[0].find("*BOUNDARY, *END STEP, *STEP"),
            std::string::npos);
  EXPECT_NE(body->notes()[1].find("point"), std::string::npos);
  EXPECT_EQ(body->notes()[1].find("Front"), std::string::npos);

  // without sets there are no names
  write("plain.inp", nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n");
  const auto plain = mesh_of("set Mesh = plain.inp", folder);
  EXPECT_EQ(names(plain->surfaces()) + names(plain->regions()), "");
  expect_input_error([&]() { plain->surface("side", "s", "e"); },
                     {"no surfaces"});
}

TEST_F(MeshFiles, AbaqusPartsAndAssemblies)
{
  const std::string instance =
    "*Instance, name=Part-1-1, part=Part-1\n*End Instance\n";
  const std::string part = "*Part, name=Part-1\n" + mesh + "*End Part\n";
  write("assembly.inp",
        part + "*Assembly, name=A\n" + instance +
          joined({"*Nset, nset=base, instance=Part-1-1",
                  "1, 2, 3",
                  "*Elset, elset=_S, internal, instance=PART-1-1",
                  "11,",
                  "*Surface, type=ELEMENT, name=Surf",
                  "_S, S1",
                  "*Surface, type=ELEMENT, name=Other",
                  "Part-1-1.small, S2",
                  "*End Assembly"}));
  const auto body = mesh_of("set Mesh = assembly.inp", folder);
  EXPECT_EQ(names(body->surfaces()), "Other|Surf|base");
  EXPECT_EQ(names(body->regions()), "small");
  EXPECT_NEAR(area(*body, "Other"), 0.5, 1e-14);

  expect_error("moved.inp",
               part + "*Instance, name=a, part=b\n1., 0, 0\n",
               {"line 14", "*INSTANCE", "without translation"});
  expect_error("parts.inp", part + part, {"line 13", "second *PART"});
  expect_error("instances.inp",
               part + instance + instance,
               {"line 15", "second *INSTANCE"});
  expect_error("of.inp",
               part + instance + "*Nset, nset=n, instance=other\n1\n",
               {"line 15", "'OTHER'"});
}

TEST_F(MeshFiles, AbaqusElementTypes)
{
  // one hexahedron of each order, with the nodes in Abaqus's order
  const std::vector<std::array<double, 3>> corners = {{{0, 0, 0}},
                                                      {{2, 0, 0}},
                                                      {{2, 2, 0}},
                                                      {{0, 2, 0}},
                                                      {{0, 0, 2}},
                                                      {{2, 0, 2}},
                                                      {{2, 2, 2}},
                                                      {{0, 2, 2}}};
  std::string linear = "*NODE\n", element = "1";
  unsigned int n = 0;
  const auto add = [&](const std::array<double, 3> &p) {
    ++n;
    linear += std::to_string(n) + ", " + std::to_string(p[0]) + ", " +
              std::to_string(p[1]) + ", " + std::to_string(p[2]) + "\n";
    element += ", " + std::to_string(n);
  };
  for (const auto &corner : corners)
    add(corner);
  const std::string surfaces =
    "*ELSET, ELSET=e\n1\n*SURFACE, NAME=s4\ne, S4\n*SURFACE, NAME=s6\ne, S6\n";
  for (const std::string type : {"C3D8", "C3D8R"})
    {
      write("linear.inp",
            linear + "*ELEMENT, TYPE=" + type + "\n" + element + "\n" +
              surfaces);
      const auto body =
        mesh_of("set Element = hexahedron\nset Mesh = linear.inp", folder);
      EXPECT_NEAR(volume(*body), 8, 1e-14);
      const auto s4 = integrate_normal(*body, body->surface("s4", "", ""));
      EXPECT_NEAR(s4.first[0], 4, 1e-14);
      const auto s6 = integrate_normal(*body, body->surface("s6", "", ""));
      EXPECT_NEAR(s6.first[0], -4, 1e-14);
    }
  element += ",\n";
  const std::array<std::array<unsigned int, 2>, 12> edges = {{{{0, 1}},
                                                              {{1, 2}},
                                                              {{2, 3}},
                                                              {{3, 0}},
                                                              {{4, 5}},
                                                              {{5, 6}},
                                                              {{6, 7}},
                                                              {{7, 4}},
                                                              {{0, 4}},
                                                              {{1, 5}},
                                                              {{2, 6}},
                                                              {{3, 7}}}};
  for (const auto &[a, b] : edges)
    {
      add({{(corners[a][0] + corners[b][0]) / 2,
            (corners[a][1] + corners[b][1]) / 2,
            (corners[a][2] + corners[b][2]) / 2}});
    }
  // the line that ends with a comma goes on
  const auto gap = element.find(",\n,");
  ASSERT_NE(gap, std::string::npos);
  element.erase(gap + 2, 1);
  write("quadratic.inp",
        linear + "*ELEMENT, TYPE=C3D20R\n" + element + "\n" + surfaces +
          "*NSET, NSET=floor, GENERATE\n1, 4, 1\n9, 12, 1\n"
          "*NSET, NSET=corners\n5, 6, 7, 8\n");
  const auto body =
    mesh_of("set Element = hexahedron\nset Mesh = quadratic.inp", folder);
  EXPECT_NEAR(volume(*body), 8, 1e-14);
  EXPECT_NEAR(area(*body, "floor"), 4, 1e-14);
  // not all nodes of the face
  EXPECT_EQ(body->surfaces().count("corners"), 0);

  // what gmsh writes: surface elements, trusses, and sets of both
  convert("two_boxes.geo", "gmsh.inp");
  const auto from_gmsh = mesh_of("set Mesh = gmsh.inp", folder);
  EXPECT_NEAR(volume(*from_gmsh), 2, 1e-12);
  EXPECT_NEAR(area(*from_gmsh, "start"), 1, 1e-12);
  EXPECT_NEAR(area(*from_gmsh, "ends"), 2, 1e-12);
  EXPECT_EQ(from_gmsh->regions().count("all"), 1);

  // second order, straight and curved
  convert("cylinder.geo", "curved.inp", 3, 4.1, false, 2);
  expect_mesh_error("set Mesh = curved.inp",
                    {"curved element", "Geometry = quadratic"},
                    folder);
  const auto curved =
    mesh_of("set Mesh = curved.inp\n set Geometry = quadratic", folder);
  convert("cylinder.geo", "curved.msh", 3, 4.1, false, 2);
  const auto same =
    mesh_of("set Mesh = curved.msh\n set Geometry = quadratic", folder);
  EXPECT_NEAR(volume(*curved), volume(*same), 1e-9);
}

TEST_F(MeshFiles, AbaqusErrors)
{
  expect_error("empty.inp", "", {"empty"});
  expect_error("text.inp", "hello\n", {"line 1", "'hello'", "keyword"});
  expect_error("heading.inp", "*HEADING\n", {"without nodes"});
  expect_error("zero.inp", std::string("*HEADING\n\0\n", 11), {"line 2", "0"});
  for (const std::string keyword : {"SYSTEM",
                                    "TRANSFORM, NSET=a",
                                    "Include, Input=x.inp",
                                    "NGEN",
                                    "ELGEN",
                                    "NCOPY",
                                    "NFILL",
                                    "PARAMETER"})
    expect_error("keyword.inp",
                 nodes + "*" + keyword + "\n1, 2, 3\n",
                 {"line 7", "the keyword *", "written out"});
  expect_error("cylindrical.inp",
               "*NODE, SYSTEM=C\n1, 0, 0, 0\n",
               {"line 1", "'C'", "SYSTEM = R"});
  expect_error("input.inp", "*NODE, INPUT=other\n", {"line 1", "INPUT"});
  expect_error("number.inp", "*NODE\n1, 0, x, 0\n", {"line 2", "'x'"});
  expect_error("nan.inp", "*NODE\n1, 0, nan, 0\n", {"line 2", "'nan'"});
  expect_error("huge.inp", "*NODE\n1, 0, 1e999, 0\n", {"line 2", "'1e999'"});
  expect_error("fields.inp", "*NODE\n1, 0, 1\n", {"line 2", "3 fields"});
  expect_error("label.inp", "*NODE\n0, 0, 1, 2\n", {"line 2", "'0'"});
  expect_error("labels.inp",
               "*NODE\n99999999999999999999, 0, 1, 2\n",
               {"line 2", "the number of a node"});
  expect_error("twice.inp", nodes + "5, 1, 1, 1\n", {"line 7", "second time"});
  expect_error("type.inp", nodes + "*ELEMENT\n", {"line 7", "TYPE"});
  expect_error("wedge.inp",
               nodes + "*ELEMENT, TYPE=C3D6\n1, 1, 2, 3, 4, 5, 6\n",
               {"line 7", "'C3D6'", "C3D10"});
  expect_error("more.inp",
               nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4, 5\n",
               {"line 8", "6 fields", "4 nodes"});
  expect_error("less.inp",
               nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3,\n*STEP\n",
               {"line 9", "element 1 with 3 nodes"});
  expect_error("node.inp",
               nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 6\n",
               {"line 8", "node 6, which does not exist"});
  expect_error("element.inp", mesh + "12, 2, 5, 3, 4\n", {"line 11", "second"});
  expect_error("none.inp", nodes, {"without volume elements"});
  const auto set = [&](const std::vector<std::string> &lines,
                       const std::vector<std::string> &parts) {
    expect_error("set.inp", mesh + joined(lines), parts);
  };
  set({"*NSET", "1"}, {"line 11", "NSET"});
  set({"*NSET, NSET=", "1"}, {"line 11", "NSET"});
  set({"*NSET, NSET=a, NSET=b", "1"}, {"line 11", "second parameter"});
  set({"*NSET, NSET=a", "1, b"}, {"line 12", "'b'", "before"});
  set({"*NSET, NSET=a", "1, 7"}, {"line 12", "node 7, which does not exist"});
  set({"*NSET, NSET=a, GENERATE", "1, 999999999, 1"},
      {"line 12", "node 6, which does not exist"});
  set({"*NSET, NSET=a, GENERATE", "1, 4, 2"}, {"line 12", "a step"});
  set({"*NSET, NSET=a, GENERATE", "4, 1"}, {"line 12", "not smaller"});
  set({"*ELSET, ELSET=a", "13"}, {"line 12", "element 13"});
  set({"*NSET, NSET=a, ELSET=small"}, {"line 11", "ELSET"});
  set({"*SURFACE, NAME=s", "small, S5"}, {"line 12", "element 11", "S1 to S4"});
  set({"*SURFACE, NAME=s", "small, S7"}, {"line 12", "'S7'"});
  set({"*SURFACE, NAME=s", "small, SPOS"}, {"line 12", "'SPOS'"});
  set({"*SURFACE, NAME=s", "big, S1"}, {"line 12", "'big'"});
  set({"*SURFACE, NAME=s", "11, S3"}, {"surface 's'", "inside the body"});
  set({"*SURFACE, NAME=s", "11, S1", "*SURFACE, NAME=S", "11, S1"},
      {"line 13", "second surface"});
  set({"*"}, {"line 11", "without a keyword"});

  // bytes that are no characters, where they would become names; elsewhere
  // they do not matter
  set({"*NSET, NSET=\xf0", "1"}, {"line 11", "UTF-8"});
  set({"*ELSET, ELSET=a", "\xf0"}, {"line 12", "UTF-8"});
  set({"*\xf0"}, {"line 11", "UTF-8"});
  write("latin.inp", mesh + "** \xe4\n*MATERIAL, NAME=\xe4\n\xe4, 1\n");
  EXPECT_NEAR(volume(*mesh_of("set Mesh = latin.inp", folder)), 0.5, 1e-14);

  // whatever is cut off
  for (std::size_t n = 0; n < mesh.size(); ++n)
    {
      write("cut.inp", mesh.substr(0, n));
      try
        {
          mesh_of("set Mesh = cut.inp", folder);
        }
      catch (const InputError &error)
        {
          EXPECT_NE(std::string(error.what()).find("cut.inp"),
                    std::string::npos);
        }
    }
}
