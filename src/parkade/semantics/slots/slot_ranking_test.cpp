// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_ranking.hpp"

#include "parkade/semantics/slots/slot_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

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

TEST(SlotRanking, TakesNoGapIntoASlot) {
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

TEST(SlotRanking, WideSlotsMayStandAlone) {
  Row row;
  row.marking = SlotMarking::kOpen;
  for (const double width : {3.4, 3.95}) {  // the widest that standards know, and an error
    row.width = width;
    PaintedFloor floor;
    row.paint(floor);
    expectRow(row, slotsOf(floor), SlotShape::kPerpendicular, 0.02);
  }
}

// Fronts do not go on across the gap beside a pillar.
TEST(SlotRanking, AWideSlotBetweenOthersIsOneWhereItsFrontIsPainted) {
  Row narrow;
  narrow.x0 = 7.5;
  narrow.width = 2.4;
  Row wide = narrow;
  wide.x0 = narrow.front(narrow.count).x();
  wide.width = 3.5;
  wide.count = 1;
  Row next = narrow;
  next.x0 = wide.front(1).x();
  PaintedFloor floor;
  for (const Row& row : {narrow, wide, next}) row.paint(floor);
  const SlotObservation* slot = slotAt(slotsOf(floor), wide.front(0));
  ASSERT_NE(slot, nullptr);
  EXPECT_NEAR((slot->corners[1] - slot->corners[0]).norm(), wide.width, 0.05);
}

// Whether an open slot is told that has one more line, from and to beside its left corner.
bool isToldWithLine(const Vector2d& from, const Vector2d& to) {
  Row row;
  row.count = 1;
  row.marking = SlotMarking::kOpen;
  PaintedFloor floor;
  row.paint(floor);
  floor.line(row.front(0) + from, row.front(0) + to, kLine);
  return slotAt(slotsOf(floor), row.front(0)) != nullptr;
}

// What glare and wear leave of a front, or a scratch, runs anywhere.
TEST(SlotRanking, AShortPieceOfLineAtACornerDoesNotDenyASlot) {
  EXPECT_TRUE(isToldWithLine({0.0, 0.0}, {-0.25, 0.25}));
}

// Of a T, smeared so that it looks turned.
TEST(SlotRanking, ATurnedBarDoesNotDenyASlot) {
  EXPECT_TRUE(isToldWithLine({-0.32, -0.12}, {0.32, 0.12}));
}

// A car hides where narrower slots, as those beside, would have a line. A front with a hole may be
// a narrower slot's and another's beyond a gap.
TEST(SlotRanking, AWideSlotIsOneWhereItsFrontIsPaintedBehindACar) {
  for (const bool has_hole : {false, true}) {
    Row narrow;
    narrow.x0 = 7.0;
    narrow.count = 3;
    Row wide = narrow;
    wide.x0 = narrow.front(narrow.count).x() - 0.8;
    wide.width = 3.6;
    wide.count = 1;
    PaintedFloor floor;
    narrow.paint(floor);
    wide.paint(floor);
    floor.line(wide.front(1), wide.front(1) - Vector2d(0.8, 0.0), kLine);  // it goes on
    if (has_hole) {
      const Vector2d hole = wide.front(0) - Vector2d(2.66, 0.0);
      floor.line(hole, hole - Vector2d(0.8, 0.0), 0.2, SemanticClass::kFloor, 90);
    }
    floor.polygon({wide.front(0) + Vector2d(-0.3, -0.5), wide.front(1) + Vector2d(0.3, -0.5),
                   wide.rear(1) + Vector2d(0.3, 0.0), wide.rear(0) + Vector2d(-0.3, 0.0)},
                  SemanticClass::kVehicle, 30);
    EXPECT_EQ(slotAt(slotsOf(floor), wide.front(0)) == nullptr, has_hole);
  }
}

// As those for wheelchairs do: where the front of one ends the other's begins.
TEST(SlotRanking, WideSlotsComeInPairs) {
  Row narrow;
  narrow.x0 = 7.2;
  Row wide = narrow;
  wide.x0 = narrow.front(narrow.count).x() - 0.8;
  wide.width = 3.6;
  PaintedFloor floor;
  narrow.paint(floor);
  wide.paint(floor);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  for (int i = 0; i < 2; ++i) EXPECT_NE(slotAt(slots, wide.front(i)), nullptr) << i;
}

TEST(SlotRanking, RearsAreNoEntrances) {
  Row row;
  row.depth = 4.8;
  PaintedFloor floor;
  row.paint(floor);
  EXPECT_EQ(slotsOf(floor).size(), 2U);
  for (int i = 0; i < row.count; ++i) {  // this is where they are entered from beyond
    const Vector2d stop = row.front(i) + Vector2d(-0.35, -0.6);
    floor.line(stop, stop - Vector2d(1.8, 0.0), 0.2, SemanticClass::kWheelStop, 150);
  }
  for (const SlotObservation& slot : slotsOf(floor)) {
    EXPECT_GT((slot.corners[0] - row.front(0)).norm(), 1.0);
    EXPECT_LT(slot.corners[0].y(), kFront - 4.0);
  }
}

TEST(SlotRanking, AnAislesEdgeIsNoSide) {
  Row row;  // along the aisle, its end towards the car
  row.x0 = 2.5;
  row.width = 6.0;
  row.depth = 2.4;
  row.count = 1;
  PaintedFloor floor;
  floor.polygon({{9.0, -8.0}, {9.0, -2.0}, {1.0, -2.0}, {1.0, -8.0}}, SemanticClass::kUnknown, 0);
  row.paint(floor);
  floor.line(row.front(1) - Vector2d(0.4, 0.0), row.front(1) - Vector2d(3.0, 0.0), kLine,
             SemanticClass::kLaneLine);
  for (const SlotObservation& slot : slotsOf(floor)) {
    EXPECT_EQ(slot.shape, SlotShape::kParallel);
  }
}

// Cars hide all but the bars of Ts on both sides of the aisle.
TEST(SlotRanking, BarsAreNoSides) {
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

TEST(SlotRanking, ShortSidesWillDo) {
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

// A car hides the line between two slots of a row but for its bar.
TEST(SlotRanking, ABarStandsForItsLine) {
  Row row;
  row.count = 3;
  row.marking = SlotMarking::kT;
  PaintedFloor floor;
  row.paint(floor);
  const double x = row.front(1).x();
  floor.polygon(
      {{x + 0.6, -8.0}, {x + 0.6, kFront - 0.1}, {x - 0.6, kFront - 0.1}, {x - 0.6, -8.0}},
      SemanticClass::kVehicle, 30);
  const std::vector<SlotObservation> slots = slotsOf(floor);
  EXPECT_NE(slotAt(slots, row.front(0)), nullptr);
  EXPECT_NE(slotAt(slots, row.front(1)), nullptr);
}

// Short pieces of line know their direction badly.
TEST(SlotRanking, ShortSidesMayBeCrooked) {
  PaintedFloor floor;
  const Vector2d left(3.5, kFront);
  const Vector2d right(1.0, kFront);
  floor.line(left, left + Vector2d(0.0, -3.0), kLine);
  floor.line(right, right + Vector2d(0.10, -0.6), kLine);  // 9 degrees off
  floor.line(left, right, kLine);
  floor.polygon({{2.9, -8.0}, {2.9, kFront - 0.6}, {0.5, kFront - 0.7}, {0.5, -8.0}},
                SemanticClass::kVehicle, 30);
  EXPECT_NE(slotAt(slotsOf(floor), left), nullptr);
}

}  // namespace
}  // namespace parkade
