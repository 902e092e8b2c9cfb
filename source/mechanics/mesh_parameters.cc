// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/input_problems.h>
#include <acf/mechanics/mesh.h>
#include <acf/mechanics/mesh_division.h>
#include <acf/mechanics/mesh_import.h>
#include <acf/mechanics/mesh_limits.h>
#include <acf/mechanics/mesh_surfaces.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <sstream>
#include <tuple>

namespace ACF
{
  namespace
  {
    /** "1, 2, 3" */
    template <typename Number>
    std::string
    describe_list(const std::vector<Number> &list)
    {
      std::ostringstream text;
      for (std::size_t i = 0; i < list.size(); ++i)
        text << (i > 0 ? ", " : "") << list[i];
      return text.str();
    }

    /** An entry that one kind of mesh uses, and that it must have then. */
    template <typename Number>
    void
    check_list(const std::vector<Number> &value,
               const std::size_t n_numbers,
               const bool is_used,
               const std::string &meaning,
               const std::string &mesh,
               const std::string &section,
               const std::string &entry,
               InputProblems &problems)
    {
      if (is_used && value.size() != n_numbers)
        problems.add(InputError(section,
                                entry,
                                value.empty()
                                  ? "no value"
                                  : "'" + describe_list(value) + "'",
                                meaning + " for Mesh = " + mesh));
      if (!is_used && !value.empty())
        problems.add(InputError(section,
                                entry,
                                "'" + describe_list(value) + "'",
                                "no value for Mesh = " + mesh));
    }

    /** Entries of a built-in shape that are there must fit each other. */
    void
    check_shape(const MeshParameters &parameters,
                const std::string &section,
                InputProblems &problems)
    {
      const bool is_box      = (parameters.mesh == "box");
      const bool is_cylinder = !is_box;
      const auto &from       = parameters.box_from;
      const auto &to         = parameters.box_to;
      const auto is_point    = [](const std::vector<double> &coordinates) {
        return coordinates.size() == dim;
      };
      if (is_box && is_point(from) && is_point(to) &&
          !(from[0] < to[0] && from[1] < to[1] && from[2] < to[2]))
        problems.add(
          InputError(section,
                     "Box to",
                     "'" + describe_list(to) + "'",
                     "coordinates larger than those of 'Box from', '" +
                       describe_list(from) + "'"));
      if (is_cylinder && is_point(parameters.cylinder_to) &&
          parameters.cylinder_from == parameters.cylinder_to)
        problems.add(
          InputError(section,
                     "Cylinder to",
                     "'" + describe_list(parameters.cylinder_to) + "'",
                     "a point other than 'Cylinder from'"));

      const auto &cells = parameters.cells;
      if (cells.size() != (is_box ? 3 : 2))
        return;
      const std::string found = "'" + describe_list(cells) + "'";
      if (std::find(cells.begin(), cells.end(), 0U) != cells.end() ||
          (is_cylinder && cells[0] < 3))
        {
          problems.add(InputError(section,
                                  "Cells",
                                  found,
                                  is_box ? "three positive counts"
                                         : "two counts, at least 3 and 1"));
          return;
        }
      const bool is_simplex = (parameters.element == "tetrahedron");
      double n_cells        = (is_simplex ? 24 : 1);
      for (const unsigned int count : cells)
        n_cells *= count;
      if (is_cylinder)
        n_cells *= cells[0];
      problems.attempt([&]() {
        check_number_of_cells(n_cells, is_simplex, section, "Cells", found);
      });
    }
  } // namespace

  void
  MeshParameters::add_parameters(ParameterHandler &prm)
  {
    const Patterns::List point(Patterns::Double(), 0, 3);
    prm.add_parameter(
      "Mesh",
      mesh,
      "Mesh file of gmsh (.msh) or Abaqus (.inp), geometry that gmsh meshes "
      "(.geo and .brep; .step, .stp, .igs, .iges in their own unit), 'box' or "
      "'cylinder'; files without a unit are in m; file names are relative to "
      "the folder of this file. "
      "Units: none.");
    prm.add_parameter("Element",
                      element,
                      "Shape of the cells; files must contain it, the built-in "
                      "shapes are made of either. Units: none.",
                      Patterns::Selection("tetrahedron|hexahedron"));
    prm.add_parameter(
      "Mesh size",
      mesh_size,
      "Largest element size when gmsh meshes a geometry, where the geometry "
      "does not prescribe counts of cells; 0: what the file says, or gmsh's "
      "default, a tenth of the diagonal of the bounding box, which is also "
      "its limit. Units: m.",
      Patterns::Double(0));
    prm.add_parameter(
      "Surface mesh sizes",
      surface_mesh_sizes,
      "Largest element sizes at surfaces when gmsh meshes a geometry, "
      "'NAME: size, NAME: size'; names are those of the surfaces of the "
      "geometry, or of the entry Surfaces. The sizes grow with the distance "
      "from the surface by a third of it. Units: m.");
    prm.add_parameter(
      "Geometry",
      geometry,
      "Edges of the cells: 'straight', or 'quadratic' as the nodes of second "
      "order in the file, or on the surface of the geometry or the cylinder, "
      "give them; for tetrahedra. Units: none.",
      Patterns::Selection("straight|quadratic"));
    prm.add_parameter(
      "Mesh scale",
      mesh_scale,
      "Factor on the coordinates of a file: 0.001 if they are in mm. Files of "
      "STEP and IGES have a unit, which is converted to m before. Everything "
      "else in this section is in m, after this factor. Units: none.",
      Patterns::Double(0));
    prm.add_parameter(
      "Surfaces",
      surfaces,
      "Surfaces that get a name by their place: 'NAME: plane x y z nx ny nz', "
      "a point and the normal; 'NAME: cylinder x y z ax ay az r', a point of "
      "the axis, its direction and the radius; 'NAME: box x1 y1 z1 x2 y2 z2', "
      "two corners; separated by ';', each followed by 'tolerance t' if 1e-5 "
      "of the diagonal of the bounding box does not suit. Units: m.");
    prm.add_parameter(
      "Box from",
      box_from,
      "Corner of the box with the smallest coordinates. Units: m.",
      point);
    prm.add_parameter("Box to",
                      box_to,
                      "Corner of the box with the largest coordinates. "
                      "Units: m.",
                      point);
    prm.add_parameter("Cylinder from",
                      cylinder_from,
                      "Centre of the face 'start' of the cylinder. Units: m.",
                      point);
    prm.add_parameter("Cylinder to",
                      cylinder_to,
                      "Centre of the face 'end' of the cylinder. Units: m.",
                      point);
    prm.add_parameter("Cylinder radius",
                      cylinder_radius,
                      "Radius of the cylinder. Units: m.",
                      Patterns::Double(0));
    prm.add_parameter(
      "Cells",
      cells,
      "Counts of hexahedra in a built-in shape, each of which is split into "
      "24 if the element is the tetrahedron; box: along x, y and z; cylinder: "
      "across the diameter (at least 3) and along the axis. Units: none.",
      Patterns::List(Patterns::Integer(1), 0, 3));
    prm.add_parameter(
      "Mirror",
      mirror,
      "Normal of a plane through the origin at which the mesh, then of half a "
      "body, is mirrored; the images of surfaces are called 'NAME mirrored', "
      "a surface with its image 'NAME both'. "
      "Units: none.",
      Patterns::Selection("none|x|y|z"));
    prm.add_parameter(
      "Cut",
      cut,
      "Where the body is divided into parts with rotations of their own: at "
      "planes across an axis of the mesh, 'y: 0.25, 0.5'; into slices of equal "
      "thickness, '4 along y'; or into the 'volumes' of the mesh file. Parts "
      "are called 'NAME 1', 'NAME 2', ... or 'NAME VOLUME'. Units: m.");
  }

  bool
  MeshParameters::operator==(const MeshParameters &other) const
  {
    const auto all = [](const MeshParameters &p) {
      return std::tie(p.mesh,
                      p.element,
                      p.mesh_size,
                      p.surface_mesh_sizes,
                      p.geometry,
                      p.mesh_scale,
                      p.surfaces,
                      p.box_from,
                      p.box_to,
                      p.cylinder_from,
                      p.cylinder_to,
                      p.cylinder_radius,
                      p.cells,
                      p.mirror,
                      p.cut,
                      p.part);
    };
    return all(*this) == all(other);
  }



  void
  MeshParameters::check(const std::string &section) const
  {
    const bool is_box      = (mesh == "box");
    const bool is_cylinder = (mesh == "cylinder");
    const auto kind        = mesh_file_kind(mesh);
    if (!is_box && !is_cylinder && kind == MeshFileKind::unknown)
      throw InputError(section,
                       "Mesh",
                       mesh.empty() ? "no value" : "'" + mesh + "'",
                       "box, cylinder, or a file .msh, .inp, .geo, .step, "
                       ".stp, .igs, .iges or .brep");
    InputProblems problems;
    const bool is_geometry = !is_box && !is_cylinder &&
                             kind != MeshFileKind::mesh &&
                             kind != MeshFileKind::abaqus;
    if (mesh_size > 0 && !is_geometry)
      problems.add(InputError(section,
                              "Mesh size",
                              Utilities::to_string(mesh_size),
                              "no value for Mesh = " + mesh +
                                ", only geometries are meshed by gmsh"));

    if (!(mesh_scale > 0) || (mesh_scale != 1 && (is_box || is_cylinder)))
      problems.add(InputError(section,
                              "Mesh scale",
                              "'" + format_number(mesh_scale) + "'",
                              mesh_scale > 0 ? "no value for Mesh = " + mesh +
                                                 ", only files are scaled"
                                             : "a positive number"));
    problems.attempt([&]() { parse_surfaces(surfaces, section); });
    problems.attempt(
      [&]() { parse_surface_sizes(surface_mesh_sizes, section); });
    if (!surface_mesh_sizes.empty() && !is_geometry)
      problems.add(InputError(section,
                              "Surface mesh sizes",
                              "'" + surface_mesh_sizes + "'",
                              "no value for Mesh = " + mesh +
                                ", only geometries are meshed by gmsh"));
    if (geometry == "quadratic" && (is_box || element != "tetrahedron"))
      problems.add(InputError(section,
                              "Geometry",
                              "'quadratic'",
                              is_box
                                ? "straight for Mesh = box"
                                : "straight for hexahedra, only tetrahedra are "
                                  "curved"));

    const auto check_point = [&](const std::vector<double> &value,
                                 const bool is_used,
                                 const std::string &entry) {
      check_list(value,
                 3,
                 is_used,
                 "a point of three coordinates",
                 mesh,
                 section,
                 entry,
                 problems);
    };
    check_point(box_from, is_box, "Box from");
    check_point(box_to, is_box, "Box to");
    check_point(cylinder_from, is_cylinder, "Cylinder from");
    check_point(cylinder_to, is_cylinder, "Cylinder to");
    check_list(cells,
               is_box ? 3 : 2,
               is_box || is_cylinder,
               is_box ? "three positive counts" : "two positive counts",
               mesh,
               section,
               "Cells",
               problems);
    if (is_cylinder != (cylinder_radius > 0))
      problems.add(InputError(section,
                              "Cylinder radius",
                              Utilities::to_string(cylinder_radius),
                              (is_cylinder ? "a positive number for Mesh = "
                                           : "no value for Mesh = ") +
                                mesh));
    problems.attempt([&]() { parse_cut(cut, section); });
    if (is_box || is_cylinder)
      check_shape(*this, section, problems);
    problems.throw_all();
  }
} // namespace ACF
