// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/closed_slots.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using testing::Garage;

// Along the aisle across from the row, entered from it.
MapSlot acrossTheAisle() {
  MapSlot slot;
  slot.corners = {Vector2d(8.6, -6.0), Vector2d(2.0, -6.0), Vector2d(2.0, -8.4),
                  Vector2d(8.6, -8.4)};
  slot.shape = SlotShape::kParallel;
  return slot;
}

class ClosedSlots : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const int bay : {0, 1}) garage_.tell(bay, {0, 1, 2});
    garage_.paintTold();
    garage_.fill(GridLayer::kParkingLines, SemanticClass::kFloor, {-12.0, -9.0}, {36.0, -4.0});
  }
  void paintRear(const MapSlot& slot) {
    const auto& c = slot.corners;
    MapSlot turned;
    turned.corners = {c[2], c[3], c[0], c[1]};
    garage_.paint(turned);
  }
  [[nodiscard]] std::vector<MapSlot> added() const { return garage_.complete().added; }
  Garage garage_;
};

TEST_F(ClosedSlots, LinesOnAllSidesMakeASlotOfTheirOwn) {
  garage_.paint(acrossTheAisle());
  paintRear(acrossTheAisle());
  const std::vector<MapSlot> slots = added();
  ASSERT_EQ(slots.size(), 1U);
  EXPECT_EQ(slots[0].shape, SlotShape::kParallel);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((slots[0].corners[k] - acrossTheAisle().corners[k]).norm(), 0.06) << k;
  }
}

TEST_F(ClosedSlots, ThreeSidesAreNotEnough) {
  garage_.paint(acrossTheAisle());
  EXPECT_TRUE(added().empty());
}

TEST_F(ClosedSlots, MarkingsForWhoDrivesDenyIt) {
  garage_.paint(acrossTheAisle());
  paintRear(acrossTheAisle());
  garage_.fill(GridLayer::kRoadMarkers, SemanticClass::kArrow, {4.0, -7.5}, {6.5, -6.9});
  EXPECT_TRUE(added().empty());
}

TEST_F(ClosedSlots, WhatIsToldStays) {
  MapSlot told = acrossTheAisle();
  told.id = 90;
  told.observations = 20;
  told.corner_sigma = 0.02;
  garage_.paint(told);
  paintRear(told);
  garage_.told.push_back(told);
  EXPECT_TRUE(added().empty());
}

TEST_F(ClosedSlots, WiderOrShorterBoxesAreNone) {
  for (const Vector2d& size : {Vector2d(6.6, 3.6), Vector2d(4.4, 2.4)}) {
    MapSlot box;
    box.corners = {Vector2d(2.0 + size.x(), -5.2), Vector2d(2.0, -5.2),
                   Vector2d(2.0, -5.2 - size.y()), Vector2d(2.0 + size.x(), -5.2 - size.y())};
    garage_.paint(box);
    paintRear(box);
    EXPECT_TRUE(added().empty()) << size.transpose();
    garage_ = Garage();
    ClosedSlots::SetUp();
  }
}

}  // namespace
}  // namespace parkade
