// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/sign_sight.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "parkade/mapping/objects/level_view_test_support.hpp"

namespace parkade {
namespace {

using testing::drawColumn;
using testing::emptyLevelView;

const Eigen::Vector3d kSign(5.0, 1.0, 2.2);
constexpr auto kGuide = SemanticClass::kGuideSign;

TEST(SignSight, TellsASignFromNone) {
  LevelView view = emptyLevelView();
  EXPECT_EQ(signSight(view, kSign, kGuide), ColumnSight::kNotThere);
  drawColumn(view, kSign.head<2>(), 0.8, kGuide, 2.0, 2.4);
  EXPECT_EQ(signSight(view, kSign, kGuide), ColumnSight::kThere);
  EXPECT_EQ(signSight(view, kSign, SemanticClass::kSpeedLimitSign), ColumnSight::kUnsure);
  EXPECT_EQ(signSight(view, kSign - Eigen::Vector3d(0.0, 0.0, 0.8), kGuide),
            ColumnSight::kNotThere);
  EXPECT_EQ(signSight(view, kSign + Eigen::Vector3d(0.0, 1.6, 0.0), kGuide),
            ColumnSight::kNotThere);
}

TEST(SignSight, WhatMayHideItSaysNothing) {
  LevelView view = emptyLevelView();
  drawColumn(view, kSign.head<2>(), 0.35, SemanticClass::kPillar);
  EXPECT_EQ(signSight(view, kSign, kGuide), ColumnSight::kUnsure);
  view.labels.setTo(LevelView::kNotSeen);
  EXPECT_EQ(signSight(view, kSign, kGuide), ColumnSight::kUnsure);
}

TEST(SignSight, NothingIsSaidTooNearOrTooFar) {
  const LevelView view = emptyLevelView();
  EXPECT_EQ(signSight(view, {0.8, 0.0, 1.5}, kGuide), ColumnSight::kUnsure);
  EXPECT_EQ(signSight(view, {9.5, 0.0, 2.2}, kGuide), ColumnSight::kUnsure);
  EXPECT_EQ(signSight(view, {8.5, 0.0, 2.2}, kGuide), ColumnSight::kNotThere);
}

TEST(SignSight, AFarOneMayBeSeenButIsNotMissed) {
  for (const auto& [distance, sight] :
       {std::pair(11.0, ColumnSight::kThere), {13.0, ColumnSight::kUnsure}}) {
    LevelView view = emptyLevelView();
    const Eigen::Vector3d p(distance, 0.0, 2.2);
    EXPECT_EQ(signSight(view, p, kGuide), ColumnSight::kUnsure);
    drawColumn(view, p.head<2>(), 0.8, kGuide, 2.0, 2.4);
    EXPECT_EQ(signSight(view, p, kGuide), sight);
  }
}

}  // namespace
}  // namespace parkade
