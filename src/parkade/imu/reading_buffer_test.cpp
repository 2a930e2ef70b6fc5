// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/reading_buffer.hpp"

#include <gtest/gtest.h>

#include <functional>
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

TEST(ReadingBuffer, WhatIsHeldForLongIsAGap) {
  ReadingBuffer buffer;
  (void)buffer.add({0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  (void)buffer.add({10 * kNsPerMs, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  const auto gapOf = [&](int begin_ms, int end_ms) {
    return buffer
        .sumBetween(begin_ms * kNsPerMs, end_ms * kNsPerMs, ImuNoise{}, ImuBias{}, 100 * kNsPerMs)
        .gapDuration();
  };
  EXPECT_DOUBLE_EQ(gapOf(0, 100), 0.0);
  EXPECT_NEAR(gapOf(0, 160), 0.15, 1e-9);
  EXPECT_NEAR(gapOf(60, 160), 0.1, 1e-9);
}

TEST(ReadingBuffer, RefusesWhatNoVehicleDoes) {
  ReadingBuffer buffer = ramp();
  EXPECT_FALSE(buffer.add({50, Eigen::Vector3d::Zero(), {161.0, 0.0, 0.0}}));
  EXPECT_FALSE(buffer.add({50, {0.0, -36.0, 0.0}, Eigen::Vector3d::Zero()}));
  EXPECT_TRUE(buffer.add({50, {0.0, -34.0, 0.0}, {0.0, 0.0, 157.0}}));
}

TEST(ReadingBuffer, DropsSingleBrokenReadings) {
  ReadingBuffer buffer;
  const Eigen::Vector3d rest(0.0, 0.0, 9.81);
  const auto fill = [&](const std::function<Eigen::Vector3d(int)>& accel) {
    buffer = ReadingBuffer();
    for (int i = 0; i <= 60; ++i) {
      ASSERT_TRUE(buffer.add({i * 5 * kNsPerMs, Eigen::Vector3d::Zero(), accel(i)}));
    }
  };
  fill([&](int i) { return i == 30 ? Eigen::Vector3d(150.0, 0.0, 9.81) : rest; });
  EXPECT_EQ(buffer.dropSpikes(0, 100 * kNsPerMs), 0);
  EXPECT_EQ(buffer.dropSpikes(102 * kNsPerMs, 202 * kNsPerMs), 1);
  EXPECT_EQ(buffer.size(), 60U);
  EXPECT_DOUBLE_EQ(buffer.at(150 * kNsPerMs).accel.x(), 0.0);
  // What lasts is believed, and so is what a hard braking does.
  fill([&](int i) { return i > 30 ? Eigen::Vector3d(50.0, 0.0, 9.81) : rest; });
  EXPECT_EQ(buffer.dropSpikes(151 * kNsPerMs, 202 * kNsPerMs), 0);
  fill([&](int i) { return i == 30 ? Eigen::Vector3d(-12.0, 0.0, 9.81) : rest; });
  EXPECT_EQ(buffer.dropSpikes(102 * kNsPerMs, 202 * kNsPerMs), 0);
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

// Readings at 200 Hz of a car that shakes a little, with some of them changed.
int isolatedAmong(const std::function<void(int, ImuReading&)>& change, TimeNs step_ms = 5) {
  ReadingBuffer buffer;
  int dropped = 0;
  for (int i = 0; i < 400; ++i) {
    ImuReading reading;
    reading.t_ns = i * step_ms * kNsPerMs;
    reading.gyro = Eigen::Vector3d(0.0, 0.02 * (i % 3), 0.3);
    reading.accel = Eigen::Vector3d(0.5 * (i % 2), 0.0, 9.81);
    change(i, reading);
    EXPECT_TRUE(buffer.add(reading));
    if (buffer.dropIsolated()) ++dropped;
  }
  EXPECT_EQ(buffer.size(), 400U - static_cast<std::size_t>(dropped));
  return dropped;
}

TEST(ReadingBuffer, ReadingsThatStandApartAreForgotten) {
  EXPECT_EQ(isolatedAmong([](int, ImuReading&) {}), 0);
  const auto broken = [](int i, ImuReading& reading) {
    if (i == 100) reading.gyro.x() = -3.0;
    if (i == 200) reading.accel = Eigen::Vector3d(-60.0, 0.0, 0.0);
    if (i == 300) reading.gyro.setZero(), reading.accel.setZero();  // 9.81 m/s^2: a hard bump may
  };
  EXPECT_EQ(isolatedAmong(broken), 2);
  EXPECT_EQ(isolatedAmong(broken, 40), 0);  // too slow to tell
}

TEST(ReadingBuffer, StepsBumpsAndShakingStay) {
  EXPECT_EQ(isolatedAmong([](int i, ImuReading& r) { r.gyro.z() += i >= 200 ? 2.0 : 0.0; }), 0);
  const auto bump = [](int i, ImuReading& r) {
    if (i >= 200 && i < 204) r.accel.z() += i % 2 == 0 ? 40.0 : 30.0;
  };
  EXPECT_EQ(isolatedAmong(bump), 0);
  const auto drone = [](int i, ImuReading& r) { r.accel.z() += i % 4 == 0 ? 25.0 : 0.0; };
  EXPECT_LT(isolatedAmong(drone), 20);  // until it is known to be usual
}

}  // namespace
}  // namespace parkade
