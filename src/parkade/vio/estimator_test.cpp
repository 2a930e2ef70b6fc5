// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/estimator.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

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
  VioEstimator estimator(drive.rig, VioOptions{});
  const auto start = std::chrono::steady_clock::now();
  const auto estimates = runDrive(drive, estimator);
  const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const DriveScore result = score(drive, estimates);
  fmt::print("frames {} poses {} first {:.2f} rmse {:.6f} max {:.6f} yaw {:.6f} ms/frame {:.1f}\n",
             drive.frames.size(), result.poses, result.first_pose, result.rmse, result.max_error,
             result.max_yaw_error, 1e3 * s / static_cast<double>(drive.frames.size()));
  EXPECT_LT(result.max_error, 1e-3);
  EXPECT_GE(result.poses, static_cast<int>(drive.frames.size()) - 3);
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
