// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace parkade::sim {
namespace {

PathLeg zigzag() {
  PathLeg leg;
  leg.vertices = {{0, 0}, {30, 0}, {30, 40}, {60, 40}, {80, 45}, {80, 0}};
  return leg;
}

TEST(Path, EndsAtTheLastVertexAlongTheLastLine) {
  const Result<Path> path = buildPath({zigzag()});
  ASSERT_TRUE(path.ok()) << path.error().message;
  const PathPoint end = path->at(path->length());
  EXPECT_NEAR((end.position - Eigen::Vector2d(80, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(end.heading, -std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(end.curvature, 0.0);
}

TEST(Path, StaysWithinTheTurningLimit) {
  const Result<Path> path = buildPath({zigzag()});
  ASSERT_TRUE(path.ok());
  EXPECT_LE(path->maxCurvature(), 1.0 / 5.5 + 1e-12);
  EXPECT_GT(path->maxCurvature(), 1.0 / 7.0 - 1e-12);
}

TEST(Path, MovesAlongItsHeadingAndTurnsByItsCurvature) {
  const Result<Path> path = buildPath({zigzag()});
  ASSERT_TRUE(path.ok());
  const double h = 1e-4;
  for (double s = 0.1; s < path->length() - 0.1; s += 0.037) {
    const PathPoint a = path->at(s - h);
    const PathPoint b = path->at(s);
    const PathPoint c = path->at(s + h);
    const Eigen::Vector2d tangent = (c.position - a.position) / (2 * h);
    EXPECT_NEAR((tangent - Eigen::Vector2d(std::cos(b.heading), std::sin(b.heading))).norm(), 0.0,
                1e-7);
    EXPECT_NEAR((c.heading - a.heading) / (2 * h), b.curvature, 1e-7);
    // The curvature's slope is continuous: no second difference larger than a smooth one's.
    EXPECT_LT(std::abs(c.curvature - 2 * b.curvature + a.curvature) / (h * h), 0.2);
  }
}

TEST(Path, ReversesAfterStandingStraight) {
  PathLeg forward;
  forward.vertices = {{0, 0}, {20, 0}};
  PathLeg back;
  back.reverse = true;
  back.vertices = {{20, 0}, {12, 0}, {12, -9}};
  back.corners = {4.5, 4.5, 2.0, 2.0};
  const Result<Path> path = buildPath({forward, back});
  ASSERT_TRUE(path.ok()) << path.error().message;
  ASSERT_EQ(path->gearChanges().size(), 1U);
  EXPECT_NEAR(path->gearChanges()[0], 20.0, 1e-12);
  const PathPoint end = path->at(path->length());
  EXPECT_NEAR((end.position - Eigen::Vector2d(12, -9)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(end.heading, std::numbers::pi / 2, 1e-12);  // nose to the aisle
  EXPECT_EQ(end.direction, -1);
  const PathPoint middle = path->at(26.0);
  EXPECT_LT(std::cos(middle.heading), 1.0);
  EXPECT_GT(middle.heading, 0.0);
}

TEST(Path, SaysWhereACornerDoesNotFit) {
  PathLeg leg;
  leg.vertices = {{0, 0}, {20, 0}, {20, 8}, {40, 8}};
  const Result<Path> path = buildPath({leg});
  ASSERT_FALSE(path.ok());
  EXPECT_NE(path.error().message.find("(20.0, 0.0)"), std::string::npos) << path.error().message;
}

}  // namespace
}  // namespace parkade::sim
