// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/compass.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parkade/core/units.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/geometry/so3.hpp"

namespace parkade {

std::vector<Compass::Line> Compass::linesOf(const SemanticFrame& frame) const {
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
  return lines;
}

// The direction that most lines lie along, if it is most of all: slanted rows have another.
bool Compass::learnAxis() {
  constexpr double kMost = 0.6;
  double all = 0.0;
  for (const Line& line : seen_) all += line.weight;
  double best = 0.0;
  for (const Line& about : seen_) {
    double offset = 0.0;
    double weight = 0.0;
    for (const Line& line : seen_) {
      const double off = wrapQuarter(line.direction - about.direction);
      if (std::abs(off) > options_.window_deg * kDegree) continue;
      offset += line.weight * off;
      weight += line.weight;
    }
    if (weight <= best) continue;
    best = weight;
    axis_ = wrapQuarter(about.direction + offset / weight);
  }
  seen_.clear();
  return best > kMost * all;
}

std::optional<double> Compass::read(const SemanticFrame& frame, double expected_heading,
                                    double travelled_m, double axis_shift) {
  if (!options_.enable) return std::nullopt;
  if (begin_m_ < 0.0) begin_m_ = travelled_m;
  const std::vector<Line> lines = linesOf(frame);
  if (lines.empty()) return std::nullopt;
  if (!learned_ && travelled_m - begin_m_ >= options_.reference_m) {
    learned_ = learnAxis();
    begin_m_ = travelled_m;
  }
  if (!learned_) {
    for (const Line& line : lines) {
      seen_.push_back({line.direction + expected_heading, line.weight});
    }
    return std::nullopt;
  }
  double sum = 0.0;
  double along_axes = 0.0;
  double all = 0.0;
  for (const Line& line : lines) {
    all += line.weight;
    const double off = wrapQuarter(axis_ + axis_shift - (line.direction + expected_heading));
    if (std::abs(off) > options_.window_deg * kDegree) continue;
    sum += line.weight * off;
    along_axes += line.weight;
  }
  if (along_axes <= 0.0 || along_axes < options_.min_share * all) return std::nullopt;
  return expected_heading + sum / along_axes - axis_shift;
}

void Compass::turnWorld(double angle) {
  for (Line& line : seen_) line.direction += angle;
}

std::optional<double> CompassScatter::add(double off_odometry) {
  constexpr std::size_t kReadings = 15;
  constexpr std::size_t kLeast = 4;
  constexpr double kPrior = 4.0;   // readings that the usual scatter counts for
  constexpr double kShared = 1.3;  // of the error over the scatter: neighbours see the same lines
  latest_.push_back(off_odometry);
  if (latest_.size() < kLeast) return std::nullopt;
  if (latest_.size() > kReadings) latest_.pop_front();
  double sum = 0.0;
  double squares = 0.0;
  for (const double offset : latest_) {
    const double off = wrapAngle(offset - latest_.front());
    sum += off;
    squares += off * off;
  }
  const auto count = static_cast<double>(latest_.size());
  const double usual = usual_sigma_ / kShared;
  const double scattered = std::max(0.0, squares - sum * sum / count);
  const double variance = (kPrior * usual * usual + scattered) / (kPrior + count - 1.0);
  // Those of poor lines err together, by far more than the mean of so many would.
  constexpr double kPoor = 0.05 * kDegree;
  const double sigma = kShared * std::sqrt(variance);
  const double more = std::max(0.0, sigma * sigma - usual_sigma_ * usual_sigma_);
  return std::max(usual_sigma_, sigma * std::sqrt(1.0 + more / (kPoor * kPoor)));
}

}  // namespace parkade
