// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/body.h>
#include <acf/mechanics/mesh_import.h>
#include <acf/model.h>
#include <acf/simulation.h>

#include <deal.II/base/multithread_info.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fuzz/fuzz_targets.h>

namespace ACF::Testing
{
  namespace
  {
    constexpr double most_cells = 64;

    // Threads would cost more than they gain.
    void
    write_input(const char *const name, const std::string &text)
    {
      MultithreadInfo::set_thread_limit(1);
      std::ofstream(name, std::ios::binary) << text;
    }



    double
    n_cells(const MeshParameters &mesh)
    {
      double n = 1;
      for (const unsigned int count : mesh.cells)
        n *= count;
      if (mesh.mesh == "cylinder")
        n *= mesh.cells.front();
      return n * (mesh.element == "tetrahedron" ? 24 : 1) *
             (mesh.mirror == "none" ? 1 : 2);
    }



    // Whether the bodies can be made in a moment. Geometries are programs of
    // gmsh, or files of a CAD kernel: no matter of this fuzzer.
    bool
    is_small(const SystemParameters &system)
    {
      double n = 0;
      for (const BodyParameters &body : system.bodies)
        {
          const MeshFileKind kind = mesh_file_kind(body.mesh.mesh);
          if (kind != MeshFileKind::unknown && kind != MeshFileKind::mesh &&
              kind != MeshFileKind::abaqus)
            return false;
          n += n_cells(body.mesh);
        }
      return n <= most_cells;
    }
  } // namespace



  void
  prepare_fuzzing()
  {
    for (const auto &file :
         std::filesystem::directory_iterator(ACF_FUZZ "/seeds/mesh"))
      std::filesystem::copy_file(
        file.path(),
        file.path().filename(),
        std::filesystem::copy_options::overwrite_existing);
  }



  Outcome
  fuzz_model(const std::string &text)
  {
    const char *const name = "fuzz_input.prm";
    write_input(name, text);
    try
      {
        CommandLine command_line;
        command_line.action = CommandLine::Action::validate;
        command_line.model  = name;
        if (!is_small(read_model(ParameterFile(name)).system))
          return Outcome::read;
        std::ostringstream stream, warnings;
        run_command(command_line, stream, warnings);
        return Outcome::accepted;
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        if (message.rfind(std::string(name) + ":", 0) != 0)
          throw std::logic_error("no file before the message: " + message);
        return Outcome::rejected;
      }
  }



  Outcome
  fuzz_mesh(const std::string &contents)
  {
    // files of Abaqus begin with a keyword
    const bool is_abaqus   = !contents.empty() && contents[0] == '*';
    const char *const name = is_abaqus ? "fuzz_input.inp" : "fuzz_input.msh";
    write_input(name, contents);
    BodyParameters body;
    body.name                    = "body";
    body.mesh.mesh               = name;
    body.material.youngs_modulus = 1e9;
    body.material.density        = 1000;
    for (const char *const element : {"tetrahedron", "hexahedron"})
      try
        {
          body.mesh.element = element;
          // a function of the input, so that the same one takes the same way
          body.mesh.mirror = (contents.size() % 8 == 1 ? "x" : "none");
          body.mesh.cut    = (contents.size() % 8 == 2 ? "volumes" : "");
          body.mesh.geometry =
            (contents.size() % 7 == 1 && element[0] == 't' ? "quadratic"
                                                           : "straight");
          SystemParameters system;
          system.bodies = {body};
          auto mesh     = make_mesh_data(body.mesh, body.section(), "");
          if (mesh.cells.size() > most_cells)
            return Outcome::read;
          const MultibodySystem built(system, "");
          return Outcome::accepted;
        }
      catch (const InputError &error)
        {
          // the other element then
          if (error.entry == "Element" && element[0] == 't')
            continue;
          // an error of 'Cut' is located in the model file
          const std::string message = error.what();
          if (message.find(name) == std::string::npos && error.entry != "Cut")
            throw std::logic_error("no file in the message: " + message);
          return Outcome::rejected;
        }
    return Outcome::rejected;
  }
} // namespace ACF::Testing
