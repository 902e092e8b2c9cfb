// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_mesh_files_h
#define acf_tests_mesh_files_h

#include <gmsh.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <unit/mesh_test.h>

namespace ACF::Testing
{
  /** A folder for files that a test writes, removed with it. */
  class MeshFiles : public testing::Test
  {
  protected:
    void
    SetUp() override
    {
      folder = std::string("mesh_test_") +
               testing::UnitTest::GetInstance()->current_test_info()->name();
      std::filesystem::create_directory(folder);
    }

    void
    TearDown() override
    {
      std::filesystem::remove_all(folder);
    }

    void
    write(const std::string &name, const std::string &text) const
    {
      std::ofstream(folder + "/" + name, std::ios::binary) << text;
    }

    std::string
    read(const std::string &name) const
    {
      std::ostringstream text;
      text << std::ifstream(folder + "/" + name, std::ios::binary).rdbuf();
      return text.str();
    }

    /** Have gmsh mesh a script (or, with dimension 0, only export it). */
    void
    convert(const std::string &script,
            const std::string &name,
            const unsigned int dimension = 3,
            const double version         = 4.1,
            const bool binary            = false,
            const unsigned int order     = 1) const
    {
      gmsh::initialize(0, nullptr, false);
      gmsh::option::setNumber("General.Terminal", 0);
      gmsh::open(std::string(ACF_TEST_DATA) + "/" + script);
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
      gmsh::option::setNumber("Mesh.Binary", binary ? 1 : 0);
      gmsh::option::setNumber("Mesh.ElementOrder", order);
      if (dimension > 0)
        gmsh::model::mesh::generate(dimension);
      gmsh::write(folder + "/" + name);
      gmsh::finalize();
    }

    /** A .msh file 2.2 of the given lines "number x y z" and "number ...". */
    static std::string
    msh(const std::vector<std::string> &nodes,
        const std::vector<std::string> &elements,
        const std::string &groups = "")
    {
      std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + groups +
                         "$Nodes\n" + std::to_string(nodes.size()) + "\n";
      for (const std::string &node : nodes)
        text += node + "\n";
      text += "$EndNodes\n$Elements\n" + std::to_string(elements.size()) + "\n";
      for (const std::string &element : elements)
        text += element + "\n";
      return text + "$EndElements\n";
    }

    void
    expect_error(const std::string &name,
                 const std::string &text,
                 const std::vector<std::string> &parts) const
    {
      write(name, text);
      std::vector<std::string> all = parts;
      all.insert(all.end(), {"Bodies/b", "'Mesh'", name});
      expect_mesh_error("set Mesh = " + name, all, folder);
    }

    std::string folder;
  };
} // namespace ACF::Testing

#endif
