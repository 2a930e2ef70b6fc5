// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/bay_ends.hpp"

#include <gtest/gtest.h>

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

constexpr double kBetweenRears = 0.6;  // m
constexpr double kFront = 2 * kDepth + kBetweenRears;

// A known row, and behind it another one, entered from above, of which only the first slot's half
// next to the column at x = 0 is in sight: the car turned past there.
class TwoRows : public Garage {
 public:
  TwoRows() : Garage(kDepth) {
    for (const int bay : {0, 1, 2}) tell(bay, {0, 1, 2});
    MapObject pillar = objects.front();
    pillar.id = 10;
    pillar.position = {0.0, kFront - 1.2, 0.0};
    objects.push_back(pillar);
    const Vector2d from(-6.0, 4.0);
    const Vector2d to(kMargin + 0.6 * kWidth, kFront + 4.0);
    for (const GridLayer layer : {GridLayer::kParkingLines, GridLayer::kAvailability})
      fill(layer, SemanticClass::kFloor, from, to);
    paintTold();
  }

  static MapSlot hidden() {
    MapSlot slot;
    const double x = kMargin;
    slot.corners = {Vector2d(x + kWidth, kFront), Vector2d(x, kFront), Vector2d(x, kFront - kDepth),
                    Vector2d(x + kWidth, kFront - kDepth)};
    return slot;
  }
  void paintSide(double from, double to) {
    fill(GridLayer::kParkingLines, SemanticClass::kSlotLine, {kMargin - 0.05, from},
         {kMargin + 0.05, to});
  }
  void paintEntrance() {
    fill(GridLayer::kParkingLines, SemanticClass::kSlotLine, {kMargin, kFront - 0.05},
         {kMargin + 0.6 * kWidth, kFront + 0.05});
  }
};

TEST(BayEnds, FindsTheFirstSlotOfTheRowBehind) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  const RowCompletion rows = garage.complete();
  ASSERT_EQ(rows.added.size(), 1U);
  const MapSlot expected = TwoRows::hidden();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((rows.added[0].corners[k] - expected.corners[k]).norm(), 0.16) << "corner " << k;
  }
  EXPECT_EQ(rows.added[0].observations, 0);
  EXPECT_GT(rows.added[0].probability_free, 0.8);
  EXPECT_GE(rows.added[0].corner_sigma, 0.1);
}

TEST(BayEnds, OneSideAloneIsNotEnough) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, AWheelStopSpeaksForASlot) {
  TwoRows garage;
  for (const MapSlot& slot : garage.told) garage.stop(slot);
  garage.paintSide(kFront - kDepth, kFront);
  EXPECT_TRUE(garage.complete().added.empty());
  garage.stop(TwoRows::hidden());
  EXPECT_EQ(garage.complete().added.size(), 1U);
}

TEST(BayEnds, ABayIsFilledFromItsEndOn) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  MapObject pillar = garage.objects.back();
  pillar.id = 11;
  pillar.position.x() = 2.0 * kMargin + 2.0 * kWidth;
  garage.objects.push_back(pillar);
  MapSlot second = TwoRows::hidden();
  for (Vector2d& corner : second.corners) corner.x() += kWidth;
  garage.park(second);
  EXPECT_EQ(garage.complete().added.size(), 2U);
}

TEST(BayEnds, ALineThatGoesOnIsNoSide) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront + 3.0);
  garage.paintEntrance();
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, NobodyDrivesInThroughAnotherSlot) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  MapSlot ahead = Garage::slotAt(0, 0);
  ahead.id = 99;
  for (Vector2d& corner : ahead.corners) corner.y() += kFront + 0.5;
  garage.told.push_back(ahead);
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, TheOtherSideShowsWhereTheFloorIsInSight) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  for (const GridLayer layer : {GridLayer::kParkingLines, GridLayer::kAvailability}) {
    garage.fill(layer, SemanticClass::kFloor, {kMargin + 0.6 * kWidth, kFront - kDepth},
                {kMargin + 2.0 * kWidth, kFront + 4.0});
  }
  EXPECT_TRUE(garage.complete().added.empty());
}

TEST(BayEnds, NeedsToHaveSeenSuchSlotsBesideColumns) {
  TwoRows garage;
  garage.paintSide(kFront - kDepth, kFront);
  garage.paintEntrance();
  garage.objects.erase(garage.objects.begin(), garage.objects.end() - 1);
  EXPECT_TRUE(garage.complete().added.empty());
}

}  // namespace
}  // namespace parkade
