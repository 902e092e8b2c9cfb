// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/base/parameter_patterns.h>
#include <acf/mechanics/mesh_surfaces.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace ACF
{
  namespace
  {
    constexpr double default_tolerance = 1e-5;

    const char *const surfaces_form =
      "'NAME: plane x y z nx ny nz', 'NAME: cylinder x y z ax ay az r' or "
      "'NAME: box x1 y1 z1 x2 y2 z2', separated by ';', each of them followed "
      "by 'tolerance t' or not";

    InputError
    surfaces_error(const std::string &section,
                   const std::string &found,
                   const std::string &allowed)
    {
      return InputError(section, "Surfaces", found, allowed);
    }



    // One selection, "NAME: plane 0 0 0 0 0 1".
    class SelectionParser
    {
    public:
      SelectionParser(const std::string &text, const std::string &section)
        : text(text)
        , section(section)
      {
        const auto colon = text.find(':');
        if (colon == std::string::npos)
          fail(surfaces_form);
        result.text = text;
        result.name = Utilities::trim(text.substr(0, colon));
        if (result.name.empty() ||
            result.name.find_first_of(",") != std::string::npos)
          fail("a name without ':', ',' and ';' before the shape");
        std::istringstream rest(text.substr(colon + 1));
        std::string word;
        while (rest >> word)
          words.push_back(word);
        read_tolerance();
        read_shape();
      }

      SurfaceSelection result;

    private:
      [[noreturn]] void
      fail(const std::string &allowed) const
      {
        throw surfaces_error(section, in_quotes(text), allowed);
      }

      double
      number(const std::string &word) const
      {
        double value = std::numeric_limits<double>::quiet_NaN();
        try
          {
            value = Utilities::string_to_double(word);
          }
        catch (const std::exception &)
          {}
        if (!(std::abs(value) <= 1e100))
          fail("numbers, at most 1e100 in size, where " + in_quotes(word) +
               " is");
        return value;
      }

      void
      read_tolerance()
      {
        const auto keyword = std::find(words.begin(), words.end(), "tolerance");
        if (keyword == words.end())
          return;
        if (words.end() - keyword != 2)
          fail("one number at the end after 'tolerance'");
        result.tolerance = number(words.back());
        if (!(result.tolerance > 0))
          fail("a positive tolerance");
        words.resize(words.size() - 2);
      }

      void
      read_shape()
      {
        using Shape = SurfaceSelection::Shape;
        static const std::map<std::string, std::pair<Shape, unsigned int>>
          shapes = {{"plane", {Shape::plane, 6}},
                    {"cylinder", {Shape::cylinder, 7}},
                    {"box", {Shape::box, 6}}};
        const auto shape =
          words.empty() ? shapes.end() : shapes.find(words.front());
        if (shape == shapes.end() || words.size() != 1 + shape->second.second)
          fail(surfaces_form);
        result.shape = shape->second.first;
        std::vector<double> values;
        for (std::size_t w = 1; w < words.size(); ++w)
          values.push_back(number(words[w]));
        for (unsigned int d = 0; d < dim; ++d)
          {
            result.point[d]     = values[d];
            result.direction[d] = values[dim + d];
            result.corner[d]    = values[dim + d];
          }
        if (result.shape == Shape::box)
          {
            for (unsigned int d = 0; d < dim; ++d)
              if (!(result.point[d] <= result.corner[d]))
                fail("corners of a box, the smaller coordinates first");
            return;
          }
        const double length = result.direction.norm();
        if (!(length > 0))
          fail("a normal or an axis that is not zero");
        result.direction /= length;
        if (result.shape == Shape::cylinder)
          result.radius = values[6];
        if (result.shape == Shape::cylinder && !(result.radius > 0))
          fail("a positive radius");
      }

      const std::string &text;
      const std::string &section;
      std::vector<std::string> words;
    };



    struct BoundaryFace
    {
      std::vector<unsigned int> vertices;
      types::boundary_id id = 0;
      std::set<std::string> new_names;
    };



    // Faces of one cell, with the ids of the surfaces they belong to.
    std::map<FaceKey, BoundaryFace>
    find_boundary(const MeshData &data)
    {
      const auto table = make_face_table(data);
      std::map<FaceKey, BoundaryFace> result;
      for (std::size_t i = 0; i < table.size(); ++i)
        {
          const FaceKey &key = table[i].first;
          if ((i > 0 && table[i - 1].first == key) ||
              (i + 1 < table.size() && table[i + 1].first == key))
            continue;
          BoundaryFace face;
          for (const unsigned int vertex : key)
            if (vertex != numbers::invalid_unsigned_int)
              face.vertices.push_back(vertex);
          result.emplace(key, face);
        }
      for (const CellData<dim - 1> &face : data.faces)
        {
          const auto known = result.find(make_face_key(face.vertices));
          if (known != result.end())
            known->second.id = face.boundary_id;
        }
      return result;
    }



    // Of the whole face from the shape.
    double
    distance(const MeshData &data,
             const BoundaryFace &face,
             const SurfaceSelection &selection)
    {
      double largest = 0;
      for (const unsigned int vertex : face.vertices)
        largest = std::max(largest, selection.distance(data.vertices[vertex]));
      return largest;
    }



    bool
    is_across_axis(const MeshData &data,
                   const BoundaryFace &face,
                   const SurfaceSelection &selection)
    {
      if (selection.shape != SurfaceSelection::Shape::cylinder)
        return false;
      const Point<dim> &origin = data.vertices[face.vertices[0]];
      const Vector3 normal =
        cross_product_3d(data.vertices[face.vertices[1]] - origin,
                         data.vertices[face.vertices[2]] - origin);
      return std::abs(normal * selection.direction) >
             std::sqrt(0.5) * normal.norm();
    }



    std::string
    describe_face(const MeshData &data, const BoundaryFace &face)
    {
      Point<dim> centre;
      for (const unsigned int vertex : face.vertices)
        centre += Vector3(data.vertices[vertex]);
      return describe_point(centre / static_cast<double>(face.vertices.size()));
    }



    void
    name_faces(const MeshData &data,
               const SurfaceSelection &selection,
               const double diagonal,
               std::map<FaceKey, BoundaryFace> &boundary,
               const MeshSource &source)
    {
      const double tolerance      = selection.tolerance_for(diagonal);
      bool found                  = false;
      double smallest             = std::numeric_limits<double>::max();
      const BoundaryFace *nearest = nullptr;
      for (auto &[key, face] : boundary)
        {
          if (is_across_axis(data, face, selection))
            continue;
          const double d = distance(data, face, selection);
          if (d <= tolerance)
            {
              face.new_names.insert(selection.name);
              found = true;
            }
          else if (d < smallest)
            {
              smallest = d;
              nearest  = &face;
            }
        }
      if (found)
        return;
      throw surfaces_error(
        source.section,
        in_quotes(selection.text) + ", which selects no face of the mesh; " +
          (nearest == nullptr
             ? "there is none along its axis"
             : "the nearest one, at " + describe_face(data, *nearest) +
                 ", has vertices up to " + format_number(smallest) +
                 " m from it"),
        "a place where faces are, all of their vertices within " +
          format_number(tolerance) +
          " m, or a larger tolerance; coordinates are those of the mesh, in m, "
          "after 'Mesh scale'");
    }
  } // namespace



  double
  SurfaceSelection::distance(const Point<dim> &x) const
  {
    const Vector3 arm = x - point;
    switch (shape)
      {
        case Shape::plane:
          return std::abs(arm * direction);
        case Shape::cylinder:
          return std::abs((arm - (arm * direction) * direction).norm() -
                          radius);
        case Shape::box:
          {
            Vector3 outside;
            for (unsigned int d = 0; d < dim; ++d)
              outside[d] = std::max({0., point[d] - x[d], x[d] - corner[d]});
            return outside.norm();
          }
      }
    return 0;
  }



  double
  SurfaceSelection::tolerance_for(const double diagonal) const
  {
    return tolerance > 0 ? tolerance : default_tolerance * diagonal;
  }



  std::vector<SurfaceSelection>
  parse_surfaces(const std::string &text, const std::string &section)
  {
    std::vector<SurfaceSelection> result;
    if (Utilities::trim(text).empty())
      return result;
    for (const std::string &part : split(text, ";"))
      {
        result.push_back(SelectionParser(part, section).result);
        for (std::size_t i = 0; i + 1 < result.size(); ++i)
          if (result[i].name == result.back().name)
            throw surfaces_error(section,
                                 "two surfaces " +
                                   in_quotes(result.back().name),
                                 "different names");
      }
    return result;
  }



  double
  mesh_diagonal(const std::vector<Point<dim>> &vertices)
  {
    Point<dim> lower, upper;
    if (!vertices.empty())
      lower = upper = vertices.front();
    for (const Point<dim> &vertex : vertices)
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = std::min(lower[d], vertex[d]);
          upper[d] = std::max(upper[d], vertex[d]);
        }
    return lower.distance(upper);
  }



  void
  select_surfaces(MeshData &data,
                  const std::vector<SurfaceSelection> &selections,
                  const MeshSource &source)
  {
    if (selections.empty())
      return;
    const double diagonal = mesh_diagonal(data.vertices);
    auto boundary         = find_boundary(data);
    for (const SurfaceSelection &selection : selections)
      {
        if (data.surfaces.count(selection.name) > 0)
          {
            std::vector<std::string> names;
            for (const auto &surface : data.surfaces)
              names.push_back(surface.first);
            throw surfaces_error(source.section,
                                 in_quotes(selection.text) +
                                   ", a name that the mesh has already",
                                 "names other than " + list_words(names, "'"));
          }
        name_faces(data, selection, diagonal, boundary, source);
      }

    // a new id for each present id with some new names
    types::boundary_id next_id = 1;
    for (const CellData<dim - 1> &face : data.faces)
      next_id = std::max(next_id, face.boundary_id + 1);
    std::map<std::pair<types::boundary_id, std::set<std::string>>,
             types::boundary_id>
      new_ids;
    for (const auto &[key, face] : boundary)
      if (!face.new_names.empty())
        {
          const auto [entry, is_new] =
            new_ids.try_emplace({face.id, face.new_names}, next_id);
          if (!is_new)
            continue;
          ++next_id;
          for (auto &surface : data.surfaces)
            if (face.id != 0 && surface.second.count(face.id) > 0)
              surface.second.insert(entry->second);
          for (const std::string &name : face.new_names)
            data.surfaces[name].insert(entry->second);
        }

    std::set<FaceKey> listed;
    for (CellData<dim - 1> &face : data.faces)
      {
        const FaceKey key = make_face_key(face.vertices);
        const auto known  = boundary.find(key);
        listed.insert(key);
        // a face that is listed with two ids is an error, found later
        if (known != boundary.end() && !known->second.new_names.empty() &&
            known->second.id == face.boundary_id)
          face.boundary_id =
            new_ids.at({known->second.id, known->second.new_names});
      }
    for (const auto &[key, face] : boundary)
      if (!face.new_names.empty() && listed.count(key) == 0)
        {
          CellData<dim - 1> added(face.vertices.size());
          added.vertices    = face.vertices;
          added.boundary_id = new_ids.at({0, face.new_names});
          data.faces.push_back(added);
        }
  }
} // namespace ACF
