// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Preintegration of one frame interval, one solve of a full six-camera window,
// and one frame set through the estimator, on simulated tracks: six cameras, 120 tracks each.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "parkade/imu/reading_buffer.hpp"
#include "parkade/vio/feature_manager.hpp"
#include "parkade/vio/track_simulator.hpp"
#include "parkade/vio/window_solver.hpp"

namespace parkade {
namespace {

const testing::SimulatedDrive& drive() {
  static const testing::SimulatedDrive result = [] {
    testing::TrackSimulatorOptions options;
    options.length = 60.0;
    options.stops = {};
    return simulateDrive(testing::surroundRig(), options);
  }();
  return result;
}

// A window of ten keyframes and their landmarks, near the truth.
Window fullWindow(std::vector<WindowFeature*>& features) {
  Window window;
  window.T_imu_vehicle = drive().rig.imu.T_vehicle_imu.inverse();
  for (const RigCamera& camera : drive().rig.cameras) {
    window.cameras.push_back({camera.camera, window.T_imu_vehicle * camera.T_vehicle_cam});
  }
  ReadingBuffer readings;
  for (const ImuSample& s : drive().imu) (void)readings.add({s.t_ns, s.gyro, s.accel});
  FeatureManager manager{VioOptions{}};
  for (int i = 0; i < 13; ++i) {
    const TrackSet& tracks = drive().frames[static_cast<std::size_t>(60 + 2 * i)];
    const SE3 T = drive().truthAt(tracks.t_ns) * drive().rig.imu.T_vehicle_imu;
    const SE3 T_next = drive().truthAt(tracks.t_ns + kNsPerMs) * drive().rig.imu.T_vehicle_imu;
    WindowFrame frame;
    frame.id = i;
    frame.t_ns = tracks.t_ns;
    frame.keyframe = true;
    frame.state = {T.rotation(), T.translation(), 1e3 * (T_next.translation() - T.translation())};
    if (i > 0) {
      frame.imu = readings.sumBetween(window.frames.back().t_ns, frame.t_ns, ImuNoise{}, ImuBias{},
                                      kNsPerSecond);
      frame.imu_sqrt_information = sqrtInformation(*frame.imu);
    }
    window.frames.push_back(frame);
    manager.add(window, FeatureManager::observationsOf(window.cameras, tracks, i));
    if (i > 0) manager.triangulateNew(window);
  }
  window.start.frame_id = 0;
  window.start.state = window.frames.front().state;
  window.start.sigma.setConstant(0.01);
  window.start.gravity_sigma = 0.02;
  features = manager.select(window);
  return window;
}

void preintegrate(benchmark::State& state) {
  ReadingBuffer readings;
  for (const ImuSample& s : drive().imu) (void)readings.add({s.t_ns, s.gyro, s.accel});
  const TimeNs begin = drive().frames[50].t_ns;
  const TimeNs end = drive().frames[51].t_ns;
  for (auto _ : state) {
    benchmark::DoNotOptimize(readings.sumBetween(begin, end, ImuNoise{}, ImuBias{}, kNsPerSecond));
  }
  state.counters["readings"] = 0.1 * 200.0;
}

void solve(benchmark::State& state) {
  std::vector<WindowFeature*> features;
  const Window start = fullWindow(features);
  std::vector<std::uint64_t> ids;
  for (const WindowFeature* feature : features) ids.push_back(feature->id);
  SolveSummary summary;
  for (auto _ : state) {
    state.PauseTiming();
    Window window = start;
    std::vector<WindowFeature*> selected;
    for (const std::uint64_t id : ids) selected.push_back(&window.features.at(id));
    state.ResumeTiming();
    SolveOptions options;
    options.min_decrease = 0.0;  // all four steps
    summary = solveWindow(window, selected, options);
  }
  state.counters["landmarks"] = static_cast<double>(features.size());
  state.counters["observations"] = summary.observations;
  state.counters["steps"] = summary.iterations;
}

void frameSet(benchmark::State& state) {
  std::size_t next_frame = drive().frames.size();
  std::size_t next_imu = 0;
  std::unique_ptr<VioEstimator> estimator;
  const auto feed = [&](const TrackSet& tracks) {
    while (next_imu < drive().imu.size() &&
           drive().imu[next_imu].t_ns <= tracks.t_ns + 5 * kNsPerMs) {
      estimator->addImu(drive().imu[next_imu++]);
    }
    benchmark::DoNotOptimize(estimator->addTracks(tracks));
  };
  for (auto _ : state) {
    if (next_frame == drive().frames.size()) {
      state.PauseTiming();
      estimator = std::make_unique<VioEstimator>(drive().rig, VioOptions{});
      next_imu = 0;
      // The window is full and in motion before the clock runs.
      for (next_frame = 0; next_frame < 60; ++next_frame) feed(drive().frames[next_frame]);
      state.ResumeTiming();
    }
    feed(drive().frames[next_frame++]);
  }
}

BENCHMARK(preintegrate)->Unit(benchmark::kMicrosecond);
BENCHMARK(solve)->Unit(benchmark::kMillisecond);
BENCHMARK(frameSet)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace parkade

BENCHMARK_MAIN();
