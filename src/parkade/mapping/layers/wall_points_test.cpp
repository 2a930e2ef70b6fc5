// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/wall_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Key points of a garage's walls and what stands before them, turned by 20 degrees.
struct Scene {
  SE2 T_map_garage = SE2(0.35, {3.0, -2.0});
  Random random{5};
  std::vector<Vector3d> places;

  void add(const Vector2d& p_garage, double low, double high) {
    const Vector2d p = T_map_garage * p_garage;
    places.emplace_back(p.x(), p.y(), random.uniform(low, high));
  }
  void wall(const Vector2d& from, const Vector2d& to, int count, double low = 0.3,
            double high = 2.6) {
    const Vector2d along = (to - from).normalized();
    const Vector2d across(-along.y(), along.x());
    for (int k = 0; k < count; ++k) {
      add(from + random.uniform(0.0, 1.0) * (to - from) + 0.02 * random.normal() * across, low,
          high);
    }
  }
  void box(const Vector2d& low, const Vector2d& high, int count) {
    for (int k = 0; k < count; ++k) {
      add({random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y())}, 0.3, 1.5);
    }
  }
  // Whether a found face lies along the garage's line y = at between two places.
  [[nodiscard]] bool hasFace(double y, double from, double to) const {
    const std::vector<WallFace> faces = findWallFaces(places, {}, kPointsOnFace);
    return std::any_of(faces.begin(), faces.end(), [&](const WallFace& face) {
      Vector2d a = T_map_garage.inverse() * face.from;
      Vector2d b = T_map_garage.inverse() * face.to;
      if (a.x() > b.x()) std::swap(a, b);
      return std::abs(a.y() - y) < 0.05 && std::abs(b.y() - y) < 0.05 &&
             std::abs(a.x() - from) < 1.0 && std::abs(b.x() - to) < 1.0;
    });
  }
};

TEST(WallPoints, LieOnStraightFaces) {
  Scene scene;
  scene.wall({0.0, 10.0}, {20.0, 10.0}, 60);
  scene.wall({25.0, 10.0}, {35.0, 10.0}, 30);  // beyond a gate
  scene.wall({0.0, 0.0}, {0.0, 10.0}, 40);
  EXPECT_TRUE(scene.hasFace(10.0, 0.0, 20.0));
  EXPECT_TRUE(scene.hasFace(10.0, 25.0, 35.0));
  EXPECT_EQ(findWallFaces(scene.places, {}, kPointsOnFace).size(), 3U);
}

TEST(WallPoints, PillarsInARowAreNoWall) {
  Scene scene;
  scene.wall({0.0, 0.0}, {30.0, 0.0}, 200);
  for (int k = 0; k < 5; ++k) {
    scene.wall({8.0 * k, 10.0}, {8.0 * k + 0.6, 10.0}, 20);
  }
  EXPECT_TRUE(scene.hasFace(0.0, 0.0, 30.0));
  EXPECT_EQ(findWallFaces(scene.places, {}, kPointsOnFace).size(), 1U);
}

TEST(WallPoints, WhatFillsARoomIsNoWall) {
  Scene scene;
  scene.wall({0.0, 0.0}, {30.0, 0.0}, 200);
  scene.box({0.0, 5.0}, {20.0, 7.0}, 800);
  EXPECT_EQ(findWallFaces(scene.places, {}, kPointsOnFace).size(), 1U);
  EXPECT_TRUE(findWallFaces({}, {}, kPointsOnFace).empty());
}

TEST(WallPoints, StayWithTheirAnchorsAndCountOnce) {
  WallPoints points;
  points.add({{7, {1.0, 0.0, 1.0}}}, 1, SE2());
  points.add({{7, {2.0, 0.0, 1.2}}}, 2, SE2(0.0, {1.0, 0.0}));
  const std::vector<Vector3d> places = points.places([](std::int64_t anchor) {
    return SE2(0.0, {0.0, static_cast<double>(anchor)});
  });
  ASSERT_EQ(places.size(), 1U);
  EXPECT_TRUE(places[0].isApprox(Vector3d(3.0, 2.0, 1.2)));
}

TEST(WallPoints, LowerThanCarsOrHigherThanThemAreNoWall) {
  Scene scene;
  scene.wall({0.0, 0.0}, {30.0, 0.0}, 200);
  scene.wall({0.0, 10.0}, {6.0, 10.0}, 60, 0.3, 1.5);   // bumpers
  scene.wall({0.0, 20.0}, {30.0, 20.0}, 90, 2.2, 2.7);  // a pipe
  EXPECT_TRUE(scene.hasFace(0.0, 0.0, 30.0));
  EXPECT_EQ(findWallFaces(scene.places, {}, kPointsOnFace).size(), 1U);
}

TEST(WallPoints, OfCarsBesideAWallDoNotCarryItOn) {
  Scene scene;
  scene.wall({0.0, 10.0}, {12.0, 10.0}, 120);
  for (int k = 0; k < 3; ++k) {
    scene.box({13.0 + 2.5 * k, 9.7}, {14.8 + 2.5 * k, 10.6}, 30);
  }
  EXPECT_TRUE(scene.hasFace(10.0, 0.0, 12.0));
  EXPECT_EQ(findWallFaces(scene.places, {}, kPointsOnFace).size(), 1U);
}

TEST(WallPoints, OfAPillarBesideACarAreNoWall) {
  Scene scene;
  scene.wall({0.0, 0.0}, {30.0, 0.0}, 200);
  scene.wall({10.0, 10.0}, {14.5, 10.0}, 60, 0.3, 1.5);  // a car's side
  scene.wall({12.0, 10.0}, {12.6, 10.0}, 30);
  scene.wall({9.6, 10.0}, {10.2, 10.0}, 30);
  MapObject pillar;
  pillar.semantic_class = SemanticClass::kPillar;
  std::vector<MapObject> pillars;
  for (const double x : {12.3, 9.9}) {
    pillar.position.head<2>() = scene.T_map_garage * Vector2d(x, 10.3);
    pillars.push_back(pillar);
  }
  EXPECT_EQ(findWallFaces(scene.places, pillars, kPointsOnFace).size(), 1U);
}

int wallCells(const LayeredGrid& grid) {
  int count = 0;
  grid.forEachKnown(GridLayer::kZoneMarkers, [&](const Eigen::Vector2i&, const GridCell& cell) {
    count += cell.believed() == SemanticClass::kWall ? 1 : 0;
  });
  return count;
}

TEST(WallPoints, LabelledPiecesOfAWallTellTheWholeOfIt) {
  LayeredGrid grid;
  const std::vector<SE2> way = {SE2(0.0, {0.0, 0.0}), SE2(0.0, {5.0, 0.0}), SE2(0.0, {10.0, 0.0})};
  for (double x = 0.0; x < 12.0; x += 0.05) {
    for (double y = 0.0; y < 6.0; y += 0.05) {
      const bool wall = y > 4.0 && std::fmod(x, 4.0) < 2.0;  // else taken for floor
      grid.add(GridLayer::kZoneMarkers, {x, y}, wall ? SemanticClass::kWall : SemanticClass::kFloor,
               2.0F);
    }
  }
  const std::vector<WallFace> faces = findWallFaces(wallFronts(grid, way, 8.0), {}, kLabelsOnFace);
  ASSERT_EQ(faces.size(), 1U);
  EXPECT_NEAR((faces[0].to - faces[0].from).norm(), 10.0, 0.6);
  EXPECT_NEAR(faces[0].from.y(), 4.05, 0.06);
  EXPECT_NEAR(faces[0].to.y(), 4.05, 0.06);
}

TEST(WallPoints, AreDrawnBehindTheFaceAndNotThroughSlotsCarsOrTheWay) {
  const std::vector<WallFace> faces = {{{0.0, 5.01}, {10.0, 5.01}}};
  const std::vector<SE2> way = {SE2(0.0, {0.0, 0.0}), SE2(0.0, {10.0, 0.0})};
  LayeredGrid grid;
  drawWalls(faces, {}, way, 8.0, grid);
  EXPECT_NEAR(wallCells(grid), 800, 30);  // 10 m by 0.2 m
  EXPECT_EQ(grid.at(GridLayer::kZoneMarkers, grid.cellOf({5.0, 5.1})).believed(),
            SemanticClass::kWall);
  EXPECT_FALSE(grid.at(GridLayer::kZoneMarkers, grid.cellOf({5.0, 4.9})).known());

  MapSlot slot;
  slot.corners = {Vector2d(2.0, 3.0), Vector2d(8.0, 3.0), Vector2d(8.0, 8.0), Vector2d(2.0, 8.0)};
  LayeredGrid behind_slot;
  drawWalls(faces, {slot}, way, 8.0, behind_slot);
  EXPECT_EQ(wallCells(behind_slot), 0);
  // A slot that ends at the wall is no reason against it.
  slot.corners = {Vector2d(2.0, 0.0), Vector2d(8.0, 0.0), Vector2d(8.0, 5.1), Vector2d(2.0, 5.1)};
  drawWalls(faces, {slot}, way, 8.0, behind_slot);
  EXPECT_GT(wallCells(behind_slot), 700);

  // But nobody enters a slot through a wall.
  slot.corners = {Vector2d(2.0, 5.1), Vector2d(8.0, 5.1), Vector2d(8.0, 0.1), Vector2d(2.0, 0.1)};
  LayeredGrid before_slot;
  drawWalls(faces, {slot}, way, 8.0, before_slot);
  EXPECT_EQ(wallCells(before_slot), 0);

  LayeredGrid cars;
  for (double x = 0.0; x < 6.0; x += 0.05) {
    cars.add(GridLayer::kAvailability, {x, 5.0}, SemanticClass::kVehicle, 2.0F);
  }
  drawWalls(faces, {}, way, 8.0, cars);
  EXPECT_EQ(wallCells(cars), 0);

  LayeredGrid crossed;
  drawWalls(faces, {}, {SE2(0.0, {5.0, 2.0}), SE2(0.0, {5.0, 5.0}), SE2(0.0, {5.0, 9.0})}, 8.0,
            crossed);
  EXPECT_FALSE(crossed.at(GridLayer::kZoneMarkers, crossed.cellOf({5.0, 5.1})).known());
}

TEST(WallPoints, AreDrawnInsideARoomWhoseSideIsSeenPastItsCorner) {
  // The way leads along the room's front, which is labelled, and hardly past its corner.
  LayeredGrid grid;
  for (double x = 0.0; x < 10.0; x += 0.05) {
    for (double y = 3.0; y < 3.2; y += 0.05) {
      grid.add(GridLayer::kZoneMarkers, {x, y}, SemanticClass::kWall, 2.0F);
    }
  }
  std::vector<SE2> way;
  for (double x = 0.0; x < 12.0; x += 0.5) way.emplace_back(0.0, Eigen::Vector2d(x, 0.0));
  drawWalls({{{10.02, 3.0}, {10.02, 8.0}}}, {}, way, 8.0, grid);
  EXPECT_EQ(grid.at(GridLayer::kZoneMarkers, grid.cellOf({9.9, 5.0})).believed(),
            SemanticClass::kWall);
  EXPECT_FALSE(grid.at(GridLayer::kZoneMarkers, grid.cellOf({10.12, 5.0})).known());
}

TEST(WallPoints, WhereAWallGoesOnAThinStripOfFloorBehindItIsNone) {
  const WallFace face{{0.0, 4.0}, {5.0, 4.0}};
  const std::vector<SE2> way = {SE2(0.0, {0.0, 0.0}), SE2(0.0, {5.0, 0.0}), SE2(0.0, {10.0, 0.0})};
  // Floor up to the wall and, where it goes on (to 8 m), up to 0.6 m behind it; then a door.
  LayeredGrid grid;
  for (double x = 0.025; x < 12.0; x += 0.05) {
    const double end = x < 5.0 ? 4.0 : x < 8.0 ? 4.6 : 6.0;
    for (double y = 0.025; y < end; y += 0.05) {
      grid.add(GridLayer::kZoneMarkers, {x, y}, SemanticClass::kFloor, 2.0F);
    }
  }
  drawWalls({face}, {}, way, 8.0, grid);
  forgetFloorBeyondWalls({face}, grid);
  const auto known = [&](double x, double y) {
    return grid.at(GridLayer::kZoneMarkers, grid.cellOf({x, y})).known();
  };
  EXPECT_FALSE(known(6.02, 4.12));
  EXPECT_FALSE(known(6.02, 4.52));
  EXPECT_TRUE(known(6.02, 3.92));
  EXPECT_TRUE(known(8.52, 4.52));
  EXPECT_TRUE(known(11.02, 4.12));
}

TEST(WallPoints, NoWallStandsInsideASlot) {
  LayeredGrid grid;
  for (double x = 0.025; x < 6.0; x += 0.05) {
    grid.add(GridLayer::kZoneMarkers, {x, 4.5}, SemanticClass::kWall, 2.0F);
    grid.add(GridLayer::kZoneMarkers, {x, 5.0}, SemanticClass::kWall, 2.0F);
  }
  grid.set(GridLayer::kZoneMarkers, grid.cellOf({3.0, 4.3}), SemanticClass::kPillar, 2.0F);
  MapSlot slot;
  slot.corners = {Vector2d(2.0, 0.0), Vector2d(4.0, 0.0), Vector2d(4.0, 5.0), Vector2d(2.0, 5.0)};
  forgetWallsInSlots({slot}, grid);
  const auto at = [&](double x, double y) {
    return grid.at(GridLayer::kZoneMarkers, grid.cellOf({x, y})).believed();
  };
  EXPECT_EQ(at(3.0, 4.5), SemanticClass::kUnknown);
  EXPECT_EQ(at(1.5, 4.5), SemanticClass::kWall);
  EXPECT_EQ(at(3.0, 5.0), SemanticClass::kWall);
  EXPECT_EQ(at(3.0, 4.3), SemanticClass::kPillar);
}

}  // namespace
}  // namespace parkade
