// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/dead_reckoning.hpp"

#include <gmock/gmock.h>

#include "parkade/core/random.hpp"
#include "parkade/geometry/se2.hpp"

namespace parkade {
namespace {

constexpr double kDegree = M_PI / 180.0;

struct Drive {
  double stand_s = 2.0;
  double drive_s = 30.0;
  double yaw_rate = 0.2;
  double scale = 1.0;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  double gyro_noise = 0.0;
  std::uint64_t seed = 1;
};

// Stands, then drives circles at 2 m/s; IMU at 200 Hz, wheels at 100 Hz, level.
SE2 truthAt(const Drive& d, double t) {
  const double s = std::max(0.0, t - d.stand_s);
  return SE2::exp({2.0 * s, 0.0, d.yaw_rate * s});
}

PoseEstimate run(const Drive& d, DeadReckoning& reckoning) {
  Random random(d.seed);
  const double end = d.stand_s + d.drive_s;
  const int count = static_cast<int>(std::lround(200.0 * end));
  PoseEstimate pose;
  for (int k = 0; k <= count; ++k) {
    const double t = k / 200.0;
    const bool moves = t > d.stand_s;
    const double yaw_rate = moves ? d.yaw_rate : 0.0;
    const double speed = moves ? 2.0 : 0.0;
    ImuSample imu;
    imu.t_ns = fromSeconds(t) + 1;
    imu.gyro = d.bias + Eigen::Vector3d(0.0, 0.0, yaw_rate);
    for (int i = 0; i < 3; ++i) imu.gyro[i] += d.gyro_noise * random.normal();
    imu.accel = {0.0, speed * yaw_rate, 9.81};
    reckoning.addImu(imu);
    if (k % 2 == 0) {
      WheelSample wheel;
      wheel.t_ns = imu.t_ns;
      wheel.rear_left_mps = wheel.rear_right_mps = speed * d.scale;
      reckoning.addWheel(wheel);
    }
    if (k % 20 == 0) pose = reckoning.poseAt(imu.t_ns);
  }
  return pose;
}

TEST(DeadReckoning, FollowsACircleExactlyWithoutNoise) {
  Drive d;
  d.bias = {0.01, -0.02, 0.005};
  DeadReckoning reckoning(SE3(), {});
  const PoseEstimate e = run(d, reckoning);
  ASSERT_EQ(e.health, Health::kTracking);
  const SE2 truth = truthAt(d, d.stand_s + d.drive_s);
  const SE2 found = SE2::fromSE3(e.T_odom_vehicle);
  // The step to 2 m/s lies between two wheel readings.
  EXPECT_LT((found.translation() - truth.translation()).norm(), 0.03);
  EXPECT_NEAR(wrapAngle(found.angle() - truth.angle()), 0.0, 2e-3);
  EXPECT_NEAR((e.bias_gyro - d.bias).norm(), 0.0, 1e-9);
}

TEST(DeadReckoning, IsHonestAboutBiasNoiseAndWheels) {
  double nees = 0.0;
  constexpr int kRuns = 40;
  for (int i = 0; i < kRuns; ++i) {
    Drive d;
    d.seed = 100 + static_cast<std::uint64_t>(i);
    Random random(d.seed);
    d.scale = 1.0 + 0.005 * random.normal();
    d.bias = 0.01 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    d.gyro_noise = 0.014 * kDegree * std::sqrt(200.0);
    DeadReckoning reckoning(SE3(), {});
    const PoseEstimate e = run(d, reckoning);
    const Eigen::Vector3d error =
        (SE2::fromSE3(e.T_odom_vehicle).inverse() * truthAt(d, d.stand_s + d.drive_s)).log();
    Eigen::Matrix3d P;
    constexpr int kAt[3] = {0, 1, 5};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) P(a, b) = e.covariance(kAt[a], kAt[b]);
    }
    nees += error.dot(P.inverse() * error) / kRuns;
  }
  EXPECT_LT(nees, 6.0);
  EXPECT_GT(nees, 0.3);
}

TEST(DeadReckoning, SaysWhatIsMissing) {
  DeadReckoning reckoning(SE3(), {});
  EXPECT_EQ(reckoning.poseAt(1).health, Health::kInitialising);
  ImuSample imu;
  imu.t_ns = 10;
  imu.accel.z() = 9.81;
  reckoning.addImu(imu);
  EXPECT_THAT(reckoning.poseAt(20).reason, testing::HasSubstr("wheel"));
}

TEST(DeadReckoning, WhatHappenedBeforeTheWheelsWereHeardIsNoStand) {
  DeadReckoning reckoning(SE3(), {});
  PoseEstimate pose;
  // A curve of 20 s; then the wheels are heard, stand first, and a straight follows.
  for (int k = 0; k <= 200 * 40; ++k) {
    const double t = k / 200.0;
    const double speed = t < 22.0 ? 0.0 : 2.0;
    ImuSample imu;
    imu.t_ns = fromSeconds(t) + 1;
    imu.gyro = {0.0, 0.0, t < 20.0 ? 0.2 : 0.0};
    imu.accel = {0.0, t < 20.0 ? 0.4 : 0.0, 9.81};
    reckoning.addImu(imu);
    if (t >= 20.0 && k % 2 == 0) {
      WheelSample wheel;
      wheel.t_ns = imu.t_ns;
      wheel.rear_left_mps = wheel.rear_right_mps = speed;
      reckoning.addWheel(wheel);
    }
    if (k % 20 == 0) pose = reckoning.poseAt(imu.t_ns);
  }
  ASSERT_EQ(pose.health, Health::kTracking);
  EXPECT_NEAR(pose.bias_gyro.norm(), 0.0, 1e-6);
  EXPECT_NEAR(SE2::fromSE3(pose.T_odom_vehicle).angle(), 0.0, 1e-4);
  EXPECT_NEAR(pose.T_odom_vehicle.translation().x(), 36.0, 0.1);
}

// The covariance of (x, y, yaw).
Eigen::Vector3d sigmasOf(const PoseEstimate& e) {
  return {std::sqrt(e.covariance(0, 0)), std::sqrt(e.covariance(1, 1)),
          std::sqrt(e.covariance(5, 5))};
}

TEST(DeadReckoning, ACarIsLostAndSaysSoWhileASensorIsSilent) {
  Drive d;
  DeadReckoning reckoning(SE3(), {});
  const PoseEstimate before = run(d, reckoning);
  const double end = d.stand_s + d.drive_s;
  PoseEstimate e;
  for (int k = 1; k <= 30; ++k) e = reckoning.poseAt(fromSeconds(end + 0.1 * k));
  EXPECT_EQ(e.health, Health::kLost);
  // It may have turned away and braked in these three seconds.
  EXPECT_GT(sigmasOf(e).z(), 1.0);
  EXPECT_GT(sigmasOf(e).head<2>().norm(), sigmasOf(before).head<2>().norm() + 3.0);
}

TEST(DeadReckoning, WheelsGoOnWhileTheInertialUnitIsSilent) {
  Drive d;
  DeadReckoning reckoning(SE3(), {});
  run(d, reckoning);
  const double end = d.stand_s + d.drive_s;
  PoseEstimate e;
  for (int k = 1; k <= 100; ++k) {
    WheelSample wheel;
    wheel.t_ns = fromSeconds(end + 0.01 * k);
    wheel.rear_left_mps = wheel.rear_right_mps = 2.0;
    reckoning.addWheel(wheel);
    if (k % 10 == 0) e = reckoning.poseAt(wheel.t_ns);
  }
  EXPECT_EQ(e.health, Health::kLost);
  EXPECT_THAT(e.reason, testing::HasSubstr("inertial unit"));
  EXPECT_GT(sigmasOf(e).z(), 0.4);
}

}  // namespace
}  // namespace parkade
