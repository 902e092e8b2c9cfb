// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/console.h>
#include <acf/mechanics/accuracy.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace ACF
{
  namespace
  {
    // Elements lock beyond both.
    constexpr double largest_poissons_ratio = 0.45;
    constexpr double largest_elongation     = 6;

    constexpr double largest_round_off = 2e-5;



    // Square root of the ratio of the largest to the smallest eigenvalue.
    double
    principal_ratio(const Matrix3 &second_moment)
    {
      Eigen::Matrix3d matrix;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          matrix(i, j) = second_moment[i][j];
      // not the analytic formula: the ratio may be a million
      const Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix,
                                                       Eigen::EigenvaluesOnly)
          .eigenvalues();
      return std::sqrt(values(2) / values(0));
    }



    double
    elongation(const Triangulation<dim>::active_cell_iterator &cell)
    {
      Point<dim> centre;
      for (const unsigned int v : cell->vertex_indices())
        centre += Vector3(cell->vertex(v)) / (1. * cell->n_vertices());
      Matrix3 second_moment;
      for (const unsigned int v : cell->vertex_indices())
        {
          const Vector3 arm = cell->vertex(v) - centre;
          second_moment += outer_product(arm, arm);
        }
      return principal_ratio(second_moment);
    }



    // Integral of the products of coordinates about the centre of mass.
    Matrix3
    second_moment(const BodyOperators &operators)
    {
      Matrix3 result = -operators.inertia;
      for (unsigned int i = 0; i < dim; ++i)
        result[i][i] += 0.5 * trace(operators.inertia);
      return result;
    }



    // Of all parts of a body, which have the same coordinates.
    Matrix3
    second_moment(const MultibodySystem &system, const std::string &whole)
    {
      double mass = 0;
      Vector3 centre;
      for (const Body &part : system.bodies())
        if (part.whole() == whole)
          {
            mass += part.operators().mass;
            centre += part.operators().mass * part.operators().centre;
          }
      centre /= mass;
      Matrix3 result;
      for (const Body &part : system.bodies())
        if (part.whole() == whole)
          {
            const Vector3 arm = part.operators().centre - centre;
            result += second_moment(part.operators()) +
                      part.operators().mass * outer_product(arm, arm);
          }
      return result;
    }



    double
    round_off(const Matrix3 &second_moment, const Material &material)
    {
      return std::numeric_limits<double>::epsilon() *
             std::pow(principal_ratio(second_moment), 4) *
             (material.lambda() + 2 * material.mu()) / material.youngs_modulus;
    }
  } // namespace



  BodyAccuracy
  body_accuracy(const Body &body)
  {
    double weighted = 0, volume = 0;
    for (const auto &cell :
         body.discretization().mesh().triangulation().active_cell_iterators())
      {
        weighted += cell->measure() * elongation(cell);
        volume += cell->measure();
      }

    return {weighted / volume,
            round_off(second_moment(body.operators()), body.material())};
  }



  std::vector<std::string>
  accuracy_warnings(const MultibodySystem &system)
  {
    std::vector<std::string> warnings;
    std::set<const ReferenceBody *> seen;
    std::set<std::string> wholes; // of which parts have been warned of
    for (const Body &body : system.bodies())
      {
        if (!seen.insert(&body.reference()).second ||
            wholes.count(body.whole()) > 0)
          continue;
        BodyAccuracy accuracy = body_accuracy(body);
        if (!body.whole().empty()) // parts are not much better than the whole
          accuracy.round_off =
            round_off(second_moment(system, body.whole()), body.material());
        const double nu            = body.material().poissons_ratio;
        const std::string name     = "the body '" + body.name() + "'";
        const std::size_t n_before = warnings.size();
        if (nu > largest_poissons_ratio &&
            accuracy.elongation > largest_elongation)
          warnings.push_back(
            name + " may be too stiff in bending: its cells are " +
            format_number(accuracy.elongation) +
            " times as long as thin, with a Poisson's ratio of " +
            format_number(nu) + "; use shorter cells, at most " +
            format_number(largest_elongation) +
            " times, or a Poisson's ratio of at most " +
            format_number(largest_poissons_ratio));
        if (accuracy.round_off > largest_round_off)
          warnings.push_back(
            name + " is so slender and so little compressible that rounding " +
            "errors may change its bending by a part of " +
            format_number(10 * accuracy.round_off));
        if (!body.whole().empty() && warnings.size() > n_before)
          wholes.insert(body.whole());
      }
    return warnings;
  }
} // namespace ACF
