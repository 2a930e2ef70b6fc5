// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/routes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/sim/drive/lane.hpp"
#include "parkade/sim/drive/way.hpp"
#include "parkade/sim/world/generate.hpp"

namespace parkade::sim {
namespace {

Garage makeGarage(const std::string& preset, int seed) {
  GarageOptions options;
  options.preset = preset;
  options.seed = seed;
  return std::move(generateGarage(options)).value();
}

TEST(Routes, OfThePaperGarageAreDrivable) {
  const Garage garage = makeGarage("paper", 1);
  for (const RouteInfo& info : routeCatalogue()) {
    if (info.garage != "paper") continue;
    const Result<Route> route = planRoute(garage, info.name, 1, VehicleShape{});
    ASSERT_TRUE(route.ok()) << info.name << ": " << route.error().message;
    EXPECT_GE(route->path.length(), 100.0) << info.name;
    EXPECT_LE(route->path.length(), 350.0) << info.name;
    EXPECT_LE(route->path.maxCurvature(), 1.0 / 4.5 + 1e-9) << info.name;
    EXPECT_GE(route->clearance.distance, 0.2) << info.name << " " << route->clearance.obstacle;
    RecordProperty(info.name, std::to_string(route->path.length()));
    RecordProperty(info.name + "_clear", std::to_string(route->clearance.distance) + " " +
                                             route->clearance.obstacle + " at " +
                                             std::to_string(route->clearance.s));
  }
}

TEST(Routes, ConditionsSpanThePapersTable) {
  double low_lux = 1e9, high_lux = 0, low_share = 1, high_share = 0;
  for (const RouteInfo& info : routeCatalogue()) {
    low_lux = std::min(low_lux, info.lux);
    high_lux = std::max(high_lux, info.lux);
    low_share = std::min(low_share, info.occupancy);
    high_share = std::max(high_share, info.occupancy);
  }
  EXPECT_EQ(low_lux, 10.0);
  EXPECT_EQ(high_lux, 1000.0);
  EXPECT_EQ(low_share, 0.20);
  EXPECT_EQ(high_share, 0.95);
}

// Shares of the path near to where it was more than 30 m of driving ago.
double revisitedShare(const Path& path) {
  int count = 0;
  int near = 0;
  for (double s = 0.0; s < path.length(); s += 1.0, ++count) {
    for (double before = 0.0; before < s - 30.0; before += 1.0) {
      if ((path.at(s).position - path.at(before).position).norm() < 4.0) {
        ++near;
        break;
      }
    }
  }
  return static_cast<double>(near) / count;
}

TEST(Routes, HaveTheShapesTheyAreNamedFor) {
  const Garage garage = makeGarage("paper", 1);
  const auto plan = [&](const char* name) {
    return std::move(planRoute(garage, name, 1, VehicleShape{})).value();
  };
  EXPECT_NEAR(revisitedShare(plan("test1").path), 0.12, 0.05);
  EXPECT_NEAR(revisitedShare(plan("test2").path), 0.0, 0.01);
  EXPECT_NEAR(revisitedShare(plan("test3").path), 0.43, 0.08);
  EXPECT_NEAR(revisitedShare(plan("test4").path), 0.0, 0.01);
  const Route parked = plan("test5");
  ASSERT_GT(parked.parking_slot_id, 0);
  const PathPoint end = parked.path.at(parked.path.length());
  const Slot& slot = garage.slots.at(parked.parking_slot_id - 1);
  const Eigen::Vector2d entrance = 0.5 * (slot.corners[0] + slot.corners[1]);
  const Eigen::Vector2d rear = 0.5 * (slot.corners[2] + slot.corners[3]);
  const Eigen::Vector2d out = (entrance - rear).normalized();
  EXPECT_NEAR(std::cos(end.heading) * out.x() + std::sin(end.heading) * out.y(), 1.0, 1e-9);
  EXPECT_NEAR((end.position + 1.3 * -out - rear).norm(), 0.0, 1e-6);
  EXPECT_EQ(end.direction, -1);
}

TEST(Routes, RandomOnesFitManyGarages) {
  int parked = 0;
  int failed = 0;
  for (int seed = 0; seed < 25; ++seed) {
    const Garage garage = makeGarage(seed % 5 == 0 ? "paper" : "random", seed);
    const Result<Route> route = planRoute(garage, "random", seed, VehicleShape{});
    if (!route) {
      ++failed;
      ADD_FAILURE() << seed << ": " << route.error().message;
      continue;
    }
    EXPECT_GE(route->clearance.distance, route->parking_slot_id < 0 ? 0.25 : 0.15);
    EXPECT_LE(route->path.length(), 400.0);
    parked += route->parking_slot_id >= 0 ? 1 : 0;
  }
  EXPECT_GT(parked, 2);
  EXPECT_LT(parked, 20);
}

TEST(Routes, DependOnTheSeedAlone) {
  Garage garage = makeGarage("paper", 1);
  const Route a = std::move(planRoute(garage, "random", 5, VehicleShape{})).value();
  for (Slot& slot : garage.slots) slot.occupied = !slot.occupied;
  const Route b = std::move(planRoute(garage, "random", 5, VehicleShape{})).value();
  const Route c = std::move(planRoute(garage, "random", 6, VehicleShape{})).value();
  EXPECT_EQ(a.path.length(), b.path.length());
  EXPECT_NE(a.path.length(), c.path.length());
}

TEST(Routes, SayWhichAreKnown) {
  const Result<Route> route = planRoute(makeGarage("random", 3), "test1", 1, VehicleShape{});
  ASSERT_FALSE(route.ok());
  EXPECT_NE(route.error().message.find("known are random"), std::string::npos)
      << route.error().message;
}

TEST(Lane, SwingsOutBeforeRightTurns) {
  LaneOptions options;
  options.wander = 0.0;
  Random random(1);
  const std::vector<Eigen::Vector2d> vertices =
      laneVertices({{{0, 0}, {60, 0}}, {{60, 0}, {60, -60}}}, options, random);
  EXPECT_EQ(vertices.front(), Eigen::Vector2d(0, -0.9));  // right of the centre
  EXPECT_EQ(vertices.back(), Eigen::Vector2d(59.1, -60));
  bool corner = false;
  for (const Eigen::Vector2d& v : vertices) {
    corner = corner || (v - Eigen::Vector2d(59.8, -0.2)).norm() < 1e-9;
  }
  EXPECT_TRUE(corner);
}

}  // namespace
}  // namespace parkade::sim
