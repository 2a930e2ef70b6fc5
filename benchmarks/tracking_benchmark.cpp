// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// One frame set through the tracker: a textured wall seen by cameras that turn and move, 640x400.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/tracking/detector.hpp"
#include "parkade/tracking/patch.hpp"
#include "parkade/tracking/tracker.hpp"

namespace parkade {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 400;
constexpr int kFrames = 8;

Rig makeRig(int cameras) {
  PinholeRadtan::Parameters p;
  p.fx = p.fy = 270.0;
  p.cx = 0.5 * (kWidth - 1);
  p.cy = 0.5 * (kHeight - 1);
  Rig rig;
  rig.name = "benchmark";
  for (int c = 0; c < cameras; ++c) {
    RigCamera camera;
    camera.name = "cam" + std::to_string(c);
    camera.camera = Camera(PinholeRadtan(p), kWidth, kHeight);
    // A ring that looks outward, neighbours overlap by 40 degrees.
    camera.T_vehicle_cam = SE3(SO3::exp(Eigen::Vector3d(0.0, c * M_PI / 3.0, 0.0)),
                               Eigen::Vector3d(0.5 * c, 0.0, 0.0));
    rig.cameras.push_back(camera);
  }
  return rig;
}

// Random blocks of two sizes, shifted by 3 px per frame: corners everywhere, and easy to draw.
cv::Mat drawImage(int camera, int frame) {
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto block = [&](int size, std::uint64_t seed) {
        const auto bx = static_cast<std::uint64_t>((x + 3 * frame + 1000) / size);
        const auto by = static_cast<std::uint64_t>((y + 1000) / size);
        return static_cast<double>(
            hash64(hash64(bx, by), seed + static_cast<std::uint64_t>(camera)) % 100);
      };
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(20.0 + block(37, 1) + block(11, 9));
    }
  }
  return image;
}

std::vector<FrameSet> drawFrames(int cameras) {
  std::vector<FrameSet> frames(kFrames);
  for (int i = 0; i < kFrames; ++i) {
    for (int c = 0; c < cameras; ++c)
      frames[static_cast<std::size_t>(i)].images.push_back(drawImage(c, i));
    frames[static_cast<std::size_t>(i)].image_t_ns.resize(static_cast<std::size_t>(cameras));
  }
  return frames;
}

// There and back through the frames: the features live on.
void trackFrameSet(benchmark::State& state) {
  cv::setNumThreads(1);
  const int cameras = static_cast<int>(state.range(0));
  std::vector<FrameSet> frames = drawFrames(cameras);
  Tracker tracker(makeRig(cameras), TrackingOptions{});
  MotionPrior prior;
  prior.valid = true;
  std::int64_t step = 0;
  std::size_t tracks = 0;
  const auto advance = [&] {
    const auto turn = static_cast<int>(step % (2 * kFrames - 2));
    const int index = turn < kFrames ? turn : 2 * kFrames - 2 - turn;
    FrameSet& set = frames[static_cast<std::size_t>(index)];
    set.t_ns = (step + 1) * 100 * kNsPerMs;
    ++step;
    tracks = tracker.track(set, prior).observations.size();
  };
  for (int i = 0; i < 4; ++i) advance();
  for (auto _ : state) advance();
  state.counters["tracks"] = static_cast<double>(tracks);
}
BENCHMARK(trackFrameSet)->Arg(1)->Arg(2)->Arg(6)->Unit(benchmark::kMillisecond);

void detectCorners(benchmark::State& state) {
  const cv::Mat image = drawImage(0, 0);
  const GridDetector detector(DetectionOptions{}, kWidth, kHeight);
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(image, {}, {}));
}
BENCHMARK(detectCorners)->Unit(benchmark::kMillisecond);

void alignPatch(benchmark::State& state) {
  const cv::Mat image = drawImage(0, 0);
  const std::vector<Corner> corners =
      GridDetector(DetectionOptions{}, kWidth, kHeight).detect(image, {}, {});
  const Eigen::Vector2d pixel = corners.at(corners.size() / 2).pixel;
  const auto patch = Patch::sample(image, pixel);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        patch->align(image, pixel + Eigen::Vector2d(0.4, -0.3), Eigen::Matrix2d::Identity(), 0.01));
  }
}
BENCHMARK(alignPatch)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace parkade

BENCHMARK_MAIN();
