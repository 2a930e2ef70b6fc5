// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Bays of a row that were not told, filled with slots.
#include <gtest/gtest.h>

#include <vector>

#include "parkade/mapping/slots/row_completion.hpp"
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

TEST(RowFilling, FillsABayThatShowsItsPaint) {
  Garage garage;
  garage.tell(0, {0, 1, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  for (const int place : {0, 2}) garage.paint(Garage::slotAt(1, place));
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 3U);
  for (int place = 0; place < 3; ++place) {
    expectAt(rows.added[static_cast<std::size_t>(place)], Garage::slotAt(1, place));
  }
}

// Between two bays of three; painted.
std::vector<MapSlot> paintTwoWideSlots(Garage& garage) {
  garage.tell(0, {0, 1, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  std::vector<MapSlot> wide;
  for (int place = 0; place < 2; ++place) {
    MapSlot slot = Garage::slotAt(1, 0);
    const double x = slot.corners[0].x() + 1.5 * kWidth * place;
    slot.corners = {Vector2d(x, 0.0), Vector2d(x + 1.5 * kWidth, 0.0),
                    Vector2d(x + 1.5 * kWidth, kDepth), Vector2d(x, kDepth)};
    wide.push_back(slot);
    garage.paint(slot);
  }
  return wide;
}

// Three slots of the row's width would fit as well, but a line goes in amid the second.
TEST(RowFilling, FillsABayWithTwoWideSlots) {
  Garage garage;
  const std::vector<MapSlot> wide = paintTwoWideSlots(garage);
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) expectAt(rows.added[i], wide[i]);
}

// Any gap is some wide slots wide: what lies where nobody looked may be something else.
TEST(RowFilling, WideSlotsMustBeSeen) {
  Garage garage;
  const std::vector<MapSlot> wide = paintTwoWideSlots(garage);
  for (const GridLayer layer : {GridLayer::kParkingLines, GridLayer::kAvailability}) {
    garage.fill(layer, SemanticClass::kUnknown, wide[1].corners[0] + Vector2d(0.2, -1.0),
                wide[1].corners[2] + Vector2d(-0.2, 1.0));
  }
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  expectAt(rows.added[0], wide[0]);
}

TEST(RowFilling, LeavesABareBayAlone) {
  Garage garage;
  garage.tell(0, {0, 1, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  EXPECT_TRUE(garage.complete().added.empty());
}

// Two that wait where an aisle crosses between bays full of slots: the third place would be a free
// one in plain sight without a line. Where one is painted it is a bay.
TEST(RowFilling, CarsInABareBayMakeNoSlots) {
  for (const bool has_paint : {true, false}) {
    Garage garage;
    garage.tell(0, {0, 1, 2});
    garage.tell(2, {0, 1, 2});
    garage.paintTold();
    for (const int place : {0, 1}) garage.park(Garage::slotAt(1, place));
    if (has_paint) garage.paint(Garage::slotAt(1, 2));
    EXPECT_EQ(garage.complete().added.size(), has_paint ? 3U : 0U);
  }
}

// Between bays full of slots a parked vehicle and one line are enough, beyond them not.
TEST(RowFilling, BelievesABayBetweenTwoOthersSooner) {
  for (const bool between : {true, false}) {
    Garage garage;
    garage.tell(0, {0, 1, 2});
    if (between) garage.tell(2, {0, 1, 2});
    garage.paintTold();
    MapSlot first = Garage::slotAt(1, 0);
    garage.park(first);
    garage.paintUpright(first.corners[1] + Vector2d(0.0, 0.5),
                        first.corners[1] + Vector2d(0.0, 3.0));
    EXPECT_EQ(garage.complete().added.size(), between ? 3U : 0U);
  }
}

// The same with a line over which the row behind is entered.
TEST(RowFilling, AnEntranceOfTheNextRowIsNoSide) {
  for (const bool has_next : {false, true}) {
    Garage garage;
    garage.tell(0, {0, 1, 2});
    garage.tell(2, {0, 1, 2});
    garage.paintTold();
    garage.park(Garage::slotAt(1, 1));
    const Vector2d from = Garage::slotAt(1, 2).corners[1] + Vector2d(0.0, 0.5);
    const Vector2d to = from + Vector2d(0.0, 3.6);
    garage.paintUpright(from, to);
    if (has_next) {
      MapSlot next = Garage::slotAt(3, 0);
      const Vector2d depth(2.3, 0.0);
      next.shape = SlotShape::kParallel;
      next.corners = {to, from, from + depth, to + depth};
      garage.told.push_back(next);
    }
    EXPECT_EQ(garage.complete().added.size(), has_next ? 0U : 3U);
  }
}

// The rest of a bay, with one parked vehicle and no paint, where the next bay holds slots as well.
TEST(RowFilling, BelievesTheRestOfABayBesideAnotherSooner) {
  for (const bool beside : {true, false}) {
    Garage garage;
    garage.tell(0, {0});
    if (beside) garage.tell(1, {0, 1, 2});
    garage.paintTold();
    garage.park(Garage::slotAt(0, 1));
    EXPECT_EQ(garage.complete().added.size(), beside ? 2U : 0U);
  }
}

// Next to a wide slot that stands alone a bay shows its outer lines and vehicles: two wide slots
// would fit as well.
TEST(RowFilling, UsualSlotsAreMoreLikelyThanWideOnes) {
  Garage garage;
  MapSlot wide = Garage::slotAt(0, 2);
  for (const std::size_t k : {0U, 3U}) wide.corners[k].x() -= 0.5 * kWidth;
  garage.told.push_back(wide);
  garage.tell(3, {0, 1, 2});
  garage.paintTold();
  const double left = kBay + kMargin;
  const double right = 2.0 * kBay - kMargin;
  for (const double x : {left, right}) garage.paintUpright({x, 0.0}, {x, kDepth});
  for (int place = 0; place < 3; ++place) garage.park(Garage::slotAt(1, place));
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 3U);
  for (int place = 0; place < 3; ++place) {
    expectAt(rows.added[static_cast<std::size_t>(place)], Garage::slotAt(1, place));
  }
}

}  // namespace
}  // namespace parkade
