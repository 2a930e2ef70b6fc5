// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/estimator.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/random.hpp"
#include "parkade/vio/track_simulator.hpp"

namespace parkade {
namespace {

using testing::DriveScore;
using testing::SimulatedDrive;
using testing::TrackSimulatorOptions;

// A rig whose cameras are told wrong by as much about and along each axis, 1 sigma.
Rig disturbed(const Rig& rig, double rotation, double position, std::uint64_t seed) {
  Rig wrong = rig;
  Random random(seed);
  const auto draw = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  };
  for (RigCamera& camera : wrong.cameras) {
    camera.T_vehicle_cam =
        camera.T_vehicle_cam * SE3(SO3::exp(rotation * draw()), position * draw());
  }
  return wrong;
}

TEST(VioEstimator, WithoutNoiseTheTrajectoryIsReproduced) {
  TrackSimulatorOptions options;
  options.length = 40.0;
  options.stops = {20.0};
  options.pixel_sigma = 0.0;
  options.imu_noise = false;
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  for (const bool refine : {false, true}) {
    for (const bool standstill : {false, true}) {
      VioOptions vio;
      vio.standstill.enable = standstill;
      vio.calibration.refine_extrinsics = refine;
      VioEstimator estimator(drive.rig, vio);
      const DriveScore result = score(drive, runDrive(drive, estimator));
      // Rest ends for the estimator once the car has moved by a fraction of a millimetre. Where
      // cameras may move, the landmarks' weak prior pulls by about a millimetre.
      const double limit = refine ? 2e-3 : (standstill ? 6e-4 : 1e-4);
      EXPECT_LT(result.max_error, limit) << standstill << refine;
      EXPECT_GE(result.poses, static_cast<int>(drive.frames.size()) - (standstill ? 3 : 10));
    }
  }
}

TEST(VioEstimator, IsConsistentOverManyDrives) {
  // 200 m with BMI088-like noise and 0.5 px; each mean NEES inside its 95 % chi-square band.
#ifdef __SANITIZE_ADDRESS__
  constexpr int kSeeds = 1;               // the sanitizers take the time of many drives
  constexpr double kLowPosition = 0.216;  // chi-square of 3 at 0.025
  constexpr double kHighPosition = 9.348;
  constexpr double kLowYaw = 0.001;  // of 1
  constexpr double kHighYaw = 5.024;
#else
  constexpr int kSeeds = 6;
  constexpr double kLowPosition = 8.231 / kSeeds;    // chi-square of 18 at 0.025
  constexpr double kHighPosition = 31.526 / kSeeds;  // at 0.975
  constexpr double kLowYaw = 1.237 / kSeeds;         // of 6
  constexpr double kHighYaw = 14.449 / kSeeds;
#endif
  double position = 0.0;
  double yaw = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    TrackSimulatorOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
    VioOptions vio;
    vio.imu_noise_factor = 1.0;  // the simulated noise is the told one
    VioEstimator estimator(drive.rig, vio);
    const DriveScore result = score(drive, runDrive(drive, estimator));
    EXPECT_LT(result.end_error, 0.0015 * drive.distance) << seed;
    EXPECT_LT(result.end_tilt_error, 2e-3) << seed;
    position += result.mean_nees_position / kSeeds;
    yaw += result.mean_nees_yaw / kSeeds;
  }
  EXPECT_GT(position, kLowPosition);
  EXPECT_LT(position, kHighPosition);
  EXPECT_GT(yaw, kLowYaw);
  EXPECT_LT(yaw, kHighYaw);
}

TEST(VioEstimator, RefinesTheCalibrationWhileDriving) {
  TrackSimulatorOptions options;
  options.length = 60.0;
  options.stops = {20.0, 40.0};  // at even speed a delay looks like a shifted camera
  options.camera_delay = 0.004;
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  const Rig wrong = disturbed(drive.rig, 3.5e-3, 5e-3, 5);
  VioOptions vio;
  vio.calibration.refine_extrinsics = false;
  vio.calibration.refine_time_offset = false;
  vio.calibration.rotation_sigma_deg = 0.2;
  VioEstimator believing(wrong, vio);
  const DriveScore off = score(drive, runDrive(drive, believing));
  EXPECT_TRUE(believing.calibration().empty());
  vio.calibration.refine_extrinsics = true;
  vio.calibration.refine_time_offset = true;
  VioEstimator refining(wrong, vio);
  const DriveScore on = score(drive, runDrive(drive, refining));
  EXPECT_LT(on.rmse, 0.5 * off.rmse);
  const std::vector<CameraCalibrationEstimate> found = refining.calibration();
  ASSERT_EQ(found.size(), wrong.cameras.size());
  double before = 0.0;
  double after = 0.0;
  for (std::size_t c = 0; c < found.size(); ++c) {
    const SO3 truth = drive.rig.cameras[c].T_vehicle_cam.rotation();
    before += angleBetween(truth, wrong.cameras[c].T_vehicle_cam.rotation());
    after += angleBetween(truth, found[c].T_vehicle_cam.rotation());
    EXPECT_NEAR(found[c].time_offset, options.camera_delay, 3.5 * found[c].sigma(6)) << c;
    EXPECT_LT(found[c].sigma(6), 0.5 * vio.calibration.time_sigma) << c;
  }
  EXPECT_LT(after, 0.3 * before);
  fmt::print("rmse {:.4f} -> {:.4f} m, rotations off by {:.5f} -> {:.5f} rad in all\n", off.rmse,
             on.rmse, before, after);
}

TEST(VioEstimator, FollowsARollingShutterAndFindsHowLongItReads) {
  TrackSimulatorOptions options;
  options.length = 60.0;
  options.stops = {20.0, 40.0};
  constexpr double kReadout = 0.03;
  Rig rig = testing::surroundRig();
  for (RigCamera& camera : rig.cameras) camera.readout_time = kReadout;
  const SimulatedDrive drive = simulateDrive(rig, options);
  const auto drivenWith = [&](double readout_time, bool finds) {
    Rig told = rig;
    for (RigCamera& camera : told.cameras) camera.readout_time = readout_time;
    VioOptions vio;
    vio.imu_noise_factor = 1.0;  // the simulated noise is the told one
    VioEstimator estimator(told, vio);
    const DriveScore result = score(drive, runDrive(drive, estimator));
    for (const CameraCalibrationEstimate& camera : estimator.calibration()) {
      if (!finds) continue;
      EXPECT_NEAR(camera.readout_time, kReadout, 4.0 * camera.sigma(7));
      EXPECT_LT(camera.sigma(7), 0.3 * VioCalibrationOptions{}.readout_sigma);
    }
    return result;
  };
  const DriveScore known = drivenWith(kReadout, true);
  const DriveScore guessed = drivenWith(0.022, true);
  const DriveScore untold = drivenWith(0.0, false);
  fmt::print("rolling shutter told {:.4f} m, guessed {:.4f} m, not told {:.4f} m\n", known.rmse,
             guessed.rmse, untold.rmse);
  for (const DriveScore& result : {known, guessed}) {
    EXPECT_LT(result.end_error, 0.0015 * drive.distance);
    EXPECT_LT(result.mean_nees_position, 9.348);  // chi-square of 3 at 0.975
  }
  EXPECT_LT(known.rmse, 0.8 * untold.rmse);
}

// As a drive's rig does: where its pictures find nothing wrong it is not exact in what they do not
// show.
TEST(VioEstimator, SigmasThatTheRigTellsAreNotLearned) {
  TrackSimulatorOptions options;
  options.length = 25.0;
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  Rig told = drive.rig;
  for (RigCamera& camera : told.cameras) {
    camera.position_sigma = 0.003;
    camera.rotation_sigma = 3e-4;
  }
  VioEstimator learning(drive.rig, {});
  VioEstimator holding(told, {});
  EXPECT_DOUBLE_EQ(holding.calibration()[0].sigma(0), 0.003);
  EXPECT_DOUBLE_EQ(holding.calibration()[0].sigma(5), 3e-4);
  runDrive(drive, learning);
  runDrive(drive, holding);
  // Clocks are learned all the same; these are exact.
  for (const VioEstimator* estimator : {&learning, &holding}) {
    for (const CameraCalibrationEstimate& camera : estimator->calibration()) {
      EXPECT_LT(std::abs(camera.time_offset), 4.0 * camera.sigma(6));
      EXPECT_LT(camera.sigma(6), 0.2 * VioCalibrationOptions{}.time_sigma);
    }
  }
  EXPECT_GT(holding.rigSigma().length, 2.0 * learning.rigSigma().length);
  EXPECT_GT(holding.rigSigma().turn.minCoeff(), 1.3 * learning.rigSigma().turn.minCoeff());
  fmt::print("lengths {:.5f}, {:.5f}; turns {:.6f}, {:.6f} rad\n", holding.rigSigma().length,
             learning.rigSigma().length, holding.rigSigma().turn.minCoeff(),
             learning.rigSigma().turn.minCoeff());
}

TEST(VioEstimator, BearsAWrongCalibrationAndTellsHonestly) {
  // 0.1 deg and 5 mm, what a car's calibration is worth, against the same rig told exactly.
  constexpr int kSeeds = 4;
  constexpr double kHighPosition = 23.337 / kSeeds;  // chi-square of 12 at 0.975
  double exact = 0.0;
  double exact_believed = 0.0;
  double wrong = 0.0;
  double believed = 0.0;
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    TrackSimulatorOptions options;
    options.seed = seed;
    options.length = 60.0;
    options.stops = {};
    const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
    const Rig told = disturbed(drive.rig, 1.75e-3, 5e-3, 100 + seed);
    VioOptions vio;
    vio.calibration.refine_extrinsics = true;
    VioEstimator of_exact(drive.rig, vio);
    exact += score(drive, runDrive(drive, of_exact)).rmse / kSeeds;
    VioEstimator of_wrong(told, vio);
    const DriveScore result = score(drive, runDrive(drive, of_wrong));
    wrong += result.rmse / kSeeds;
    nees += result.mean_nees_position / kSeeds;
    vio.calibration.refine_extrinsics = false;
    VioEstimator believing_exact(drive.rig, vio);
    exact_believed += score(drive, runDrive(drive, believing_exact)).rmse / kSeeds;
    VioEstimator believing(told, vio);
    believed += score(drive, runDrive(drive, believing)).rmse / kSeeds;
  }
  fmt::print(
      "rmse {:.4f} m exact ({:.4f} m believed), {:.4f} m wrong (NEES {:.2f}), {:.4f} m wrong and "
      "believed\n",
      exact, exact_believed, wrong, nees, believed);
  EXPECT_LT(wrong, 0.5 * believed);
  EXPECT_LT(exact, 1.3 * exact_believed);  // an exact calibration is not given away
  EXPECT_LT(nees, kHighPosition);
}

}  // namespace
}  // namespace parkade
