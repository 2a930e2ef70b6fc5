// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/unseen_ground.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/layers/layer_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kRange = 8.5;

constexpr auto fill = testing::fillLayer<GridLayer::kZoneMarkers>;
constexpr auto at = testing::classAt<GridLayer::kZoneMarkers>;

// Along the x axis, floor to both sides, a wall 3 m to the left of the way.
class UnseenGround : public ::testing::Test {
 protected:
  UnseenGround() {
    fill(grid, SemanticClass::kFloor, {0.0, -6.0}, {20.0, 6.0});
    fill(grid, SemanticClass::kWall, {0.0, 3.0}, {20.0, 3.3});
    for (double x = 0.0; x < 20.0; x += 0.3) way.emplace_back(0.0, Vector2d(x, 0.0));
  }
  LayeredGrid grid;
  std::vector<SE2> way;
};

TEST_F(UnseenGround, FloorBehindAWallIsForgotten) {
  forgetUnseenGround(way, kRange, grid);
  for (const double x : {4.0, 10.0, 16.0}) {
    EXPECT_EQ(at(grid, x, 4.0), SemanticClass::kUnknown);
    EXPECT_EQ(at(grid, x, 5.9), SemanticClass::kUnknown);
    EXPECT_EQ(at(grid, x, 3.1), SemanticClass::kWall);
    EXPECT_EQ(at(grid, x, 2.9), SemanticClass::kFloor);
    EXPECT_EQ(at(grid, x, -5.9), SemanticClass::kFloor);
  }
}

TEST_F(UnseenGround, WhatIsSeenThroughADoorStays) {
  fill(grid, SemanticClass::kFloor, {9.0, 3.0}, {11.0, 3.3});
  forgetUnseenGround(way, kRange, grid);
  EXPECT_EQ(at(grid, 10.0, 4.0), SemanticClass::kFloor);
  EXPECT_EQ(at(grid, 4.0, 4.0), SemanticClass::kUnknown);
}

TEST_F(UnseenGround, CellsMayBeWide) {
  for (const double resolution : {0.1, 0.25, 0.5}) {
    LayeredGrid wide(resolution);
    fill(wide, SemanticClass::kFloor, {0.0, -6.0}, {20.0, 6.0});
    fill(wide, SemanticClass::kWall, {0.0, 3.0}, {20.0, 3.5});
    forgetUnseenGround(way, kRange, wide);
    EXPECT_EQ(at(wide, 10.0, 5.2), SemanticClass::kUnknown) << resolution;
    EXPECT_EQ(at(wide, 10.0, 3.2), SemanticClass::kWall) << resolution;
    EXPECT_EQ(at(wide, 10.0, 2.2), SemanticClass::kFloor) << resolution;
    EXPECT_EQ(at(wide, 10.0, -5.2), SemanticClass::kFloor) << resolution;
  }
}

TEST_F(UnseenGround, SpecksAndPillarsHideNothingForGood) {
  fill(grid, SemanticClass::kFloor, {0.0, 3.0}, {20.0, 3.3});
  fill(grid, SemanticClass::kWall, {5.0, 3.0}, {5.05, 3.05});
  fill(grid, SemanticClass::kPillar, {10.0, 2.0}, {10.5, 2.5});
  forgetUnseenGround(way, kRange, grid);
  EXPECT_EQ(at(grid, 5.0, 4.0), SemanticClass::kFloor);
  EXPECT_EQ(at(grid, 10.25, 4.5), SemanticClass::kFloor);  // from before and after the pillar
  EXPECT_EQ(at(grid, 10.25, 2.45), SemanticClass::kPillar);
}

TEST_F(UnseenGround, FloorRetreatsFromTheBorderOfWhatWasSeen) {
  grid.touch(GridLayer::kZoneMarkers, grid.cellOf({10.0, -3.0})) = GridCell();
  retreatFromUnseen(grid);
  EXPECT_EQ(at(grid, 10.0, -5.975), SemanticClass::kUnknown);
  EXPECT_EQ(at(grid, 10.0, -5.775), SemanticClass::kUnknown);
  EXPECT_EQ(at(grid, 10.0, -5.7), SemanticClass::kFloor);
  EXPECT_EQ(at(grid, 10.1, -3.0), SemanticClass::kFloor) << "beside a speck";
  EXPECT_EQ(at(grid, 10.0, 2.975), SemanticClass::kFloor) << "before a wall";
  EXPECT_EQ(at(grid, 0.025, 3.1), SemanticClass::kWall);
}

TEST_F(UnseenGround, OfADriveThatWentAstrayNothingChanges) {
  const Vector2d far(2e6, 2e6);  // an array of this would not fit into any memory
  grid.add(GridLayer::kZoneMarkers, far, SemanticClass::kFloor, 2.0F);
  forgetUnseenGround({SE2()}, 8.5, grid);
  retreatFromUnseen(grid);
  EXPECT_TRUE(grid.at(GridLayer::kZoneMarkers, grid.cellOf(far)).known());
}

TEST_F(UnseenGround, WithoutAWayNothingChanges) {
  const LayeredGrid before = grid;
  forgetUnseenGround({}, kRange, grid);
  EXPECT_TRUE(grid == before);
}

}  // namespace
}  // namespace parkade
