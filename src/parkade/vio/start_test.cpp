// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "parkade/vio/estimator.hpp"
#include "parkade/vio/track_simulator.hpp"

namespace parkade {
namespace {

using testing::DriveScore;
using testing::SimulatedDrive;
using testing::TrackSimulatorOptions;

DriveScore startOf(double start_speed, double frame_rate, const VioOptions& vio) {
  TrackSimulatorOptions options;
  options.seed = 2;
  options.length = 6.0;
  options.stops = {};
  options.initial_rest = start_speed > 0.0 ? 0.0 : 2.0;
  options.start_speed = start_speed;
  options.frame_rate = frame_rate;
  options.tracks_per_camera = 60;
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  while (toSeconds(drive.frames.back().t_ns - drive.frames.front().t_ns) > 3.0) {
    drive.frames.pop_back();
  }
  VioEstimator estimator(drive.rig, vio);
  return score(drive, runDrive(drive, estimator));
}

TEST(VioStart, WaitsForALeastSpanAboveTheUsualOne) {
  VioOptions vio;
  vio.start_up.min_span_s = 1.0;  // max_span_s is 0.8
  const DriveScore score = startOf(1.5, 10.0, vio);
  EXPECT_GE(score.first_pose, 0.99);
  EXPECT_LE(score.first_pose, 2.0);
}

TEST(VioStart, TakesFewImagesASecond) {
  for (const double rate : {4.0, 7.7}) {
    const DriveScore score = startOf(1.5, rate, VioOptions{});
    EXPECT_GE(score.first_pose, 0.0) << rate;
    EXPECT_LE(score.first_pose, 2.5) << rate;
  }
}

TEST(VioStart, FromRestWithAShortWindowOfQuiet) {
  VioOptions vio;
  vio.standstill.window_s = 0.1;
  const DriveScore score = startOf(0.0, 10.0, vio);
  EXPECT_GE(score.first_pose, 0.0);
  EXPECT_LT(score.first_pose, vio.start_up.min_span_s);
}

TEST(VioStart, KeepsFewReadingsWhileItWaits) {
  VioEstimator estimator(testing::surroundRig(), VioOptions{});
  TimeNs t_ns = kNsPerSecond;
  for (int frame = 0; frame < 200; ++frame) {
    for (int k = 0; k < 20; ++k, t_ns += 5 * kNsPerMs) {
      estimator.addImu({t_ns, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.0, 9.81)});
    }
    TrackSet dark;
    dark.t_ns = t_ns - 6 * kNsPerMs;
    dark.camera_ok.assign(6, 0);
    EXPECT_EQ(estimator.addTracks(dark).health, Health::kInitialising);
  }
  EXPECT_GT(estimator.statistics().imu_readings, 400);
  EXPECT_LT(estimator.statistics().imu_readings, 600);
}

}  // namespace
}  // namespace parkade
