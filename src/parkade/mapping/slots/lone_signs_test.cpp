// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/lone_signs.hpp"

#include <gtest/gtest.h>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using testing::Garage;
using testing::kDepth;

constexpr double kFront = 3.6;  // m

// Known rows, and across their aisle a slot with a sign, in no row, entered from its row's side:
// what lies behind it nobody saw.
class AcrossTheAisle : public Garage {
 public:
  AcrossTheAisle() {
    for (const int bay : {0, 1, 2}) tell(bay, {0, 1, 2});
    fill(GridLayer::kParkingLines, SemanticClass::kFloor, {-12.0, kRear}, {36.0, 0.0});
    paintTold();
    sign(middle());
  }

  static Vector2d middle() { return {14.0, kEntrance - 0.5 * kDepth}; }
  static MapSlot slot() {
    MapSlot slot;
    const double left = middle().x() + 0.5 * kFront;
    const double right = middle().x() - 0.5 * kFront;
    slot.corners = {Vector2d(left, kEntrance), Vector2d(right, kEntrance), Vector2d(right, kRear),
                    Vector2d(left, kRear)};
    return slot;
  }
  void line(std::size_t from, std::size_t to) {
    const Vector2d a = slot().corners[from];
    const Vector2d b = slot().corners[to];
    const Vector2d half(0.05, 0.05);
    fill(GridLayer::kParkingLines, SemanticClass::kSlotLine, a.cwiseMin(b) - half,
         a.cwiseMax(b) + half);
  }

 private:
  static constexpr double kEntrance = -6.0;  // m
  static constexpr double kRear = kEntrance - kDepth;
};

TEST(LoneSigns, AnOutlinedSlotIsFoundWithoutARow) {
  AcrossTheAisle garage;
  for (const auto& [from, to] : {std::pair{0, 1}, {0, 3}, {1, 2}, {2, 3}}) garage.line(from, to);
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((rows.added[0].corners[k] - AcrossTheAisle::slot().corners[k]).norm(), 0.08)
        << "corner " << k;
  }
  EXPECT_EQ(rows.added[0].shape, SlotShape::kPerpendicular);
}

TEST(LoneSigns, ASideAndTheEntranceTellWhereItLies) {
  AcrossTheAisle garage;
  garage.line(0, 1);
  garage.line(0, 3);
  EXPECT_TRUE(garage.complete().added.empty());  // the other side is in sight, and bare
  garage.line(1, 2);
  EXPECT_EQ(garage.complete().added.size(), 1U);
}

TEST(LoneSigns, ASignWithoutLinesIsNone) {
  EXPECT_TRUE(AcrossTheAisle().complete().added.empty());
}

}  // namespace
}  // namespace parkade
