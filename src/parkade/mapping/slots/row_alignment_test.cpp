// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "parkade/mapping/slots/row_test_support.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"
#include "parkade/mapping/slots/slot_row.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using slot_rows::SquaredSlots;
using slot_rows::squareSlots;
using testing::expectAt;
using testing::Garage;
using testing::kBay;
using testing::kDepth;

// As pictures tell a slot whose right side is worn off at its end.
MapSlot misread(MapSlot slot) {
  slot.shape = SlotShape::kSlanted;
  slot.corners[1].y() += 0.9;
  slot.corners[2].y() += 0.9;
  return slot;
}

class Squaring : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const int bay : {0, 1}) garage_.tell(bay, {0, 1, 2});
  }
  SquaredSlots square() { return squareSlots(garage_.told, garage_.grid); }
  Garage garage_;
};

TEST_F(Squaring, ACornerOfARowIsPutRight) {
  garage_.told.push_back(misread(Garage::slotAt(2, 0)));
  const SquaredSlots squared = square();
  ASSERT_EQ(squared.moved, std::vector<std::size_t>{6});
  EXPECT_TRUE(squared.wrong.empty());
  expectAt(garage_.told[6], Garage::slotAt(2, 0));
  EXPECT_EQ(garage_.told[6].shape, SlotShape::kPerpendicular);
}

TEST_F(Squaring, WhatPicturesTookForASquareSlotIsPutRightAsWell) {
  MapSlot slot = Garage::slotAt(2, 0);
  slot.corners[1].y() += 0.4;  // 9 degrees
  slot.corners[2].y() += 0.4;
  garage_.told.push_back(slot);
  EXPECT_EQ(square().moved, std::vector<std::size_t>{6});
  expectAt(garage_.told[6], Garage::slotAt(2, 0));
}

// Away from all rows.
MapSlot alone() {
  MapSlot slot = misread(Garage::slotAt(2, 0));
  for (Vector2d& corner : slot.corners) corner.y() += 1.7;
  return slot;
}

TEST_F(Squaring, WhatStandsAloneNeedsItsSides) {
  garage_.told.push_back(alone());
  const SquaredSlots squared = square();
  EXPECT_TRUE(squared.moved.empty());
  EXPECT_EQ(squared.wrong, std::vector<std::size_t>{6});
}

TEST_F(Squaring, WhatStandsAloneWithPaintedSidesIsMadeSquare) {
  garage_.told.push_back(alone());
  garage_.paint(alone());
  const SquaredSlots squared = square();
  EXPECT_EQ(squared.moved, std::vector<std::size_t>{6});
  EXPECT_TRUE(squared.wrong.empty());
}

TEST_F(Squaring, SidesMayBeALittleAskewAsWell) {
  MapSlot slot = misread(Garage::slotAt(2, 0));
  slot.corners[2].x() += 0.4;
  slot.corners[3].x() += 0.4;
  garage_.told.push_back(slot);
  EXPECT_EQ(square().moved, std::vector<std::size_t>{6});
}

TEST_F(Squaring, SlantedSlotsStay) {
  MapSlot slot = Garage::slotAt(2, 0);
  slot.shape = SlotShape::kSlanted;
  slot.corners[2].x() += 2.5;
  slot.corners[3].x() += 2.5;
  garage_.told.push_back(slot);
  const SquaredSlots squared = square();
  EXPECT_TRUE(squared.moved.empty());
  EXPECT_TRUE(squared.wrong.empty());
}

// Slots of a row that lean by 2 m.
MapSlot slanted(int place) {
  MapSlot slot = Garage::slotAt(2, place);
  slot.shape = SlotShape::kSlanted;
  slot.corners[2].x() += 2.0;
  slot.corners[3].x() += 2.0;
  return slot;
}

// A corner of it worn off: 1.2 m in along its side.
MapSlot slantedAndWorn(int place) {
  MapSlot slot = slanted(place);
  const Vector2d in = 1.2 * (slot.corners[2] - slot.corners[1]).normalized();
  slot.corners[1] += in;
  slot.corners[2] += in;
  return slot;
}

TEST_F(Squaring, SlantedSlotsHaveTheirEntranceOnTheirRow) {
  garage_.told.push_back(slanted(0));
  garage_.told.push_back(slantedAndWorn(2));
  const SquaredSlots squared = square();
  ASSERT_EQ(squared.moved, std::vector<std::size_t>{7});
  expectAt(garage_.told[7], slanted(2));
  EXPECT_EQ(garage_.told[7].shape, SlotShape::kSlanted);
}

// Its sides lean by 45 degrees, and what pictures see of the front is square to them.
TEST_F(Squaring, SlantedSlotsReadAsSquareOnesStandOnTheLineOfOthersFarAlong) {
  const auto leaning = [](int bay) {
    MapSlot slot = slanted(0);
    const Vector2d left(bay * kBay, 12.0);
    slot.corners = {left, left + Vector2d(3.7, 0.0), left + Vector2d(7.3, 3.6),
                    left + Vector2d(3.6, 3.6)};
    return slot;
  };
  MapSlot read = leaning(2);
  const Vector2d in = (read.corners[3] - read.corners[0]).normalized();
  const double off = (read.corners[1] - read.corners[0]).dot(in);
  read.corners[0] += off * in;
  read.corners[3] += off * in;
  garage_.told.push_back(leaning(0));
  for (const SlotShape shape : {SlotShape::kSlanted, SlotShape::kPerpendicular}) {
    garage_.told.resize(7);
    read.shape = shape;
    garage_.told.push_back(read);
    ASSERT_EQ(square().moved, std::vector<std::size_t>{7});
    for (const std::size_t k : {0U, 1U})
      EXPECT_LT((garage_.told[7].corners[k] - leaning(2).corners[k]).norm(), 0.02) << k;
    EXPECT_EQ(garage_.told[7].shape, SlotShape::kSlanted);
  }
}

TEST_F(Squaring, AskewSlotsWithoutARowOrWithAnotherInTheirWayStay) {
  garage_.told.push_back(slantedAndWorn(2));
  for (Vector2d& corner : garage_.told[6].corners) corner.y() += 1.7;
  EXPECT_TRUE(square().moved.empty());
  garage_.told = {garage_.told.begin(), garage_.told.begin() + 6};
  for (const int place : {0, 2}) garage_.told.push_back(slanted(place));
  garage_.told.push_back(slantedAndWorn(2));
  EXPECT_TRUE(square().moved.empty());
}

TEST_F(Squaring, WhereNoAxesAreKnownNothingChanges) {
  garage_.told = {misread(Garage::slotAt(0, 0))};
  const SquaredSlots squared = square();
  EXPECT_TRUE(squared.moved.empty());
  EXPECT_TRUE(squared.wrong.empty());
}

// Turned about the middle of its entrance; its entrance alone as well.
MapSlot turned(MapSlot slot, double sides_deg, double entrance_deg) {
  const auto about = [&](const Vector2d& p, double degrees) -> Vector2d {
    const double angle = degrees * M_PI / 180.0;
    const Vector2d d = p - slot.entrance();
    return slot.entrance() + Vector2d(std::cos(angle) * d.x() - std::sin(angle) * d.y(),
                                      std::sin(angle) * d.x() + std::cos(angle) * d.y());
  };
  const Vector2d in =
      about(slot.entrance() + slot.corners[3] - slot.corners[0], sides_deg) - slot.entrance();
  MapSlot result = slot;
  for (const std::size_t k : {0U, 1U}) {
    result.corners[k] = about(slot.corners[k], entrance_deg);
    result.corners[3 - k] = result.corners[k] + in;
  }
  return result;
}

TEST_F(Squaring, SlotsAFewDegreesOffAreTurnedToTheAxes) {
  garage_.told.push_back(turned(Garage::slotAt(2, 0), 4.0, 4.0));
  garage_.told.push_back(turned(Garage::slotAt(2, 2), 0.0, -6.0));
  garage_.told.push_back(turned(Garage::slotAt(3, 1), 0.5, 1.0));
  EXPECT_EQ(slot_rows::turnToAxes(garage_.told), (std::vector<std::size_t>{6, 7}));
  for (const auto& [index, place] : {std::pair{6, 0}, std::pair{7, 2}}) {
    const MapSlot& slot = garage_.told[static_cast<std::size_t>(index)];
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_LT((slot.corners[k] - Garage::slotAt(2, place).corners[k]).norm(), 0.03) << k;
  }
}

TEST_F(Squaring, ARowThatIsTurnedAsAWholeStays) {
  for (const int place : {0, 1, 2}) {
    garage_.told.push_back(turned(Garage::slotAt(2, place), 4.0, 4.0));
  }
  garage_.told.push_back(turned(Garage::slotAt(3, 0), 4.2, 3.8));
  EXPECT_TRUE(slot_rows::turnToAxes(garage_.told).empty());
}

TEST_F(Squaring, EntrancesAloneMakeNoTurnedRow) {
  for (const int place : {0, 1, 2}) {
    garage_.told.push_back(turned(Garage::slotAt(2, place), 0.2, 5.0));
  }
  garage_.told.push_back(turned(Garage::slotAt(3, 0), -0.1, 4.5));
  EXPECT_EQ(slot_rows::turnToAxes(garage_.told), (std::vector<std::size_t>{6, 7, 8, 9}));
}

TEST(SlotRow, OneMisreadCornerHardlyTurnsARow) {
  std::vector<MapSlot> told;
  for (int place = 0; place < 3; ++place) told.push_back(Garage::slotAt(0, place));
  told[0].corners[0].y() += 0.22;
  const std::vector<slot_rows::Row> rows = slot_rows::findRows(told);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_LT(std::abs(std::atan2(rows[0].u.y(), rows[0].u.x())), 0.3 * M_PI / 180.0);
  EXPECT_NEAR(rows[0].origin.y(), 0.0, 0.02);
}

}  // namespace
}  // namespace parkade
