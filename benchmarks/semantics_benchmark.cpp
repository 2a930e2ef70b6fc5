// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Time of the segmentation networks on one thread: preparing the input, the network, the labels.
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>
#include <string>

#include "parkade/semantics/segmentation.hpp"

namespace parkade {
namespace {

// A picture of noise: the time does not depend on what it shows.
cv::Mat noise(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  cv::randu(image, 0, 255);
  return image;
}

void segmentBev(benchmark::State& state) {
  cv::setNumThreads(1);
  const Result<std::string> path = findModel("bev_segmentation");
  if (!path) return state.SkipWithError(path.error().message.c_str());
  Result<SegmentationNetwork> network = SegmentationNetwork::load(*path);
  if (!network) return state.SkipWithError(network.error().message.c_str());
  BevImage bev;
  bev.image = noise(bev.geometry.width_px, bev.geometry.height_px);
  bev.valid = cv::Mat(bev.image.size(), CV_8UC1, cv::Scalar(255));
  for (auto _ : state) benchmark::DoNotOptimize(network->segment(bev));
}
BENCHMARK(segmentBev)->Unit(benchmark::kMillisecond);

void segmentView(benchmark::State& state) {
  cv::setNumThreads(1);
  const Result<std::string> path = findModel("view_segmentation");
  if (!path) return state.SkipWithError(path.error().message.c_str());
  Result<SegmentationNetwork> network = SegmentationNetwork::load(*path);
  if (!network) return state.SkipWithError(network.error().message.c_str());
  const cv::Mat image = noise(640, 400);
  for (auto _ : state) benchmark::DoNotOptimize(network->segmentView(image));
}
BENCHMARK(segmentView)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace parkade

BENCHMARK_MAIN();
