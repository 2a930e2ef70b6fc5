// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "parkade/core/log.hpp"
#include "parkade/core/random.hpp"
#include "parkade/vio/estimator.hpp"
#include "parkade/vio/track_simulator.hpp"

// What may go wrong on the way; each drive is short, with noise, and must end near the truth.

namespace parkade {
namespace {

using testing::DriveScore;
using testing::SimulatedDrive;
using testing::TrackSimulatorOptions;

SimulatedDrive shortDrive(double length = 30.0, std::vector<double> stops = {},
                          std::uint64_t seed = 4) {
  TrackSimulatorOptions options;
  options.seed = seed;
  options.length = length;
  options.stops = std::move(stops);
  options.tracks_per_camera = 60;
  return simulateDrive(testing::surroundRig(), options);
}

double secondsOf(const SimulatedDrive& drive, TimeNs t_ns) {
  return toSeconds(t_ns - drive.frames.front().t_ns);
}

// Applies a change to the frames between two times after the first frame.
template <class Change>
void between(SimulatedDrive& drive, double begin, double end, const Change& change) {
  for (TrackSet& frame : drive.frames) {
    const double t = secondsOf(drive, frame.t_ns);
    if (t >= begin && t < end) change(frame);
  }
}

void darken(TrackSet& frame, int camera) {
  std::erase_if(frame.observations,
                [&](const TrackObservation& o) { return camera < 0 || o.camera == camera; });
  for (std::size_t c = 0; c < frame.camera_ok.size(); ++c) {
    if (camera < 0 || static_cast<int>(c) == camera) frame.camera_ok[c] = 0;
  }
}

// After the front end loses its images, what it finds later are new features.
void renameAfter(SimulatedDrive& drive, double when, int camera) {
  between(drive, when, 1e9, [&](TrackSet& frame) {
    for (TrackObservation& o : frame.observations) {
      if (camera < 0 || o.camera == camera) o.id += 1'000'000;
    }
  });
}

std::vector<PoseEstimate> run(const SimulatedDrive& drive) {
  VioEstimator estimator(drive.rig, VioOptions{});
  return runDrive(drive, estimator);
}

Health worstBetween(const SimulatedDrive& drive, const std::vector<PoseEstimate>& estimates,
                    double begin, double end) {
  Health worst = Health::kTracking;
  for (const PoseEstimate& e : estimates) {
    const double t = secondsOf(drive, e.t_ns);
    if (t >= begin && t < end && e.health > worst) worst = e.health;
  }
  return worst;
}

TEST(VioSurvival, OneCameraAfterAnotherGoesDark) {
  SimulatedDrive drive = shortDrive();
  for (int camera = 0; camera < 6; ++camera) {
    const double begin = 2.0 + 1.2 * camera;
    between(drive, begin, begin + 1.2, [&](TrackSet& f) { darken(f, camera); });
    renameAfter(drive, begin + 1.2, camera);
  }
  const auto estimates = run(drive);
  const DriveScore s = score(drive, estimates);
  EXPECT_LT(s.end_error, 0.15);
  EXPECT_EQ(worstBetween(drive, estimates, 2.0, 9.0), Health::kDegraded);
  EXPECT_EQ(estimates.back().health, Health::kTracking);
}

TEST(VioSurvival, CamerasDropSingleFrames) {
  SimulatedDrive drive = shortDrive();
  Random random(5);
  for (TrackSet& frame : drive.frames) {
    for (int camera = 0; camera < 6; ++camera) {
      if (random.chance(0.15)) darken(frame, camera);
    }
  }
  EXPECT_LT(score(drive, run(drive)).end_error, 0.15);
}

TEST(VioSurvival, FrameSetsAreMissingForTwoSeconds) {
  SimulatedDrive drive = shortDrive();
  const TimeNs first = drive.frames.front().t_ns;
  std::erase_if(drive.frames, [&](const TrackSet& f) {
    const double t = toSeconds(f.t_ns - first);
    return t > 5.0 && t < 7.0;
  });
  renameAfter(drive, 6.9, -1);
  const auto estimates = run(drive);
  EXPECT_LT(score(drive, estimates).end_error, 0.3);
  EXPECT_EQ(estimates.back().health, Health::kTracking);
}

TEST(VioSurvival, StaleFrameSetIsIgnored) {
  SimulatedDrive drive = shortDrive(5.0);
  VioEstimator estimator(drive.rig, VioOptions{});
  const auto estimates = runDrive(drive, estimator);
  const PoseEstimate again = estimator.addTracks(drive.frames[drive.frames.size() - 3]);
  EXPECT_EQ(again.t_ns, estimates.back().t_ns);
  EXPECT_EQ(again.T_odom_vehicle.translation(), estimates.back().T_odom_vehicle.translation());
}

TEST(VioSurvival, AllImagesBlackForThreeSecondsInMotion) {
  SimulatedDrive drive = shortDrive(40.0);
  between(drive, 8.0, 11.0, [](TrackSet& f) { darken(f, -1); });
  renameAfter(drive, 11.0, -1);
  const auto estimates = run(drive);
  double before = 0.0;
  double last_blind = 0.0;
  double error_blind = 0.0;
  for (const PoseEstimate& e : estimates) {
    const double t = secondsOf(drive, e.t_ns);
    const double sigma = std::sqrt(e.covariance.block<3, 3>(0, 0).trace());
    const double error =
        (e.T_odom_vehicle.translation() - drive.truthAt(e.t_ns).translation()).norm();
    if (t < 7.9) before = sigma;
    if (t > 8.2 && t < 11.0) {
      EXPECT_EQ(e.health, Health::kDegraded) << t;
      EXPECT_FALSE(e.reason.empty());
      EXPECT_LT(error, 6.0 * sigma + 0.1) << t;
      last_blind = sigma;
      error_blind = std::max(error_blind, error);
    }
  }
  EXPECT_GT(last_blind, before);
  EXPECT_LT(error_blind, 1.0);
  EXPECT_EQ(estimates.back().health, Health::kTracking);
  EXPECT_LT(score(drive, estimates).end_error, 1.0);
}

TEST(VioSurvival, ImuGapsUpToTheLimitAndBeyond) {
  for (const double gap : {0.08, 0.5}) {
    SimulatedDrive drive = shortDrive();
    const TimeNs first = drive.frames.front().t_ns;
    std::erase_if(drive.imu, [&](const ImuSample& s) {
      const double t = toSeconds(s.t_ns - first);
      return (t > 4.0 && t < 4.0 + gap) || (t > 7.0 && t < 7.0 + gap);
    });
    const auto estimates = run(drive);
    EXPECT_LT(score(drive, estimates).end_error, 0.2) << gap;
    EXPECT_EQ(worstBetween(drive, estimates, 4.0, 8.0),
              gap > 0.1 ? Health::kDegraded : Health::kTracking)
        << gap;
  }
}

TEST(VioSurvival, RecordingPausesForManySeconds) {
  for (const double pause : {6.0, 60.0, 600.0, 36000.0}) {
    SimulatedDrive drive = shortDrive();
    const TimeNs first = drive.frames.front().t_ns;
    const TimeNs later = fromSeconds(pause);
    const auto pauses = [&](auto& stamped) {
      for (auto& s : stamped) {
        if (toSeconds(s.t_ns - first) > 5.0) s.t_ns += later;
      }
    };
    // The car stands for a while and nobody records.
    pauses(drive.imu);
    pauses(drive.frames);
    renameAfter(drive, 5.0 + pause, -1);
    const auto estimates = run(drive);
    EXPECT_EQ(estimates.back().health, Health::kTracking) << pause;
    EXPECT_TRUE(estimates.back().T_odom_vehicle.translation().allFinite()) << pause;
  }
}

TEST(VioSurvival, FinalTrajectoryHasEveryFrameOfAShortStop) {
  for (const double stop : {0.4, 0.6, 0.8, 1.1, 1.5}) {
    TrackSimulatorOptions options;
    options.seed = 4;
    options.length = 16.0;
    options.stops = {8.0};
    options.stop_duration = stop;
    options.tracks_per_camera = 60;
    const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
    VioEstimator estimator(drive.rig, VioOptions{});
    const std::vector<PoseEstimate> estimates = runDrive(drive, estimator);
    const Trajectory last = estimator.finalTrajectory();
    std::size_t delivered = 0;
    for (const PoseEstimate& e : estimates) delivered += e.health != Health::kInitialising ? 1 : 0;
    EXPECT_GE(last.size(), delivered) << stop;
    std::size_t k = 0;
    for (const PoseEstimate& e : estimates) {
      if (e.health == Health::kInitialising) continue;
      while (k < last.size() && last[k].t_ns < e.t_ns) ++k;
      ASSERT_LT(k, last.size()) << stop;
      EXPECT_EQ(last[k].t_ns, e.t_ns) << stop;
    }
  }
}

TEST(VioSurvival, PassingCarFillsOneCamera) {
  // All features of one side camera move with a car that drives by: they agree with each other.
  SimulatedDrive drive = shortDrive();
  double shift = 0.0;
  between(drive, 5.0, 6.5, [&](TrackSet& frame) {
    shift += 7.0;
    for (TrackObservation& o : frame.observations) {
      if (o.camera == 1) o.pixel.x() += shift;
    }
    std::erase_if(frame.observations,
                  [](const TrackObservation& o) { return o.camera == 1 && o.pixel.x() > 636.0; });
  });
  renameAfter(drive, 6.5, 1);
  const auto estimates = run(drive);
  EXPECT_LT(score(drive, estimates).end_error, 0.15);
  EXPECT_EQ(estimates.back().health, Health::kTracking);
}

TEST(VioSurvival, ParkedCarStaysWhereItIs) {
  TrackSimulatorOptions options;
  options.seed = 6;
  options.length = 8.0;
  options.stops = {};
  options.final_rest = 62.0;
  options.tracks_per_camera = 40;
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  const auto estimates = run(drive);
  // The last 60 s lie within the rest.
  const TimeNs end = drive.frames.back().t_ns;
  const PoseEstimate* first = nullptr;
  double moved = 0.0;
  double turned = 0.0;
  for (const PoseEstimate& e : estimates) {
    if (toSeconds(end - e.t_ns) > 60.0) continue;
    if (first == nullptr) first = &e;
    moved = std::max(moved,
                     (e.T_odom_vehicle.translation() - first->T_odom_vehicle.translation()).norm());
    turned = std::max(turned,
                      angleBetween(e.T_odom_vehicle.rotation(), first->T_odom_vehicle.rotation()));
  }
  ASSERT_NE(first, nullptr);
  EXPECT_LT(moved, 0.01);
  EXPECT_LT(turned, 0.02 * std::numbers::pi / 180.0);
  EXPECT_EQ(estimates.back().health, Health::kTracking);
}

TEST(VioSurvival, ParkedCarInTheDarkStaysWhereItIs) {
  TrackSimulatorOptions options;
  options.seed = 7;
  options.length = 8.0;
  options.stops = {};
  options.final_rest = 20.0;
  options.tracks_per_camera = 40;
  SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  const double end = secondsOf(drive, drive.frames.back().t_ns);
  between(drive, end - 17.0, end + 1.0, [](TrackSet& f) { darken(f, -1); });
  const auto estimates = run(drive);
  const DriveScore s = score(drive, estimates);
  EXPECT_LT(s.end_error, 0.1);
  EXPECT_LT(estimates.back().velocity_odom.norm(), 0.01);
}

// Pixels at rest repeat to some hundredths; a car that sets off is noticed by their common shift.
TEST(VioSurvival, CarThatStartsToRollIsNoticed) {
  TrackSimulatorOptions options;
  options.seed = 9;
  options.length = 8.0;
  options.initial_rest = 2.0;
  options.stops = {};
  options.max_jerk = 0.3;  // the inertial unit feels nothing
  options.pixel_sigma = 0.05;
  options.tracks_per_camera = 60;
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  const auto lag = [&](double max_shift_px) {
    VioOptions vio;
    vio.standstill.max_shift_px = max_shift_px;
    VioEstimator estimator(drive.rig, vio);
    double worst = 0.0;
    for (const PoseEstimate& e : runDrive(drive, estimator)) {
      const Eigen::Vector3d true_place = drive.truthAt(e.t_ns).translation();
      if (true_place.norm() > 0.2) break;
      worst = std::max(worst, (e.T_odom_vehicle.translation() - true_place).norm());
    }
    return worst;
  };
  const double without = lag(20.0);  // px: the shift is never too large
  const double with = lag(VioStandstillOptions().max_shift_px);
  EXPECT_LT(with, 0.006);
  EXPECT_GT(without, 0.012);
}

TEST(VioSurvival, SameInputSameBytes) {
  const SimulatedDrive drive = shortDrive(10.0);
  const auto a = run(drive);
  const auto b = run(drive);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].T_odom_vehicle.matrix(), b[i].T_odom_vehicle.matrix()) << i;
    EXPECT_EQ(a[i].covariance, b[i].covariance) << i;
  }
}

TEST(VioSurvival, StartsInMotionWithinASecond) {
  TrackSimulatorOptions options;
  options.seed = 2;
  options.length = 15.0;
  options.stops = {};
  options.initial_rest = 0.0;
  options.start_speed = 1.5;
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  const auto estimates = run(drive);
  const DriveScore s = score(drive, estimates);
  EXPECT_GE(s.first_pose, 0.0);
  EXPECT_LE(s.first_pose, 1.0);
  EXPECT_LT(s.end_error, 0.15);
}

TEST(VioSurvival, PredictsTheNextFrame) {
  const SimulatedDrive drive = shortDrive(10.0);
  VioEstimator estimator(drive.rig, VioOptions{});
  const auto estimates = runDrive(drive, estimator);
  for (const ImuSample& s : drive.imu) estimator.addImu(s);
  const TimeNs previous = drive.frames.back().t_ns;
  const MotionPrior prior = estimator.predict(previous + 40 * kNsPerMs);
  ASSERT_TRUE(prior.valid);
  EXPECT_TRUE(prior.translation_valid);
  EXPECT_EQ(prior.previous_t_ns, previous);
  EXPECT_LT(prior.T_previous_current.translation().norm(), 0.01);
  EXPECT_GT(prior.p_previous.size(), 20U);
}

// By errors of so many rad/s and m/s^2, standard deviations.
void disturb(ImuSample& sample, double gyro, double accel, Random& random) {
  for (int axis = 0; axis < 3; ++axis) {
    sample.gyro(axis) += gyro * random.normal();
    sample.accel(axis) += accel * random.normal();
  }
}

// An inertial unit that is not as told: pictures must not be taken for wrong.
void expectDrivenWell(const SimulatedDrive& drive, const std::string& what,
                      double least_noise_factor = 1.0) {
  VioEstimator estimator(drive.rig, VioOptions{});
  const DriveScore s = score(drive, runDrive(drive, estimator));
  EXPECT_GE(estimator.statistics().imu_noise_factor, least_noise_factor) << what;
  EXPECT_LT(s.end_error, 0.25) << what;
  EXPECT_LT(s.mean_nees_position, 12.0) << what;
}

TEST(VioSurvival, InertialBiasesJump) {
  struct Jump {
    double gyro;   // deg/s
    double accel;  // m/s^2
  };
  for (const Jump& jump : {Jump{0.3, 0.1}, Jump{1.0, 0.0}, Jump{0.0, 0.1}, Jump{-0.1, 0.2}}) {
    SimulatedDrive drive = shortDrive(60.0);
    for (ImuSample& s : drive.imu) {
      if (secondsOf(drive, s.t_ns) < 6.0) continue;
      s.gyro += Eigen::Vector3d::Constant(jump.gyro * std::numbers::pi / 180.0);
      s.accel += Eigen::Vector3d::Constant(jump.accel);
    }
    expectDrivenWell(drive, fmt::format("{} deg/s, {} m/s^2", jump.gyro, jump.accel));
  }
}

TEST(VioSurvival, InertialUnitIsTenTimesNoisierThanTold) {
  SimulatedDrive drive = shortDrive(60.0);
  Random random(6);
  for (ImuSample& s : drive.imu) disturb(s, 0.02, 0.3, random);
  expectDrivenWell(drive, "noise", 3.0);
}

TEST(VioSurvival, InertialUnitSitsTurnedAndItsScaleIsWrong) {
  SimulatedDrive drive = shortDrive(60.0);
  const double turn = 2.0 * std::numbers::pi / 180.0;
  const SO3 turned = SO3::exp(Eigen::Vector3d(0.0, turn, turn));
  for (ImuSample& s : drive.imu) {
    s.gyro = 1.01 * (turned * s.gyro);
    s.accel = turned * s.accel;
  }
  expectDrivenWell(drive, "turned");
}

TEST(VioSurvival, SingleInertialReadingsAreBroken) {
  SimulatedDrive drive = shortDrive(60.0);
  Random random(7);
  for (ImuSample& s : drive.imu) {
    if (random.chance(0.005)) disturb(s, 3.0, 50.0, random);
  }
  expectDrivenWell(drive, "broken");
}

}  // namespace
}  // namespace parkade
