// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#ifndef acf_tests_reduced_strain_test_h
#define acf_tests_reduced_strain_test_h

#include <acf/mechanics/reduced_strain.h>

#include <list>

#include <unit/mechanics_test.h>

namespace ACF::Testing
{
  /** A body, with what its force needs. */
  struct Example
  {
    std::string name;
    BodyDiscretization discretization;
    BodyOperators body;

    Example(const std::string &name, const MeshData &data)
      : name(name)
      , discretization(discretize(data))
      , body(assemble_body_operators(discretization, test_material()))
    {}

    /** A scale of forces: E V / l. */
    double
    force_scale() const
    {
      return test_material().youngs_modulus * body.volume / body.length;
    }
  };

  inline const std::list<Example> &
  examples()
  {
    static const std::list<Example> list = []() {
      const Point<dim> from(0.2, -0.1, 0.4), to(1, 0.2, 0.6);
      std::list<Example> all;
      all.emplace_back("hexahedra",
                       distorted(generate_box(from,
                                              to,
                                              {{3, 2, 1}},
                                              ReferenceCells::Hexahedron),
                                 0.02));
      all.emplace_back("tetrahedra",
                       distorted(generate_box(from,
                                              to,
                                              {{2, 1, 1}},
                                              ReferenceCells::Tetrahedron),
                                 0.02));
      return all;
    }();
    return list;
  }

  inline const std::vector<std::pair<RotationMeasure, std::string>> measures = {
    {RotationMeasure::polar, "polar"},
    {RotationMeasure::three_points, "three points"}};

  /** Bending, twist and stretch of some ten per cent, and small-scale noise. */
  inline NodalVector
  deformed(const Example &example, Random &random)
  {
    const Matrix3 Q       = random.rotation();
    const Matrix3 stretch = identity_matrix() + random.matrix(0.1);
    const Vector3 bend = random.vector(0.15), t = random.vector(3);
    NodalVector x =
      transformed(example.body.reference_positions, [&](const Vector3 &X) {
        const Vector3 Y =
          rotation_matrix(Vector3({0.4 * X[0], 0, 0.2 * X[1]})) * (stretch * X);
        return t + Q * (Y + X[0] * X[0] * bend);
      });
    x += random.nodal_vector(x.size(), 2e-3);
    return x;
  }

  struct Force
  {
    std::optional<double> energy;
    NodalVector value;
  };

  inline Force
  force_of(const Example &example,
           const RotationMeasure measure,
           const NodalVector &x)
  {
    Force force;
    NodalVector scratch(x.size());
    force.value.reinit(x.size());
    force.energy =
      reduced_strain_force(example.body, measure, x, force.value, scratch);
    return force;
  }

  inline Vector3
  resultant(const NodalVector &force)
  {
    Vector3 sum;
    for (unsigned int a = 0; a < force.size() / dim; ++a)
      sum += node_value(force, a);
    return sum;
  }

  inline Vector3
  moment(const NodalVector &force, const NodalVector &x, const Vector3 &point)
  {
    Vector3 sum;
    for (unsigned int a = 0; a < force.size() / dim; ++a)
      sum += cross_product_3d(node_value(x, a) - point, node_value(force, a));
    return sum;
  }
} // namespace ACF::Testing

#endif
