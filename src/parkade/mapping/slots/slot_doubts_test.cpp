// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// What the map as a whole says for and against slots.
#include <gtest/gtest.h>

#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

using testing::expectAt;
using testing::Garage;
using testing::kBay;
using testing::kDepth;

// Tells a clear row, and apart from it a slot that few pictures told.
MapSlot tellOneRarelySeen(Garage& garage) {
  garage.tell(0, {0, 1, 2});
  garage.paintTold();
  MapSlot slot = Garage::slotAt(2, 1);
  slot.observations = 5;
  garage.told.push_back(slot);
  return slot;
}

// One side alone: 0 is left of the entrance, 1 right.
void paintSide(Garage& garage, const MapSlot& slot, std::size_t side) {
  garage.paintUpright(slot.corners[side], slot.corners[3 - side]);
}

// Pictures may take a lane's edge for a slot's side, and nothing for the other one; where two of
// its lines show, only few do.
TEST(SlotDoubts, AFreeSlotSeenRarelyMustShowBothSides) {
  Garage garage;
  const MapSlot slot = tellOneRarelySeen(garage);
  paintSide(garage, slot, 0);
  EXPECT_EQ(garage.complete().replaced, std::vector<std::int64_t>{slot.id});
  {
    Garage hidden = garage;
    hidden.park(slot);
    EXPECT_TRUE(hidden.complete().replaced.empty());
  }
  {
    Garage seen_often = garage;
    seen_often.told.back().observations = 20;
    EXPECT_EQ(seen_often.complete().replaced, std::vector<std::int64_t>{slot.id});
    seen_often.fill(GridLayer::kParkingLines, SemanticClass::kSlotLine,
                    slot.corners[0] - Vector2d(0.0, 0.05), slot.corners[1] + Vector2d(0.0, 0.05));
    EXPECT_TRUE(seen_often.complete().replaced.empty());
  }
  garage.paint(slot);
  EXPECT_TRUE(garage.complete().replaced.empty());
}

TEST(SlotDoubts, WhereThePaintIsWornABareSideSaysLittle) {
  Garage garage;
  tellOneRarelySeen(garage);
  for (double y = 0.0; y < kDepth; y += 1.0) {  // half of every side
    garage.fill(GridLayer::kParkingLines, SemanticClass::kFloor, {-1.0, y}, {kBay, y + 0.5});
  }
  EXPECT_TRUE(garage.complete().replaced.empty());
}

TEST(SlotDoubts, AFewPicturesDoNotOutweighAnArrow) {
  Garage garage;
  const MapSlot slot = tellOneRarelySeen(garage);
  garage.paint(slot);
  garage.fill(GridLayer::kRoadMarkers, SemanticClass::kArrow, slot.corners[0] + Vector2d(1.1, 1.0),
              slot.corners[0] + Vector2d(1.4, 3.0));
  EXPECT_EQ(garage.complete().replaced, std::vector<std::int64_t>{slot.id});
}

// Two bays' sides with a pillar or a lane's edge between them look like a slot in every picture.
TEST(SlotDoubts, AGapBetweenBaysIsNoSlotHoweverOftenItIsTaken) {
  Garage open;
  const MapSlot slot = tellOneRarelySeen(open);
  open.told.back().observations = 40;
  for (const std::size_t side : {0U, 1U}) paintSide(open, slot, side);
  EXPECT_TRUE(open.complete().replaced.empty());
  const Vector2d begin = slot.corners[0];
  {
    Garage garage = open;
    const Vector2d foot = begin + Vector2d(1.0, 3.5);
    garage.fill(GridLayer::kZoneMarkers, SemanticClass::kPillar, foot, foot + Vector2d(0.6, 0.6));
    EXPECT_EQ(garage.complete().replaced, std::vector<std::int64_t>{slot.id});
    garage.number(slot);
    EXPECT_TRUE(garage.complete().replaced.empty());
  }
  {
    Garage garage = open;
    garage.fill(GridLayer::kParkingLines, SemanticClass::kLaneLine, begin - Vector2d(0.0, 0.1),
                begin + Vector2d(1.3, 0.1));
    EXPECT_EQ(garage.complete().replaced, std::vector<std::int64_t>{slot.id});
    garage.park(slot);
    EXPECT_TRUE(garage.complete().replaced.empty());
  }
}

// One line of the next slot is not enough, but numbers are painted in slots alone.
TEST(SlotDoubts, APaintedNumberSpeaksForASlot) {
  for (const bool has_number : {false, true}) {
    Garage garage;
    garage.tell(0, {0, 1, 2});
    garage.tell(1, {0, 1});
    garage.paintTold();
    for (const MapSlot& slot : garage.told) garage.number(slot);
    const MapSlot last = Garage::slotAt(1, 2);
    if (has_number) garage.number(last);
    const RowCompletion rows = garage.complete();
    ASSERT_EQ(rows.added.size(), has_number ? 1U : 0U);
    if (has_number) expectAt(rows.added[0], last);
  }
}

// Every car of a bay between two others stands in a slot; one that waits beyond them may not.
TEST(SlotDoubts, CarsOfABayBetweenTwoOthersCountEach) {
  Garage garage;
  garage.tell(0, {0, 1, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  for (int place = 0; place < 3; ++place) garage.park(Garage::slotAt(1, place));
  EXPECT_EQ(garage.complete().added.size(), 3U);
}

// Two slots read as one along the aisle, their neighbours not told either.
TEST(SlotDoubts, AMisfitNeedNotTouchItsRow) {
  Garage garage;
  garage.tell(0, {0, 1, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  for (int place = 0; place < 3; ++place) garage.paint(Garage::slotAt(1, place));
  MapSlot along = Garage::slotAt(1, 0);
  along.id = 99;
  along.shape = SlotShape::kParallel;
  along.observations = 11;
  const double x = along.corners[0].x() + 0.8;
  along.corners = {Vector2d(x, 0.0), Vector2d(x + 5.8, 0.0), Vector2d(x + 5.8, 2.2),
                   Vector2d(x, 2.2)};
  garage.told.push_back(along);
  const RowCompletion rows = garage.complete();
  EXPECT_EQ(rows.replaced, std::vector<std::int64_t>{99});
  EXPECT_EQ(rows.added.size(), 3U);
}

// An arrow on a car's roof, a pillar that its smear is taken for.
TEST(SlotDoubts, WhatAParkedCarIsReadAsDeniesNoSlotBetweenPlainSides) {
  Garage garage;
  garage.tell(0, {0, 2});
  garage.paintTold();
  const MapSlot between = Garage::slotAt(0, 1);
  const Vector2d at = between.corners[0] + Vector2d(0.8, 1.0);
  garage.fill(GridLayer::kRoadMarkers, SemanticClass::kArrow, at, at + Vector2d(0.8, 0.6));
  garage.fill(GridLayer::kZoneMarkers, SemanticClass::kPillar, at, at + Vector2d(1.2, 1.2));
  EXPECT_TRUE(garage.complete().added.empty());
  garage.park(between);
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], between);
  EXPECT_LT(rows.added[0].probability_free, 0.5);
  // The vehicle hides most of the sides.
  garage.fill(GridLayer::kParkingLines, SemanticClass::kUnknown,
              between.corners[0] + Vector2d(-0.2, 1.4), between.corners[2] + Vector2d(0.2, 0.2));
  EXPECT_EQ(garage.complete().added.size(), 1U);
  // And all of one of them: then it must fill the place.
  garage.fill(GridLayer::kParkingLines, SemanticClass::kUnknown,
              between.corners[0] + Vector2d(-0.2, 0.2), between.corners[3] + Vector2d(0.2, 0.2));
  EXPECT_EQ(garage.complete().added.size(), 1U);
  garage.fill(GridLayer::kAvailability, SemanticClass::kFloor,
              between.corners[0] + Vector2d(0.2, 0.2), between.corners[1] + Vector2d(-0.2, 2.2));
  EXPECT_TRUE(garage.complete().added.empty());
}

}  // namespace
}  // namespace parkade
