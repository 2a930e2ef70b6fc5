// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "parkade/vio/estimator.hpp"
#include "parkade/vio/track_simulator.hpp"

// Rest that no image vouches for.

namespace parkade {
namespace {

using testing::SimulatedDrive;
using testing::TrackSimulatorOptions;

// No images from some time after the first frame on.
void blindFrom(SimulatedDrive& drive, double begin) {
  for (TrackSet& frame : drive.frames) {
    const double t = toSeconds(frame.t_ns - drive.frames.front().t_ns);
    if (t < begin) continue;
    frame.observations.clear();
    std::fill(frame.camera_ok.begin(), frame.camera_ok.end(), std::uint8_t{0});
  }
}

TEST(DarkRest, EndsWhenTheCarLeavesGently) {
  TrackSimulatorOptions options;
  options.seed = 9;
  options.length = 8.0;
  options.initial_rest = 2.0;
  options.stops = {};
  options.max_jerk = 0.3;  // within half a second the readings hardly spread
  options.tracks_per_camera = 60;
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  blindFrom(drive, 1.0);
  VioEstimator estimator(drive.rig, VioOptions{});
  double worst = 0.0;
  int on_its_way = 0;
  for (const PoseEstimate& e : runDrive(drive, estimator)) {
    if (e.health == Health::kInitialising) continue;
    const Eigen::Vector3d truth = drive.truthAt(e.t_ns).translation();
    if (truth.norm() > 1.0) break;
    worst = std::max(worst, (e.T_odom_vehicle.translation() - truth).norm());
    if (truth.norm() < 0.3) continue;
    ++on_its_way;
    EXPECT_EQ(e.health, Health::kDegraded) << e.t_ns;
  }
  EXPECT_GT(on_its_way, 3);
  EXPECT_LT(worst, 0.15);
}

TEST(DarkRest, IsFoundWhereTheCarStopsUnseen) {
  TrackSimulatorOptions options;
  options.seed = 7;
  options.length = 8.0;
  options.stops = {};
  options.final_rest = 4.0;
  options.tracks_per_camera = 60;
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  const double end = toSeconds(drive.frames.back().t_ns - drive.frames.front().t_ns);
  blindFrom(drive, end - 5.5);
  VioEstimator estimator(drive.rig, VioOptions{});
  const auto estimates = runDrive(drive, estimator);
  EXPECT_TRUE(estimator.statistics().standstill);
  EXPECT_LT(estimates.back().velocity_odom.norm(), 0.01);
}

// Whether a car is held at rest, by time since the first frame, that stands for 3 s while its
// wheels say that it goes at `speed` (m/s) from 1.45 s on.
std::map<double, bool> restsBesideWheels(bool dark, double speed) {
  TrackSimulatorOptions options;
  options.length = 3.0;
  options.initial_rest = 3.0;
  options.stops = {};
  options.tracks_per_camera = 60;
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  if (dark) blindFrom(drive, 1.0);
  Rig rig = drive.rig;
  rig.vehicle = VehicleShape{};
  VioOptions vio;
  vio.use_wheel = true;
  VioEstimator estimator(rig, vio);
  std::map<double, bool> rests;
  std::size_t next = 0;
  for (const TrackSet& frame : drive.frames) {
    const double t = toSeconds(frame.t_ns - drive.frames.front().t_ns);
    if (t > 2.0) break;  // the car has not moved
    const double wheels = t < 1.45 ? 0.0 : speed;
    estimator.addWheel({frame.t_ns, wheels, wheels, std::numeric_limits<double>::quiet_NaN()});
    while (next < drive.imu.size() && drive.imu[next].t_ns < frame.t_ns + 5 * kNsPerMs) {
      estimator.addImu(drive.imu[next++]);
    }
    (void)estimator.addTracks(frame);
    if (t > 1.05) rests[t] = estimator.statistics().standstill;
  }
  return rests;
}

TEST(DarkRest, EndsWhereWheelsTurn) {
  for (const auto& [t, rests] : restsBesideWheels(true, 0.3)) EXPECT_EQ(rests, t < 1.45) << t;
}

// A camera may give its last picture again and again.
TEST(Rest, EndsWhereWheelsSurelyTurnWhateverPicturesSay) {
  for (const auto& [t, rests] : restsBesideWheels(false, 1.0)) EXPECT_EQ(rests, t < 1.45) << t;
  for (const auto& [t, rests] : restsBesideWheels(false, 0.05)) EXPECT_TRUE(rests) << t;
}

}  // namespace
}  // namespace parkade
