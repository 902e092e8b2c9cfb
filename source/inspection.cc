// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/exceptions.h>
#include <acf/base/files.h>
#include <acf/base/input_file.h>
#include <acf/inspection.h>
#include <acf/io/mesh_picture.h>
#include <acf/io/result_directory.h>
#include <acf/mechanics/body_operators.h>
#include <acf/mechanics/mesh_import.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <ostream>
#include <sstream>

namespace ACF
{
  namespace
  {
    // Sizes of parts that are doubted, m.
    constexpr double largest_part  = 10;
    constexpr double smallest_part = 1e-4;

    // Cells worse than this one are counted.
    constexpr double poor_quality = 0.1;

    // Distance of the mean position of a cylinder from its axis, in radii, from
    // which on it must be a part of a cylinder.
    constexpr double off_axis = 0.05;



    // Components that are only round-off of the scale are shown as zero.
    std::string
    format_vector(const Tensor<1, dim> &v, const double scale)
    {
      std::string text;
      for (unsigned int i = 0; i < dim; ++i)
        text += (i == 0 ? "(" : ", ") +
                format_number(std::abs(v[i]) < 1e-9 * scale ? 0. : v[i]);
      return text + ")";
    }



    // An error of the mesh in the words of the command line.
    InputError
    command_line_error(const InputError &error)
    {
      std::string message     = error.what();
      const std::size_t begin = message.find("found ");
      if (begin != std::string::npos)
        message.erase(0, begin);
      const std::string shapes = "box, cylinder, or ";
      const std::size_t shape  = message.find("; allowed: " + shapes);
      if (shape != std::string::npos)
        message.erase(message.find(shapes, shape), shapes.size());
      return InputError(
        std::string("command line: ") +
        (error.entry == "Mesh size" ? "--mesh-size" : "--inspect") + ": " +
        message);
    }



    void
    check_file(const CommandLine &command_line)
    {
      const std::string name = "'" + command_line.part.string() + "'";
      MeshParameters parameters;
      parameters.mesh      = command_line.part.string();
      parameters.mesh_size = command_line.mesh_size;
      if (mesh_file_kind(command_line.part) == MeshFileKind::unknown)
        parameters.mesh = "./" + parameters.mesh; // no built-in shape
      try
        {
          parameters.check("");
        }
      catch (const InputError &error)
        {
          throw command_line_error(error);
        }
      try
        {
          require_regular_file(command_line.part);
        }
      catch (const UnreadableFile &error)
        {
          throw InputError("command line: --inspect: found " + name + ": " +
                           error.what() +
                           "; allowed: the name of a file that exists");
        }
    }



    // Tetrahedra, or hexahedra where the file has them.
    std::unique_ptr<const BodyMesh>
    read_part(const CommandLine &command_line)
    {
      const double scale = command_line.scale;
      MeshParameters parameters;
      parameters.mesh      = command_line.part.string();
      parameters.mesh_size = command_line.mesh_size / scale;
      const auto read      = [&]() {
        try
          {
            return make_mesh_data(parameters, "", {});
          }
        catch (const InputError &error)
          {
            if (error.entry != "Element")
              throw;
            parameters.element = "hexahedron";
            return make_mesh_data(parameters, "", {});
          }
      };
      try
        {
          MeshData data = read();
          for (Point<dim> &vertex : data.vertices)
            vertex *= scale;
          return std::make_unique<const BodyMesh>(std::move(data),
                                                  MeshSource{"",
                                                             parameters.mesh});
        }
      catch (const InputError &error)
        {
          throw command_line_error(error);
        }
    }



    // A name that a body may have.
    std::string
    body_name(const std::filesystem::path &part)
    {
      std::string name = part.stem().string();
      for (char &c : name)
        if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '_' ||
              c == '-' || c == '+' || c == ' '))
          c = '_';
      const auto is_alnum = [](const char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0;
      };
      name.erase(name.begin(),
                 std::find_if(name.begin(), name.end(), is_alnum));
      while (!name.empty() && name.back() == ' ')
        name.pop_back();
      return name.empty() || name == "Names" ? "part" : name;
    }



    // "surface 2" comes before "surface 10".
    template <typename Survey>
    void
    sort_by_name(std::vector<Survey> &surveys)
    {
      const auto key = [](const std::string &name) {
        const std::size_t last   = name.find_last_not_of("0123456789");
        const std::size_t n      = last == std::string::npos ? 0 : last + 1;
        const std::string number = name.substr(n);
        return std::make_tuple(name.substr(0, n), number.size(), number);
      };
      std::sort(surveys.begin(),
                surveys.end(),
                [&](const Survey &a, const Survey &b) {
                  return key(a.name) < key(b.name);
                });
    }



    std::string
    describe_shape(const SurfaceSurvey &surface, const double length)
    {
      const SurfaceShape &shape = surface.shape;
      const auto curved         = [&](const std::string &name) {
        return name + (shape.is_hole ? " hole" : "") + ", radius " +
               format_number(shape.radius);
      };
      std::string text;
      switch (shape.kind)
        {
          case SurfaceShape::Kind::plane:
            text = "plane, normal " + format_vector(shape.direction, 1);
            break;
          case SurfaceShape::Kind::cylinder:
            {
              text = curved("cylinder") + ", axis " +
                     format_vector(shape.direction, 1) + " through " +
                     format_vector(shape.point, length);
              const Vector3 arm = surface.centre - shape.point;
              const double distance =
                (arm - (arm * shape.direction) * shape.direction).norm();
              if (distance > off_axis * shape.radius)
                text += "; a part of it, mean position " +
                        format_number(distance) + " off the axis";
              break;
            }
          case SurfaceShape::Kind::sphere:
            text = curved("sphere") + ", centre " +
                   format_vector(shape.point, length);
            break;
          case SurfaceShape::Kind::other:
            text = "other";
            break;
        }
      return text + (surface.n_pieces > 1
                       ? "; " + std::to_string(surface.n_pieces) + " pieces"
                       : "");
    }



    // Columns as wide as their longest text, but for the last one.
    void
    print_table(const std::vector<std::vector<std::string>> &rows,
                std::ostream &stream)
    {
      std::vector<std::size_t> widths(rows[0].size(), 0);
      for (const auto &row : rows)
        for (unsigned int c = 0; c < row.size(); ++c)
          widths[c] = std::max(widths[c], row[c].size());
      for (const auto &row : rows)
        {
          stream << " ";
          for (unsigned int c = 0; c < row.size(); ++c)
            {
              stream << " " << row[c];
              if (c + 1 < row.size())
                stream << std::string(widths[c] - row[c].size() + 1, ' ');
            }
          stream << "\n";
        }
    }



    void
    print_size(const CommandLine &command_line,
               const BodyMesh &mesh,
               const unsigned int n_nodes,
               const MeshSurvey &survey,
               std::ostream &stream)
    {
      const Vector3 extent = survey.upper - survey.lower;
      const double length  = extent.norm();
      const std::size_t n_poor =
        std::count_if(survey.qualities.begin(),
                      survey.qualities.end(),
                      [](const double q) { return q < poor_quality; });
      const double mean_quality =
        std::accumulate(survey.qualities.begin(), survey.qualities.end(), 0.) /
        survey.qualities.size();
      stream << command_line.part.string() << ": " << survey.qualities.size()
             << " quadratic "
             << (mesh.is_simplex() ? "tetrahedra" : "hexahedra") << ", "
             << n_nodes << " nodes, " << dim * n_nodes << " unknowns\n"
             << "  extent   " << format_number(extent[0]) << " x "
             << format_number(extent[1]) << " x " << format_number(extent[2])
             << " m, from " << format_vector(survey.lower, length) << " to "
             << format_vector(survey.upper, length) << " m\n"
             << "  volume   " << format_number(survey.volume) << " m^3, centre "
             << format_vector(survey.centre, length) << " m\n";
      if (command_line.density > 0)
        {
          const double density = command_line.density;
          const Matrix3 J      = density * survey.inertia;
          stream << "  mass     " << format_number(density * survey.volume)
                 << " kg (density " << format_number(density) << " kg/m^3)\n"
                 << "  inertia  about the centre xx, yy, zz "
                 << format_vector(Vector3({J[0][0], J[1][1], J[2][2]}),
                                  J.norm())
                 << ", yz, zx, xy "
                 << format_vector(Vector3({J[1][2], J[2][0], J[0][1]}),
                                  J.norm())
                 << " kg m^2\n";
        }
      stream << "  edges    " << format_number(survey.shortest_edge) << " to "
             << format_number(survey.longest_edge) << " m\n"
             << "  quality  mean " << std::setprecision(3) << mean_quality
             << ", worst " << survey.qualities[survey.worst_cell] << " at "
             << format_vector(survey.worst_place, length) << " m; " << n_poor
             << " of " << survey.qualities.size() << " cells below "
             << poor_quality << " ("
             << (mesh.is_simplex() ? "3 x inner / outer radius"
                                   : "scaled Jacobian")
             << ", best 1)\n";
    }



    void
    print_regions(const MeshSurvey &survey, std::ostream &stream)
    {
      std::vector<std::vector<std::string>> rows = {
        {"#", "volume", "cells", "volume [m^3]"}};
      for (const RegionSurvey &region : survey.regions)
        rows.push_back({std::to_string(rows.size()),
                        region.name,
                        std::to_string(region.n_cells),
                        format_number(region.volume)});
      stream << "\nVolumes, for Cut = volumes:\n";
      print_table(rows, stream);
    }



    void
    print_surfaces(const MeshSurvey &survey,
                   const std::string &body,
                   std::ostream &stream)
    {
      const double length = survey.lower.distance(survey.upper);
      std::vector<std::vector<std::string>> rows = {
        {"#", "surface", "faces", "area [m^2]", "mean position [m]", "shape"}};
      for (const SurfaceSurvey &surface : survey.surfaces)
        rows.push_back({std::to_string(rows.size()),
                        body + ": " + surface.name,
                        std::to_string(surface.n_faces),
                        format_number(surface.area),
                        format_vector(surface.centre, length),
                        describe_shape(surface, length)});
      if (survey.n_unnamed_faces > 0)
        rows.push_back({"0",
                        "(without a name)",
                        std::to_string(survey.n_unnamed_faces),
                        format_number(survey.unnamed_area),
                        "",
                        ""});
      stream << "\nSurfaces, as joints, loads and probes name them:\n";
      print_table(rows, stream);
    }



    void
    print_model_lines(const CommandLine &command_line,
                      const BodyMesh &mesh,
                      const MeshSurvey &survey,
                      const std::string &body,
                      std::ostream &stream)
    {
      stream << "\nLines for a model file:\n"
             << "subsection Bodies\n"
             << "  set Names = " << body << "\n"
             << "  subsection " << body << "\n"
             << "    set Mesh            = " << command_line.part.string()
             << "\n";
      if (command_line.scale != 1)
        stream << "    set Mesh scale      = "
               << format_number(command_line.scale) << "\n";
      if (command_line.mesh_size > 0)
        stream << "    set Mesh size       = "
               << format_number(command_line.mesh_size) << "  # m\n";
      if (!mesh.is_simplex())
        stream << "    set Element         = hexahedron\n";
      stream << "    set Young's modulus =   # Pa\n"
             << "    set Density         = "
             << (command_line.density > 0 ? format_number(command_line.density)
                                          : "")
             << "  # kg/m^3\n"
             << "  end\n"
             << "end\n";
      if (!survey.surfaces.empty())
        stream << "subsection Joints\n"
               << "  set Names = joint\n"
               << "  subsection joint\n"
               << "    set Type    = fixed\n"
               << "    set Between = " << body << ": "
               << survey.surfaces[0].name << ", ground\n"
               << "  end\n"
               << "end\n";
    }



    void
    print_doubts(const CommandLine &command_line,
                 const MeshSurvey &survey,
                 std::ostream &warnings)
    {
      const double length = survey.lower.distance(survey.upper);
      const bool has_unit =
        mesh_file_kind(command_line.part) == MeshFileKind::cad_with_unit;
      const std::string what = "'" + command_line.part.string() + "' is " +
                               format_number(length) + " m long";
      if (length > largest_part)
        print_warning(warnings,
                      what + ", as if it were in mm" +
                        (has_unit ? " with a wrong unit in the file" : "") +
                        "; then use --scale 0.001");
      if (length < smallest_part)
        print_warning(warnings,
                      what + ", as if it were in m" +
                        (has_unit ? " with a wrong unit in the file"
                                  : " after a scale for mm"));
    }
  } // namespace



  void
  inspect(const CommandLine &command_line,
          std::ostream &stream,
          std::ostream &warnings)
  {
    const std::filesystem::path directory =
      command_line.output_directory.value_or(command_line.part.stem().string() +
                                             "-inspection");
    check_file(command_line);
    check_writable(directory);
    const BodyDiscretization body(read_part(command_line));
    const BodyMesh &mesh = body.mesh();
    MeshSurvey survey    = survey_mesh(mesh);
    sort_by_name(survey.regions);
    sort_by_name(survey.surfaces);

    const auto aside = prepare_result_directory(directory,
                                                command_line.overwrite
                                                  ? EarlierResults::remove
                                                  : EarlierResults::set_aside,
                                                ResultKind::inspection);
    if (!aside.empty())
      print_warning(warnings,
                    "pictures of an earlier inspection in " +
                      directory.string() + " were moved to " + aside.string());
    write_surface_picture(mesh, survey, directory / surface_picture_file);
    write_mesh_picture(mesh, survey, directory / mesh_picture_file);
    print_doubts(command_line, survey, warnings);
    if (command_line.quiet)
      return;

    const std::string name = body_name(command_line.part);
    print_size(command_line, mesh, body.n_nodes(), survey, stream);
    print_regions(survey, stream);
    print_surfaces(survey, name, stream);
    print_model_lines(command_line, mesh, survey, name, stream);
    stream << "\nPictures for ParaView: "
           << (directory / surface_picture_file).string() << ", "
           << (directory / mesh_picture_file).string() << std::endl;
  }
} // namespace ACF
