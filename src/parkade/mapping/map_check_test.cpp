// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/map_check.hpp"

#include <gmock/gmock.h>

#include "parkade/mapping/map_test_support.hpp"

namespace parkade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Corners = std::array<Eigen::Vector2d, 4>;

Corners rectangle(double x, double y, double width, double depth) {
  return {Eigen::Vector2d(x, y), Eigen::Vector2d(x + width, y),
          Eigen::Vector2d(x + width, y + depth), Eigen::Vector2d(x, y + depth)};
}

TEST(MapCheck, OverlapOfRectangles) {
  const Corners a = rectangle(0.0, 0.0, 2.0, 4.0);
  EXPECT_DOUBLE_EQ(overlapShare(a, a), 1.0);
  EXPECT_NEAR(overlapShare(a, rectangle(1.0, 0.0, 2.0, 4.0)), 0.5, 1e-12);
  EXPECT_NEAR(overlapShare(rectangle(1.0, 1.0, 0.5, 0.5), a), 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(overlapShare(a, rectangle(2.0, 0.0, 2.0, 4.0)), 0.0);
  Corners clockwise = rectangle(1.0, 2.0, 2.0, 4.0);
  std::swap(clockwise[1], clockwise[3]);
  EXPECT_NEAR(overlapShare(a, clockwise), 0.25, 1e-12);
}

TEST(MapCheck, SoundMapHasNoFaults) {
  EXPECT_THAT(findFaults(testing::sampleMap()), IsEmpty());
  EXPECT_THAT(findFaults(ParkingMap()), IsEmpty());
}

TEST(MapCheck, FaultsAreNamed) {
  ParkingMap map = testing::sampleMap();
  map.slots[1].id = map.slots[0].id;
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("slot 10: id repeats")));
  map = testing::sampleMap();
  map.slots[1].corners = map.slots[0].corners;
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("slots 10 and 11: 100 %")));
  map = testing::sampleMap();
  map.slots[2].corners.fill({1.0, 1.0});
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("slot 12: area of 0.00")));
  map = testing::sampleMap();
  map.slots[2].corners[0] = {1e300, 0.0};
  map.objects[0].position.x() = -1e9;
  EXPECT_THAT(findFaults(map),
              ElementsAre(HasSubstr("slot 12: lies"), HasSubstr("object 3: lies")));
  map = testing::sampleMap();
  map.edges[0].information(0, 0) = -1.0;
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("edge 0 to 1")));
  map = testing::sampleMap();
  map.nodes[2].t_ns = 5;
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("node 2: is older")));
}

TEST(MapCheck, WhatLiesTooFarAwayIsNamed) {
  ParkingMap map = testing::sampleMap();
  map.nodes[3].T_world_vehicle.translation().x() = 1e30;
  map.nodes[1].T_world_vehicle.translation().z() = -1e4;
  map.edges[1].T_from_to.translation() = {0.0, 1e30, 0.0};
  map.objects[0].outline[1] = {0.0, 2e4};
  EXPECT_THAT(findFaults(map),
              ElementsAre("object 3: outline: lies at (0, 20000) m, farther than 10000 m from the "
                          "origin",
                          HasSubstr("node 1: lies at (1, 0, -10000)"),
                          HasSubstr("node 3: lies at (1e+30, 0, 0)"),
                          HasSubstr("edge 1 to 2: is 1e+30 m long, more than 10000")));
}

TEST(MapCheck, TilesTooFarAwayAreOneFaultOfTheirLayer) {
  ParkingMap map = testing::sampleMap();
  map.grid.touchTile(GridLayer::kRoadMarkers, {100000, 2});
  EXPECT_THAT(findFaults(map),
              ElementsAre(HasSubstr("tile (100000, 2) of layer road_markers: lies at (320000, ")));
  map.grid.touchTile(GridLayer::kRoadMarkers, {100000, 3});
  map.grid.touchTile(GridLayer::kRoadMarkers, {100000, 4});
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("(and 2 more of its tiles)")));
  // The tile that reaches beyond 10 km, and the last one that does not.
  map = testing::sampleMap();
  map.grid.touchTile(GridLayer::kDynamic, {-3125, 0});
  map.grid.touchTile(GridLayer::kDynamic, {3123, 0});
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("tile (-3125, 0) of layer dynamic")));
}

TEST(MapCheck, SigmasAndCountsBelowZeroAreNamed) {
  ParkingMap map = testing::sampleMap();
  map.objects[1].position_sigma = -5.0;
  map.objects[1].observations = -2;
  map.slots[0].corner_sigma = -0.1;
  map.slots[5].observations = -1;
  EXPECT_THAT(findFaults(map), ElementsAre(HasSubstr("slot 10: corner_sigma of -0.1 m"),
                                           HasSubstr("slot 15: observations of -1"),
                                           HasSubstr("object 4: position_sigma of -5 m"),
                                           HasSubstr("object 4: observations of -2")));
}

TEST(MapCheck, AnEdgeFromANodeToItselfIsNamed) {
  ParkingMap map = testing::sampleMap();
  map.edges[2].to = map.edges[2].from;
  EXPECT_THAT(findFaults(map), ElementsAre("edge 2 to 2: joins a node to itself"));
}

}  // namespace
}  // namespace parkade
