// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/slot_availability.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/layers/layer_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr auto fill = testing::fillLayer<GridLayer::kAvailability>;
constexpr auto at = testing::classAt<GridLayer::kAvailability>;

// Slanted by a metre over its depth.
MapSlot slotAt(double x, double probability_free) {
  MapSlot slot;
  slot.corners = {Vector2d(x, 0.0), Vector2d(x + 2.5, 0.0), Vector2d(x + 3.5, 5.0),
                  Vector2d(x + 1.0, 5.0)};
  slot.probability_free = probability_free;
  return slot;
}

TEST(SlotAvailability, FollowsTheSlotsWhereTheGroundWasSeen) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kFloor, {0.0, 0.0}, {2.5, 4.0});
  fill(grid, SemanticClass::kVehicle, {2.5, 0.0}, {9.0, 4.0});
  layDownAvailability({slotAt(0.0, 0.1), slotAt(2.5, 0.9), slotAt(5.0, 0.5)}, grid);
  EXPECT_EQ(at(grid, 1.25, 1.0), SemanticClass::kVehicle) << "occupied";
  EXPECT_EQ(at(grid, 3.75, 1.0), SemanticClass::kFloor) << "free";
  EXPECT_EQ(at(grid, 6.25, 1.0), SemanticClass::kVehicle) << "open: as it was";
  EXPECT_EQ(at(grid, 1.25, 0.2), SemanticClass::kFloor) << "near the entrance";
  EXPECT_EQ(at(grid, 0.35, 1.0), SemanticClass::kFloor) << "near the side";
  EXPECT_EQ(at(grid, 0.5, 3.9), SemanticClass::kFloor) << "beside the slanted slot";
  EXPECT_EQ(at(grid, 2.0, 4.5), SemanticClass::kUnknown) << "nobody saw that";
}

TEST(SlotAvailability, CellsAreAsSureAsTheSlots) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kVehicle, {0.0, 0.0}, {4.0, 5.0});
  layDownAvailability({slotAt(0.0, 0.8)}, grid);
  const GridCell cell = grid.at(GridLayer::kAvailability, grid.cellOf({1.5, 2.0}));
  EXPECT_EQ(cell.semantic_class, SemanticClass::kFloor);
  EXPECT_NEAR(cell.probability(), 0.8, 0.02);
}

}  // namespace
}  // namespace parkade
