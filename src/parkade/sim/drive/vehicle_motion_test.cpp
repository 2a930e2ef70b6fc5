// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/vehicle_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace parkade::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double flat(const Eigen::Vector2d& /*p*/) {
  return 0.0;
}

Path corner() {
  PathLeg leg;
  leg.vertices = {{0, 0}, {40, 0}, {40, 40}};
  return std::move(buildPath({leg})).value();
}

SuspensionOptions smoothRoad() {
  SuspensionOptions options;
  options.road_roughness = 0.0;
  return options;
}

TEST(VehicleMotion, DerivativesAreThoseOfThePose) {
  const Path path = corner();
  const SpeedProfile profile(path, {}, {}, {});
  const auto bumpy = [](const Eigen::Vector2d& p) {
    const double s = (p.x() - 20.0) / 0.2;
    return 0.02 * p.y() + (std::abs(s) < 1.0 ? 0.04 * std::pow(1 - s * s, 3) : 0.0);
  };
  const VehicleMotion motion(path, profile, bumpy, {});
  const double h = 1e-4;
  for (double t = 0.01; t < motion.duration() - 0.01; t += 0.0173) {
    const MotionState a = motion.at(t - h);
    const MotionState b = motion.at(t);
    const MotionState c = motion.at(t + h);
    EXPECT_NEAR((motion.pose(t).inverse() * b.T_world_vehicle).log().norm(), 0.0, 1e-12);
    const Eigen::Vector3d v =
        (c.T_world_vehicle.translation() - a.T_world_vehicle.translation()) / (2 * h);
    EXPECT_NEAR((v - b.velocity_world).norm(), 0.0, 1e-5);
    const Eigen::Vector3d accel = (c.velocity_world - a.velocity_world) / (2 * h);
    EXPECT_NEAR((accel - b.acceleration_world).norm(), 0.0, 1e-3);
    const Eigen::Vector3d w =
        (a.T_world_vehicle.rotation().inverse() * c.T_world_vehicle.rotation()).log() / (2 * h);
    EXPECT_NEAR((w - b.angular_velocity_body).norm(), 0.0, 1e-5);
    const Eigen::Vector3d dw = (c.angular_velocity_body - a.angular_velocity_body) / (2 * h);
    EXPECT_NEAR((dw - b.angular_acceleration_body).norm(), 0.0, 1e-3);
  }
}

TEST(VehicleMotion, AccelerationIsContinuous) {
  const Path path = corner();
  const SpeedProfile profile(path, {}, {}, {});
  const VehicleMotion motion(path, profile, flat, {});
  MotionState last = motion.at(0.0);
  for (double t = 0.001; t < motion.duration(); t += 0.001) {
    const MotionState now = motion.at(t);
    EXPECT_LT((now.acceleration_world - last.acceleration_world).norm(), 0.02);
    EXPECT_LT((now.angular_acceleration_body - last.angular_acceleration_body).norm(), 0.02);
    last = now;
  }
}

TEST(VehicleMotion, RestsWithItsOriginOnTheGround) {
  const Path path = corner();
  const SpeedProfile profile(path, {}, {}, {});
  const VehicleMotion motion(path, profile, flat, smoothRoad());
  EXPECT_NEAR(motion.pose(0.0).log().norm(), 0.0, 1e-9);
  const SE3 end = motion.pose(motion.duration());
  EXPECT_NEAR((end.translation() - Eigen::Vector3d(40, 40, 0)).norm(), 0.0, 1e-3);
  EXPECT_NEAR(end.rotation().yaw(), std::numbers::pi / 2, 1e-6);
}

TEST(VehicleMotion, TheRearAxleFollowsThePathWithoutSlip) {
  const Path path = corner();
  const SpeedProfile profile(path, {}, {}, {});
  const VehicleMotion motion(path, profile, flat, smoothRoad());
  for (double t = 0.0; t < motion.duration(); t += 0.05) {
    const MotionState state = motion.at(t);
    const PathPoint axle = path.at(profile.distance(t));
    // The body tilts about a point above the ground: some millimetres.
    EXPECT_NEAR((state.T_world_vehicle.translation().head<2>() - axle.position).norm(), 0.0, 0.008);
    EXPECT_NEAR(state.T_world_vehicle.rotation().yaw(), axle.heading, 1e-4);
  }
}

TEST(VehicleMotion, LeansOutwardsAndDivesAsTheGradientsSay) {
  const Path path = corner();
  const SpeedProfile profile(path, {}, {}, {});
  const VehicleMotion motion(path, profile, flat, smoothRoad());
  double roll = 0.0;
  double dive = 0.0;
  double squat = 0.0;
  for (double t = 0.0; t < motion.duration(); t += 0.05) {
    const Eigen::Vector3d angles = motion.pose(t).rotation().yawPitchRoll();
    roll = std::max(roll, angles[2]);
    dive = std::max(dive, angles[1]);
    squat = std::min(squat, angles[1]);
  }
  EXPECT_NEAR(roll, 5.0 * kDegree * 1.3 / 9.81, 0.25 * kDegree);  // left turn: right side down
  EXPECT_NEAR(dive, 2.0 * kDegree * 0.9 / 9.81, 0.08 * kDegree);
  EXPECT_NEAR(squat, -2.0 * kDegree * 0.9 / 9.81, 0.08 * kDegree);
}

TEST(VehicleMotion, FollowsASlopeAndTheStaticLoad) {
  PathLeg leg;
  leg.vertices = {{0, 0}, {60, 0}};
  const Path path = std::move(buildPath({leg})).value();
  const SpeedProfile profile(path, {}, {}, {});
  SuspensionOptions options = smoothRoad();
  options.static_pitch_deg = 0.5;
  options.static_roll_deg = -0.2;
  const VehicleMotion motion(
      path, profile, [](const Eigen::Vector2d& p) { return 0.05 * p.x(); }, options);
  const Eigen::Vector3d start = motion.pose(0.0).rotation().yawPitchRoll();
  EXPECT_NEAR(start[1], -0.05 + 0.5 * kDegree, 1e-3);
  EXPECT_NEAR(start[2], -0.2 * kDegree, 1e-6);
  EXPECT_NEAR(motion.pose(motion.duration()).translation().z(), 3.0, 0.03);
}

TEST(VehicleMotion, ASpeedBumpShakesTheBody) {
  PathLeg leg;
  leg.vertices = {{0, 0}, {30, 0}};
  const Path path = std::move(buildPath({leg})).value();
  const SpeedProfile profile(path, {}, {{0.0, 30.0, 2.0}}, {});
  const auto bump = [](const Eigen::Vector2d& p) {
    const double s = (p.x() - 15.0) / 0.175;
    return std::abs(s) < 1.0 ? 0.04 * std::pow(1 - s * s, 3) : 0.0;
  };
  const VehicleMotion motion(path, profile, bump, smoothRoad());
  double pitch = 0.0;
  double accel = 0.0;
  for (double t = 0.0; t < motion.duration(); t += 0.005) {
    pitch = std::max(pitch, std::abs(motion.pose(t).rotation().yawPitchRoll()[1]));
    accel = std::max(accel, std::abs(motion.at(t).acceleration_world.z()));
  }
  EXPECT_GT(pitch, 0.3 * kDegree);
  EXPECT_LT(pitch, 1.5 * kDegree);
  EXPECT_GT(accel, 0.5);
  EXPECT_LT(accel, 8.0);
}

TEST(WheelState, TurnsTheInnerWheelSlower) {
  const Path path = corner();
  const SpeedProfile profile(path, {}, {}, {});
  const SuspensionOptions options;
  double t = 0.0;
  while (std::abs(path.at(profile.distance(t)).heading - 0.8) > 0.02) t += 0.01;
  const WheelState state = wheelState(path, profile, flat, options, t);
  EXPECT_LT(state.rear_left, state.rear_right);
  EXPECT_NEAR(0.5 * (state.rear_left + state.rear_right), profile.speed(t), 1e-12);
  const double curvature = path.at(profile.distance(t)).curvature;
  EXPECT_NEAR((state.rear_right - state.rear_left) / options.track, profile.speed(t) * curvature,
              1e-12);
  EXPECT_NEAR(std::tan(state.steering) / options.wheelbase, curvature, 1e-12);
}

}  // namespace
}  // namespace parkade::sim
