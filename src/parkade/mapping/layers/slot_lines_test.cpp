// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/slot_lines.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/layers/layer_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kWidth = 2.5;
constexpr double kDepth = 5.0;

constexpr auto fill = testing::fillLayer<GridLayer::kParkingLines>;
constexpr auto at = testing::classAt<GridLayer::kParkingLines>;

// Slots side by side, entrances along y = 0, rears at y = 5 m.
std::vector<MapSlot> rowOf(int count) {
  std::vector<MapSlot> slots;
  for (int k = 0; k < count; ++k) {
    MapSlot slot;
    slot.id = k;
    const double x = kWidth * k;
    slot.corners = {Vector2d(x, 0.0), Vector2d(x + kWidth, 0.0), Vector2d(x + kWidth, kDepth),
                    Vector2d(x, kDepth)};
    slots.push_back(slot);
  }
  return slots;
}

// Floor in sight up to 4.5 m; sides with even numbers show their line up to 4 m, others up to near.
LayeredGrid sidesOf(int slots, double near, double shift = 0.0) {
  LayeredGrid grid;
  fill(grid, SemanticClass::kFloor, {-1.0, -2.0}, {kWidth * slots + 1.0, 4.5});
  for (int k = 0; k <= slots; ++k) {
    const double x = kWidth * k + shift;
    fill(grid, SemanticClass::kSlotLine, {x - 0.05, 0.0}, {x + 0.05, k % 2 == 0 ? 4.0 : near});
  }
  return grid;
}

TEST(SlotLines, SidesGoOnAsFarAsThoseOfOtherSlotsDo) {
  LayeredGrid grid = sidesOf(12, 1.5);
  completeSlotLines(rowOf(12), grid);
  for (double y = 0.1; y < 3.9; y += 0.1)
    EXPECT_EQ(at(grid, 2.5, y), SemanticClass::kSlotLine) << y;
  EXPECT_EQ(at(grid, 2.5, 4.4), SemanticClass::kFloor) << "no slot shows a line there";
  EXPECT_EQ(at(grid, 2.5, 4.8), SemanticClass::kUnknown) << "nobody saw that";
  EXPECT_EQ(at(grid, 3.7, 2.0), SemanticClass::kFloor);
  EXPECT_EQ(at(grid, 3.7, 0.0), SemanticClass::kFloor) << "no slot shows a line along its entrance";
}

// All of it worn off, and of one entrance among painted ones.
TEST(SlotLines, ASlotHasSidesWhateverTheWearAndAnEntranceLineWhereItsRowHasOne) {
  LayeredGrid grid = sidesOf(20, 4.0);
  fill(grid, SemanticClass::kSlotLine, {0.0, -0.05}, {20 * kWidth, 0.05});
  fill(grid, SemanticClass::kFloor, {3 * kWidth - 0.2, 0.1}, {3 * kWidth + 0.2, 4.5});
  fill(grid, SemanticClass::kFloor, {7 * kWidth + 0.1, -0.1}, {8 * kWidth - 0.1, 0.1});
  completeSlotLines(rowOf(20), grid);
  EXPECT_EQ(at(grid, 3 * kWidth, 2.0), SemanticClass::kSlotLine);
  EXPECT_EQ(at(grid, 7.5 * kWidth, 0.0), SemanticClass::kSlotLine);
}

TEST(SlotLines, RearsFarAwayAreLinesWhereAFewOfTheirRowShowOne) {
  for (const int shown : {1, 3}) {
    LayeredGrid grid = sidesOf(12, 4.0);
    fill(grid, SemanticClass::kFloor, {-1.0, 4.5}, {12 * kWidth + 1.0, 5.4});
    fill(grid, SemanticClass::kSlotLine, {0.0, 4.95}, {shown * kWidth, 5.05});
    completeSlotLines(rowOf(12), grid);
    EXPECT_EQ(at(grid, 9.5 * kWidth, 5.0),
              shown == 3 ? SemanticClass::kSlotLine : SemanticClass::kFloor);
    EXPECT_EQ(at(grid, 9.5 * kWidth, 0.0), SemanticClass::kFloor);
  }
}

TEST(SlotLines, FollowTheLineAndNotTheSlot) {
  LayeredGrid grid = sidesOf(12, 1.5, 0.12);
  completeSlotLines(rowOf(12), grid);
  EXPECT_EQ(at(grid, 2.62, 3.0), SemanticClass::kSlotLine);
  EXPECT_EQ(at(grid, 2.48, 3.0), SemanticClass::kFloor);
}

TEST(SlotLines, BarsOfTAreNoLineAlongTheEntrance) {
  LayeredGrid grid = sidesOf(20, 4.0);
  for (int k = 0; k < 20; ++k) {
    const double x = kWidth * k;
    const bool closed = k < 10;
    fill(grid, SemanticClass::kSlotLine, {x, -0.05}, {x + (closed ? 1.8 : 0.3), 0.05});
    fill(grid, SemanticClass::kSlotLine, {x + kWidth - 0.3, -0.05}, {x + kWidth, 0.05});
  }
  completeSlotLines(rowOf(20), grid);
  EXPECT_EQ(at(grid, 2.0, 0.0), SemanticClass::kSlotLine) << "a closed one";
  EXPECT_EQ(at(grid, 15.5 * kWidth, 0.0), SemanticClass::kFloor) << "one with bars";
}

TEST(SlotLines, FewSlotsTeachNothing) {
  LayeredGrid grid = sidesOf(3, 1.5);
  const LayeredGrid before = grid;
  completeSlotLines(rowOf(3), grid);
  EXPECT_TRUE(grid == before);
  completeSlotLines({}, grid);
  EXPECT_TRUE(grid == before);
}

}  // namespace
}  // namespace parkade
