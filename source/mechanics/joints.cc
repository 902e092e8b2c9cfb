// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/base/exceptions.h>
#include <acf/mechanics/joints.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ACF
{
  namespace
  {
    const char *const direction_form =
      "axes x, y, z separated by ',' or vectors of three numbers separated by "
      "';' (for example '1,0,0; 0,1,1'), linearly independent";

    // The rows of a joint while they are collected: one coefficient per row and
    // functional of the joint.
    class JointBuilder
    {
    public:
      JointBuilder(Joint &joint, Body &body)
        : joint(joint)
        , body(body)
      {}

      // Index of a functional in the joint.
      unsigned int
      add_functional(const NodalFunctional &functional,
                     const bool is_mean_position)
      {
        joint.functionals.push_back(body.add_joint_functional(functional));
        joint.is_mean_position.push_back(is_mean_position);
        return joint.functionals.size() - 1;
      }

      // A row sum_p coefficient_p . s_p.
      void
      add_row(const std::vector<std::pair<unsigned int, Vector3>> &terms)
      {
        rows.push_back(terms);
      }

      void
      finish()
      {
        const unsigned int n = joint.functionals.size();
        joint.matrix         = Eigen::MatrixXd::Zero(rows.size(), dim * n);
        for (unsigned int r = 0; r < rows.size(); ++r)
          for (const auto &[p, coefficient] : rows[r])
            for (unsigned int i = 0; i < dim; ++i)
              joint.matrix(r, dim * p + i) += coefficient[i];

        Eigen::VectorXd values(dim * n);
        const NodalVector x = body.initial_positions();
        for (unsigned int p = 0; p < n; ++p)
          {
            const Vector3 s = body.joint_functionals()[joint.functionals[p]](x);
            for (unsigned int i = 0; i < dim; ++i)
              values(dim * p + i) = s[i];
          }
        joint.right_hand_side = joint.matrix * values;
      }

    private:
      using Row = std::vector<std::pair<unsigned int, Vector3>>;

      Joint &joint;
      Body &body;
      std::vector<Row> rows;
    };



    // Principal directions and values of a symmetric matrix.
    void
    eigen_decomposition(const Matrix3 &matrix,
                        std::array<double, dim> &values,
                        std::array<Vector3, dim> &vectors)
    {
      Eigen::Matrix3d copy;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          copy(i, j) = matrix[i][j];
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(copy);
      for (unsigned int k = 0; k < dim; ++k)
        {
          values[k] = solver.eigenvalues()(k);
          for (unsigned int i = 0; i < dim; ++i)
            vectors[k][i] = solver.eigenvectors()(i, k);
        }
    }



    // theta = R0 Theta sum_k p_k x (R0^T h_k), Theta = (tr(J) I - J)^-1, with
    // the first moments h_k along the principal directions p_k of the surface.
    void
    add_mean_rotation(JointBuilder &builder,
                      const Body &body,
                      const std::set<types::boundary_id> &surface,
                      const std::vector<Vector3> &axes)
    {
      const SurfaceGeometry geometry =
        surface_geometry(body.discretization(), surface);
      std::array<double, dim> values;
      std::array<Vector3, dim> directions;
      eigen_decomposition(geometry.second_moment, values, directions);
      const double sum = trace(geometry.second_moment);

      std::vector<unsigned int> functional(dim, numbers::invalid_unsigned_int);
      for (unsigned int k = 0; k < dim; ++k)
        if (values[k] > 1e-10 * sum)
          functional[k] = builder.add_functional(
            surface_moment(body.discretization(), surface, directions[k]),
            false);

      const Matrix3 &R0 = body.placement_rotation();
      for (const Vector3 &axis : axes)
        {
          const Vector3 axis_in_body = transpose(R0) * axis;
          Vector3 scaled; // Theta R0^T e
          for (unsigned int k = 0; k < dim; ++k)
            scaled += (axis_in_body * directions[k]) / (sum - values[k]) *
                      directions[k];

          std::vector<std::pair<unsigned int, Vector3>> row;
          for (unsigned int k = 0; k < dim; ++k)
            if (functional[k] != numbers::invalid_unsigned_int)
              row.emplace_back(functional[k],
                               R0 * cross_product_3d(scaled, directions[k]));
          builder.add_row(row);
        }
    }



    // The surface may turn by any angle about the axis e: either d_e . t = 0 or
    // d_t . e = 0 for two directions t perpendicular to e.
    void
    add_hinge(JointBuilder &builder,
              const Body &body,
              const std::set<types::boundary_id> &surface,
              const std::array<Vector3, 2> &across,
              const JointParameters &parameters)
    {
      const SurfaceGeometry geometry =
        surface_geometry(body.discretization(), surface);
      const Matrix3 to_body = transpose(body.placement_rotation());
      const Vector3 axis    = cross_product_3d(across[0], across[1]);

      const bool along = geometry.resolves(to_body * axis);
      const bool plane = geometry.resolves(to_body * across[0]) &&
                         geometry.resolves(to_body * across[1]);
      if (!along && !plane)
        throw InputError(
          parameters.section(),
          parameters.type == "revolute" ? "Axis" : "Directions",
          "a plane surface that is oblique to the axis of rotation",
          "a surface that contains the direction of the axis or is "
          "perpendicular to it");

      if (along && (!plane || geometry.extent(to_body * axis) >=
                                std::min(geometry.extent(to_body * across[0]),
                                         geometry.extent(to_body * across[1]))))
        {
          const unsigned int p = builder.add_functional(
            surface_director(body.discretization(), surface, to_body * axis),
            false);
          for (const Vector3 &t : across)
            builder.add_row({{p, t}});
        }
      else
        for (const Vector3 &t : across)
          {
            const unsigned int p = builder.add_functional(
              surface_director(body.discretization(), surface, to_body * t),
              false);
            builder.add_row({{p, axis}});
          }
    }



    // Two unit vectors perpendicular to a unit vector and to each other, so
    // that t_1 x t_2 = axis.
    std::array<Vector3, 2>
    perpendicular(const Vector3 &axis)
    {
      Vector3 t;
      unsigned int smallest = 0;
      for (unsigned int i = 1; i < dim; ++i)
        if (std::abs(axis[i]) < std::abs(axis[smallest]))
          smallest = i;
      t[smallest] = 1;
      t -= (t * axis) * axis;
      t /= t.norm();
      return {{t, cross_product_3d(axis, t)}};
    }



    Vector3
    parse_direction(const std::string &text, const JointParameters &parameters)
    {
      const InputError error(parameters.section(),
                             "Directions",
                             "'" + parameters.directions + "'",
                             direction_form);
      Vector3 direction;
      if (text == "x" || text == "y" || text == "z")
        {
          direction[text[0] - 'x'] = 1;
          return direction;
        }
      const auto numbers = Utilities::split_string_list(text, ',');
      if (numbers.size() != dim)
        throw error;
      try
        {
          for (unsigned int i = 0; i < dim; ++i)
            direction[i] = Utilities::string_to_double(numbers[i]);
        }
      catch (const std::exception &)
        {
          throw error;
        }
      if (!(direction.norm() > 0) || !std::isfinite(direction.norm()))
        throw error;
      return direction / direction.norm();
    }
  } // namespace



  void
  JointParameters::add_parameters(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Type",
      type,
      "What the joint blocks: 'spherical' the mean position of the surface; "
      "'mean position' its mean position in the chosen Directions (a guide); "
      "'mean rotation' its mean rotation about the chosen Directions; "
      "'revolute' its mean position and every rotation but that about Axis; "
      "'fixed' its mean position and mean rotation (a clamp). Units: none.",
      Patterns::Selection("spherical|mean position|mean rotation|revolute|"
                          "fixed"));
    prm.add_parameter("Between",
                      between,
                      "The two sides of the joint, 'BODY: SURFACE, ground'; "
                      "required. Units: none.");
    prm.add_parameter("Directions",
                      directions,
                      "Directions or axes of the types 'mean position' and "
                      "'mean rotation' in the world: " +
                        std::string(direction_form) +
                        "; all three if nothing is given. Units: none.");
    prm.add_parameter("Axis",
                      axis,
                      "Axis of a revolute joint in the world. Units: none.");
  }



  void
  JointParameters::check() const
  {
    const bool uses_directions =
      (type == "mean position" || type == "mean rotation");
    if (!uses_directions && !directions.empty())
      throw InputError(section(),
                       "Directions",
                       "'" + directions + "'",
                       "nothing for the type '" + type +
                         "'; directions belong to 'mean position' and 'mean "
                         "rotation'");
    if (type == "revolute" && !(axis.norm() > 0))
      throw InputError(section(),
                       "Axis",
                       "nothing or the zero vector",
                       "the direction of the axis of the revolute joint");
    if (type != "revolute" && axis.norm() > 0)
      throw InputError(section(),
                       "Axis",
                       "a vector",
                       "nothing for the type '" + type +
                         "'; an axis belongs to 'revolute'");
    direction_vectors();
  }



  std::vector<Vector3>
  JointParameters::direction_vectors() const
  {
    std::vector<Vector3> vectors;
    if (directions.empty())
      for (unsigned int i = 0; i < dim; ++i)
        {
          vectors.emplace_back();
          vectors.back()[i] = 1;
        }
    else
      {
        const bool letters =
          directions.find_first_of("xyz") != std::string::npos;
        for (const std::string &part :
             Utilities::split_string_list(directions, letters ? ',' : ';'))
          vectors.push_back(parse_direction(part, *this));
      }

    Eigen::MatrixXd matrix(dim, vectors.size());
    for (unsigned int k = 0; k < vectors.size(); ++k)
      for (unsigned int i = 0; i < dim; ++i)
        matrix(i, k) = vectors[k][i];
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(1e-8);
    if (decomposition.compute(matrix).rank() !=
        static_cast<long>(vectors.size()))
      throw InputError(section(),
                       "Directions",
                       "'" + directions + "'",
                       direction_form);
    return vectors;
  }



  SurfaceName
  parse_surface_name(const std::string &text,
                     const std::string &section,
                     const std::string &entry)
  {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
      throw InputError(section,
                       entry,
                       text.empty() ? "nothing" : "'" + text + "'",
                       "a surface in the form 'BODY: SURFACE'");
    return {Utilities::trim(text.substr(0, colon)),
            Utilities::trim(text.substr(colon + 1))};
  }



  unsigned int
  find_body(const std::vector<Body> &bodies,
            const std::string &name,
            const std::string &section,
            const std::string &entry)
  {
    std::string names;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        if (bodies[b].name() == name)
          return b;
        names += (b > 0 ? ", " : "") + bodies[b].name();
      }
    throw InputError(section,
                     entry,
                     "the body '" + name + "', which does not exist",
                     names);
  }



  Joint
  make_joint(const JointParameters &parameters, std::vector<Body> &bodies)
  {
    const auto sides = Utilities::split_string_list(parameters.between, ',');
    if (sides.size() != 2 || (sides[0] == "ground") == (sides[1] == "ground"))
      throw InputError(parameters.section(),
                       "Between",
                       parameters.between.empty()
                         ? "nothing"
                         : "'" + parameters.between + "'",
                       "a surface and the ground, 'BODY: SURFACE, ground'");
    const SurfaceName name =
      parse_surface_name(sides[0] == "ground" ? sides[1] : sides[0],
                         parameters.section(),
                         "Between");

    Joint joint;
    joint.name = parameters.name;
    joint.body = find_body(bodies, name.body, parameters.section(), "Between");
    Body &body = bodies[joint.body];
    const auto &surface =
      body.discretization().mesh().surface(name.surface,
                                           parameters.section(),
                                           "Between");

    const std::vector<Vector3> directions = parameters.direction_vectors();
    JointBuilder builder(joint, body);
    if (parameters.type != "mean rotation")
      {
        const unsigned int p =
          builder.add_functional(surface_mean(body.discretization(), surface),
                                 true);
        for (const Vector3 &direction : directions)
          builder.add_row({{p, direction}});
      }

    if (parameters.type == "revolute")
      add_hinge(builder,
                body,
                surface,
                perpendicular(parameters.axis / parameters.axis.norm()),
                parameters);
    else if (parameters.type == "mean rotation" && directions.size() == 2)
      {
        const Vector3 axis = cross_product_3d(directions[0], directions[1]);
        add_hinge(builder,
                  body,
                  surface,
                  perpendicular(axis / axis.norm()),
                  parameters);
      }
    else if (parameters.type == "mean rotation" || parameters.type == "fixed")
      add_mean_rotation(builder, body, surface, directions);

    builder.finish();
    return joint;
  }
} // namespace ACF
