// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_mesh_h
#define acf_mechanics_mesh_h

#include <acf/mechanics/mesh_data.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/quadrature.h>

#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace ACF
{
  /**
   * The entries of a body's subsection that describe its mesh. Lists that are
   * empty, numbers that are zero and the mirror "none" count as not given.
   */
  struct MeshParameters
  {
    /** File, or "box", or "cylinder". */
    std::string mesh;

    /** "tetrahedron" or "hexahedron". */
    std::string element = "tetrahedron";

    /** Largest element size that gmsh may make, m. */
    double mesh_size = 0;

    /** Sizes at surfaces that gmsh meshes, see parse_surface_sizes(). */
    std::string surface_mesh_sizes;

    /** "straight" or "quadratic" edges of the cells. */
    std::string geometry = "straight";

    /** Factor of the coordinates of a file, after its unit. */
    double mesh_scale = 1;

    /** Surfaces that are selected by their place, see parse_surfaces(). */
    std::string surfaces;

    /** Two opposite corners of a box, m. */
    std::vector<double> box_from;
    std::vector<double> box_to;

    /** Centres of the end faces of a cylinder, m, and its radius, m. */
    std::vector<double> cylinder_from;
    std::vector<double> cylinder_to;
    double cylinder_radius = 0;

    /** Counts of hexahedra of a built-in shape, see add_parameters(). */
    std::vector<unsigned int> cells;

    /** "none", or the normal "x", "y" or "z" of the plane of symmetry. */
    std::string mirror = "none";

    /** How the mesh is divided into parts, see parse_cut(). */
    std::string cut;

    /** The part of the mesh that is meant; empty: the whole. No entry. */
    std::string part;

    /**
     * Declare the entries in the current subsection of @p prm.
     * @pre the object stays where it is until @p prm has been parsed
     */
    void
    add_parameters(ParameterHandler &prm);

    /**
     * Check what patterns cannot: that everything the kind of mesh needs is
     * given and makes sense, and that nothing is given that it does not use.
     * @param section path of the body's subsection, for the message
     * @throws InputError
     */
    void
    check(const std::string &section) const;

    /** Whether the same mesh results. */
    bool
    operator==(const MeshParameters &other) const;
  };

  /**
   * The mesh of a body: one connected piece of tetrahedra, with straight or
   * quadratic edges, or of hexahedra with straight ones, its named surfaces and
   * regions, and the mapping and the quadrature rules that fit its cells.
   * Immutable, and where it was made.
   */
  class BodyMesh
  {
  public:
    /**
     * Check @p data and build the triangulation.
     * @throws InputError if cells are inverted, degenerate, duplicate, overlap
     *   or are not connected through faces, or if a face of a surface is not
     *   on the boundary
     */
    BodyMesh(MeshData data, const MeshSource &source);

    BodyMesh(const BodyMesh &) = delete;
    BodyMesh &
    operator=(const BodyMesh &) = delete;

    const Triangulation<dim> &
    triangulation() const;

    ReferenceCell
    reference_cell() const;

    /** Tetrahedra (otherwise hexahedra). */
    bool
    is_simplex() const;

    /** Names of surfaces and the boundary ids each consists of; 0 is none. */
    const std::map<std::string, std::set<types::boundary_id>> &
    surfaces() const;

    /** Names of regions and the material ids each consists of; 0 is none. */
    const std::map<std::string, std::set<types::material_id>> &
    regions() const;

    /**
     * Boundary ids of a surface that @p entry of @p section names.
     * @throws InputError that lists the surfaces which exist
     */
    const std::set<types::boundary_id> &
    surface(const std::string &name,
            const std::string &section,
            const std::string &entry) const;

    /** Material ids of a region, like surface(). */
    const std::set<types::material_id> &
    region(const std::string &name,
           const std::string &section,
           const std::string &entry) const;

    /** Whether there are edges that are not straight. */
    bool
    is_curved() const;

    /** What the reader of a file left out, a sentence each. */
    const std::vector<std::string> &
    notes() const;

    /** The affine, trilinear or isoparametric quadratic mapping of the cells.
     */
    const Mapping<dim> &
    mapping() const;

    /**
     * A rule that integrates polynomials of total degree @p exact_degree (of
     * that degree in each coordinate, for hexahedra) on the reference cell; for
     * curved cells, their products with the Jacobian, which is of degree 3.
     * @pre tetrahedra: @p exact_degree at most 9, or 6 if they are curved
     */
    Quadrature<dim>
    cell_quadrature(const unsigned int exact_degree) const;

    /** The same for a face; triangles: @p exact_degree at most 13, or 10 if
     * they are curved, whose normals (with the area) are of degree 2; the rule
     * is exact for degree 3. */
    Quadrature<dim - 1>
    face_quadrature(const unsigned int exact_degree) const;

  private:
    void
    set_boundary_ids(const MeshData &data);

    std::map<std::string, std::set<types::boundary_id>> named_surfaces;
    std::map<std::string, std::set<types::material_id>> named_regions;
    ReferenceCell cell_type;
    std::vector<std::string> all_notes;
    Triangulation<dim> tria;
    bool has_curved_edges = false;
    std::unique_ptr<const Mapping<dim>> cell_mapping;
  };

  /**
   * Read or generate the mesh of a body, undivided, as plain data.
   * @pre MeshParameters::check() has passed
   * @param section path of the body's subsection, for errors
   * @param directory relative file names start here: that of the model file
   * @throws InputError
   */
  MeshData
  make_mesh_data(const MeshParameters &parameters,
                 const std::string &section,
                 const std::filesystem::path &directory);

  /** The same, checked. */
  std::unique_ptr<const BodyMesh>
  make_mesh(const MeshParameters &parameters,
            const std::string &section,
            const std::filesystem::path &directory);
} // namespace ACF

#endif
