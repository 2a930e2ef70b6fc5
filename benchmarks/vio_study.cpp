// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// The odometry on simulated tracks over many drives: error, consistency (mean NEES beside its 95 %
// chi-square band), time and memory. For example
//   parkade_vio_study --seeds 20
//   parkade_vio_study --length 5400 --seeds 1 --memory
#include <fmt/core.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "parkade/vio/track_simulator.hpp"

namespace parkade {
namespace {

struct Arguments {
  int first = 1;
  int seeds = 20;
  double length = 200.0;
  double pixel = 0.5;
  double start_speed = 0.0;
  bool no_imu_noise = false;
  bool memory = false;
  std::string rig = "surround";
  std::vector<std::string> sets;
};

// Wilson and Hilferty's approximation of the chi-square quantile at a normal deviate z.
double chiSquareQuantile(double degrees, double z) {
  const double c = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - c + z * std::sqrt(c), 3.0);
}

void printBand(const char* name, double mean, int dimensions, int runs) {
  const double degrees = static_cast<double>(dimensions) * runs;
  fmt::print("mean NEES of {:<9} {:.3f}, 95 % band {:.3f} to {:.3f}\n", name, mean,
             chiSquareQuantile(degrees, -1.96) / runs, chiSquareQuantile(degrees, 1.96) / runs);
}

double heapMb() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1048576.0;
}

// What the estimator itself holds while a drive goes on, the drive being in memory before.
void printMemory(const testing::SimulatedDrive& drive, VioEstimator& estimator) {
  const double before = heapMb();
  std::size_t next = 0;
  double minute = 0.0;
  std::size_t poses = 0;
  for (const TrackSet& tracks : drive.frames) {
    while (next < drive.imu.size() && drive.imu[next].t_ns <= tracks.t_ns) {
      estimator.addImu(drive.imu[next++]);
    }
    if (next < drive.imu.size()) estimator.addImu(drive.imu[next++]);
    (void)estimator.addTracks(tracks);
    ++poses;
    const double now = toSeconds(tracks.t_ns - drive.frames.front().t_ns) / 60.0;
    if (now < minute) continue;
    fmt::print("{:5.1f} min {:6d} frame sets {:8.2f} MB held\n", now, poses, heapMb() - before);
    std::fflush(stdout);
    minute += now < 3.0 ? 1.0 : 3.0;
  }
}

int study(const Arguments& arguments) {
  testing::TrackSimulatorOptions options;
  options.length = arguments.length;
  options.pixel_sigma = arguments.pixel;
  options.imu_noise = !arguments.no_imu_noise;
  options.start_speed = arguments.start_speed;
  if (options.start_speed > 0.0) options.initial_rest = 0.0;
  Rig rig = testing::surroundRig();
  if (arguments.rig != "surround") {
    rig = testing::stereoRig();
    if (arguments.rig == "mono") rig = *rig.subset({"cam0"});
    options.frame_rate = 20.0;
  }
  VioOptions vio;
  for (const std::string& set : arguments.sets) {
    if (const Status status = setOption(asOptions(vio), set); !status) {
      fmt::print(stderr, "{}\n", status.error().message);
      return 2;
    }
  }
  double position = 0.0;
  double yaw = 0.0;
  double drift = 0.0;
  double worst = 0.0;
  for (int seed = arguments.first; seed < arguments.first + arguments.seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    const testing::SimulatedDrive drive = simulateDrive(rig, options);
    VioEstimator estimator(drive.rig, vio);
    if (arguments.memory) {
      printMemory(drive, estimator);
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    const std::vector<PoseEstimate> estimates = runDrive(drive, estimator);
    const double spent =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const testing::DriveScore r = score(drive, estimates);
    const double percent = 100.0 * r.end_error / drive.distance;
    fmt::print(
        "seed {:3d}: {:.0f} m, {} of {} poses, first after {:.2f} s, rmse {:.4f} m, max {:.4f}, "
        "end {:.4f} ({:.3f} %), yaw max {:.3f} deg, vertical {:.3f} deg, NEES p {:.2f} yaw {:.2f}, "
        "{:.1f} ms per frame set\n",
        seed, drive.distance, r.poses, drive.frames.size(), r.first_pose, r.rmse, r.max_error,
        r.end_error, percent, r.max_yaw_error * 180.0 / M_PI, r.end_tilt_error * 180.0 / M_PI,
        r.mean_nees_position, r.mean_nees_yaw,
        1e3 * spent / static_cast<double>(drive.frames.size()));
    std::fflush(stdout);
    position += r.mean_nees_position / arguments.seeds;
    yaw += r.mean_nees_yaw / arguments.seeds;
    drift += percent / arguments.seeds;
    worst = std::max(worst, percent);
  }
  if (arguments.memory) return 0;
  printBand("position", position, 3, arguments.seeds);
  printBand("yaw", yaw, 1, arguments.seeds);
  fmt::print("error at the end {:.3f} % of the way in the mean, {:.3f} % at worst\n", drift, worst);
  return 0;
}

}  // namespace
}  // namespace parkade

int main(int argc, char** argv) {
  parkade::Arguments arguments;
  CLI::App app("Odometry on simulated tracks: error, consistency, time, memory");
  app.add_option("--seeds", arguments.seeds, "Drives")->check(CLI::Range(1, 10000));
  app.add_option("--first", arguments.first, "First seed");
  app.add_option("--length", arguments.length, "Length of a drive, m");
  app.add_option("--pixel", arguments.pixel, "Pixel noise, px");
  app.add_option("--start-speed", arguments.start_speed, "Begin in motion, m/s");
  app.add_flag("--no-imu-noise", arguments.no_imu_noise, "Exact readings");
  app.add_flag("--memory", arguments.memory, "Print what the estimator holds over time instead");
  app.add_option("--rig", arguments.rig, "surround, stereo or mono")
      ->check(CLI::IsMember({"surround", "stereo", "mono"}));
  app.add_option("--set", arguments.sets, "A vio option, as window.keyframes=8");
  CLI11_PARSE(app, argc, argv);
  return parkade::study(arguments);
}
