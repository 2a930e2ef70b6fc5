// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/bay_ends.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using testing::expectAt;
using testing::Garage;
using testing::kBay;
using testing::kDepth;
using testing::kMargin;
using testing::kWidth;

constexpr double kBetweenRears = 0.6;  // m
constexpr double kFront = 2 * kDepth + kBetweenRears;

// A known row, and behind it another one, entered from above, of which only the first slot's half
// next to the column at x = 0 is in sight: the car turned past there.
class TwoRows : public Garage {
 public:
  TwoRows() : Garage(kDepth) {
    for (const int bay : {0, 1, 2}) tell(bay, {0, 1, 2});
    MapObject pillar = objects.front();
    pillar.id = 10;
    pillar.position = {0.0, kFront - 1.2, 0.0};
    objects.push_back(pillar);
    const Vector2d from(-6.0, 4.0);
    const Vector2d to(kMargin + 0.6 * kWidth, kFront + 4.0);
    for (const GridLayer layer : {GridLayer::kParkingLines, GridLayer::kAvailability})
      fill(layer, SemanticClass::kFloor, from, to);
    paintTold();
  }

  static MapSlot hidden() {
    MapSlot slot;
    const double x = kMargin;
    slot.corners = {Vector2d(x + kWidth, kFront), Vector2d(x, kFront), Vector2d(x, kFront - kDepth),
                    Vector2d(x + kWidth, kFront - kDepth)};
    return slot;
  }
  void paintSide(double from, double to) { paintUpright({kMargin, from}, {kMargin, to}); }
  void paintEntrance() {
    fill(GridLayer::kParkingLines, SemanticClass::kSlotLine, {kMargin, kFront - 0.05},
         {kMargin + 0.6 * kWidth, kFront + 0.05});
  }
};

TEST(BayEnds, FindsTheFirstSlotOfTheRowBehind) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  const MapSlot expected = TwoRows::hidden();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((rows.added[0].corners[k] - expected.corners[k]).norm(), 0.16) << "corner " << k;
  }
  EXPECT_EQ(rows.added[0].observations, 0);
  EXPECT_GT(rows.added[0].probability_free, 0.8);
  EXPECT_GE(rows.added[0].corner_sigma, 0.1);
}

TEST(BayEnds, OneSideAloneIsNotEnough) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, AWheelStopSpeaksForASlot) {
  TwoRows garage;
  for (const MapSlot& slot : garage.told) garage.stop(slot);
  garage.paintSide(kFront - kDepth, kFront);
  EXPECT_TRUE(garage.complete().added.empty());
  garage.stop(TwoRows::hidden());
  EXPECT_EQ(garage.complete().added.size(), 1U);
}

TEST(BayEnds, ABayIsFilledFromItsEndOn) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  MapObject pillar = garage.objects.back();
  pillar.id = 11;
  pillar.position.x() = 2.0 * kMargin + 2.0 * kWidth;
  garage.objects.push_back(pillar);
  MapSlot second = TwoRows::hidden();
  for (Vector2d& corner : second.corners) corner.x() += kWidth;
  garage.park(second);
  EXPECT_EQ(garage.complete().added.size(), 2U);
}

TEST(BayEnds, ALineThatGoesOnIsNoSide) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront + 3.0);
  garage.paintEntrance();
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, NobodyDrivesInThroughAnotherSlot) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  MapSlot ahead = Garage::slotAt(0, 0);
  ahead.id = 99;
  for (Vector2d& corner : ahead.corners) corner.y() += kFront + 0.5;
  garage.told.push_back(ahead);
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, TheOtherSideShowsWhereTheFloorIsInSight) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  for (const GridLayer layer : {GridLayer::kParkingLines, GridLayer::kAvailability}) {
    garage.fill(layer, SemanticClass::kFloor, {kMargin + 0.6 * kWidth, kFront - kDepth},
                {kMargin + 2.0 * kWidth, kFront + 4.0});
  }
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, NeedsToHaveSeenSuchSlotsBesideColumns) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  garage.objects.erase(garage.objects.begin(), garage.objects.end() - 1);
  EXPECT_TRUE(garage.complete().added.empty());
}

// Bays of one slot along the aisle each, three of which are known; the columns of a fourth stand at
// x = 0 and kBay behind them, and it is entered from above.
class SlotsAlongTheAisle : public Garage {
 public:
  static constexpr double kAside = 1.25;  // m from a column's middle
  static constexpr double kDeep = 2.3;
  static constexpr double kEntrance = 20.0;

  SlotsAlongTheAisle() {
    for (const GridLayer layer : {GridLayer::kParkingLines, GridLayer::kAvailability})
      fill(layer, SemanticClass::kFloor, {-2.0, kEntrance - 4.0}, {12.0, kEntrance + 4.0});
    for (const int bay : {0, 1, 2}) told.push_back(knownIn(bay));
    for (const double x : {0.0, kBay}) {
      MapObject pillar = objects.front();
      pillar.id = 20 + static_cast<int>(x);
      pillar.position = {x, kEntrance - 1.2, 0.0};
      objects.push_back(pillar);
    }
    for (const MapSlot& slot : told) paintSides(slot, kDeep, kDeep);
  }

  static MapSlot knownIn(int bay) {
    MapSlot slot = slotAt(bay, 0);
    slot.shape = SlotShape::kParallel;
    const Vector2d left(bay * kBay + kAside, 0.0);
    const Vector2d front(kBay - 2.0 * kAside, 0.0);
    const Vector2d side(0.0, kDeep);
    slot.corners = {left, left + front, left + front + side, left + side};
    return slot;
  }
  static MapSlot hidden() {
    MapSlot slot = knownIn(0);
    for (Vector2d& corner : slot.corners) corner = Vector2d(kBay, kEntrance) - corner;
    return slot;
  }
  void paintSides(const MapSlot& slot, double left, double right) {
    const Vector2d in = (slot.corners[3] - slot.corners[0]).normalized();
    for (const auto& [front, length] :
         {std::pair{slot.corners[0], left}, {slot.corners[1], right}}) {
      paintUpright(front, front + length * in);
    }
  }
};

TEST(BayEnds, ASlotAlongTheAisleStandsBetweenColumnsAsOthersDo) {
  SlotsAlongTheAisle garage;
  garage.paintSides(SlotsAlongTheAisle::hidden(), SlotsAlongTheAisle::kDeep, 1.0);
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  const MapSlot expected = SlotsAlongTheAisle::hidden();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((rows.added[0].corners[k] - expected.corners[k]).norm(), 0.2) << "corner " << k;
  }
  EXPECT_EQ(rows.added[0].shape, SlotShape::kParallel);
  EXPECT_EQ(rows.added[0].observations, 0);
}

TEST(BayEnds, ACarBesideASingleLineIsInNoSlot) {
  SlotsAlongTheAisle garage;
  garage.paintSides(SlotsAlongTheAisle::hidden(), SlotsAlongTheAisle::kDeep, 0.0);
  garage.park(SlotsAlongTheAisle::hidden());
  EXPECT_TRUE(garage.complete().added.empty());
}

// A row square to it is entered over what would be one of its sides.
TEST(BayEnds, AnEntranceOfTheNextRowIsNoSide) {
  SlotsAlongTheAisle garage;
  const MapSlot hidden = SlotsAlongTheAisle::hidden();
  garage.paintSides(hidden, SlotsAlongTheAisle::kDeep, SlotsAlongTheAisle::kDeep);
  MapSlot square = hidden;
  square.id = 77;
  square.shape = SlotShape::kPerpendicular;
  const Vector2d front = hidden.corners[0] + Vector2d(0.0, 0.7);
  square.corners = {front, front - Vector2d(0.0, 3.6), front - Vector2d(-kDepth, 3.6),
                    front + Vector2d(kDepth, 0.0)};
  garage.told.push_back(square);
  EXPECT_TRUE(garage.complete().added.empty());
}

// As edges of an aisle do not, of which the first metres are in sight.
TEST(BayEnds, SidesOfSlotsAlongTheAisleEndAtTheirRear) {
  const MapSlot hidden = SlotsAlongTheAisle::hidden();
  SlotsAlongTheAisle garage;
  garage.park(hidden);
  SlotsAlongTheAisle seen_in_part = garage;
  seen_in_part.paintSides(hidden, SlotsAlongTheAisle::kDeep, SlotsAlongTheAisle::kDeep);
  EXPECT_EQ(seen_in_part.complete().added.size(), 1U);
  const Vector2d rear = hidden.corners[2].cwiseMin(hidden.corners[3]);
  seen_in_part.fill(GridLayer::kParkingLines, SemanticClass::kUnknown, rear - Vector2d(1.0, 1.6),
                    rear + Vector2d(8.0, -0.3));
  EXPECT_TRUE(seen_in_part.complete().added.empty());
  garage.paintSides(hidden, kDepth, kDepth);
  EXPECT_TRUE(garage.complete().added.empty());
}

}  // namespace
}  // namespace parkade
