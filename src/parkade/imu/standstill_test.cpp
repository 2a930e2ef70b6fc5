// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/standstill.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

std::vector<ImuReading> stretch(double sway_rate, double sway_accel, std::uint64_t seed) {
  Random random(seed);
  const ImuNoise noise;
  const double root_rate = std::sqrt(200.0);
  std::vector<ImuReading> readings;
  for (int i = 0; i <= 100; ++i) {
    ImuReading r;
    r.t_ns = i * 5 * kNsPerMs;
    const double phase = std::sin(2.0 * i * 0.05);
    for (int axis = 0; axis < 3; ++axis) {
      r.gyro(axis) = 0.01 + noise.gyroscope_noise_density * root_rate * random.normal();
      r.accel(axis) = noise.accelerometer_noise_density * root_rate * random.normal();
    }
    r.gyro.z() += sway_rate * phase;
    r.accel.x() += sway_accel * phase;
    r.accel.z() += 9.81;
    readings.push_back(r);
  }
  return readings;
}

TEST(Stillness, RestIsQuietAndItsMeanIsTheBias) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const StillnessCheck check = checkStillness(stretch(0.0, 0.0, seed), ImuNoise{}, 2.0, 0.0, 0.0);
    EXPECT_TRUE(check.quiet) << seed;
    EXPECT_NEAR(check.mean_gyro.x(), 0.01, 0.002);
    EXPECT_NEAR(check.mean_accel.z(), 9.81, 0.02);
  }
}

TEST(Stillness, MotionIsNotQuiet) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    EXPECT_FALSE(checkStillness(stretch(0.02, 0.0, seed), ImuNoise{}, 2.0, 0.003, 0.05).quiet);
    EXPECT_FALSE(checkStillness(stretch(0.0, 0.3, seed), ImuNoise{}, 2.0, 0.003, 0.05).quiet);
  }
}

TEST(Stillness, EvenAccelerationIsQuietButNotRest) {
  const ImuNoise noise;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const StillnessCheck before = checkStillness(stretch(0.0, 0.0, seed), noise, 2.0, 0.003, 0.05);
    const RestReadings rest{before.mean_gyro, before.mean_accel, 0.0, 0.0};
    const StillnessCheck later =
        checkStillness(stretch(0.0, 0.0, seed + 100), noise, 2.0, 0.003, 0.05);
    EXPECT_TRUE(meansAreOfRest(later, rest, noise, 0.5, 10.0)) << seed;
    std::vector<ImuReading> driving = stretch(0.0, 0.0, seed + 100);
    for (ImuReading& reading : driving) reading.accel.x() += 0.1;
    const StillnessCheck moving = checkStillness(driving, noise, 2.0, 0.003, 0.05);
    EXPECT_TRUE(moving.quiet) << seed;
    EXPECT_FALSE(meansAreOfRest(moving, rest, noise, 0.5, 10.0)) << seed;
    RestReadings doubtful = rest;
    doubtful.accel_doubt = 0.15;
    EXPECT_TRUE(meansAreOfRest(moving, doubtful, noise, 0.5, 10.0)) << seed;
  }
}

TEST(Stillness, TooFewReadingsSayNothing) {
  const auto readings = stretch(0.0, 0.0, 1);
  const std::span<const ImuReading> few(readings.data(), 3);
  EXPECT_FALSE(checkStillness(few, ImuNoise{}, 2.0, 0.0, 0.0).quiet);
}

}  // namespace
}  // namespace parkade
