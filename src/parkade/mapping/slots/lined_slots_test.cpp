// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/lined_slots.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using testing::expectAt;
using testing::Garage;
using testing::kBay;
using testing::kDepth;
using testing::kMargin;
using testing::kWidth;
using testing::Vector2d;

constexpr double kWide = 3.3;

// Behind the last pillar, beside each other, where nothing bounds the row.
MapSlot wideSlot(int place) {
  MapSlot slot = Garage::slotAt(3, 0);
  const double x = 3 * kBay + kMargin + place * kWide;
  slot.corners = {Vector2d(x, 0.0), Vector2d(x + kWide, 0.0), Vector2d(x + kWide, kDepth),
                  Vector2d(x, kDepth)};
  return slot;
}

Garage fullBays() {
  Garage garage;
  garage.tell(1, {0, 1, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  return garage;
}

TEST(LinedSlots, WideOnesAtTheEndOfARow) {
  Garage garage = fullBays();
  for (const int place : {0, 1}) garage.paint(wideSlot(place));
  RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 2U);
  std::sort(rows.added.begin(), rows.added.end(),
            [](const MapSlot& a, const MapSlot& b) { return a.corners[0].x() < b.corners[0].x(); });
  for (const int place : {0, 1}) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT(
          (rows.added[static_cast<std::size_t>(place)].corners[k] - wideSlot(place).corners[k])
              .norm(),
          0.06);  // a cell
    }
  }
}

TEST(LinedSlots, LinesAsFarApartAsNoSlotIsWideBoundNone) {
  Garage garage = fullBays();
  MapSlot broad = wideSlot(0);
  for (const std::size_t k : {1, 2}) broad.corners[k].x() = broad.corners[0].x() + 5.6;
  garage.paint(broad);
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(LinedSlots, TwoLinesAloneBoundNone) {
  Garage garage = fullBays();
  garage.paint(wideSlot(0));
  garage.fill(GridLayer::kParkingLines, SemanticClass::kFloor,
              wideSlot(0).corners[0] - Vector2d(0.2, 0.2),
              wideSlot(0).corners[1] + Vector2d(0.2, 0.1));
  EXPECT_TRUE(garage.complete().added.empty());
  garage.park(wideSlot(0));
  EXPECT_EQ(garage.complete().added.size(), 1U);
}

const MapSlot kMissing = Garage::slotAt(1, 1);

// A slot between others whose entrance was taken for a lane line.
Garage withLaneAhead() {
  Garage garage;
  garage.tell(1, {0, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  garage.paint(kMissing);
  garage.fill(GridLayer::kParkingLines, SemanticClass::kLaneLine,
              kMissing.corners[0] + Vector2d(0.1, -0.1), kMissing.corners[1] + Vector2d(-0.1, 0.1));
  return garage;
}

TEST(LaneAhead, DeniesNoSlotThatHoldsAWheelStop) {
  Garage garage = withLaneAhead();
  EXPECT_TRUE(garage.complete().added.empty());
  garage.stop(kMissing);
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], kMissing);
}

// Closed all around, as slots along a wall are.
TEST(LaneAhead, DeniesNoSlotThatLinesBoundOnThreeSides) {
  Garage garage = withLaneAhead();
  garage.fill(GridLayer::kParkingLines, SemanticClass::kSlotLine,
              kMissing.corners[3] - Vector2d(0.0, 0.05), kMissing.corners[2] + Vector2d(0.0, 0.05));
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], kMissing);
}

}  // namespace
}  // namespace parkade
