// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slot_extraction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "parkade/semantics/features_test_support.hpp"
#include "parkade/semantics/line_extraction.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kFront = -2.6;  // y of the row's entrances, right of the car
constexpr double kLine = 0.12;   // m

// A row on the right of the car: count slots of a width along x from x0 backwards, as a driver
// entering them sees the left one at the larger x.
struct Row {
  double x0 = 5.0;
  double width = 2.5;
  double depth = 5.0;
  int count = 2;
  SlotMarking marking = SlotMarking::kClosed;
  double lean = 0.0;  // m that the rear lies further back (-x)

  [[nodiscard]] Vector2d front(int i) const { return {x0 - i * width, kFront}; }
  [[nodiscard]] Vector2d rear(int i) const { return {x0 - i * width - lean, kFront - depth}; }

  void paint(PaintedFloor& floor) const {
    for (int i = 0; i <= count; ++i) {
      floor.line(front(i), rear(i), kLine);
      constexpr double kBar = 0.3;
      const Vector2d bar(kBar, 0.0);
      const bool first = i == 0;
      const bool last = i == count;
      if (marking == SlotMarking::kT || (marking == SlotMarking::kL && !first)) {
        floor.line(front(i), front(i) + bar, kLine);
      }
      if (marking == SlotMarking::kT || (marking == SlotMarking::kL && !last)) {
        floor.line(front(i) - bar, front(i), kLine);
      }
    }
    if (marking != SlotMarking::kClosed) return;
    floor.line(front(0), front(count), kLine);
    floor.line(rear(0), rear(count), kLine);
  }
};

std::vector<SlotObservation> slotsOf(const PaintedFloor& floor, const FloorSigma& sigma = {}) {
  const Lines lines = extractLines(floor.bev, floor.labels, sigma.attitude);
  return extractSlots(floor.bev, floor.labels, lines.segments,
                      BevViews::fromMiddle(floor.labels.geometry), sigma);
}

const SlotObservation* slotAt(const std::vector<SlotObservation>& slots, const Vector2d& left) {
  const auto it = std::find_if(slots.begin(), slots.end(), [&](const SlotObservation& slot) {
    return (slot.corners[0] - left).norm() < 0.5;
  });
  return it == slots.end() ? nullptr : &*it;
}

void expectRow(const Row& row, const std::vector<SlotObservation>& slots, SlotShape shape,
               double tolerance) {
  ASSERT_EQ(slots.size(), static_cast<std::size_t>(row.count));
  for (int i = 0; i < row.count; ++i) {
    const SlotObservation* slot = slotAt(slots, row.front(i));
    ASSERT_NE(slot, nullptr) << i;
    EXPECT_LT((slot->corners[0] - row.front(i)).norm(), tolerance) << i;
    EXPECT_LT((slot->corners[1] - row.front(i + 1)).norm(), tolerance) << i;
    EXPECT_EQ(slot->shape, shape) << i;
    EXPECT_GT(slot->confidence, 0.8) << i;
    const Vector2d side = slot->corners[3] - slot->corners[0];
    const Vector2d wanted = row.rear(i) - row.front(i);
    EXPECT_GT(side.normalized().dot(wanted.normalized()), 0.999) << i;
  }
}

TEST(SlotExtraction, FindsPerpendicularSlotsOfAnyMarking) {
  for (const SlotMarking marking :
       {SlotMarking::kClosed, SlotMarking::kT, SlotMarking::kL, SlotMarking::kOpen}) {
    SCOPED_TRACE(static_cast<int>(marking));
    Row row;
    row.marking = marking;
    PaintedFloor floor;
    row.paint(floor);
    const std::vector<SlotObservation> slots = slotsOf(floor);
    // An L at the end of a row tells little of where its short bar lies.
    const double tolerance = marking == SlotMarking::kL ? 0.03 : 0.02;
    expectRow(row, slots, SlotShape::kPerpendicular, tolerance);
    for (const SlotObservation& slot : slots) {
      // A neighbour's bar makes two Ls look like a T.
      const bool alike = slot.marking == marking ||
                         (marking == SlotMarking::kL && slot.marking == SlotMarking::kT);
      EXPECT_TRUE(alike) << static_cast<int>(slot.marking);
      EXPECT_GT(slot.probability_free, 0.9);
    }
  }
}

TEST(SlotExtraction, TellsRearsThatItSees) {
  Row row;
  row.x0 = 6.0;
  row.depth = 4.7;
  PaintedFloor floor;
  row.paint(floor);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  ASSERT_EQ(slots.size(), 2U);
  for (const SlotObservation& slot : slots) {
    EXPECT_TRUE(slot.rear_seen);
    EXPECT_NEAR((slot.corners[3] - slot.corners[0]).norm(), 4.7, 0.03);
  }
}

TEST(SlotExtraction, FindsParallelSlots) {
  Row row;
  row.x0 = 7.5;
  row.width = 6.0;
  row.depth = 2.2;
  for (const SlotMarking marking : {SlotMarking::kClosed, SlotMarking::kT}) {
    SCOPED_TRACE(static_cast<int>(marking));
    row.marking = marking;
    PaintedFloor floor;
    row.paint(floor);
    expectRow(row, slotsOf(floor), SlotShape::kParallel, 0.02);
  }
}

TEST(SlotExtraction, FindsSlantedSlots) {
  Row row;
  row.width = 2.9;
  row.lean = 2.6;
  for (const SlotMarking marking : {SlotMarking::kClosed, SlotMarking::kT, SlotMarking::kOpen}) {
    SCOPED_TRACE(static_cast<int>(marking));
    row.marking = marking;
    PaintedFloor floor;
    row.paint(floor);
    expectRow(row, slotsOf(floor), SlotShape::kSlanted, 0.04);
  }
}

TEST(SlotExtraction, TellsFreeFromOccupied) {
  Row row;
  row.count = 3;
  PaintedFloor floor;
  row.paint(floor);
  // A car in the middle slot, and its smear away from the camera over the slot behind it.
  floor.polygon({{2.2, -7.0}, {2.2, -3.4}, {0.3, -3.4}, {0.3, -7.0}}, SemanticClass::kVehicle, 30);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  ASSERT_EQ(slots.size(), 3U);
  EXPECT_GT(slotAt(slots, row.front(0))->probability_free, 0.9);
  EXPECT_LT(slotAt(slots, row.front(1))->probability_free, 0.1);
  EXPECT_GT(slotAt(slots, row.front(2))->probability_free, 0.9);
}

// Low cameras see the floor below a parked car: its labels begin half way down the slot.
TEST(SlotExtraction, FloorSeenBelowACarIsNotFree) {
  Row row;
  row.count = 3;
  PaintedFloor floor;
  row.paint(floor);
  floor.polygon({{2.2, -8.0}, {2.2, -5.0}, {0.3, -5.0}, {0.3, -8.0}}, SemanticClass::kVehicle, 30);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  ASSERT_EQ(slots.size(), 3U);
  EXPECT_GT(slotAt(slots, row.front(0))->probability_free, 0.9);
  EXPECT_LT(slotAt(slots, row.front(1))->probability_free, 0.1);
  EXPECT_GT(slotAt(slots, row.front(2))->probability_free, 0.9);
}

TEST(SlotExtraction, KnowsNothingOfWhatItDoesNotSee) {
  Row row;
  row.count = 1;
  PaintedFloor floor;
  row.paint(floor);
  floor.polygon({{4.9, -7.6}, {4.9, -3.6}, {2.6, -3.6}, {2.6, -7.6}}, SemanticClass::kUnknown, 0);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  ASSERT_EQ(slots.size(), 1U);
  EXPECT_NEAR(slots[0].probability_free, 0.5, 1e-9);
}

// Two slots, the gap of a pillar, two slots: the line behind the gap is not labelled.
Row besideGap(PaintedFloor& floor, double gap) {
  Row row;
  row.x0 = 7.0;
  row.marking = SlotMarking::kOpen;
  row.paint(floor);
  Row behind = row;
  behind.x0 = row.front(row.count).x() - gap;
  for (int i = 1; i <= behind.count; ++i) floor.line(behind.front(i), behind.rear(i), kLine);
  return row;
}

TEST(SlotExtraction, TakesNoGapIntoASlot) {
  PaintedFloor floor;
  const Row row = besideGap(floor, 0.8);
  const double x = row.front(row.count).x();
  floor.polygon({{x - 0.3, -8.0}, {x - 0.3, -2.9}, {x - 1.1, -2.9}, {x - 1.1, -8.0}},
                SemanticClass::kPillar, 60);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  EXPECT_EQ(slotAt(slots, row.front(row.count)), nullptr);
  EXPECT_EQ(slots.size(), 3U);
  for (const SlotObservation& slot : slots) {
    EXPECT_NEAR((slot.corners[1] - slot.corners[0]).norm(), row.width, 0.05);
  }
}

TEST(SlotExtraction, WideSlotsMayStandAlone) {
  Row row;
  row.width = 3.4;
  row.marking = SlotMarking::kOpen;
  PaintedFloor floor;
  row.paint(floor);
  expectRow(row, slotsOf(floor), SlotShape::kPerpendicular, 0.02);
}

TEST(SlotExtraction, SlotsEndWhereLaneLinesBegin) {
  Row row;
  row.width = 3.4;
  row.count = 1;
  row.marking = SlotMarking::kT;
  PaintedFloor floor;
  row.paint(floor);
  EXPECT_EQ(slotsOf(floor).size(), 1U);
  floor.line(row.front(1) + Vector2d(0.2, 0.0), row.front(1) + Vector2d(1.2, 0.0), kLine,
             SemanticClass::kLaneLine);
  EXPECT_TRUE(slotsOf(floor).empty());
}

// Cars hide all but the bars of Ts on both sides of the aisle.
TEST(SlotExtraction, BarsAreNoSides) {
  PaintedFloor floor;
  for (const double y : {-2.8, 2.8}) {
    for (const double x : {-0.5, 2.0, 4.5}) {
      const Vector2d p(x, y);
      floor.line(p - Vector2d(0.4, 0.0), p + Vector2d(0.4, 0.0), kLine);
      floor.line(p, p + Vector2d(0.0, y > 0.0 ? 0.8 : -0.8), kLine);
    }
  }
  for (const SlotObservation& slot : slotsOf(floor)) {
    EXPECT_LT(std::abs(slot.corners[0].y() - slot.corners[1].y()), 0.1);
  }
}

TEST(SlotExtraction, ShortSidesWillDo) {
  Row row;
  row.count = 3;
  row.depth = 0.65;  // cars hide the rest
  row.marking = SlotMarking::kOpen;
  PaintedFloor floor;
  row.paint(floor);
  floor.polygon({{9.0, -8.0}, {9.0, -3.2}, {-4.0, -3.2}, {-4.0, -8.0}}, SemanticClass::kVehicle,
                30);
  EXPECT_EQ(slotsOf(floor).size(), 3U);
}

TEST(SlotExtraction, FindsNoSlotsWhereNoneFits) {
  PaintedFloor narrow;
  Row row;
  row.width = 1.2;
  row.count = 4;
  row.paint(narrow);
  EXPECT_TRUE(slotsOf(narrow).empty());
  PaintedFloor aisle;  // two lines along the way
  aisle.line({-6.0, 2.8}, {8.5, 2.8});
  aisle.line({-6.0, -2.8}, {8.5, -2.8});
  EXPECT_TRUE(slotsOf(aisle).empty());
  EXPECT_TRUE(slotsOf(PaintedFloor()).empty());
}

TEST(SlotExtraction, CovarianceHoldsTheAttitude) {
  Row row;
  row.count = 1;
  PaintedFloor floor;
  row.paint(floor);
  const FloorSigma sigma{0.002, 0.005};
  const std::vector<SlotObservation> slots = slotsOf(floor, sigma);
  ASSERT_EQ(slots.size(), 1U);
  const Vector2d ray = slots[0].corners[0] - floor.labels.geometry.center;
  const double along =
      std::hypot(sigma.attitude * (ray.squaredNorm() + 1.0), sigma.height * ray.norm());
  const Vector2d d = ray.normalized();
  const Eigen::Matrix2d C = slots[0].entrance_covariance.topLeftCorner<2, 2>();
  EXPECT_NEAR(std::sqrt(d.dot(C * d)), along, 0.1 * along);
  // Both corners move together.
  EXPECT_GT(slots[0].entrance_covariance(1, 3), 0.0);
}

TEST(SlotExtraction, SurvivesFrazzledLabels) {
  Random random(5);
  for (const SlotMarking marking : {SlotMarking::kClosed, SlotMarking::kT}) {
    SCOPED_TRACE(static_cast<int>(marking));
    Row row;
    row.marking = marking;
    PaintedFloor floor;
    row.paint(floor);
    floor.addNoise(5.0, 0.3, random);
    expectRow(row, slotsOf(floor), SlotShape::kPerpendicular, 0.04);
  }
}

TEST(SlotExtraction, IsQuick) {
  PaintedFloor floor;
  Row row;
  row.x0 = 8.0;
  row.count = 5;
  row.paint(floor);
  for (int i = 0; i <= 5; ++i) floor.line({8.0 - 2.5 * i, 2.6}, {8.0 - 2.5 * i, 7.6});
  floor.line({8.0, 2.6}, {-4.5, 2.6});
  const Lines lines = extractLines(floor.bev, floor.labels, 0.002);
  const BevViews views = BevViews::fromMiddle(floor.labels.geometry);
  double best = 1e9;
  std::size_t count = 0;
  for (int i = 0; i < 10; ++i) {
    const auto start = std::chrono::steady_clock::now();
    count = extractSlots(floor.bev, floor.labels, lines.segments, views, {0.002, 0.005}).size();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  std::printf("  %zu slots in %.2f ms\n", count, best);
  EXPECT_GE(count, 8U);
  EXPECT_LT(best, 40.0);  // far above what it takes: machines under load, sanitizers
}

}  // namespace
}  // namespace parkade
