// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh.h>
#include <acf/mechanics/mesh_division.h>
#include <acf/mechanics/mesh_generation.h>
#include <acf/mechanics/mesh_import.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>

#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <sstream>
#include <tuple>
#include <utility>

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

    Point<dim>
    to_point(const std::vector<double> &coordinates)
    {
      return Point<dim>(coordinates[0], coordinates[1], coordinates[2]);
    }

    ReferenceCell
    to_reference_cell(const std::string &element)
    {
      return element == "tetrahedron" ? ReferenceCells::Tetrahedron
                                      : ReferenceCells::Hexahedron;
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
               const std::string &entry)
    {
      if (is_used && value.size() != n_numbers)
        throw InputError(section,
                         entry,
                         value.empty() ? "no value"
                                       : "'" + describe_list(value) + "'",
                         meaning + " for Mesh = " + mesh);
      if (!is_used && !value.empty())
        throw InputError(section,
                         entry,
                         "'" + describe_list(value) + "'",
                         "no value for Mesh = " + mesh);
    }

    /** Names and ids to look up, in an error if in vain. */
    const std::set<unsigned int> &
    find_name(const std::map<std::string, std::set<unsigned int>> &names,
              const std::string &kind,
              const std::string &name,
              const std::string &section,
              const std::string &entry)
    {
      const auto found = names.find(name);
      if (found != names.end())
        return found->second;
      std::string known;
      for (const auto &known_name : names)
        known += (known.empty() ? "'" : ", '") + known_name.first + "'";
      throw InputError(section,
                       entry,
                       kind + " '" + name + "', which the mesh does not have",
                       known.empty() ? "none, the mesh has no " + kind + "s"
                                     : known);
    }

    /** A rule for tetrahedra and triangles, or hexahedra and quadrilaterals. */
    template <int structdim>
    Quadrature<structdim>
    make_quadrature(const bool is_simplex,
                    const unsigned int exact_degree,
                    const unsigned int largest_simplex_degree)
    {
      if (!is_simplex)
        return QGauss<structdim>(exact_degree / 2 + 1);
      AssertThrow(exact_degree <= largest_simplex_degree,
                  ExcMessage("There is no quadrature rule for simplices that "
                             "is exact to degree " +
                             std::to_string(exact_degree) + "."));
      // rules of even degree 2 n have fewer points than those of 2 n + 1
      const bool is_even = (exact_degree > 0 && exact_degree % 2 == 0);
      return QWitherdenVincentSimplex<structdim>((exact_degree + 1) / 2 +
                                                   (exact_degree == 0 ? 1 : 0),
                                                 !is_even);
    }
  } // namespace

  void
  MeshParameters::add_parameters(ParameterHandler &prm)
  {
    const Patterns::List point(Patterns::Double(), 0, 3);
    prm.add_parameter(
      "Mesh",
      mesh,
      "Mesh file of gmsh (.msh, in m), geometry that gmsh meshes (.geo and "
      ".brep in m; .step, .stp, .igs, .iges in their own unit), 'box' or "
      "'cylinder'; file names are relative to the folder of this file. "
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
    const bool is_built_in = (is_box || is_cylinder);
    const auto kind        = mesh_file_kind(mesh);
    if (!is_built_in && kind == MeshFileKind::unknown)
      throw InputError(section,
                       "Mesh",
                       mesh.empty() ? "no value" : "'" + mesh + "'",
                       "box, cylinder, or a file .msh, .geo, .step, .stp, "
                       ".igs, .iges or .brep");
    if (mesh_size > 0 && (is_built_in || kind == MeshFileKind::mesh))
      throw InputError(section,
                       "Mesh size",
                       Utilities::to_string(mesh_size),
                       "no value for Mesh = " + mesh +
                         ", only geometries are meshed by gmsh");

    const std::string point = "a point of three coordinates";
    check_list(box_from, 3, is_box, point, mesh, section, "Box from");
    check_list(box_to, 3, is_box, point, mesh, section, "Box to");
    check_list(
      cylinder_from, 3, is_cylinder, point, mesh, section, "Cylinder from");
    check_list(
      cylinder_to, 3, is_cylinder, point, mesh, section, "Cylinder to");
    check_list(cells,
               is_box ? 3 : 2,
               is_built_in,
               is_box ? "three positive counts" : "two positive counts",
               mesh,
               section,
               "Cells");
    if (is_cylinder != (cylinder_radius > 0))
      throw InputError(section,
                       "Cylinder radius",
                       Utilities::to_string(cylinder_radius),
                       (is_cylinder ? "a positive number for Mesh = "
                                    : "no value for Mesh = ") +
                         mesh);
    parse_cut(cut, section);
    if (is_box)
      for (unsigned int d = 0; d < dim; ++d)
        if (!(box_from[d] < box_to[d]))
          throw InputError(section,
                           "Box to",
                           "'" + describe_list(box_to) + "'",
                           "coordinates larger than those of 'Box from', '" +
                             describe_list(box_from) + "'");
    if (is_cylinder && cylinder_from == cylinder_to)
      throw InputError(section,
                       "Cylinder to",
                       "'" + describe_list(cylinder_to) + "'",
                       "a point other than 'Cylinder from'");

    if (!is_built_in)
      return;
    constexpr double largest_number = 1e8;
    double n_cells                  = (element == "tetrahedron" ? 24 : 1);
    for (const unsigned int count : cells)
      n_cells *= count;
    if (is_cylinder)
      n_cells *= cells[0];
    if (std::find(cells.begin(), cells.end(), 0U) != cells.end() ||
        (is_cylinder && cells[0] < 3) || n_cells > largest_number)
      throw InputError(section,
                       "Cells",
                       "'" + describe_list(cells) + "'",
                       std::string(is_box ? "three positive counts"
                                          : "two counts, at least 3 and 1") +
                         " that make no more than 100 million cells");
  }

  BodyMesh::BodyMesh(MeshData data, const MeshSource &source)
    : cell_type(data.reference_cell)
  {
    check_cells(data, source);
    check_topology(data, source);
    drop_unused_vertices(data);
    named_surfaces = data.surfaces;
    named_regions  = data.regions;

    if (is_simplex())
      cell_mapping =
        std::make_unique<const MappingFE<dim>>(FE_SimplexP<dim>(1));
    else
      {
        cell_mapping = std::make_unique<const MappingQ<dim>>(1);
        GridTools::consistently_order_cells(data.cells);
      }
    tria.create_triangulation(data.vertices, data.cells, SubCellData());
    set_boundary_ids(data);
  }

  void
  BodyMesh::set_boundary_ids(const MeshData &data)
  {
    std::map<std::set<unsigned int>, types::boundary_id> ids;
    for (const CellData<dim - 1> &face : data.faces)
      ids[{face.vertices.begin(), face.vertices.end()}] = face.boundary_id;
    for (const auto &cell : tria.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          {
            std::set<unsigned int> vertices;
            for (const unsigned int v : face->vertex_indices())
              vertices.insert(face->vertex_index(v));
            const auto id = ids.find(vertices);
            face->set_boundary_id(id == ids.end() ? 0 : id->second);
          }
  }

  const Triangulation<dim> &
  BodyMesh::triangulation() const
  {
    return tria;
  }

  ReferenceCell
  BodyMesh::reference_cell() const
  {
    return cell_type;
  }

  bool
  BodyMesh::is_simplex() const
  {
    return cell_type == ReferenceCells::Tetrahedron;
  }

  const std::map<std::string, std::set<types::boundary_id>> &
  BodyMesh::surfaces() const
  {
    return named_surfaces;
  }

  const std::map<std::string, std::set<types::material_id>> &
  BodyMesh::regions() const
  {
    return named_regions;
  }

  const std::set<types::boundary_id> &
  BodyMesh::surface(const std::string &name,
                    const std::string &section,
                    const std::string &entry) const
  {
    return find_name(named_surfaces, "surface", name, section, entry);
  }

  const std::set<types::material_id> &
  BodyMesh::region(const std::string &name,
                   const std::string &section,
                   const std::string &entry) const
  {
    return find_name(named_regions, "region", name, section, entry);
  }

  const Mapping<dim> &
  BodyMesh::mapping() const
  {
    return *cell_mapping;
  }

  Quadrature<dim>
  BodyMesh::cell_quadrature(const unsigned int exact_degree) const
  {
    return make_quadrature<dim>(is_simplex(), exact_degree, 9);
  }

  Quadrature<dim - 1>
  BodyMesh::face_quadrature(const unsigned int exact_degree) const
  {
    return make_quadrature<dim - 1>(is_simplex(), exact_degree, 13);
  }

  MeshData
  make_mesh_data(const MeshParameters &parameters,
                 const std::string &section,
                 const std::filesystem::path &directory)
  {
    const ReferenceCell reference_cell = to_reference_cell(parameters.element);
    const MeshSource source{section, parameters.mesh};
    const auto &cells = parameters.cells;

    MeshData data;
    if (parameters.mesh == "box")
      data = generate_box(to_point(parameters.box_from),
                          to_point(parameters.box_to),
                          {{cells[0], cells[1], cells[2]}},
                          reference_cell);
    else if (parameters.mesh == "cylinder")
      data = generate_cylinder(to_point(parameters.cylinder_from),
                               to_point(parameters.cylinder_to),
                               parameters.cylinder_radius,
                               cells[0],
                               cells[1],
                               reference_cell);
    else
      data = import_mesh(directory / parameters.mesh,
                         reference_cell,
                         parameters.mesh_size,
                         source);
    if (parameters.mirror != "none")
      {
        // before, to count what is wrong once only
        check_cells(data, source);
        mirror_mesh(data, parameters.mirror[0] - 'x', source);
      }
    return data;
  }

  std::unique_ptr<const BodyMesh>
  make_mesh(const MeshParameters &parameters,
            const std::string &section,
            const std::filesystem::path &directory)
  {
    return std::make_unique<const BodyMesh>(
      make_mesh_data(parameters, section, directory),
      MeshSource{section, parameters.mesh});
  }
} // namespace ACF
