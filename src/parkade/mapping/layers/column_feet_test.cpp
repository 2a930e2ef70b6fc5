// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/column_feet.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/layers/layer_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr auto fill = testing::fillLayer<GridLayer::kZoneMarkers>;
constexpr auto at = testing::classAt<GridLayer::kZoneMarkers>;

MapObject pillarAt(double x, double y) {
  MapObject pillar;
  pillar.semantic_class = SemanticClass::kPillar;
  pillar.position = {x, y, 0.0};
  return pillar;
}

TEST(ColumnFeet, CutsTheShadowBehindAPillar) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kPillar, {-0.25, -0.25}, {0.25, 0.25});
  fill(grid, SemanticClass::kPillar, {-0.1, 0.25}, {0.1, 0.7});
  fill(grid, SemanticClass::kFloor, {-1.0, -1.0}, {1.0, -0.25});
  trimColumnFeet({pillarAt(0.02, -0.01)}, grid);
  for (double x = -0.225; x < 0.25; x += 0.05) {
    for (double y = -0.225; y < 0.25; y += 0.05)
      EXPECT_EQ(at(grid, x, y), SemanticClass::kPillar) << x << " " << y;
  }
  for (double y = 0.375; y < 0.7; y += 0.05)
    EXPECT_EQ(at(grid, 0.025, y), SemanticClass::kUnknown) << y;
  EXPECT_EQ(at(grid, 0.5, -0.5), SemanticClass::kFloor);
}

TEST(ColumnFeet, LeavesWallsAndWhatIsNoKnownPillarAlone) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kWall, {0.3, 0.3}, {0.8, 0.4});
  fill(grid, SemanticClass::kPillar, {3.0, 0.0}, {3.2, 0.2});
  trimColumnFeet({pillarAt(0.0, 0.0)}, grid);
  EXPECT_EQ(at(grid, 0.5, 0.325), SemanticClass::kWall);
  EXPECT_EQ(at(grid, 3.1, 0.1), SemanticClass::kPillar);
}

TEST(ColumnFeet, WhatStandsAtNoPillarIsForgotten) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kPillar, {-0.2, -0.2}, {0.2, 0.2});
  fill(grid, SemanticClass::kPillar, {3.0, 0.0}, {3.2, 0.2});
  fill(grid, SemanticClass::kWall, {4.0, 0.0}, {5.0, 0.2});
  forgetStrayPillars({pillarAt(0.0, 0.0)}, grid);
  EXPECT_EQ(at(grid, 0.025, 0.025), SemanticClass::kPillar);
  EXPECT_EQ(at(grid, 3.1, 0.1), SemanticClass::kUnknown);
  EXPECT_EQ(at(grid, 4.5, 0.1), SemanticClass::kWall);
}

TEST(ColumnFeet, APillarKeepsItsOwnFootBesideAnother) {
  LayeredGrid grid;
  for (const double x : {0.0, 0.9})
    fill(grid, SemanticClass::kPillar, {x - 0.2, -0.2}, {x + 0.2, 0.2});
  const LayeredGrid before = grid;
  trimColumnFeet({pillarAt(0.0, 0.0), pillarAt(0.9, 0.0)}, grid);
  for (double x = -0.175; x < 1.1; x += 0.05) EXPECT_EQ(at(grid, x, 0.025), at(before, x, 0.025));
}

// Four columns, of one of which the pictures from above show floor or nothing at all.
TEST(ColumnFeet, APillarWithoutAFootGetsTheUsualOne) {
  for (const bool was_in_sight : {true, false}) {
    LayeredGrid grid;
    if (was_in_sight) fill(grid, SemanticClass::kFloor, {8.0, -1.0}, {9.1, 1.0});
    fill(grid, SemanticClass::kWall, {9.1, -1.0}, {9.2, 1.0});
    std::vector<MapObject> pillars;
    for (const double x : {0.0, 3.0, 6.0, 9.0}) {
      if (x < 9.0) fill(grid, SemanticClass::kPillar, {x - 0.2, -0.2}, {x + 0.2, 0.2});
      pillars.push_back(pillarAt(x, 0.0));
    }
    completeColumnFeet(pillars, grid);
    const SemanticClass expected = was_in_sight ? SemanticClass::kPillar : SemanticClass::kUnknown;
    EXPECT_EQ(at(grid, 9.02, 0.02), expected);
    EXPECT_EQ(at(grid, 8.87, 0.12), expected);
    EXPECT_EQ(at(grid, 9.12, 0.02), SemanticClass::kWall);
    EXPECT_EQ(at(grid, 8.72, 0.02), was_in_sight ? SemanticClass::kFloor : SemanticClass::kUnknown);
    EXPECT_EQ(at(grid, 0.27, 0.02), SemanticClass::kUnknown);
  }
}

TEST(ColumnFeet, TheUsualFootIsLearnedFromThree) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kFloor, {-1.0, -1.0}, {10.0, 1.0});
  fill(grid, SemanticClass::kPillar, {2.8, -0.2}, {3.2, 0.2});
  const LayeredGrid before = grid;
  completeColumnFeet({pillarAt(0.0, 0.0), pillarAt(3.0, 0.0), pillarAt(6.0, 0.0)}, grid);
  EXPECT_TRUE(grid == before);
}

}  // namespace
}  // namespace parkade
