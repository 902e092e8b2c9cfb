// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/parameter_patterns.h>
#include <acf/mechanics/gmsh_sizes.h>
#include <acf/mechanics/mesh_limits.h>

#include <deal.II/base/utilities.h>

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ACF
{
  namespace
  {
    constexpr double growth = 1. / 3;

    // Points of a surface that the distance from it is measured to, along each
    // of its parameters.
    constexpr double least_samples = 20;
    constexpr double most_samples  = 300;

    using SurfaceNames = std::map<std::string, std::set<int>>;

    // In the unit of the model.
    double
    diagonal_of(const int dimension, const int tag)
    {
      Point<dim> lower, upper;
      gmsh::model::getBoundingBox(dimension,
                                  tag,
                                  lower[0],
                                  lower[1],
                                  lower[2],
                                  upper[0],
                                  upper[1],
                                  upper[2]);
      return lower.distance(upper);
    }



    SurfaceNames
    surfaces_of_geometry()
    {
      SurfaceNames result;
      gmsh::vectorpair pairs;
      gmsh::model::getPhysicalGroups(pairs, dim - 1);
      for (const auto &[dimension, group] : pairs)
        {
          std::string name;
          gmsh::model::getPhysicalName(dimension, group, name);
          std::vector<int> tags;
          gmsh::model::getEntitiesForPhysicalGroup(dimension, group, tags);
          for (const int tag : tags)
            result[name.empty() ? "surface " + std::to_string(group) : name]
              .insert(std::abs(tag));
        }
      if (!result.empty())
        return result;
      gmsh::model::getEntities(pairs, dim - 1);
      for (const auto &surface : pairs)
        result["surface " + std::to_string(surface.second)] = {surface.second};
      return result;
    }



    // The surfaces whose nodes, of a coarse mesh, are all selected.
    std::set<int>
    select(const SurfaceSelection &selection, const double scale)
    {
      std::vector<std::size_t> nodes;
      std::vector<double> coordinates, parameters;
      gmsh::vectorpair surfaces;
      gmsh::model::getEntities(surfaces, dim - 1);
      if (surfaces.empty())
        return {};
      gmsh::model::mesh::getNodes(nodes, coordinates, parameters);
      if (nodes.empty())
        gmsh::model::mesh::generate(dim - 1);
      const double tolerance =
        selection.tolerance_for(scale * diagonal_of(-1, -1));

      std::set<int> result;
      for (const auto &[dimension, tag] : surfaces)
        {
          gmsh::model::mesh::getNodes(
            nodes, coordinates, parameters, dimension, tag, true);
          bool is_selected = !nodes.empty();
          for (std::size_t n = 0; n < nodes.size(); ++n)
            {
              const Point<dim> x(scale * coordinates[3 * n],
                                 scale * coordinates[3 * n + 1],
                                 scale * coordinates[3 * n + 2]);
              is_selected &= selection.distance(x) <= tolerance;
            }
          if (is_selected)
            result.insert(tag);
        }
      return result;
    }



    // At least as many elements as cover the surfaces.
    void
    check_size(const std::set<int> &surfaces,
               const double size,
               const std::string &text,
               const MeshSource &source)
    {
      gmsh::vectorpair shapes;
      gmsh::model::occ::getEntities(shapes, dim - 1);
      double n_elements = 0;
      for (const int tag : surfaces)
        {
          double area = std::pow(diagonal_of(dim - 1, tag), 2) / 100;
          if (std::find(shapes.begin(), shapes.end(), std::make_pair(2, tag)) !=
              shapes.end())
            gmsh::model::occ::getMass(dim - 1, tag, area);
          n_elements += area / (0.433 * size * size);
        }
      check_number_of_cells(
        n_elements, true, source.section, "Surface mesh sizes", text);
    }



    // The limit at a distance from surfaces, and on them, where the distance
    // from samples would be wrong.
    std::vector<double>
    make_fields(const std::set<int> &surfaces,
                const double size,
                const double largest)
    {
      namespace field = gmsh::model::mesh::field;
      const std::vector<double> tags(surfaces.begin(), surfaces.end());
      double extent = 0;
      for (const int tag : surfaces)
        extent = std::max(extent, diagonal_of(dim - 1, tag));
      const int distance = field::add("Distance");
      field::setNumbers(distance, "SurfacesList", tags);
      field::setNumber(distance,
                       "NumPointsPerCurve",
                       std::clamp(std::ceil(2 * extent / size),
                                  least_samples,
                                  most_samples));
      const int threshold = field::add("Threshold");
      field::setNumber(threshold, "InField", distance);
      field::setNumber(threshold, "DistMin", 0);
      field::setNumber(threshold, "DistMax", (largest - size) / growth);
      field::setNumber(threshold, "SizeMin", size);
      field::setNumber(threshold, "SizeMax", largest);
      const int constant = field::add("MathEval");
      field::setString(constant, "F", Utilities::to_string(size, 17));
      const int restricted = field::add("Restrict");
      field::setNumber(restricted, "InField", constant);
      field::setNumbers(restricted, "SurfacesList", tags);
      std::vector<double> curves;
      for (const int tag : surfaces)
        {
          gmsh::vectorpair boundary;
          gmsh::model::getBoundary({{dim - 1, tag}}, boundary, false, false);
          for (const auto &curve : boundary)
            curves.push_back(curve.second);
        }
      field::setNumbers(restricted, "CurvesList", curves);
      return {static_cast<double>(threshold), static_cast<double>(restricted)};
    }
  } // namespace



  void
  set_surface_sizes(const std::vector<std::pair<std::string, double>> &sizes,
                    const std::vector<SurfaceSelection> &selections,
                    const double scale,
                    const MeshSource &source)
  {
    const SurfaceNames names = surfaces_of_geometry();
    double largest           = 0;
    gmsh::option::getNumber("Mesh.MeshSizeMax", largest);
    largest = std::min(largest, 0.1 * diagonal_of(-1, -1));

    gmsh::model::mesh::clear();
    std::vector<std::pair<std::set<int>, double>> limits;
    for (const auto &[name, size] : sizes)
      {
        const std::string text = in_quotes(name + ": " + format_number(size));
        std::set<int> surfaces;
        const auto known = names.find(name);
        const auto selection =
          std::find_if(selections.begin(),
                       selections.end(),
                       [&name = name](const SurfaceSelection &candidate) {
                         return candidate.name == name;
                       });
        if (known != names.end())
          surfaces = known->second;
        else if (selection != selections.end())
          surfaces = select(*selection, scale);
        if (surfaces.empty())
          {
            std::vector<std::string> all;
            for (const auto &surface : names)
              all.push_back(surface.first);
            for (const SurfaceSelection &candidate : selections)
              all.push_back(candidate.name);
            throw InputError(
              source.section,
              "Surface mesh sizes",
              text + (selection == selections.end()
                        ? ", a surface that the geometry does not have"
                        : ", in which no whole surface of the geometry lies"),
              all.empty() ? "none, the geometry has no surfaces"
                          : list_words(all, "'"));
          }
        check_size(surfaces, size / scale, text, source);
        if (size / scale < largest)
          limits.emplace_back(surfaces, size / scale);
      }
    if (limits.empty())
      return;

    namespace field = gmsh::model::mesh::field;
    std::vector<double> fields;
    for (const auto &[surfaces, size] : limits)
      for (const double tag : make_fields(surfaces, size, largest))
        fields.push_back(tag);
    const int smallest = field::add("Min");
    field::setNumbers(smallest, "FieldsList", fields);
    field::setAsBackgroundMesh(smallest);
  }
} // namespace ACF
