// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/map_merge.hpp"

#include <gmock/gmock.h>

#include <utility>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::mapOf;
using testing::Plan;

// The part of a map up to x, and the part from x on.
ParkingMap part(const ParkingMap& whole, double from, double to) {
  ParkingMap map;
  for (const MapSlot& slot : whole.slots) {
    if (slot.entrance().x() >= from && slot.entrance().x() < to) map.slots.push_back(slot);
  }
  for (const MapObject& object : whole.objects) {
    if (object.position.x() >= from && object.position.x() < to) map.objects.push_back(object);
  }
  for (const GridLayer layer : kGridLayers) {
    whole.grid.forEachKnown(layer, [&](const Eigen::Vector2i& cell, const GridCell& known) {
      const double x = whole.grid.centerOf(cell).x();
      if (x >= from && x < to) map.grid.touch(layer, cell) = known;
    });
  }
  map.nodes = {{0, 1, SE3()}, {5, 2, SE3(SO3(), {3.0, 0.0, 0.0})}};
  map.edges.resize(1);
  map.edges[0].from = 0;
  map.edges[0].to = 5;
  return map;
}

TEST(MapMerge, ALaterDriveAddsWhatIsNewAndKeepsIds) {
  const ParkingMap whole = mapOf(makePlan(1, 60.0, 0.3, 4));
  ParkingMap saved = part(whole, 0.0, 40.0);
  const ParkingMap before = saved;
  ParkingMap later = part(whole, 20.0, 60.0);
  std::int64_t id = 500;
  for (MapSlot& slot : later.slots) {
    slot.id = id++;
    slot.probability_free = 0.9;
    slot.last_seen_ns = 77;
    for (Eigen::Vector2d& corner : slot.corners) corner += Eigen::Vector2d(0.02, 0.0);
  }
  const Result<MergeReport> report = mergeMap(later, saved);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_EQ(saved.slots.size(), whole.slots.size());
  EXPECT_EQ(saved.objects.size(), whole.objects.size());
  EXPECT_EQ(report->slots_again + report->slots_new, static_cast<int>(later.slots.size()));
  EXPECT_GT(report->slots_again, 3);
  EXPECT_GT(report->slots_new, 3);
  EXPECT_EQ(report->slots_refused, 0);
  EXPECT_THAT(findFaults(saved), ::testing::IsEmpty());
  for (std::size_t i = 0; i < before.slots.size(); ++i) {
    EXPECT_EQ(saved.slots[i].id, before.slots[i].id);
    const bool again = before.slots[i].entrance().x() >= 20.0;
    EXPECT_EQ(saved.slots[i].probability_free, again ? 0.9 : before.slots[i].probability_free);
    // Both are as sure: half way.
    EXPECT_NEAR(saved.slots[i].corners[0].x() - before.slots[i].corners[0].x(), again ? 0.01 : 0.0,
                1e-9);
  }
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(10.0, 3.0), Eigen::Vector2d(55.0, 1.0)}) {
    const Eigen::Vector2i cell = whole.grid.cellOf(p);
    EXPECT_EQ(saved.grid.at(GridLayer::kParkingLines, cell).semantic_class,
              whole.grid.at(GridLayer::kParkingLines, cell).semantic_class);
  }
  EXPECT_EQ(saved.nodes.size(), before.nodes.size());
}

TEST(MapMerge, AvailabilityIsTheLaterDrivesAndMovingThingsAreLeftOut) {
  const ParkingMap whole = mapOf(makePlan(1, 40.0, 0.3, 4));
  ParkingMap saved = whole;
  ParkingMap later = whole;
  const Eigen::Vector2i cell(100, 20);
  saved.grid.set(GridLayer::kAvailability, cell, SemanticClass::kVehicle, 6.0F);
  later.grid.set(GridLayer::kAvailability, cell, SemanticClass::kFloor, 1.0F);
  later.grid.set(GridLayer::kDynamic, cell, SemanticClass::kPedestrian, 3.0F);
  ASSERT_TRUE(mergeMap(later, saved).ok());
  EXPECT_EQ(saved.grid.at(GridLayer::kAvailability, cell).believed(), SemanticClass::kFloor);
  EXPECT_FALSE(saved.grid.at(GridLayer::kDynamic, cell).known());
}

TEST(MapMerge, SlotsThatTheLaterDriveToldByTheirRowsAreAsItSawTheirPlaces) {
  const ParkingMap whole = mapOf(makePlan(1, 40.0, 0.3, 4));
  ParkingMap saved = whole;
  ParkingMap later = whole;
  for (ParkingMap* map : {&saved, &later}) {
    for (MapSlot& slot : map->slots) slot.probability_free = map == &saved ? 0.9 : 0.5;
  }
  later.slots[0].observations = later.slots[1].observations = 0;
  later.slots[0].probability_free = 0.1;
  ASSERT_TRUE(mergeMap(later, saved).ok());
  EXPECT_EQ(saved.slots[0].probability_free, 0.1);
  EXPECT_EQ(saved.slots[1].probability_free, 0.9);  // it saw nothing there
}

TEST(MapMerge, AHeadingThatOneDriveCouldNotTellIsTheOthers) {
  const ParkingMap whole = mapOf(makePlan(1, 40.0, 0.3, 4));
  MapObject limit;
  limit.semantic_class = SemanticClass::kSpeedLimitPaint;
  limit.position = {10.0, 0.0, 0.0};
  for (const double known : {0.6, 2.0}) {
    for (const bool in_saved : {true, false}) {
      ParkingMap saved = whole;
      ParkingMap later = whole;
      for (ParkingMap* map : {&saved, &later}) {
        map->objects.push_back(limit);
        map->objects.back().id = 900;
        map->objects.back().heading = (map == &saved) == in_saved ? known : 0.0;
      }
      const Result<MergeReport> report = mergeMap(later, saved);
      ASSERT_TRUE(report.ok());
      EXPECT_EQ(report->objects_new, 0);
      EXPECT_EQ(saved.objects.back().heading, known);
    }
  }
}

TEST(MapMerge, PaintThatTheLaterDriveSawToBeGoneIsDropped) {
  const ParkingMap whole = mapOf(makePlan(1, 40.0, 0.3, 4));
  const auto gone = [&](SemanticClass c, double seen_m, SemanticClass shown, bool told) {
    ParkingMap saved = whole;
    ParkingMap later = whole;
    MapObject object;
    object.id = 900;
    object.semantic_class = c;
    object.position = {10.0, 0.5, 0.0};
    saved.objects.push_back(object);
    if (told) later.objects.push_back(object);
    for (double x = -0.5 * seen_m + 0.025; x < 0.5 * seen_m; x += 0.05) {
      for (double y = -0.5 * seen_m + 0.025; y < 0.5 * seen_m; y += 0.05) {
        later.grid.set(GridLayer::kRoadMarkers, later.grid.cellOf({10.0 + x, 0.5 + y}), shown,
                       2.0F);
      }
    }
    const Result<MergeReport> report = mergeMap(later, saved);
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(saved.objects.size() + static_cast<std::size_t>(report->objects_gone),
              whole.objects.size() + 1);
    return report->objects_gone;
  };
  EXPECT_EQ(gone(SemanticClass::kStopLine, 1.0, SemanticClass::kFloor, false), 1);
  EXPECT_EQ(gone(SemanticClass::kStopLine, 1.0, SemanticClass::kFloor, true), 0);
  EXPECT_EQ(gone(SemanticClass::kStopLine, 1.0, SemanticClass::kStopLine, false), 0);
  EXPECT_EQ(gone(SemanticClass::kStopLine, 0.2, SemanticClass::kFloor, false), 0);  // hardly seen
  EXPECT_EQ(gone(SemanticClass::kGuideSign, 1.0, SemanticClass::kFloor, false), 0);
}

TEST(MapMerge, SigmasFallToWhatAllLooksShare) {
  const ParkingMap whole = mapOf(makePlan(1, 40.0, 0.3, 4));
  ASSERT_FALSE(whole.objects.empty());
  const auto merged = [&](double sigma) {
    ParkingMap saved = whole;
    saved.slots[0].corner_sigma = saved.objects[0].position_sigma = sigma;
    const ParkingMap later = saved;
    EXPECT_TRUE(mergeMap(later, saved).ok());
    return std::pair(saved.slots[0].corner_sigma, saved.objects[0].position_sigma);
  };
  EXPECT_NEAR(merged(0.5).first, 0.354, 0.001);
  EXPECT_NEAR(merged(0.5).second, 0.354, 0.001);
  EXPECT_EQ(merged(0.022), std::pair(0.02, 0.03));
}

TEST(MapMerge, TextsAreThoseOfMoreObservations) {
  const ParkingMap whole = mapOf(makePlan(1, 40.0, 0.3, 4));
  ParkingMap saved = whole;
  ParkingMap later = whole;
  saved.slots[0].number = "12";
  later.slots[0].number = "17";
  later.slots[0].observations = 3;
  saved.slots[1].number = "12";
  later.slots[1].number = "17";
  later.slots[1].observations = 300;
  later.slots[2].number = "5";
  ASSERT_TRUE(mergeMap(later, saved).ok());
  EXPECT_EQ(saved.slots[0].number, "12");
  EXPECT_EQ(saved.slots[1].number, "17");
  EXPECT_EQ(saved.slots[2].number, "5");
}

TEST(MapMerge, MapsOfDifferentWorldsAreRefusedAndNothingChanges) {
  const Plan plan = makePlan(1, 60.0, 0.3, 4);
  ParkingMap saved = mapOf(plan);
  const LayeredGrid grid = saved.grid;
  const ParkingMap turned = mapOf(plan, SE2(0.4, {1.2, 0.0}));
  const Result<MergeReport> report = mergeMap(turned, saved);
  ASSERT_FALSE(report.ok());
  EXPECT_THAT(report.error().message, ::testing::HasSubstr("not of one world"));
  EXPECT_EQ(saved.slots, mapOf(plan).slots);
  EXPECT_TRUE(saved.grid == grid);
  ParkingMap coarse;
  coarse.grid = LayeredGrid(0.1);
  EXPECT_FALSE(mergeMap(coarse, saved).ok());
}

}  // namespace
}  // namespace parkade
