// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/surface_shape.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ACF
{
  namespace
  {
    using Eigen::Vector3d;

    // Relative to the size of the surface.
    constexpr double largest_distance = 1e-5;

    // Relative to the radius.
    constexpr double largest_depth = 0.1;

    // Radii of curved surfaces, relative to their size.
    constexpr double largest_radius = 1e3;



    Vector3d
    to_eigen(const Tensor<1, dim> &v)
    {
      return {v[0], v[1], v[2]};
    }

    Vector3
    to_vector(const Vector3d &v)
    {
      return Vector3({v(0), v(1), v(2)});
    }

    Point<dim>
    to_point(const Vector3d &v)
    {
      return {v(0), v(1), v(2)};
    }



    // Vertices about their mean, in units of their largest distance from it.
    struct Cloud
    {
      Vector3d mean = Vector3d::Zero();
      double size   = 0;
      std::vector<Vector3d> points;

      explicit Cloud(const std::vector<Point<dim>> &vertices)
      {
        for (const Point<dim> &vertex : vertices)
          mean += to_eigen(vertex) / vertices.size();
        for (const Point<dim> &vertex : vertices)
          {
            points.push_back(to_eigen(vertex) - mean);
            size = std::max(size, points.back().norm());
          }
        for (Vector3d &point : points)
          point /= size;
      }

      Vector3d
      scaled(const Point<dim> &point) const
      {
        return (to_eigen(point) - mean) / size;
      }

      Point<dim>
      unscaled(const Vector3d &point) const
      {
        return to_point(mean + size * point);
      }
    };



    // The eigenvector of the smallest eigenvalue of sum_i w_i v_i v_i^T.
    Vector3d
    least_direction(const Eigen::Matrix3d &sum)
    {
      return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum)
        .eigenvectors()
        .col(0);
    }



    std::optional<SurfaceShape>
    fit_plane(const Cloud &cloud, const std::vector<Facet> &facets)
    {
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (const Vector3d &point : cloud.points)
        sum += point * point.transpose();
      Vector3d normal = least_direction(sum);
      for (const Vector3d &point : cloud.points)
        if (std::abs(normal.dot(point)) > largest_distance)
          return {};
      double outward = 0;
      for (const Facet &facet : facets)
        outward += facet.area * normal.dot(to_eigen(facet.normal));
      SurfaceShape shape;
      shape.kind      = SurfaceShape::Kind::plane;
      shape.direction = to_vector(outward < 0 ? Vector3d(-normal) : normal);
      shape.point     = to_point(cloud.mean);
      return shape;
    }



    // Completes a cylinder or a sphere if the facets are not too deep.
    // radial: from the axis or the centre to a point.
    template <typename Radial>
    std::optional<SurfaceShape>
    check_facets(SurfaceShape shape,
                 const double radius,
                 const Cloud &cloud,
                 const std::vector<Facet> &facets,
                 const Radial &radial)
    {
      double outward = 0;
      for (const Facet &facet : facets)
        {
          const Vector3d r = radial(cloud.scaled(facet.centre));
          if (std::abs(r.norm() - radius) > largest_depth * radius)
            return {};
          outward += facet.area * r.dot(to_eigen(facet.normal));
        }
      shape.radius  = cloud.size * radius;
      shape.is_hole = outward < 0;
      return shape;
    }



    // Axis through centre + span(direction).
    struct Cylinder
    {
      Vector3d direction;
      Vector3d centre;
      double radius;

      Vector3d
      radial(const Vector3d &point) const
      {
        const Vector3d arm = point - centre;
        return arm - direction.dot(arm) * direction;
      }
    };



    // The circle through the points' projections along a direction, by least
    // squares of |x|^2 = 2 c x + (r^2 - c^2).
    std::optional<Cylinder>
    first_cylinder(const Cloud &cloud, const Vector3d &direction)
    {
      const Vector3d e = direction.unitOrthogonal();
      const Vector3d f = direction.cross(e);
      Eigen::MatrixX3d A(cloud.points.size(), 3);
      Eigen::VectorXd b(cloud.points.size());
      for (unsigned int i = 0; i < cloud.points.size(); ++i)
        {
          const double x = e.dot(cloud.points[i]), y = f.dot(cloud.points[i]);
          A.row(i) << 2 * x, 2 * y, 1;
          b(i) = x * x + y * y;
        }
      const Vector3d c            = A.colPivHouseholderQr().solve(b);
      const double squared_radius = c(2) + c(0) * c(0) + c(1) * c(1);
      if (!(squared_radius > 0))
        return {};
      return Cylinder{direction,
                      c(0) * e + c(1) * f,
                      std::sqrt(squared_radius)};
    }



    // Gauss and Newton's method for the distances of the points.
    bool
    improve(const Cloud &cloud, Cylinder &cylinder)
    {
      Eigen::MatrixXd J(cloud.points.size(), 5);
      Eigen::VectorXd residual(cloud.points.size());
      for (unsigned int k = 0; k < 30; ++k)
        {
          const Vector3d d = cylinder.direction;
          const Vector3d e = d.unitOrthogonal();
          const Vector3d f = d.cross(e);
          for (unsigned int i = 0; i < cloud.points.size(); ++i)
            {
              const Vector3d r      = cylinder.radial(cloud.points[i]);
              const double distance = r.norm();
              if (!(distance > 0))
                return false;
              const Vector3d n   = r / distance;
              const double along = d.dot(cloud.points[i] - cylinder.centre);
              residual(i)        = distance - cylinder.radius;
              J.row(i) << -along * n.dot(e), -along * n.dot(f), -n.dot(e),
                -n.dot(f), -1;
            }
          const Eigen::VectorXd step =
            J.completeOrthogonalDecomposition().solve(-residual);
          cylinder.direction = (d + step(0) * e + step(1) * f).normalized();
          cylinder.centre += step(2) * e + step(3) * f;
          cylinder.radius += step(4);
          if (!step.allFinite() || !(cylinder.radius > 0) ||
              cylinder.radius > largest_radius)
            return false;
          if (step.norm() < 1e-12 * std::max(1., cylinder.radius))
            break;
        }
      return true;
    }



    std::optional<SurfaceShape>
    fit_cylinder(const Cloud &cloud, const std::vector<Facet> &facets)
    {
      if (cloud.points.size() < 6)
        return {};
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (const Facet &facet : facets)
        {
          const Vector3d n = to_eigen(facet.normal);
          sum += facet.area * n * n.transpose();
        }
      std::optional<Cylinder> cylinder =
        first_cylinder(cloud, least_direction(sum));
      if (!cylinder || !improve(cloud, *cylinder))
        return {};
      for (const Vector3d &point : cloud.points)
        if (!(std::abs(cylinder->radial(point).norm() - cylinder->radius) <=
              largest_distance))
          return {};

      // the largest component of the axis is positive
      Vector3d &d = cylinder->direction;
      Eigen::Index largest;
      d.cwiseAbs().maxCoeff(&largest);
      if (d(largest) < 0)
        d = -d;
      double begin = d.dot(cloud.points[0]), end = begin;
      for (const Vector3d &point : cloud.points)
        {
          begin = std::min(begin, d.dot(point));
          end   = std::max(end, d.dot(point));
        }
      SurfaceShape shape;
      shape.kind      = SurfaceShape::Kind::cylinder;
      shape.direction = to_vector(d);
      shape.point     = cloud.unscaled(
        cylinder->centre + (0.5 * (begin + end) - d.dot(cylinder->centre)) * d);
      return check_facets(
        shape, cylinder->radius, cloud, facets, [&](const Vector3d &point) {
          return cylinder->radial(point);
        });
    }



    std::optional<SurfaceShape>
    fit_sphere(const Cloud &cloud, const std::vector<Facet> &facets)
    {
      if (cloud.points.size() < 5)
        return {};
      Eigen::MatrixX4d A(cloud.points.size(), 4);
      Eigen::VectorXd b(cloud.points.size());
      for (unsigned int i = 0; i < cloud.points.size(); ++i)
        {
          A.row(i) << 2 * cloud.points[i].transpose(), 1;
          b(i) = cloud.points[i].squaredNorm();
        }
      const Eigen::Vector4d solution = A.colPivHouseholderQr().solve(b);
      const Vector3d centre          = solution.head<3>();
      const double radius = std::sqrt(solution(3) + centre.squaredNorm());
      if (!(radius > 0) || radius > largest_radius)
        return {};
      for (const Vector3d &point : cloud.points)
        if (!(std::abs((point - centre).norm() - radius) <= largest_distance))
          return {};
      SurfaceShape shape;
      shape.kind  = SurfaceShape::Kind::sphere;
      shape.point = cloud.unscaled(centre);
      return check_facets(
        shape, radius, cloud, facets, [&](const Vector3d &point) {
          return Vector3d(point - centre);
        });
    }
  } // namespace



  SurfaceShape
  surface_shape(const std::vector<Point<dim>> &vertices,
                const std::vector<Facet> &facets)
  {
    const Cloud cloud(vertices);
    for (const auto fit : {fit_plane, fit_cylinder, fit_sphere})
      if (const auto shape = fit(cloud, facets))
        return *shape;
    return {};
  }
} // namespace ACF
