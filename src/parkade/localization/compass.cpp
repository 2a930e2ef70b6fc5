// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/compass.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parkade/core/units.hpp"

namespace parkade {
namespace {

// Into (-45, 45] degrees.
double wrapQuarter(double angle) {
  return angle - 0.5 * M_PI * std::round(angle / (0.5 * M_PI));
}

}  // namespace

std::optional<double> Compass::read(const SemanticFrame& frame, double expected_heading,
                                    double travelled_m) {
  if (!options_.enable) return std::nullopt;
  if (begin_m_ < 0.0) begin_m_ = travelled_m;
  struct Line {
    double direction;  // in the vehicle
    double weight;
  };
  std::vector<Line> lines;
  const double paint = options_.paint_sigma_deg * kDegree;
  for (const LineSegment& segment : frame.line_segments) {
    const Eigen::Vector2d along = segment.end - segment.begin;
    const double length = along.norm();
    if (length < options_.min_length_m) continue;
    const double variance = segment.sigma_heading * segment.sigma_heading + paint * paint;
    constexpr double kLeast = 1e-8;
    // Long lines count for their length as well: dashes of one line are not many.
    lines.push_back({std::atan2(along.y(), along.x()), length / std::max(kLeast, variance)});
  }
  if (lines.empty()) return std::nullopt;
  if (!learned_ && travelled_m - begin_m_ >= options_.reference_m) {
    // Lines that agree; slanted rows among them make the sum short.
    constexpr double kAgree = 0.9;
    learned_ = weight_sum_ > 0.0 && std::hypot(cos_sum_, sin_sum_) > kAgree * weight_sum_;
    axis_ = 0.25 * std::atan2(sin_sum_, cos_sum_);
    cos_sum_ = sin_sum_ = weight_sum_ = 0.0;
    begin_m_ = travelled_m;
  }
  if (!learned_) {
    for (const Line& line : lines) {
      const double angle = 4.0 * (line.direction + expected_heading);
      cos_sum_ += line.weight * std::cos(angle);
      sin_sum_ += line.weight * std::sin(angle);
      weight_sum_ += line.weight;
    }
    return std::nullopt;
  }
  double sum = 0.0;
  double along_axes = 0.0;
  double all = 0.0;
  for (const Line& line : lines) {
    all += line.weight;
    const double off = wrapQuarter(axis_ - (line.direction + expected_heading));
    if (std::abs(off) > options_.window_deg * kDegree) continue;
    sum += line.weight * off;
    along_axes += line.weight;
  }
  if (along_axes <= 0.0 || along_axes < options_.min_share * all) return std::nullopt;
  return expected_heading + sum / along_axes;
}

}  // namespace parkade
