// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/row_compass.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/median.hpp"
#include "parkade/core/units.hpp"
#include "parkade/geometry/planar.hpp"

namespace parkade {
namespace {

// Of a window's way, what must have been seen before it says anything.
constexpr double kLeastShare = 0.6;
// Where a pair stops counting, in scatters.
constexpr double kReachOfKernel = 3.0;
constexpr double kPointSpacing = 1.0;  // m, along a line
constexpr double kView = 20.0;         // m, ahead and behind together, that pictures show at most
constexpr double kStep = 0.02 * kDegree;
// Of a direction that the next reading is compared with.
constexpr double kLeastContrast = 1.3;

}  // namespace

void RowCompass::add(const SemanticFrame& frame, const SE2& T_odom_vehicle, double travelled_m) {
  if (!options_.enable) return;
  Seen seen{travelled_m, {}};
  for (const LineSegment& segment : frame.line_segments) {
    for (const Eigen::Vector2d& end : {segment.begin, segment.end}) {
      if (end.norm() < options_.reach_m) seen.points.push_back(T_odom_vehicle * end);
    }
    const Eigen::Vector2d along = segment.end - segment.begin;
    const int pieces = static_cast<int>(along.norm() / kPointSpacing);
    for (int i = 1; i < pieces; ++i) {
      const Eigen::Vector2d point = segment.begin + along * (static_cast<double>(i) / pieces);
      seen.points.push_back(T_odom_vehicle * point);
    }
  }
  seen_.push_back(std::move(seen));
  while (travelled_m - seen_.front().travelled_m > options_.window_m) seen_.pop_front();
}

void RowCompass::appendPairs(double direction, std::vector<AlongAcross>& pairs) const {
  const Eigen::Vector2d along(std::cos(direction), std::sin(direction));
  const Eigen::Vector2d across(-along.y(), along.x());
  std::vector<AlongAcross> points;
  for (const Seen& seen : seen_) {
    for (const Eigen::Vector2d& p : seen.points) {
      points.push_back({static_cast<float>(along.dot(p)), static_cast<float>(across.dot(p))});
    }
  }
  // Sorted across, partners lie within a band of neighbours.
  std::sort(points.begin(), points.end(),
            [](const AlongAcross& a, const AlongAcross& b) { return a.across < b.across; });
  const auto apart = static_cast<float>(options_.apart_m);
  const auto kernel = static_cast<float>(kReachOfKernel * options_.scatter_m);
  const auto slope = static_cast<float>(std::tan(options_.search_deg * kDegree));
  const float widest = kernel + slope * static_cast<float>(options_.window_m + kView);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      AlongAcross pair{points[j].along - points[i].along, points[j].across - points[i].across};
      if (pair.across > widest) break;
      if (pair.along < 0.0F) pair = {-pair.along, -pair.across};
      if (pair.along < apart || std::abs(pair.across) > kernel + slope * pair.along) continue;
      pairs.push_back(pair);
    }
  }
}

double RowCompass::support(const std::vector<AlongAcross>& pairs, double turn) const {
  const auto slope = static_cast<float>(std::tan(turn));
  const auto scale = static_cast<float>(1.0 / (kReachOfKernel * options_.scatter_m));
  float sum = 0.0F;
  for (const AlongAcross& pair : pairs) {
    const float u = scale * (pair.across - slope * pair.along);
    const float fit = std::max(0.0F, 1.0F - u * u);
    sum += fit * fit;
  }
  return sum;
}

std::optional<RowReading> RowCompass::read(double expected_direction) {
  if (!options_.enable || seen_.empty()) return std::nullopt;
  const double now = seen_.back().travelled_m;
  if (now - seen_.front().travelled_m < kLeastShare * options_.window_m) return std::nullopt;
  if (now - last_read_m_ < options_.spacing_m) return std::nullopt;
  last_read_m_ = now;
  std::vector<AlongAcross> pairs;
  appendPairs(expected_direction, pairs);
  appendPairs(expected_direction + 0.5 * M_PI, pairs);
  const int half = std::max(1, static_cast<int>(options_.search_deg * kDegree / kStep));
  std::vector<double> supports;
  for (int i = -half; i <= half; ++i) supports.push_back(support(pairs, i * kStep));
  const auto best = std::max_element(supports.begin(), supports.end());
  if (best == supports.begin() || best + 1 == supports.end()) return std::nullopt;
  // What lies along any direction is chance.
  const double chance = median(supports);
  const double excess = *best - chance;
  const double least = std::min(kLeastContrast, options_.min_contrast);
  if (excess < options_.min_excess || *best < least * chance) return std::nullopt;
  // The top of the parabola through the best and its neighbours.
  const double bend = best[-1] - 2.0 * best[0] + best[1];
  const double beside = bend < 0.0 ? 0.5 * (best[-1] - best[1]) / bend : 0.0;
  const double turn = (static_cast<double>(best - supports.begin()) - half + beside) * kStep;
  const double direction = expected_direction + turn;
  const double off = offBefore(direction);
  if (*best < options_.min_contrast * chance) return std::nullopt;
  // So many neighbours share lines, and with them what they err by: all of them together know what
  // one does.
  const double shared = std::max(1.0, options_.window_m / options_.spacing_m);
  const double sigma = options_.sigma_deg * kDegree * (1.0 + options_.doubling_excess / excess);
  return RowReading{direction, std::hypot(std::sqrt(shared) * sigma, off)};
}

double RowCompass::offBefore(double direction) {
  constexpr double kUnknown = 0.05 * kDegree;
  constexpr double kLatest = 1.6;  // spacings
  const double now = seen_.back().travelled_m;
  double off = kUnknown;
  if (before_ && now - before_->travelled_m < kLatest * options_.spacing_m) {
    off = wrapQuarter(direction - before_->direction);
  }
  before_ = Found{now, direction};
  return off;
}

}  // namespace parkade
