// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/green_lagrange.h>
#include <acf/mechanics/rotation.h>

#include <unit/all_instructions.h>
#include <unit/reduced_strain_test.h>

using namespace ACF;
using namespace ACF::Testing;

TEST(NodeRotations, NearestRotationIsThatOfThePolarDecomposition)
{
  Random random;
  double error = 0;
  for (const double strain : {0., 1e-6, 1e-2, 0.3})
    for (unsigned int k = 0; k < 20; ++k)
      {
        const Matrix3 F =
          random.rotation() * (identity_matrix() + random.matrix(strain));
        const auto nearest = nearest_rotation(F);
        ASSERT_TRUE(nearest);
        error =
          std::max(error, (*nearest - polar_rotation(F)->rotation).norm());
      }
  EXPECT_LT(error, 1e-13);
  report("Newton's rotation against the singular values", error);

  // 1:1000, and what has no rotation
  Matrix3 F = identity_matrix();
  F[0][0]   = 1000;
  EXPECT_LT((*nearest_rotation(F) - identity_matrix()).norm(), 1e-13);
  F[1][1] = -1;
  EXPECT_FALSE(nearest_rotation(F));
  F[1][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(nearest_rotation(F));
}

// In each place of a group of eight, beside others that take more or fewer
// iterations or have no rotation; a number that eight does not divide.
TEST_WITH_ALL_INSTRUCTIONS(NodeRotations, NearestRotationsOfManyMatrices)
{
  Random random;
  std::vector<Matrix3> gradients;
  const double strains[] = {0., 0.3, 1e-6, 1e-2, 0.1};
  for (unsigned int a = 0; a < 43; ++a)
    {
      Matrix3 F =
        random.rotation() * (identity_matrix() + random.matrix(strains[a % 5]));
      if (a % 9 == 4)
        F[a % 3] *= -1;
      else if (a == 11)
        F[1][1] = std::numeric_limits<double>::quiet_NaN();
      else if (a == 12)
        F *= 1e200;
      gradients.push_back(F);
    }
  const Matrix3 fallback = random.rotation();
  const auto rotations   = nearest_rotations(gradients, fallback);
  unsigned int n_without = 0;
  ASSERT_EQ(rotations.size(), gradients.size());
  for (unsigned int a = 0; a < gradients.size(); ++a)
    {
      const auto alone = nearest_rotation(gradients[a]);
      n_without += !alone;
      EXPECT_LT((rotations[a] - alone.value_or(fallback)).norm(), 1e-14) << a;
    }
  EXPECT_EQ(n_without, 7);
  EXPECT_TRUE(nearest_rotations({}, fallback).empty());
}

TEST(NodeRotations, ConnectedNodes)
{
  const auto functional = [](const std::vector<unsigned int> &nodes) {
    return NodalFunctional{nodes, std::vector<double>(nodes.size(), 1.)};
  };
  const auto a = functional({1, 2, 3}), b = functional({7, 8}),
             c = functional({3, 5}), d = functional({9}),
             e        = functional({5, 7});
  const NodeSets sets = connected_nodes({&a, &b, &c, &d});
  EXPECT_EQ(sets, (NodeSets{{7, 8}, {1, 2, 3, 5}, {9}}));
  EXPECT_EQ(connected_nodes({&a, &b, &c, &d, &e}),
            (NodeSets{{9}, {1, 2, 3, 5, 7, 8}}));
  EXPECT_TRUE(connected_nodes({}).empty());
}

TEST(NodeRotations, FollowTheMaterial)
{
  Random random;
  for (const Example &example : examples())
    {
      const GreenLagrangeOperator law(example.discretization, test_material());
      const unsigned int n  = example.body.n_nodes;
      const Matrix3 Q       = random.rotation(),
                    stretch = identity_matrix() + random.matrix(0.1);
      const NodalVector straight =
        transformed(example.body.reference_positions,
                    [&](const Vector3 &X) { return Q * (stretch * X); });
      double error = 0;
      for (const Matrix3 &F : law.node_gradients(straight))
        error = std::max(error, (F - Q * stretch).norm());
      EXPECT_LT(error, 1e-12) << example.name;

      // a twist of 0.5 rad per length
      const NodalVector twisted =
        transformed(example.body.reference_positions, [](const Vector3 &X) {
          return rotation_matrix(Vector3({0.5 * X[0], 0, 0})) * X;
        });
      const NodeSets sets = {{0, 1, 2}, {5, 6}};
      const NodeRotations rotations =
        material_rotations(law.node_gradients(twisted),
                           sets,
                           identity_matrix());
      error = 0;
      for (unsigned int a = 7; a < n; ++a)
        {
          const Vector3 X = node_value(example.body.reference_positions, a);
          const Vector3 spin({0.5, 0, 0});
          const Matrix3 R = rotation_matrix(X[0] * spin);
          const Matrix3 F = R + outer_product(cross_product_3d(spin, R * X),
                                              Vector3({1, 0, 0}));
          error           = std::max(error,
                           (rotations[a] - polar_rotation(F)->rotation).norm());
        }
      // means over cells whose ends are twisted by 0.13 and 0.2 rad
      EXPECT_LT(error, 0.15) << example.name;
      report(example.name + ", rotation of nodes in a twisted bar", error);
      for (const auto &set : sets)
        for (const unsigned int a : set)
          EXPECT_EQ((rotations[a] - rotations[set[0]]).norm(), 0);
      EXPECT_FALSE(rotations.is_uniform());

      NodalVector local(twisted), world(twisted);
      rotations.to_body(twisted, n, local);
      rotations.to_world(local, n, world);
      EXPECT_LT(relative_difference(world, twisted), 1e-14);
      const Vector3 first = transpose(rotations[8]) * node_value(twisted, 8);
      EXPECT_LT((first - node_value(local, 8)).norm(), 1e-14);
    }
}
