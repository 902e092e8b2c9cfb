// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_mechanics_gmsh_model_h
#define acf_mechanics_gmsh_model_h

#include <acf/mechanics/mesh_data.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/set.hpp>
#include <boost/serialization/unordered_map.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <array>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ACF
{
  /**
   * gmsh's library, from its initialisation to the end of all its data;
   * gmsh_element_type() and gmsh_mesh(), and what calls them, need one. There
   * can be one at a time: gmsh has one global state.
   */
  class GmshSession
  {
  public:
    GmshSession();
    ~GmshSession();

    GmshSession(const GmshSession &) = delete;
    GmshSession &
    operator=(const GmshSession &) = delete;
  };

  /** What gmsh knows of a type of element. */
  struct ElementType
  {
    /** "Tetrahedron 10" */
    std::string name;

    int dimension;
    int order;
    int n_nodes;

    /** The corners are the first nodes. */
    int n_corners;

    /** Of all nodes in the reference element, node by node. */
    std::vector<double> node_coordinates;
  };

  /**
   * @param type gmsh's number of the type
   * @throws std::string, as gmsh does, for numbers that it does not know, and
   *   for elements without a fixed set of nodes
   */
  ElementType
  gmsh_element_type(const int type);

  /** Elements of one type on one geometric entity. */
  struct ElementBlock
  {
    /** Tag of the entity. */
    int entity;

    /** gmsh's number of the type. */
    int type;

    /** Numbers of the elements. */
    std::vector<std::size_t> tags;

    /** Numbers of their nodes, element by element. */
    std::vector<std::size_t> nodes;

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &entity &type &tags &nodes;
    }
  };

  /** A mesh in gmsh's terms: from a mesh file, or meshed by gmsh. */
  struct GmshMesh
  {
    /** Positions by the tags of the nodes, in the file's unit of length. */
    std::unordered_map<std::size_t, Point<dim>> nodes;

    /** The geometric entities of one dimension. */
    struct Entities
    {
      /** The tags of the physical groups of each entity. */
      std::map<int, std::set<int>> groups;

      /** Names of physical groups by their tags, those without one left out. */
      std::map<int, std::string> group_names;

      /** By entity and type. */
      std::map<std::pair<int, int>, ElementBlock> elements;

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &groups &group_names &elements;
      }
    };

    /** By the dimension. Of points and lines, the elements may be missing. */
    std::array<Entities, dim + 1> entities;

    /** Whether an element is listed once for each of its groups. */
    bool repeats_elements = false;

    /** What the reader of a file left out, a sentence each. */
    std::vector<std::string> notes;

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &nodes &entities &repeats_elements &notes;
    }
  };

  /** The mesh of gmsh's current model. */
  GmshMesh
  gmsh_mesh();

  /** Names that entities (by their tags) of one dimension have. */
  using EntityNames = std::map<int, std::set<std::string>>;

  /**
   * The names of the physical groups of a dimension (2 or 3) each entity
   * belongs to, without the entities in no group; "surface 5" or "volume 5" for
   * group 5 if it has no name.
   * @throws InputError if a group is empty
   */
  EntityNames
  physical_groups(const GmshMesh &mesh,
                  const int dimension,
                  const MeshSource &source);

  /** All entities of a dimension (2 or 3), called "surface 5" or "volume 5". */
  EntityNames
  geometric_entities(const GmshMesh &mesh, const int dimension);

  /** The elements of the entities in @p names, in the order of their tags. */
  std::vector<ElementBlock>
  elements_of(const GmshMesh &mesh,
              const int dimension,
              const EntityNames &names);

  /** "tetrahedra", "wedges" ... of a type of element of any order. */
  std::string
  element_family(const int type);

  /** "12 tetrahedra and 3 wedges" */
  std::string
  describe_elements(const std::vector<ElementBlock> &blocks);

  /**
   * Files of format 2.2 repeat an element for each of its groups, and gmsh
   * gives all elements of an entity all of the groups it met there: keep one
   * of each.
   * @throws InputError if not all elements of an entity are in all its groups
   */
  void
  remove_repetitions(std::vector<ElementBlock> &blocks,
                     const EntityNames &names,
                     const MeshSource &source);

  /**
   * Add cells, faces and their vertices to @p data.
   * @param mesh whose nodes the elements have
   * @param cells tetrahedra or hexahedra of any order; only their corners are
   *   taken
   * @param cell_ids material id for each entity of cells
   * @param faces triangles or quadrilaterals
   * @param face_ids boundary id for each entity of faces
   * @param scale metres per unit of length of the model
   * @param is_quadratic whether cells keep the nodes in the middle of their
   *   edges
   * @throws InputError if nodes do not exist; if cells are quadratic and others
   *   than tetrahedra of second order; otherwise if nodes of higher order are
   *   not where straight edges (flat cells) have them, up to 1e-5 of the size
   *   of the cell
   */
  void
  read_elements(const GmshMesh &mesh,
                const std::vector<ElementBlock> &cells,
                const std::map<int, unsigned int> &cell_ids,
                const std::vector<ElementBlock> &faces,
                const std::map<int, unsigned int> &face_ids,
                const double scale,
                const bool is_quadratic,
                const MeshSource &source,
                MeshData &data);
} // namespace ACF

#endif
