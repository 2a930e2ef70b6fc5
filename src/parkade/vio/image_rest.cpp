// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/image_rest.hpp"

#include <cmath>
#include <map>
#include <unordered_map>

#include "parkade/core/median.hpp"

namespace parkade {
namespace {

constexpr std::size_t kEnoughFeatures = 10;    // of all cameras; fewer say nothing about rest
constexpr std::size_t kEnoughOfOneCamera = 8;  // fewer say nothing about this camera
constexpr double kDoubt = 3.0;                 // standard errors that a shift may be by chance
constexpr double kErrorOfMedian = 1.858;  // standard error times sqrt(n), over the MAD (normal)
constexpr double kMedianOfDifference = 1.665;  // length, of two noisy pixels, over their sigma

struct Displacements {
  std::vector<double> x;  // px
  std::vector<double> y;
};

double medianDeviation(std::vector<double> values, double middle) {
  for (double& value : values) value = std::abs(value - middle);
  return median(std::move(values));
}

bool shifted(const Displacements& moved, double max_shift_px) {
  const double x = median(moved.x);
  const double y = median(moved.y);
  const double spread = std::hypot(medianDeviation(moved.x, x), medianDeviation(moved.y, y));
  const double error = kErrorOfMedian * spread / std::sqrt(static_cast<double>(moved.x.size()));
  return std::hypot(x, y) > std::hypot(max_shift_px, kDoubt * error);
}

}  // namespace

std::optional<bool> imagesAtRest(const Observations& before, const Observations& now,
                                 const VioStandstillOptions& options) {
  const auto key = [](std::uint64_t id, int camera) {
    return id * 64 + static_cast<std::uint64_t>(camera);
  };
  std::unordered_map<std::uint64_t, Eigen::Vector2d> pixels;
  for (const auto& [id, o] : before) pixels.emplace(key(id, o.camera), o.pixel);
  std::map<int, Displacements> cameras;
  std::vector<double> lengths;
  double sigma = 0.0;
  for (const auto& [id, o] : now) {
    const auto it = pixels.find(key(id, o.camera));
    if (it == pixels.end()) continue;
    const Eigen::Vector2d displacement = o.pixel - it->second;
    cameras[o.camera].x.push_back(displacement.x());
    cameras[o.camera].y.push_back(displacement.y());
    lengths.push_back(displacement.norm());
    sigma += o.sigma_px;
  }
  if (lengths.size() < kEnoughFeatures) return std::nullopt;
  const double noise = kMedianOfDifference * sigma / static_cast<double>(lengths.size());
  if (median(std::move(lengths)) >= std::hypot(options.max_disparity_px, noise)) return false;
  int asked = 0;
  int moving = 0;
  for (const auto& [camera, displacements] : cameras) {
    if (displacements.x.size() < kEnoughOfOneCamera) continue;
    ++asked;
    if (shifted(displacements, options.max_shift_px)) ++moving;
  }
  return asked == 0 || 2 * moving <= asked;
}

}  // namespace parkade
