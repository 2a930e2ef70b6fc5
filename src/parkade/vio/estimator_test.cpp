// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/estimator.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "parkade/core/random.hpp"
#include "parkade/vio/track_simulator.hpp"

namespace parkade {
namespace {

using testing::DriveScore;
using testing::SimulatedDrive;
using testing::TrackSimulatorOptions;

TEST(VioEstimator, WithoutNoiseTheTrajectoryIsReproduced) {
  TrackSimulatorOptions options;
  options.length = 40.0;
  options.stops = {20.0};
  options.pixel_sigma = 0.0;
  options.imu_noise = false;
  const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  for (const bool standstill : {false, true}) {
    VioOptions vio;
    vio.standstill.enable = standstill;
    VioEstimator estimator(drive.rig, vio);
    const DriveScore result = score(drive, runDrive(drive, estimator));
    // Rest ends for the estimator once the car has moved by a fraction of a millimetre.
    EXPECT_LT(result.max_error, standstill ? 6e-4 : 1e-4) << standstill;
    EXPECT_GE(result.poses, static_cast<int>(drive.frames.size()) - (standstill ? 3 : 10));
  }
}

TEST(VioEstimator, IsConsistentOverManyDrives) {
  // 200 m with BMI088-like noise and 0.5 px; each mean NEES inside its 95 % chi-square band.
  constexpr int kSeeds = 6;
  constexpr double kLowPosition = 8.231 / kSeeds;    // chi-square of 18 at 0.025
  constexpr double kHighPosition = 31.526 / kSeeds;  // at 0.975
  constexpr double kLowYaw = 1.237 / kSeeds;         // of 6
  constexpr double kHighYaw = 14.449 / kSeeds;
  double position = 0.0;
  double yaw = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    TrackSimulatorOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    const SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
    VioEstimator estimator(drive.rig, VioOptions{});
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
  // The estimator believes a rig that is wrong by 0.2 deg and 5 mm.
  Rig wrong = drive.rig;
  Random random(5);
  const auto draw = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  };
  for (RigCamera& camera : wrong.cameras) {
    camera.T_vehicle_cam = camera.T_vehicle_cam * SE3(SO3::exp(3.5e-3 * draw()), 5e-3 * draw());
  }
  VioOptions vio;
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

TEST(VioEstimator, DISABLED_Explore) {
  const auto env = [](const char* name, double value) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atof(text) : value;
  };
  const char* rig_name = std::getenv("RIG");
  TrackSimulatorOptions options;
  options.length = env("LENGTH", 200.0);
  options.pixel_sigma = env("PIXEL", 0.5);
  options.imu_noise = env("IMU", 1.0) > 0.0;
  options.start_speed = env("SPEED", 0.0);
  options.initial_rest = options.start_speed > 0.0 ? 0.0 : env("REST", 1.0);
  Rig rig = testing::surroundRig();
  if (rig_name != nullptr && std::string(rig_name) == "stereo") {
    rig = testing::stereoRig();
    options.frame_rate = 20.0;
  } else if (rig_name != nullptr && std::string(rig_name) == "mono") {
    rig = *testing::stereoRig().subset({"cam0"});
    options.frame_rate = 20.0;
  }
  VioOptions vio;
  if (const char* sets = std::getenv("SET")) {
    std::string text = sets;
    std::size_t begin = 0;
    while (begin < text.size()) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const Status status = setOption(asOptions(vio), text.substr(begin, end - begin));
      if (!status) fmt::print("{}\n", status.error().message);
      begin = end + 1;
    }
  }
  double mean_position = 0.0;
  double mean_yaw = 0.0;
  double mean_end = 0.0;
  const int first = static_cast<int>(env("FIRST", 1.0));
  const int seeds = static_cast<int>(env("SEEDS", 1.0));
  for (int seed = first; seed < first + seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    const SimulatedDrive drive = simulateDrive(rig, options);
    VioEstimator estimator(drive.rig, vio);
    const auto start = std::chrono::steady_clock::now();
    std::vector<PoseEstimate> estimates = runDrive(drive, estimator);
    const double s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const DriveScore r = score(drive, estimates);
    double final_squared = 0.0;
    const Trajectory final_trajectory = estimator.finalTrajectory();
    for (const StampedPose& pose : final_trajectory) {
      final_squared +=
          (pose.T_world_body.translation() - drive.truthAt(pose.t_ns).translation()).squaredNorm();
    }
    fmt::print(
        "seed {} {:.0f} m frames {} poses {} first {:.2f} rmse {:.4f} final {:.4f} ({}) max {:.4f} "
        "end "
        "{:.4f} ({:.3f} %) yaw max {:.5f} end {:.5f} tilt {:.5f} nees p {:.2f} y {:.2f} end p "
        "{:.2f} y {:.2f} "
        "ms {:.1f}\n",
        seed, drive.distance, drive.frames.size(), r.poses, r.first_pose, r.rmse,
        std::sqrt(final_squared / static_cast<double>(final_trajectory.size())),
        final_trajectory.size(), r.max_error, r.end_error, 100.0 * r.end_error / drive.distance,
        r.max_yaw_error, r.end_yaw_error, r.end_tilt_error, r.mean_nees_position, r.mean_nees_yaw,
        r.end_nees_position, r.end_nees_yaw, 1e3 * s / static_cast<double>(drive.frames.size()));
    std::fflush(stdout);
    mean_position += r.mean_nees_position / seeds;
    mean_yaw += r.mean_nees_yaw / seeds;
    mean_end += r.end_error / drive.distance / seeds;
    if (std::getenv("DUMP") != nullptr) {
      for (std::size_t i = 0; i < estimates.size(); i += 5) {
        const PoseEstimate& e = estimates[i];
        const SE3 t = drive.truthAt(e.t_ns);
        fmt::print("{:.1f} {} v {:.2f} err {:.4f} {} {}\n",
                   toSeconds(e.t_ns - drive.frames.front().t_ns), toString(e.health),
                   e.velocity_odom.norm(),
                   (e.T_odom_vehicle.translation() - t.translation()).norm(),
                   std::sqrt(e.covariance.block<3, 3>(0, 0).trace()), e.reason);
      }
    }
  }
  fmt::print("mean nees position {:.3f} yaw {:.3f} end {:.3f} %\n", mean_position, mean_yaw,
             100.0 * mean_end);
}

}  // namespace
}  // namespace parkade
