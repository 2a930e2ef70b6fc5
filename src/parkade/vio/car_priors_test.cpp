// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "parkade/core/random.hpp"
#include "parkade/vio/track_simulator.hpp"

// What a car knows of its own motion: wheels, no side slip, a flat floor; from samples to the pose.

namespace parkade {
namespace {

using testing::DriveScore;
using testing::SimulatedDrive;
using testing::TrackSimulatorOptions;

constexpr double kTrack = 1.6;  // m

// Rear wheels at 100 Hz, in steps of 1/64 m/s and with a rolling radius wrong by 0.3 %.
std::vector<WheelSample> wheelsOf(const SimulatedDrive& drive) {
  std::vector<WheelSample> samples;
  const double h = 5e-3;
  for (TimeNs t = drive.frames.front().t_ns; t < drive.frames.back().t_ns; t += 10 * kNsPerMs) {
    const SE3 before = drive.truthAt(t - fromSeconds(h));
    const SE3 after = drive.truthAt(t + fromSeconds(h));
    const Vector6d motion = (before.inverse() * after).log() / (2.0 * h);
    const auto wheel = [&](double side) {
      const double speed = 1.003 * (motion(0) - side * 0.5 * kTrack * motion(5));
      return std::round(speed * 64.0) / 64.0;
    };
    samples.push_back({t, wheel(1.0), wheel(-1.0), std::nan("")});
  }
  return samples;
}

DriveScore run(const SimulatedDrive& drive, const VioOptions& options) {
  Rig rig = drive.rig;
  rig.vehicle = VehicleShape{};
  rig.vehicle->track = kTrack;
  VioEstimator estimator(rig, options);
  const std::vector<WheelSample> wheels = wheelsOf(drive);
  std::vector<PoseEstimate> estimates;
  std::size_t next_imu = 0;
  std::size_t next_wheel = 0;
  for (const TrackSet& frame : drive.frames) {
    while (next_wheel < wheels.size() && wheels[next_wheel].t_ns <= frame.t_ns) {
      estimator.addWheel(wheels[next_wheel++]);
    }
    while (next_imu < drive.imu.size()) {
      const TimeNs t = drive.imu[next_imu].t_ns;
      estimator.addImu(drive.imu[next_imu++]);
      if (t >= frame.t_ns) break;
    }
    estimates.push_back(estimator.addTracks(frame));
  }
  return score(drive, estimates);
}

TEST(CarPriors, WheelsTellASingleCameraItsScale) {
  // A forward camera at even speed sees no scale.
  TrackSimulatorOptions options;
  options.length = 60.0;
  options.stops = {};
  options.initial_rest = 0.0;
  options.start_speed = 3.0;
  options.frame_rate = 20.0;
  options.tracks_per_camera = 80;
  const SimulatedDrive drive = simulateDrive(*testing::stereoRig().subset({"cam0"}), options);
  VioOptions vio;
  const DriveScore without = run(drive, vio);
  vio.use_wheel = true;
  const DriveScore with = run(drive, vio);
  fmt::print("one camera: rmse {:.3f} m, with wheels {:.3f} m\n", without.rmse, with.rmse);
  EXPECT_LT(with.rmse, 0.1 * without.rmse);
  EXPECT_LT(with.end_error, 0.03 * drive.distance);
}

TEST(CarPriors, WheelsStartASingleCameraInMotion) {
  // The alignment of a few frames finds next to no speed here, in any direction.
  for (const std::uint64_t seed : {2, 4, 12}) {
    TrackSimulatorOptions options;
    options.seed = seed;
    options.length = 30.0;
    options.stops = {};
    options.initial_rest = 0.0;
    options.start_speed = 3.0;
    options.frame_rate = 20.0;
    options.tracks_per_camera = 80;
    VioOptions vio;
    vio.use_wheel = true;
    const DriveScore score =
        run(simulateDrive(*testing::stereoRig().subset({"cam0"}), options), vio);
    fmt::print("seed {}: rmse {:.3f} m\n", seed, score.rmse);
    EXPECT_LT(score.rmse, 0.3);
  }
}

TEST(CarPriors, HoldTheCarInTheDark) {
  TrackSimulatorOptions options;
  options.length = 50.0;
  options.stops = {};
  options.tracks_per_camera = 60;
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  // No images from 6 s on.
  for (TrackSet& frame : drive.frames) {
    if (toSeconds(frame.t_ns - drive.frames.front().t_ns) < 6.0) continue;
    frame.observations.clear();
    std::fill(frame.camera_ok.begin(), frame.camera_ok.end(), std::uint8_t{0});
  }
  VioOptions vio;
  vio.max_blind_s = 60.0;
  vio.use_no_side_slip = false;
  const DriveScore without = run(drive, vio);
  vio.use_wheel = true;
  vio.use_no_side_slip = true;
  vio.use_planar = true;
  const DriveScore with = run(drive, vio);
  fmt::print("dark: end {:.2f} m off, with car priors {:.2f} m\n", without.end_error,
             with.end_error);
  EXPECT_LT(with.end_error, 0.3 * without.end_error);
  EXPECT_LT(with.end_error, 0.02 * drive.distance);
}

}  // namespace
}  // namespace parkade
