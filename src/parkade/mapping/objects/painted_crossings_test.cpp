// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/painted_crossings.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

// A floor of 20 x 12 m with a row of slots, which tells the axes.
class PaintedCrossings : public ::testing::Test {
 protected:
  PaintedCrossings() {
    for (int x = 0; x < 400; ++x) {
      for (int y = 0; y < 240; ++y) set({x, y}, SemanticClass::kFloor);
    }
    for (int place = 0; place < 6; ++place) {
      MapSlot slot = testing::Garage::slotAt(0, place);
      slot.id = place + 1;
      for (Vector2d& corner : slot.corners) corner.y() += 13.0;
      map.slots.push_back(slot);
    }
  }
  void set(const Vector2i& cell, SemanticClass c) {
    map.grid.set(GridLayer::kRoadMarkers, cell, c, 1.0F);
  }
  // Stripes of 0.45 x 2.4 m, 0.9 m apart, from x and y = 4 on; one in so many cells is worn.
  void paint(double from, int stripes, int worn = 1000) {
    for (int k = 0; k < stripes; ++k) {
      const int x0 = static_cast<int>(std::lround((from + 0.9 * k) / 0.05));
      for (int x = x0; x < x0 + 9; ++x) {
        for (int y = 80; y < 128; ++y) {
          if ((x + 7 * y) % worn != 0) set({x, y}, SemanticClass::kCrossing);
        }
      }
    }
  }
  void hideBeyond(double from) {
    for (int x = static_cast<int>(from / 0.05); x < 400; ++x) {
      for (int y = 0; y < 240; ++y) map.grid.forget(GridLayer::kRoadMarkers, {{x, y}});
    }
  }
  [[nodiscard]] SemanticClass at(const Vector2d& p) const {
    return map.grid.at(GridLayer::kRoadMarkers, map.grid.cellOf(p)).believed();
  }
  ParkingMap map;
};

TEST_F(PaintedCrossings, IsToldByItsStripes) {
  paint(3.0, 6);
  completeCrossings(map);
  ASSERT_EQ(map.objects.size(), 1U);
  const MapObject& crossing = map.objects.front();
  EXPECT_EQ(crossing.semantic_class, SemanticClass::kCrossing);
  EXPECT_EQ(crossing.observations, 0);
  EXPECT_EQ(crossing.id, 1);
  EXPECT_NEAR(crossing.position.x(), 3.0 + 0.5 * (5 * 0.9 + 0.45), 0.08);
  EXPECT_NEAR(crossing.position.y(), 5.2, 0.06);
  ASSERT_EQ(crossing.outline.size(), 4U);
}

TEST_F(PaintedCrossings, WornStripesAreDrawnAndNotWhatLiesBetween) {
  paint(3.0, 6);
  for (int x = 98; x < 101; ++x) {  // a gap in the third
    for (int y = 90; y < 110; ++y) set({x, y}, SemanticClass::kFloor);
  }
  completeCrossings(map);
  EXPECT_EQ(at({4.98, 5.0}), SemanticClass::kCrossing);
  EXPECT_EQ(at({5.5, 5.0}), SemanticClass::kFloor);
  EXPECT_EQ(at({4.98, 7.0}), SemanticClass::kFloor);
}

TEST_F(PaintedCrossings, IsNotToldAnewWhereAPictureToldIt) {
  paint(3.0, 6);
  completeCrossings(map);
  completeCrossings(map);
  EXPECT_EQ(map.objects.size(), 1U);
}

TEST_F(PaintedCrossings, HalfOfOneIsToldOnlyIfItIsAsWideAsOthers) {
  paint(13.0, 6);
  hideBeyond(14.8);  // two stripes are left in sight
  completeCrossings(map);
  EXPECT_TRUE(map.objects.empty());

  paint(13.0, 4);  // and four, of a garage whose other crossing has six
  hideBeyond(16.4);
  paint(2.0, 6);
  completeCrossings(map);
  ASSERT_EQ(map.objects.size(), 1U);
  EXPECT_LT(map.objects.front().position.x(), 8.0);
}

TEST_F(PaintedCrossings, AnAreaWithoutStripesIsNone) {
  for (int x = 60; x < 160; ++x) {
    for (int y = 80; y < 128; ++y) set({x, y}, SemanticClass::kCrossing);
  }
  completeCrossings(map);
  EXPECT_TRUE(map.objects.empty());
}

}  // namespace
}  // namespace parkade
