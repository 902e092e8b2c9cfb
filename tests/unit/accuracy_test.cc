// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 The acf-dealii authors

#include <acf/mechanics/accuracy.h>

#include <cmath>
#include <limits>

#include <unit/multibody_test.h>

using namespace ACF;
using namespace ACF::Testing;

namespace
{
  BodyParameters
  bar(const std::string &length,
      const std::string &element,
      const double poissons_ratio)
  {
    BodyParameters parameters = body_parameters(
      "bar",
      "set Mesh = box\n set Box from = 0, 0, 0\n set Box to = " + length +
        ", 1, 1\n set Cells = 2, 1, 1\n set Element = " + element + "\n");
    parameters.material.poissons_ratio = poissons_ratio;
    return parameters;
  }

  BodyAccuracy
  accuracy(const BodyParameters &parameters)
  {
    const MultibodySystem system({parameters}, {}, LoadParameters(), ".");
    return body_accuracy(system.bodies()[0]);
  }

  std::vector<std::string>
  warnings(const std::vector<BodyParameters> &bodies)
  {
    return accuracy_warnings(
      MultibodySystem(bodies, {}, LoadParameters(), "."));
  }

  bool
  contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace

TEST(Accuracy, ElongationIsTheAspectRatioOfABox)
{
  EXPECT_NEAR(accuracy(bar("6", "hexahedron", 0)).elongation, 3, 1e-12);
  EXPECT_NEAR(accuracy(bar("2", "hexahedron", 0)).elongation, 1, 1e-12);
  // vertices (0, 0, 0), (1, 0, 0), (1/2, 1/2, 0) and the centre of the cube
  const double smallest = 7. / 128 - std::sqrt(17.) / 128;
  EXPECT_NEAR(accuracy(bar("2", "tetrahedron", 0)).elongation,
              std::sqrt(1. / 8 / smallest),
              1e-12);
}

TEST(Accuracy, RoundOffGrowsWithSlendernessAndPoissonsRatio)
{
  const double epsilon = std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(accuracy(bar("10", "hexahedron", 0)).round_off,
              1e4 * epsilon,
              1e-9 * 1e4 * epsilon);
  // (lambda + 2 mu) / E = (1 - nu) / ((1 + nu) (1 - 2 nu))
  EXPECT_NEAR(accuracy(bar("10", "tetrahedron", 0.25)).round_off,
              1.2e4 * epsilon,
              1e-9 * 1e4 * epsilon);
}

TEST(Accuracy, WarningsAtTheLimits)
{
  EXPECT_TRUE(warnings({bar("11.9", "hexahedron", 0.4999)}).empty());
  EXPECT_TRUE(warnings({bar("100", "hexahedron", 0.45)}).empty());
  const auto locking = warnings({bar("12.1", "hexahedron", 0.451)});
  ASSERT_EQ(locking.size(), 1U);
  EXPECT_TRUE(contains(locking[0], "the body 'bar' may be too stiff"))
    << locking[0];

  // epsilon L^4 = 2e-5 at L = 548
  EXPECT_TRUE(warnings({bar("540", "hexahedron", 0)}).empty());
  const auto slender = warnings({bar("555", "hexahedron", 0)});
  ASSERT_EQ(slender.size(), 1U);
  EXPECT_TRUE(contains(slender[0], "so slender")) << slender[0];

  BodyParameters in_parts = bar("555", "hexahedron", 0);
  in_parts.mesh.cut       = "2 along x";
  EXPECT_EQ(warnings({in_parts}).size(), 1U);
  in_parts.mesh.box_to[0] = 540;
  EXPECT_TRUE(warnings({in_parts}).empty());
}

TEST(Accuracy, OneWarningForBodiesWithTheSameOperatorsAndForParts)
{
  BodyParameters first = bar("20", "hexahedron", 0.49), second = first;
  second.name     = "other";
  second.position = Point<dim>(0, 5, 0);
  EXPECT_EQ(warnings({first, second}).size(), 1U);

  first.mesh.cut      = "2 along x";
  first.mesh.cells[0] = 4;
  EXPECT_TRUE(warnings({first}).empty()); // cells 5 times as long as thick
  first.mesh.cells[0] = 2;
  ASSERT_EQ(warnings({first}).size(), 1U);
  EXPECT_TRUE(contains(warnings({first})[0], "the body 'bar 1'"));
}
