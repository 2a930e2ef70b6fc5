// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "parkade/vio/estimator.hpp"
#include "parkade/vio/track_simulator.hpp"

// Readings that are broken or late, cameras that take turns.

namespace parkade {
namespace {

using testing::DriveScore;
using testing::SimulatedDrive;
using testing::TrackSimulatorOptions;

double sinceFirst(const SimulatedDrive& drive, TimeNs t_ns) {
  return toSeconds(t_ns - drive.frames.front().t_ns);
}

TrackSimulatorOptions shortWay() {
  TrackSimulatorOptions options;
  options.seed = 4;
  options.length = 14.0;
  options.stops = {};
  options.tracks_per_camera = 60;
  return options;
}

TEST(OddInput, ABrokenReadingIsLeftOut) {
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), shortWay());
  for (ImuSample& sample : drive.imu) {
    if (sinceFirst(drive, sample.t_ns) < 3.01) continue;
    sample.accel.x() = 150.0;  // 0.75 m/s
    sample.gyro.z() = 20.0;    // 0.1 rad
    break;
  }
  VioEstimator estimator(drive.rig, VioOptions{});
  const auto estimates = runDrive(drive, estimator);
  const DriveScore s = score(drive, estimates);
  EXPECT_LT(s.max_error, 0.15);
  EXPECT_EQ(estimates.back().health, Health::kTracking);
}

TEST(OddInput, ReadingsThatComeLateAreTakenIn) {
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), shortWay());
  VioEstimator estimator(drive.rig, VioOptions{});
  std::vector<PoseEstimate> estimates;
  std::size_t next = 0;
  for (const TrackSet& frame : drive.frames) {
    const double t = sinceFirst(drive, frame.t_ns);
    const bool late = t > 3.05 && t < 3.35;
    while (!late && next < drive.imu.size() && drive.imu[next].t_ns <= frame.t_ns) {
      estimator.addImu(drive.imu[next++]);
    }
    estimates.push_back(estimator.addTracks(frame));
    // The last reading is held for 0.1 s at most before it counts as missing.
    if (late) {
      EXPECT_EQ(estimates.back().health, Health::kDegraded) << t;
    } else if (t > 3.5) {
      EXPECT_EQ(estimates.back().health, Health::kTracking) << t;
    }
  }
  EXPECT_LT(score(drive, estimates).end_error, 0.15);
}

TEST(OddInput, CamerasThatTakeTurnsKeepALongWindow) {
  TrackSimulatorOptions options = shortWay();
  options.length = 10.0;
  options.max_speed = 1.5;
  options.frame_rate = 20.0;
  options.mean_lifetime = 80.0;
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    TrackSet& frame = drive.frames[i];
    const auto isAbsent = [&](std::size_t camera) { return camera % 2 != i % 2; };
    for (std::size_t c = 0; c < frame.camera_ok.size(); ++c) {
      if (isAbsent(c)) frame.camera_ok[c] = 0;
    }
    std::erase_if(frame.observations, [&](const TrackObservation& o) {
      return isAbsent(static_cast<std::size_t>(o.camera));
    });
  }
  while (drive.truthAt(drive.frames.back().t_ns).translation().norm() > 6.0) {
    drive.frames.pop_back();
  }
  VioEstimator estimator(drive.rig, VioOptions{});
  (void)runDrive(drive, estimator);
  // Fifteen frames of 0.05 s, were each a keyframe.
  EXPECT_GT(estimator.statistics().span_s, 1.5);
}

}  // namespace
}  // namespace parkade
