// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/frame_join.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace parkade {
namespace {

using testing::ElementsAre;

TEST(FrameJoin, JoinsWithinTheToleranceAndLeavesHolesOtherwise) {
  // Camera 1 lacks its image at 200; at 300 it is 6 late, beyond the tolerance.
  const auto frames = joinFrames({{100, 200, 300, 400}, {104, 306, 398}}, 5);
  ASSERT_TRUE(frames.ok());
  ASSERT_EQ(frames->size(), 5u);
  EXPECT_THAT((*frames)[0].images, ElementsAre(0, 0));
  EXPECT_EQ((*frames)[0].t_ns, 102);
  EXPECT_THAT((*frames)[1].images, ElementsAre(1, -1));
  EXPECT_THAT((*frames)[2].images, ElementsAre(2, -1));
  EXPECT_THAT((*frames)[3].images, ElementsAre(-1, 1));
  EXPECT_EQ((*frames)[3].t_ns, 306);
  EXPECT_THAT((*frames)[4].images, ElementsAre(3, 2));
  EXPECT_EQ((*frames)[4].t_ns, 399);
}

TEST(FrameJoin, RefusesAToleranceAboveHalfThePeriod) {
  const auto frames = joinFrames({{0, 10, 20}, {0, 100, 200}}, 6);
  ASSERT_FALSE(frames.ok());
  EXPECT_THAT(frames.error().message, testing::HasSubstr("more than half the frame period"));
  EXPECT_TRUE(joinFrames({{0, 10, 20}, {0, 100, 200}}, 5).ok());
}

TEST(FrameJoin, UsualToleranceSuitsFastCameras) {
  const TimeNs ms = kNsPerMs;
  EXPECT_EQ(usualJoinTolerance({}), 5 * ms);
  EXPECT_EQ(usualJoinTolerance({{0, 100 * ms, 200 * ms}, {7}}), 5 * ms);
  EXPECT_EQ(usualJoinTolerance({{0, 100 * ms, 200 * ms}, {0, 4 * ms, 8 * ms}}), 2 * ms);
}

TEST(FrameJoin, StampsNeverGoBack) {
  // A jittering camera: 0 joins 5 of the other, the mean 2 lies after the lone image at 1.
  const auto frames = joinFrames({{0, 1, 50, 100, 150}, {5, 55, 105, 155}}, 5);
  ASSERT_TRUE(frames.ok());
  for (std::size_t i = 1; i < frames->size(); ++i) {
    EXPECT_LE((*frames)[i - 1].t_ns, (*frames)[i].t_ns);
  }
}

TEST(FrameJoin, TakesCamerasWithoutImages) {
  EXPECT_TRUE(joinFrames({}, 5)->empty());
  EXPECT_EQ(joinFrames({{}, {1, 20}}, 5)->size(), 2u);
}

}  // namespace
}  // namespace parkade
