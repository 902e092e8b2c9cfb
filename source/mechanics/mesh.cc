// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/mesh.h>
#include <acf/mechanics/mesh_generation.h>
#include <acf/mechanics/mesh_import.h>
#include <acf/mechanics/mesh_limits.h>
#include <acf/mechanics/mesh_surfaces.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <utility>

#include "quadratic_mapping.h"

namespace ACF
{
  namespace
  {
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

  BodyMesh::BodyMesh(MeshData data, const MeshSource &source)
    : cell_type(data.reference_cell)
  {
    check_cells(data, source);
    check_topology(data, source);
    drop_unused_vertices(data);
    named_surfaces = data.surfaces;
    named_regions  = data.regions;
    all_notes      = data.notes;

    if (!is_simplex())
      GridTools::consistently_order_cells(data.cells);
    tria.create_triangulation(data.vertices, data.cells, SubCellData());
    has_curved_edges = !data.curved_edges.empty();
    if (has_curved_edges)
      cell_mapping = std::make_unique<const QuadraticMapping>(tria, data);
    else if (is_simplex())
      cell_mapping =
        std::make_unique<const MappingFE<dim>>(FE_SimplexP<dim>(1));
    else
      cell_mapping = std::make_unique<const MappingQ<dim>>(1);
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

  bool
  BodyMesh::is_curved() const
  {
    return has_curved_edges;
  }

  const std::vector<std::string> &
  BodyMesh::notes() const
  {
    return all_notes;
  }

  const Mapping<dim> &
  BodyMesh::mapping() const
  {
    return *cell_mapping;
  }

  Quadrature<dim>
  BodyMesh::cell_quadrature(const unsigned int exact_degree) const
  {
    return make_quadrature<dim>(is_simplex(),
                                exact_degree + (has_curved_edges ? 3 : 0),
                                9);
  }

  Quadrature<dim - 1>
  BodyMesh::face_quadrature(const unsigned int exact_degree) const
  {
    return make_quadrature<dim - 1>(is_simplex(),
                                    exact_degree + (has_curved_edges ? 3 : 0),
                                    13);
  }

  MeshData
  make_mesh_data(const MeshParameters &parameters,
                 const std::string &section,
                 const std::filesystem::path &directory)
  {
    const ReferenceCell reference_cell = to_reference_cell(parameters.element);
    const MeshSource source{section, parameters.mesh};
    const auto &cells     = parameters.cells;
    const auto selections = parse_surfaces(parameters.surfaces, section);

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
                               reference_cell,
                               parameters.geometry == "quadratic");
    else
      {
        ImportOptions options;
        options.scale        = parameters.mesh_scale;
        options.mesh_size    = parameters.mesh_size;
        options.selections   = selections;
        options.is_quadratic = (parameters.geometry == "quadratic");
        options.surface_sizes =
          parse_surface_sizes(parameters.surface_mesh_sizes, section);
        data = import_mesh(directory / parameters.mesh,
                           reference_cell,
                           options,
                           source);
        check_number_of_cells(data.cells.size(),
                              reference_cell == ReferenceCells::Tetrahedron,
                              section,
                              "Mesh",
                              "'" + parameters.mesh + "'");
      }
    select_surfaces(data, selections, source);
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
