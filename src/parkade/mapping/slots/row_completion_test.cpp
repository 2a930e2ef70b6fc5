// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_completion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/slots/row_pattern.hpp"
#include "parkade/mapping/slots/row_test_support.hpp"
#include "parkade/mapping/slots/slot_plausibility.hpp"
#include "parkade/mapping/slots/slot_row.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

using testing::expectAt;
using testing::Garage;
using testing::kBay;
using testing::kDepth;
using testing::kMargin;
using testing::kWidth;

TEST(RowCompletion, FindsTheSlotBetweenTwoOthers) {
  Garage garage;
  garage.tell(0, {0, 2});
  garage.paintTold();
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], Garage::slotAt(0, 1));
  EXPECT_TRUE(rows.replaced.empty());
  EXPECT_EQ(rows.added[0].shape, SlotShape::kPerpendicular);
  EXPECT_EQ(rows.added[0].last_seen_ns, 5);
  EXPECT_GT(rows.added[0].probability_free, 0.8);
  EXPECT_GE(rows.added[0].corner_sigma, RowCompletionOptions{}.corner_sigma_m);
}

// A slanted slot has no side that the one before it could share.
TEST(RowCompletion, WhatLiesBesideSlantedSlotsMustShowItsSide) {
  Garage garage;
  garage.tell(0, {0});
  MapSlot slanted = Garage::slotAt(0, 2);
  slanted.shape = SlotShape::kSlanted;
  for (const int rear : {2, 3}) slanted.corners[static_cast<std::size_t>(rear)].x() += 2.0;
  garage.told.push_back(slanted);
  garage.paintTold();
  EXPECT_TRUE(garage.complete().added.empty());
  const MapSlot between = Garage::slotAt(0, 1);
  garage.paint(between);
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], between);
}

// Two slots along the aisle leave a gap for a pillar, which the map need not hold.
TEST(RowCompletion, WhatLiesBetweenSlotsAlongTheAisleIsNoSlotByItself) {
  Garage garage;
  garage.tell(1, {0, 1, 2});
  for (const double x : {-7.5, 1.0}) {
    MapSlot along = Garage::slotAt(0, 0);
    along.id += static_cast<int>(x) + 30;
    along.shape = SlotShape::kParallel;
    along.corners = {Vector2d(x, 0.0), Vector2d(x + 6.0, 0.0), Vector2d(x + 6.0, 2.3),
                     Vector2d(x, 2.3)};
    garage.told.push_back(along);
  }
  garage.objects.clear();
  garage.paintTold();
  for (const MapSlot& slot : garage.complete().added) EXPECT_GT(slot.corners[0].x(), 6.5);
}

TEST(RowCompletion, TellsTheVehicleInIt) {
  Garage garage;
  garage.tell(0, {0, 2});
  garage.paintTold();
  garage.park(Garage::slotAt(0, 1));
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  EXPECT_LT(rows.added[0].probability_free, 0.2);
}

TEST(RowCompletion, LeavesPlacesWithMarkingsForWhoDrivesAlone) {
  Garage garage;
  garage.tell(0, {0, 2});
  garage.paintTold();
  const MapSlot between = Garage::slotAt(0, 1);
  garage.fill(GridLayer::kRoadMarkers, SemanticClass::kCrossing,
              between.corners[0] + Vector2d(0.8, 0.0), between.corners[2] - Vector2d(0.8, 0.0));
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(RowCompletion, LeavesGapsThatSlotsDoNotFitAlone) {
  Garage garage;
  garage.tell(0, {0, 2});
  for (Vector2d& corner : garage.told[1].corners) corner.x() -= 1.0;
  garage.paintTold();
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(RowCompletion, GoesOnWhereTheNextSlotShowsItself) {
  Garage garage;
  garage.objects.clear();
  garage.tell(0, {0, 1});
  garage.paintTold();
  EXPECT_TRUE(garage.complete().added.empty());
  garage.paint(Garage::slotAt(0, 2));
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], Garage::slotAt(0, 2));
}

// Read as one slot along the aisle: what are two, beside a third that was read rightly.
TEST(RowCompletion, ReplacesAMisfit) {
  Garage garage;
  garage.tell(0, {0});
  garage.tell(1, {0, 1, 2});
  garage.paintTold();
  for (const int place : {1, 2}) garage.paint(Garage::slotAt(0, place));
  MapSlot misfit = Garage::slotAt(0, 1);
  misfit.id = 77;
  misfit.shape = SlotShape::kParallel;
  misfit.observations = 5;
  misfit.corners[1] += Vector2d(kWidth, 0.0);
  misfit.corners[2] = misfit.corners[1] + Vector2d(0.0, 2.2);
  misfit.corners[3] = misfit.corners[0] + Vector2d(0.0, 2.2);
  garage.told.push_back(misfit);
  const RowCompletion rows = garage.complete();
  EXPECT_EQ(rows.replaced, std::vector<std::int64_t>{77});
  ASSERT_EQ(rows.added.size(), 2U);
  expectAt(rows.added[0], Garage::slotAt(0, 1));
  expectAt(rows.added[1], Garage::slotAt(0, 2));
}

// The same far from the slots of its row that were read rightly.
// The next slot of the row stands before its end: it is entered from the aisle.
TEST(RowCompletion, TurnsASlotThatIsToldFromABlockedEnd) {
  Garage garage;
  constexpr double kLength = 6.0;
  const auto along = [](double x) {
    MapSlot slot = Garage::slotAt(0, 0);
    slot.shape = SlotShape::kParallel;
    slot.corners = {Vector2d(x, 0.0), Vector2d(x + kLength, 0.0), Vector2d(x + kLength, 2.3),
                    Vector2d(x, 2.3)};
    return slot;
  };
  const MapSlot first = along(1.0);
  const MapSlot wanted = along(9.5);
  MapSlot second = wanted;
  second.id = 2;
  second.shape = SlotShape::kPerpendicular;
  std::rotate(second.corners.begin(), second.corners.begin() + 3, second.corners.end());
  garage.told = {first, second};
  for (const MapSlot& slot : garage.told) {
    garage.paint(slot);
    MapSlot back = slot;
    std::rotate(back.corners.begin(), back.corners.begin() + 2, back.corners.end());
    garage.paint(back);
  }
  // Behind them nothing was seen.
  garage.fill(GridLayer::kParkingLines, SemanticClass::kUnknown, {-12.0, 2.5}, {36.0, 9.0});
  const RowCompletion rows = garage.complete();
  EXPECT_EQ(rows.replaced, std::vector<std::int64_t>{2});
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], wanted);
  EXPECT_EQ(rows.added[0].id, 2);
  EXPECT_EQ(rows.added[0].shape, SlotShape::kParallel);
}

// A row square to this one, entered from the right, of which the first slot's side is seen.
TEST(RowCompletion, TurnsASlotThatIsSeenFromItsSide) {
  for (const bool is_like_others : {false, true}) {
    Garage garage(1.9);
    garage.tell(0, {0, 1, 2});
    garage.tell(3, {0});
    garage.tell(1, {0});
    MapSlot wanted = Garage::slotAt(1, 0);
    const double x = garage.told.back().corners[1].x() + 0.6;
    wanted.id = 50;
    wanted.corners = {Vector2d(x + kDepth, 0.0), Vector2d(x + kDepth, kWidth), Vector2d(x, kWidth),
                      Vector2d(x, 0.0)};
    MapSlot seen = wanted;
    seen.shape = SlotShape::kParallel;
    seen.corners = {wanted.corners[3], wanted.corners[0], Vector2d(x + kDepth, 2.1),
                    Vector2d(x, 2.1)};
    garage.told.push_back(seen);
    for (const int k : {1, 2}) {
      MapSlot other = seen;
      other.id = 50 + k;
      for (Vector2d& corner : other.corners) corner -= Vector2d(0.0, 10.0 * k);
      for (const std::size_t right : {1U, 2U})
        if (!is_like_others) other.corners[right].x() += 1.2;
      garage.told.push_back(other);
    }
    garage.objects.clear();
    garage.paintTold();
    const RowCompletion rows = garage.complete();
    const auto turned = std::find_if(rows.added.begin(), rows.added.end(),
                                     [](const MapSlot& slot) { return slot.id == 50; });
    ASSERT_EQ(turned == rows.added.end(), is_like_others);
    if (is_like_others) continue;
    expectAt(*turned, wanted);
    EXPECT_EQ(turned->shape, SlotShape::kPerpendicular);
  }
}

TEST(RowCompletion, SplitsTwoSlotsReadAsOne) {
  enum class Case { kTwo, kShortSides, kLonger, kWall, kRear, kNoneKnown };
  for (const Case which :
       {Case::kTwo, Case::kShortSides, Case::kLonger, Case::kWall, Case::kRear, Case::kNoneKnown}) {
    Garage garage;
    if (which != Case::kNoneKnown) garage.tell(1, {0, 1, 2});
    garage.paintTold();
    MapSlot one = Garage::slotAt(3, 0);
    one.id = 77;
    one.shape = SlotShape::kParallel;
    one.observations = 8;
    const double length = which == Case::kLonger ? 6.0 : 2.0 * kWidth;
    one.corners[1] = one.corners[0] + Vector2d(length, 0.0);
    one.corners[2] = one.corners[1] + Vector2d(0.0, 2.3);
    one.corners[3] = one.corners[0] + Vector2d(0.0, 2.3);
    garage.told.push_back(one);
    MapSlot painted = one;
    if (which != Case::kShortSides) {
      painted.corners[2].y() = painted.corners[3].y() = kDepth;
    }
    garage.paint(painted);
    if (which == Case::kRear) {
      std::swap(painted.corners[0], painted.corners[3]);
      std::swap(painted.corners[1], painted.corners[2]);
      painted.corners[0].y() = painted.corners[1].y() = one.corners[3].y();
      garage.paint(painted);
    }
    if (which == Case::kWall) {
      garage.fill(GridLayer::kZoneMarkers, SemanticClass::kWall, one.corners[3],
                  one.corners[2] + Vector2d(0.0, 0.4));
    }
    const RowCompletion rows = garage.complete();
    if (which != Case::kTwo) {
      EXPECT_TRUE(rows.replaced.empty());
      continue;
    }
    EXPECT_EQ(rows.replaced, std::vector<std::int64_t>{77});
    ASSERT_EQ(rows.added.size(), 2U);
    expectAt(rows.added[0], Garage::slotAt(3, 0));
    expectAt(rows.added[1], Garage::slotAt(3, 1));
    EXPECT_EQ(rows.added[0].observations, 0);
    EXPECT_EQ(rows.added[0].shape, SlotShape::kPerpendicular);
  }
}

// A queue, or cars read too large, on a part of the row's line where nothing is painted.
TEST(RowCompletion, VehiclesAloneMakeNoSlots) {
  Garage garage;
  garage.tell(0, {0, 1, 2});
  garage.paintTold();
  garage.fill(GridLayer::kAvailability, SemanticClass::kVehicle, {kBay + kMargin, 0.5},
              {2.0 * kBay - kMargin, kDepth - 0.5});
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(RowCompletion, ALonelySlotAlongTheAisleMustBeSeenOften) {
  // In no row, and in one of bays, 4 m beyond the last one.
  const Vector2d beside = Garage::slotAt(0, 2).corners[1] + Vector2d(4.0, 0.0);
  for (const Vector2d& left : {Vector2d(26.0, 20.0), beside}) {
    Garage garage;
    garage.tell(0, {0, 1, 2});
    garage.paintTold();
    MapSlot along = Garage::slotAt(0, 0);
    along.id = 77;
    along.shape = SlotShape::kParallel;
    along.corners = {left, left + Vector2d(6.0, 0.0), left + Vector2d(6.0, 2.2),
                     left + Vector2d(0.0, 2.2)};
    garage.told.push_back(along);
    EXPECT_TRUE(garage.complete().replaced.empty());
    garage.told.back().observations = 4;
    EXPECT_EQ(garage.complete().replaced, std::vector<std::int64_t>{77});
  }
}

TEST(RowCompletion, MovesAnEntranceToItsRow) {
  Garage garage;
  garage.tell(0, {0, 1, 2});
  garage.tell(1, {0, 1, 2});
  garage.paintTold();
  for (const std::size_t k : {0U, 1U}) garage.told[4].corners[k].y() += 0.5;  // a worn end
  const RowCompletion rows = garage.complete();
  EXPECT_EQ(rows.replaced, std::vector<std::int64_t>{garage.told[4].id});
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], Garage::slotAt(1, 1));
  EXPECT_EQ(rows.added[0].id, garage.told[4].id);
  EXPECT_EQ(rows.added[0].observations, garage.told[4].observations);
  // A row of its own, farther back, stays.
  for (std::size_t i = 3; i < 6; ++i) {
    for (Vector2d& corner : garage.told[i].corners) corner.y() = corner.y() + (i == 4 ? 0.0 : 0.5);
  }
  garage.told[4].corners[2].y() += 0.5;
  garage.told[4].corners[3].y() += 0.5;
  for (const MapSlot& slot : garage.complete().added) EXPECT_EQ(slot.observations, 0);
  EXPECT_TRUE(garage.complete().replaced.empty());
}

TEST(RowCompletion, NothingToldGivesNothing) {
  EXPECT_TRUE(Garage().complete().added.empty());
}

TEST(SlotRow, SlantedSlotsLeaveOtherMarginsBeforeThanAfter) {
  std::vector<MapSlot> told;
  const Vector2d side(3.0, 4.0);
  for (int i = 0; i < 3; ++i) {
    MapSlot slot;
    slot.shape = SlotShape::kSlanted;
    const Vector2d left(8.0 * i + 1.0, 0.0);
    slot.corners = {left, left + Vector2d(3.0, 0.0), left + Vector2d(3.0, 0.0) + side, left + side};
    told.push_back(slot);
  }
  // Two metres deep: 1.5 m along, seen along the sides.
  const std::vector<Vector2d> pillars = {{0.0 + 1.5, 2.0}, {8.0 + 1.5, 2.0}, {16.0 + 1.5, 2.0}};
  const std::vector<slot_rows::Row> rows = slot_rows::findRows(told);
  ASSERT_EQ(rows.size(), 1U);
  const auto patterns = slot_rows::findPatterns(rows, told, pillars)[0];
  ASSERT_FALSE(patterns.empty());
  ASSERT_EQ(patterns[0].before.size(), 3U);
  EXPECT_NEAR(patterns[0].before[1].length, 1.0, 1e-9);
  EXPECT_EQ(patterns[0].before[1].seen, 3);
  EXPECT_TRUE(patterns[0].after.empty());  // 4 m is no margin: a slot fits in
}

TEST(SlotRow, ALineMayLieOnOneOfASlot) {
  const MapSlot slot = Garage::slotAt(0, 0);
  const Vector2d left = slot.corners[0];
  const Vector2d right = slot.corners[1];
  EXPECT_TRUE(slot_rows::liesOnLineOf(slot, left + Vector2d(0.3, 0.2), right));
  EXPECT_TRUE(slot_rows::liesOnLineOf(slot, slot.corners[2], right + Vector2d(0.2, 1.0)));
  EXPECT_FALSE(
      slot_rows::liesOnLineOf(slot, left + Vector2d(0.0, 0.6), right + Vector2d(0.0, 0.6)));
  const Vector2d middle = 0.5 * (left + right);  // crosses the entrance
  EXPECT_FALSE(
      slot_rows::liesOnLineOf(slot, middle - Vector2d(0.0, 1.0), middle + Vector2d(0.0, 1.0)));
}

TEST(SlotPlausibility, APillarInTheWayInDeniesASlot) {
  const MapSlot slot = Garage::slotAt(0, 0);
  MapObject pillar;
  pillar.semantic_class = SemanticClass::kPillar;
  pillar.observations = 20;
  const auto holds = [&](double aside, double deep, std::int64_t looks) {
    pillar.position = {slot.corners[0].x() + aside, deep, 0.0};
    return holdsPillar(slot.corners, {pillar}, looks);
  };
  EXPECT_TRUE(holds(1.25, 1.0, 20));
  EXPECT_FALSE(holds(1.25, 1.0, 100));  // the slot was seen far more often
  EXPECT_FALSE(holds(0.2, 1.0, 20));    // at its side
  EXPECT_FALSE(holds(1.25, 4.9, 20));   // at its rear
  EXPECT_FALSE(holds(1.25, -1.0, 20));  // in front
}

}  // namespace
}  // namespace parkade
