// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/wheel_stops.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/layers/layer_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr auto fill = testing::fillLayer<GridLayer::kRoadMarkers>;
constexpr auto at = testing::classAt<GridLayer::kRoadMarkers>;

// Entrance along y = 0, rear at y = 5 m.
MapSlot slotAtOrigin() {
  MapSlot slot;
  slot.corners = {Vector2d(0.0, 0.0), Vector2d(2.5, 0.0), Vector2d(2.5, 5.0), Vector2d(0.0, 5.0)};
  return slot;
}

std::vector<SE2> wayAlong(double y) {
  std::vector<SE2> way;
  for (double x = -10.0; x < 10.0; x += 1.0) way.emplace_back(0.0, Vector2d(x, y));
  return way;
}

TEST(WheelStops, LoseTheSmearBehindThem) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kWheelStop, {0.5, 4.0}, {2.0, 4.15});
  fill(grid, SemanticClass::kWheelStop, {0.7, 4.15}, {1.2, 4.5});
  fill(grid, SemanticClass::kFloor, {0.5, 3.5}, {2.0, 4.0});
  trimWheelStops({slotAtOrigin()}, wayAlong(-3.0), grid);
  EXPECT_EQ(at(grid, 1.0, 4.025), SemanticClass::kWheelStop);
  EXPECT_EQ(at(grid, 1.0, 4.125), SemanticClass::kWheelStop);
  EXPECT_EQ(at(grid, 1.0, 4.275), SemanticClass::kUnknown);
  EXPECT_EQ(at(grid, 1.0, 3.9), SemanticClass::kFloor);
}

TEST(WheelStops, SeenFromTheRearLieBehindTheirOtherEdge) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kWheelStop, {0.5, 3.6}, {2.0, 4.15});
  trimWheelStops({slotAtOrigin()}, wayAlong(8.0), grid);
  EXPECT_EQ(at(grid, 1.0, 4.125), SemanticClass::kWheelStop);
  EXPECT_EQ(at(grid, 1.0, 3.8), SemanticClass::kUnknown);
}

TEST(WheelStops, WhatLiesInNoSlotOrAlongTheAisleStays) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kWheelStop, {6.0, 4.0}, {7.0, 4.6});
  fill(grid, SemanticClass::kWheelStop, {0.5, 4.0}, {2.0, 4.6});
  const LayeredGrid before = grid;
  MapSlot parallel = slotAtOrigin();
  parallel.shape = SlotShape::kParallel;
  trimWheelStops({parallel}, wayAlong(-3.0), grid);
  EXPECT_TRUE(grid == before);
}

}  // namespace
}  // namespace parkade
