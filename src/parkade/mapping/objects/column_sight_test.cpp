// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/column_sight.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/mapping/objects/level_view_test_support.hpp"

namespace parkade {
namespace {

using testing::drawColumn;
using testing::emptyLevelView;

const Eigen::Vector2d kFoot(5.0, 1.0);

TEST(ColumnSight, TellsAPillarFromNone) {
  LevelView view = emptyLevelView();
  EXPECT_EQ(columnSight(view, kFoot), ColumnSight::kNotThere);
  drawColumn(view, kFoot, 0.35, SemanticClass::kPillar);
  EXPECT_EQ(columnSight(view, kFoot), ColumnSight::kThere);
  const Eigen::Vector2d across = Eigen::Vector2d(-kFoot.y(), kFoot.x()).normalized();
  EXPECT_EQ(columnSight(view, kFoot + 0.5 * across), ColumnSight::kThere);  // its place lies off
  EXPECT_EQ(columnSight(view, kFoot + 0.9 * across), ColumnSight::kNotThere);
  EXPECT_EQ(columnSight(view, kFoot - 0.9 * across), ColumnSight::kNotThere);
  drawColumn(view, kFoot, 0.35, SemanticClass::kZoneMarker, 1.0, 1.8);
  EXPECT_EQ(columnSight(view, kFoot), ColumnSight::kThere);
}

TEST(ColumnSight, WhatHidesSaysNothing) {
  LevelView view = emptyLevelView();
  drawColumn(view, kFoot, 0.35, SemanticClass::kPillar);
  drawColumn(view, kFoot, 2.0, SemanticClass::kVehicle, -0.5, 1.2);
  EXPECT_EQ(columnSight(view, kFoot), ColumnSight::kThere);  // its head is seen over the car
  drawColumn(view, kFoot, 2.0, SemanticClass::kVehicle);
  EXPECT_EQ(columnSight(view, kFoot), ColumnSight::kUnsure);
  view.labels.setTo(LevelView::kNotSeen);
  EXPECT_EQ(columnSight(view, kFoot), ColumnSight::kUnsure);
}

TEST(ColumnSight, NothingIsSaidTooNearOrTooFar) {
  const LevelView view = emptyLevelView();
  EXPECT_EQ(columnSight(view, {0.5, 0.0}), ColumnSight::kUnsure);
  EXPECT_EQ(columnSight(view, {10.5, 0.0}), ColumnSight::kUnsure);
  EXPECT_EQ(columnSight(view, {9.5, 0.0}), ColumnSight::kNotThere);
}

TEST(ColumnSight, WhatStandsInLine) {
  const Eigen::Vector2d eye(1.0, 0.0);
  EXPECT_TRUE(standsInLine({4.0, 0.3}, {7.0, 0.0}, eye));
  EXPECT_TRUE(standsInLine({7.0, 0.0}, {4.0, 0.3}, eye));    // behind
  EXPECT_FALSE(standsInLine({4.0, 0.8}, {7.0, 0.0}, eye));   // beside
  EXPECT_FALSE(standsInLine({6.8, 0.0}, {7.0, 0.0}, eye));   // the same place
  EXPECT_FALSE(standsInLine({-2.0, 0.0}, {7.0, 0.0}, eye));  // the other way
}

}  // namespace
}  // namespace parkade
