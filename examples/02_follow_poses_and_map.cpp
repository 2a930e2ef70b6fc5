// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Follows a drive while it happens: a pose with its uncertainty and health per frame set, and the
// map at the end, saved to a file. The garage is simulated in memory; a recorded folder or one's
// own SensorSource (01_feed_a_source) works the same.
//
//   02_follow_poses_and_map MAP.DB [SECONDS]
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>

#include "parkade/mapping/storage/map_file.hpp"
#include "parkade/pipeline/mapping_run.hpp"
#include "parkade/sim/drive/frame_renderer.hpp"

namespace {

using namespace parkade;

/// Prints a line per second of drive. onPose comes from a thread of the run: be brief there.
class PosePrinter : public PipelineObserver {
 public:
  void onPose(const PoseEvent& event) override {
    const PoseEstimate& e = event.estimate;
    constexpr double kPeriod = 1.0;
    if (e.health == Health::kInitialising || toSeconds(e.t_ns - last_ns_) < kPeriod) return;
    last_ns_ = e.t_ns;
    const Eigen::Vector3d p = e.T_odom_vehicle.translation();
    const double sigma = std::sqrt(e.covariance.topLeftCorner<2, 2>().trace());
    fmt::print("x {:7.2f} m  y {:7.2f} m  +- {:.3f} m  {:4.1f} km/h  {}{}\n", p.x(), p.y(), sigma,
               3.6 * e.velocity_odom.norm(), toString(e.health),
               e.reason.empty() ? "" : ": " + e.reason);
  }

 private:
  TimeNs last_ns_ = 0;
};

int fail(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: {} MAP.DB [SECONDS]\n", argv[0]);
    return 2;
  }
  sim::SimSourceOptions options;
  options.duration = argc > 2 ? std::atof(argv[2]) : 20.0;
  auto source = sim::openSimSource("sim:random/random?garage_seed=7&fast=true", options);
  if (!source) return fail(source.error());

  constexpr int kThreads = 2;
  auto run = MappingRun::create((*source)->rig(), PipelineOptions{}, kThreads, RunMethod::kFused);
  if (!run) return fail(run.error());
  PosePrinter printer;
  (*run)->addObserver(&printer);
  if (const Status done = (*run)->run(**source); !done) return fail(done.error());

  ParkingMap map = (*run)->mapper()->map("example");
  auto file = MapFile::open(argv[1]);
  if (!file) return fail(file.error());
  if (const Status saved = file->save(map); !saved) return fail(saved.error());
  fmt::print("wrote {}: {} slots, {} objects\n", argv[1], map.slots.size(), map.objects.size());
  return 0;
}
