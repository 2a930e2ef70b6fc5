// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/wheel_report.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

struct Readings {
  std::vector<WheelSample> wheels;
  std::vector<ImuSample> imu;
};

// 20 s of a car that goes faster and slower by up to `swing` m/s; the unit is turned by a quarter
// about the vertical and leans by 2 degrees.
const SO3 kVehicleImu = SO3::exp({0.0, 0.0, M_PI / 2.0});

Readings drive(double swing, double wheels_per_mps) {
  Random random(3);
  Readings readings;
  const double rate = 0.8;  // rad/s
  const Eigen::Vector3d gravity = SO3::exp({0.0, 0.035, 0.0}) * Eigen::Vector3d(0.0, 0.0, 9.81);
  for (TimeNs t_ns = 0; t_ns < 20 * kNsPerSecond; t_ns += 10 * kNsPerMs) {
    const double t = toSeconds(t_ns);
    const double speed = 4.0 + swing * std::sin(rate * t);
    const Eigen::Vector3d felt =
        gravity + Eigen::Vector3d(swing * rate * std::cos(rate * t), random.normal(), 0.0);
    readings.imu.push_back({t_ns, Eigen::Vector3d::Zero(), kVehicleImu.inverse() * felt});
    if (t_ns % (20 * kNsPerMs) != 0) continue;
    const double told = wheels_per_mps * (speed + 0.02 * random.normal());
    readings.wheels.push_back({t_ns, told, NAN, NAN});
  }
  return readings;
}

std::optional<Check> checkOf(const Readings& readings) {
  return checkWheelUnit(readings.wheels, readings.imu, kVehicleImu);
}

TEST(WheelReport, TellsSpeedAndWay) {
  WheelReport report;
  describeWheels(
      {{0, 2.0, 4.0, NAN}, {kNsPerSecond, NAN, -5.0, 0.1}, {2 * kNsPerSecond, NAN, NAN, NAN}},
      report);
  EXPECT_EQ(report.max_speed_mps, 5.0);
  EXPECT_EQ(report.distance_m, 5.0);
  EXPECT_TRUE(report.has_steering);
}

TEST(WheelReport, MetresASecondPass) {
  const auto check = checkOf(drive(2.0, 1.0));
  ASSERT_TRUE(check);
  EXPECT_EQ(check->mark, CheckMark::kPass) << check->detail;
}

TEST(WheelReport, OtherUnitsAndSignsAreSuspect) {
  for (const double unit : {3.6, 3.2, 1.0 / 3.6, -1.0}) {
    const auto check = checkOf(drive(2.0, unit));
    ASSERT_TRUE(check) << unit;
    EXPECT_EQ(check->mark, CheckMark::kWarn) << check->detail;
  }
}

TEST(WheelReport, NothingIsSaidOfACarThatHardlyAcceleratesOrOfGaps) {
  EXPECT_FALSE(checkOf(drive(0.05, 3.6)));
  Readings readings = drive(2.0, 3.6);
  EXPECT_FALSE(checkWheelUnit({}, readings.imu, kVehicleImu));
  EXPECT_FALSE(checkWheelUnit(readings.wheels, {}, kVehicleImu));
  for (WheelSample& sample : readings.wheels) sample.t_ns *= 100;
  for (ImuSample& sample : readings.imu) sample.t_ns *= 100;
  EXPECT_FALSE(checkOf(readings));
}

}  // namespace
}  // namespace parkade
