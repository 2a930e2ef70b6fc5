// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/reading_buffer.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace parkade {
namespace {

ReadingBuffer ramp() {
  ReadingBuffer buffer;
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(buffer.add({i * 10, Eigen::Vector3d::Constant(i), Eigen::Vector3d::Constant(-i)}));
  }
  return buffer;
}

TEST(ReadingBuffer, InterpolatesBothEnds) {
  const auto cut = ramp().between(5, 32);
  ASSERT_EQ(cut.size(), 5U);
  EXPECT_EQ(cut.front().t_ns, 5);
  EXPECT_DOUBLE_EQ(cut.front().gyro.x(), 0.5);
  EXPECT_EQ(cut[1].t_ns, 10);
  EXPECT_EQ(cut.back().t_ns, 32);
  EXPECT_DOUBLE_EQ(cut.back().accel.y(), -3.2);
}

TEST(ReadingBuffer, StampsOnReadingsAreNotDoubled) {
  const auto cut = ramp().between(10, 30);
  ASSERT_EQ(cut.size(), 3U);
  EXPECT_EQ(cut[1].t_ns, 20);
}

TEST(ReadingBuffer, HoldsBeyondItsEnds) {
  const auto cut = ramp().between(-10, 60);
  ASSERT_EQ(cut.size(), 7U);
  EXPECT_DOUBLE_EQ(cut.front().gyro.x(), 0.0);
  EXPECT_DOUBLE_EQ(cut.back().gyro.x(), 4.0);
  EXPECT_TRUE(ReadingBuffer().between(0, 10).empty());
}

TEST(ReadingBuffer, GapStaysAGapWhenItIsCut) {
  ReadingBuffer buffer;
  (void)buffer.add({0, {}, {}});
  (void)buffer.add({10 * kNsPerMs, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  (void)buffer.add({510 * kNsPerMs, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  const TimeNs limit = 100 * kNsPerMs;
  const auto gapOf = [&](int begin_ms, int end_ms) {
    return buffer.sumBetween(begin_ms * kNsPerMs, end_ms * kNsPerMs, ImuNoise{}, ImuBias{}, limit)
        .gapDuration();
  };
  EXPECT_DOUBLE_EQ(gapOf(0, 10), 0.0);
  EXPECT_NEAR(gapOf(100, 150), 0.05, 1e-9);
  EXPECT_NEAR(gapOf(0, 110), 0.1, 1e-9);
  EXPECT_EQ(buffer.spacingAt(200 * kNsPerMs), 500 * kNsPerMs);
}

TEST(ReadingBuffer, RefusesStaleAndBrokenReadings) {
  ReadingBuffer buffer = ramp();
  EXPECT_FALSE(buffer.add({40, {}, {}}));
  EXPECT_FALSE(buffer.add({39, {}, {}}));
  Eigen::Vector3d broken = Eigen::Vector3d::Zero();
  broken.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(buffer.add({50, broken, Eigen::Vector3d::Zero()}));
  EXPECT_EQ(buffer.size(), 5U);
}

TEST(ReadingBuffer, KeepsWhatInterpolationStillNeeds) {
  ReadingBuffer buffer = ramp();
  buffer.dropBefore(25);
  EXPECT_EQ(buffer.firstTime(), 20);
  EXPECT_DOUBLE_EQ(buffer.at(25).gyro.x(), 2.5);
  buffer.dropBefore(1000);
  EXPECT_EQ(buffer.size(), 1U);
}

}  // namespace
}  // namespace parkade
