// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/point_icp.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace parkade {
namespace {

std::optional<PointKind> kindOf(SemanticClass semantic_class) {
  switch (semantic_class) {
    case SemanticClass::kSlotLine:
    case SemanticClass::kLaneLine:
      return PointKind::kLine;
    case SemanticClass::kArrow:
    case SemanticClass::kSpeedLimitPaint:
    case SemanticClass::kStopLine:
    case SemanticClass::kCrossing:
      return PointKind::kGuideSign;
    case SemanticClass::kSpeedBump:
      return PointKind::kBump;
    default:
      return std::nullopt;
  }
}

struct Pair {
  double square = 0.0;
  Eigen::Vector2d source;
  Eigen::Vector2d target;
};

// Every so many points take part: more of them cost time and tell nothing new.
std::size_t strideOf(const PointCloud& source) {
  constexpr std::size_t kMost = 600;
  return 1 + source.points().size() / kMost;
}

std::vector<Pair> pairsOf(const PointCloud& source, const PointCloud& target, const SE2& T,
                          double radius) {
  std::vector<Pair> pairs;
  const std::size_t stride = strideOf(source);
  for (std::size_t i = 0; i < source.points().size(); i += stride) {
    const SemanticPoint& point = source.points()[i];
    const Eigen::Vector2d q = T * point.p;
    const int at = target.nearest(q, point.kind, radius);
    if (at < 0) continue;
    const Eigen::Vector2d& m = target.points()[static_cast<std::size_t>(at)].p;
    pairs.push_back({(q - m).squaredNorm(), point.p, m});
  }
  return pairs;
}

// The rigid motion with the least sum of squares, in closed form.
SE2 fit(const std::vector<Pair>& pairs, std::size_t count) {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    a += pairs[i].source / static_cast<double>(count);
    b += pairs[i].target / static_cast<double>(count);
  }
  double dot = 0.0;
  double cross = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d s = pairs[i].source - a;
    const Eigen::Vector2d t = pairs[i].target - b;
    dot += s.dot(t);
    cross += s.x() * t.y() - s.y() * t.x();
  }
  const SE2 turn(std::atan2(cross, dot), Eigen::Vector2d::Zero());
  return {turn.angle(), b - turn * a};
}

}  // namespace

std::int64_t PointCloud::keyOf(const Eigen::Vector2d& p, PointKind kind) const {
  const auto x = static_cast<std::int64_t>(std::floor(p.x() / cell_));
  const auto y = static_cast<std::int64_t>(std::floor(p.y() / cell_));
  return ((x + (1LL << 27)) << 32) ^ ((y + (1LL << 27)) << 2) ^ static_cast<std::int64_t>(kind);
}

void PointCloud::add(const SemanticPoint& point) {
  const auto [it, fresh] =
      cells_.try_emplace(keyOf(point.p, point.kind), static_cast<int>(points_.size()));
  if (fresh) {
    points_.push_back(point);
    counts_.push_back(1);
    return;
  }
  // The mean of what fell into the cell; it never leaves it.
  const auto at = static_cast<std::size_t>(it->second);
  ++counts_[at];
  points_[at].p += (point.p - points_[at].p) / counts_[at];
}

void PointCloud::add(const PointCloud& other, const SE2& T_this_other) {
  for (const SemanticPoint& point : other.points_) add({T_this_other * point.p, point.kind});
}

int PointCloud::nearest(const Eigen::Vector2d& p, PointKind kind, double radius) const {
  int best = -1;
  double least = radius * radius;
  // Ring by ring: what lies in ring r is at least (r - 1) cells away.
  const int rings = static_cast<int>(std::ceil(radius / cell_)) + 1;
  for (int r = 0; r <= rings; ++r) {
    const double nearest_possible = cell_ * std::max(0, r - 1);
    if (nearest_possible * nearest_possible > least) break;
    for (int dy = -r; dy <= r; ++dy) {
      const int step = std::abs(dy) == r ? 1 : std::max(1, 2 * r);
      for (int dx = -r; dx <= r; dx += step) {
        const auto it = cells_.find(keyOf(p + cell_ * Eigen::Vector2d(dx, dy), kind));
        if (it == cells_.end()) continue;
        const double d = (points_[static_cast<std::size_t>(it->second)].p - p).squaredNorm();
        if (d < least) {
          least = d;
          best = it->second;
        }
      }
    }
  }
  return best;
}

PointCloud pointsOfLabels(const BevLabels& labels, double range_m, double cell_m) {
  PointCloud cloud(cell_m);
  const BevGeometry& g = labels.geometry;
  for (int v = 0; v < labels.labels.rows; ++v) {
    const std::uint8_t* row = labels.labels.ptr<std::uint8_t>(v);
    for (int u = 0; u < labels.labels.cols; ++u) {
      const auto kind = kindOf(static_cast<SemanticClass>(row[u]));
      if (!kind) continue;
      const Eigen::Vector2d p = g.toGround({static_cast<double>(u), static_cast<double>(v)});
      if ((p - g.center).norm() <= range_m) cloud.add({p, *kind});
    }
  }
  return cloud;
}

PointIcpResult registerPoints(const PointCloud& source, const PointCloud& target, const SE2& prior,
                              const PointIcpOptions& options) {
  PointIcpResult result;
  result.T_target_source = prior;
  if (source.empty() || target.empty()) return result;
  double radius = options.start_radius_m;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    std::vector<Pair> pairs = pairsOf(source, target, result.T_target_source, radius);
    if (static_cast<int>(pairs.size()) < options.min_points) return result;
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.square < b.square; });
    const auto kept = static_cast<std::size_t>(options.trim * static_cast<double>(pairs.size()));
    const SE2 next = fit(pairs, std::max<std::size_t>(2, kept));
    const SE2 step = result.T_target_source.inverse() * next;
    result.T_target_source = next;
    const bool still = step.translation().norm() < 1e-4 && std::abs(step.angle()) < 1e-5;
    if (still && radius <= options.end_radius_m) break;
    constexpr double kNarrow = 0.8;
    radius = std::max(options.end_radius_m, kNarrow * radius);
  }
  const std::vector<Pair> pairs =
      pairsOf(source, target, result.T_target_source, options.end_radius_m);
  result.pairs = static_cast<int>(pairs.size());
  double sum = 0.0;
  for (const Pair& pair : pairs) sum += pair.square;
  result.rms = pairs.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(pairs.size()));
  const std::size_t stride = strideOf(source);
  const std::size_t asked = (source.points().size() + stride - 1) / stride;
  result.share = static_cast<double>(pairs.size()) / static_cast<double>(asked);
  result.accepted = result.pairs >= options.min_points && result.rms <= options.accept_rms_m &&
                    result.share >= options.accept_share;
  return result;
}

}  // namespace parkade
