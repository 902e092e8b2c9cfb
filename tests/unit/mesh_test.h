// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_mesh_test_h
#define acf_tests_mesh_test_h

#include <acf/mechanics/mesh.h>

#include <deal.II/base/parameter_handler.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ACF::Testing
{
  /** Parse the entries of a body's subsection. */
  inline MeshParameters
  parse_mesh(const std::string &entries)
  {
    MeshParameters parameters;
    ParameterHandler prm;
    parameters.add_parameters(prm);
    prm.parse_input_from_string(entries);
    return parameters;
  }

  /** The mesh that the entries describe, in the folder of the test data. */
  inline std::unique_ptr<const BodyMesh>
  mesh_of(const std::string &entries,
          const std::string &directory = ACF_TEST_DATA)
  {
    const MeshParameters parameters = parse_mesh(entries);
    parameters.check("Bodies/b");
    return make_mesh(parameters, "Bodies/b", directory);
  }

  /** Expect an InputError whose message has all of some parts. */
  inline void
  expect_input_error(const std::function<void()> &action,
                     const std::vector<std::string> &parts)
  {
    try
      {
        action();
        ADD_FAILURE() << "no error with " << parts.front();
      }
    catch (const InputError &error)
      {
        for (const std::string &part : parts)
          EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
            << "no '" << part << "' in: " << error.what();
      }
  }

  inline void
  expect_mesh_error(const std::string &entries,
                    const std::vector<std::string> &parts,
                    const std::string &directory = ACF_TEST_DATA)
  {
    expect_input_error([&]() { mesh_of(entries, directory); }, parts);
  }

  /** Integral of a function over the body, without finite elements. */
  inline double
  integrate(const BodyMesh &mesh,
            const std::function<double(const Point<dim> &)> &function)
  {
    const FE_Nothing<dim> fe(mesh.reference_cell());
    FEValues<dim> fe_values(mesh.mapping(),
                            fe,
                            mesh.cell_quadrature(5),
                            update_JxW_values | update_quadrature_points);
    double sum = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      {
        fe_values.reinit(cell);
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            EXPECT_GT(fe_values.JxW(q), 0);
            sum += function(fe_values.quadrature_point(q)) * fe_values.JxW(q);
          }
      }
    return sum;
  }

  inline double
  volume(const BodyMesh &mesh)
  {
    return integrate(mesh, [](const Point<dim> &) { return 1.; });
  }

  /** Integral of the outward normal over the faces with some boundary ids, all
   * if there are none; the last number is the area. */
  inline std::pair<Vector3, double>
  integrate_normal(const BodyMesh &mesh,
                   const std::set<types::boundary_id> &ids)
  {
    const FE_Nothing<dim> fe(mesh.reference_cell());
    FEFaceValues<dim> fe_values(mesh.mapping(),
                                fe,
                                mesh.face_quadrature(3),
                                update_JxW_values | update_normal_vectors);
    Vector3 normal;
    double area = 0;
    for (const auto &cell : mesh.triangulation().active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() &&
            (ids.empty() || ids.count(cell->face(f)->boundary_id()) > 0))
          {
            fe_values.reinit(cell, f);
            for (const unsigned int q : fe_values.quadrature_point_indices())
              {
                normal += fe_values.normal_vector(q) * fe_values.JxW(q);
                area += fe_values.JxW(q);
              }
          }
    return {normal, area};
  }

  inline double
  area(const BodyMesh &mesh, const std::string &surface)
  {
    return integrate_normal(mesh, mesh.surface(surface, "", "")).second;
  }

  /** Names of surfaces or regions in one string: "a|b|c". */
  inline std::string
  names(const std::map<std::string, std::set<unsigned int>> &groups)
  {
    std::string result;
    for (const auto &group : groups)
      result += (result.empty() ? "" : "|") + group.first;
    return result;
  }
} // namespace ACF::Testing

#endif
