// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Time of the segmentation networks on one thread (preparing the input, the network, the labels),
// and of the features that are drawn from labels.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "parkade/semantics/lines/line_extraction.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"
#include "parkade/semantics/standing/agent_tracker.hpp"
#include "parkade/semantics/standing/object_extraction.hpp"

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

// A busy aisle: rows of cars with pillars between them on both sides, arrows, a crossing, a limit,
// people; upright things smeared away from the picture's middle.
BevLabels busyAisle() {
  BevLabels labels;
  labels.geometry.center = {1.4, 0.0};
  const BevGeometry& g = labels.geometry;
  labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(1));
  labels.confidence = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(230));
  const auto classAt = [](const Eigen::Vector2d& p, const Eigen::Vector2d& foot) {
    const Eigen::Vector2d d = p - foot;
    if (std::abs(d.x()) < 2.4 && std::abs(d.y()) < 0.95) return SemanticClass::kUnknown;
    for (double share = 1.0; share > 0.1; share *= 0.9) {
      const Eigen::Vector2d q = foot + share * d;
      const double along = q.x() - 2.6 * std::floor(q.x() / 2.6);
      if (std::abs(q.y()) > 3.6 && std::abs(q.y()) < 8.0 && along > 0.4 && along < 2.2) {
        return SemanticClass::kVehicle;
      }
      const double bay = q.x() - 7.8 * std::floor(q.x() / 7.8);
      if (std::abs(std::abs(q.y()) - 4.6) < 0.35 && bay < 0.36) return SemanticClass::kPillar;
      if ((q - Eigen::Vector2d(6.0, 2.0)).norm() < 0.25) return SemanticClass::kPedestrian;
    }
    for (const double x : {-4.5, -1.0, 3.0, 6.5}) {
      for (const double y : {-1.7, 1.7}) {
        const double along = p.x() - x;
        const double across = std::abs(p.y() - y);
        const bool shaft = along > -1.2 && along < 0.4 && across < 0.09;
        const bool head = along >= 0.4 && along < 1.2 && across < 0.28 * (1.2 - along) / 0.8;
        if (shaft || head) return SemanticClass::kArrow;
      }
    }
    if (p.x() > 8.0 && p.x() < 8.7 && std::fmod(p.y() + 9.0, 0.9) < 0.45) {
      return SemanticClass::kCrossing;
    }
    const double ring = (p - Eigen::Vector2d(-4.5, 0.0)).norm();
    if (ring > 0.75 && ring < 0.9) return SemanticClass::kSpeedLimitPaint;
    return SemanticClass::kFloor;
  };
  for (int v = 0; v < g.height_px; ++v) {
    for (int u = 0; u < g.width_px; ++u) {
      labels.labels.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(classAt(g.toGround(Eigen::Vector2d(u, v)), g.center));
    }
  }
  return labels;
}

void extractObjects(benchmark::State& state) {
  cv::setNumThreads(1);
  const BevLabels labels = busyAisle();
  const ObjectExtractor extractor(labels.geometry, BevViews::fromMiddle(labels.geometry));
  AgentTracker tracker({});
  TimeNs t_ns = 0;
  std::size_t found = 0;
  for (auto _ : state) {
    const FoundObjects objects = extractor.extract(labels, {}, 0.003);
    benchmark::DoNotOptimize(tracker.update(objects.agents, SE2(), t_ns));
    found = objects.objects.size() + objects.agents.size();
    t_ns += kNsPerSecond / 10;
  }
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(extractObjects)->Unit(benchmark::kMillisecond);

// Rows of slots on both sides of an aisle, and cars in some of them.
void paintRows(BevImage& bev, BevLabels& labels) {
  const BevGeometry& g = bev.geometry;
  bev.image = cv::Mat(g.height_px, g.width_px, CV_8UC3, cv::Scalar::all(90.0));
  labels.geometry = g;
  labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(1.0));
  labels.confidence = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(255.0));
  const auto paint = [&](const cv::Rect& where, SemanticClass c, double grey) {
    const cv::Rect inside = where & cv::Rect(0, 0, g.width_px, g.height_px);
    bev.image(inside).setTo(cv::Scalar::all(grey));
    labels.labels(inside).setTo(static_cast<double>(c));
  };
  constexpr int kPitch = 62;
  constexpr int kLine = 3;
  for (const int side : {0, 254}) {
    for (int v = 8; v < g.height_px; v += kPitch) {
      paint({side, v, 130, kLine}, SemanticClass::kSlotLine, 190.0);
      if (v % 4 == 0) paint({side + 20, v + 9, 90, 42}, SemanticClass::kVehicle, 40.0);
    }
    paint({side == 0 ? 127 : side, 8, kLine, 6 * kPitch}, SemanticClass::kSlotLine, 190.0);
  }
}

void findLinesAndSlots(benchmark::State& state) {
  cv::setNumThreads(1);
  BevImage bev;
  BevLabels labels;
  paintRows(bev, labels);
  const BevViews views = BevViews::fromMiddle(bev.geometry);
  std::size_t slots = 0;
  for (auto _ : state) {
    const Lines lines = extractLines(bev, labels, 0.002);
    slots = extractSlots(bev, labels, lines.segments, views, {0.002, 0.005}).size();
    benchmark::DoNotOptimize(slots);
  }
  state.counters["slots"] = static_cast<double>(slots);
}
BENCHMARK(findLinesAndSlots)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace parkade

BENCHMARK_MAIN();
