// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/reserved_slots.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

using testing::expectAt;
using testing::Garage;
using testing::kBay;
using testing::kDepth;

const Vector2d kMiddle(1.5 * kBay, 0.5 * kDepth);

// In the middle of the bay at kMiddle.
MapSlot wideSlot(double front) {
  MapSlot slot = Garage::slotAt(1, 0);
  const Vector2d left(kMiddle.x() - 0.5 * front, 0.0);
  const Vector2d right(kMiddle.x() + 0.5 * front, 0.0);
  slot.corners = {left, right, right + Vector2d(0.0, kDepth), left + Vector2d(0.0, kDepth)};
  return slot;
}

// Full bays, and one between them with a sign in its middle.
Garage withSign(const Vector2d& at) {
  Garage garage;
  garage.tell(0, {0, 1, 2});
  garage.tell(2, {0, 1, 2});
  garage.paintTold();
  garage.sign(at);
  return garage;
}

TEST(PaintedSigns, AreLargerThanNumbers) {
  Garage garage;
  EXPECT_TRUE(slot_rows::findPaintedSigns(garage.grid).empty());
  garage.number(Garage::slotAt(0, 0));
  EXPECT_TRUE(slot_rows::findPaintedSigns(garage.grid).empty());
  const Vector2d across_tiles(-0.03, 3.2);
  for (const Vector2d& at : {kMiddle, across_tiles}) garage.sign(at);
  const std::vector<Vector2d> signs = slot_rows::findPaintedSigns(garage.grid);
  ASSERT_EQ(signs.size(), 2U);
  for (const Vector2d& at : {kMiddle, across_tiles}) {
    EXPECT_LT(std::min((signs[0] - at).norm(), (signs[1] - at).norm()), 0.05);
  }
}

TEST(ReservedSlots, OneSignOneWideSlot) {
  const RowCompletion rows = withSign(kMiddle).complete();
  ASSERT_EQ(rows.added.size(), 1U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((rows.added[0].corners[k] - wideSlot(3.5).corners[k]).norm(), 0.06);
  }
  EXPECT_GT(rows.added[0].corner_sigma, RowCompletionOptions().corner_sigma_m);
}

TEST(ReservedSlots, PaintTellsHowWide) {
  for (const double front : {3.3, 3.9}) {
    Garage garage = withSign(kMiddle);
    garage.paint(wideSlot(front));
    const RowCompletion rows = garage.complete();
    ASSERT_EQ(rows.added.size(), 1U);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT((rows.added[0].corners[k] - wideSlot(front).corners[k]).norm(), 0.06);  // a cell
    }
  }
}

// Cars in all three, as if the bay held slots of the usual width: the sign lies amid two of them.
TEST(ReservedSlots, NoSlotHasASignAtItsSide) {
  const Vector2d between = Garage::slotAt(1, 1).corners[1] + Vector2d(0.0, 0.5 * kDepth);
  Garage garage = withSign(between);
  for (int place = 0; place < 3; ++place) garage.paint(Garage::slotAt(1, place));
  for (const MapSlot& slot : garage.complete().added) {
    const double off = std::abs(0.5 * (slot.corners[0] + slot.corners[1]).x() - between.x());
    EXPECT_TRUE(off < 0.21 || off > testing::kWidth) << off;  // about the sign, or clear of it
  }
}

TEST(ReservedSlots, LeavesSignsInTheAisleAlone) {
  EXPECT_TRUE(withSign(Vector2d(kMiddle.x(), -2.5)).complete().added.empty());
}

TEST(ReservedSlots, LeavesSlotsThatWereToldAlone) {
  Garage garage = withSign(kMiddle);
  garage.told.push_back(wideSlot(3.7));
  garage.paint(garage.told.back());
  const RowCompletion rows = garage.complete();
  EXPECT_TRUE(rows.added.empty());
  EXPECT_TRUE(rows.replaced.empty());
}

}  // namespace
}  // namespace parkade
