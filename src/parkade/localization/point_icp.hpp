// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// What a semantic point belongs to, as AVP-SLAM maps it.
enum class PointKind : std::uint8_t { kLine = 0, kGuideSign = 1, kBump = 2 };

struct SemanticPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  PointKind kind = PointKind::kLine;
};

/// Points thinned to one per cell and kind, with a search for the nearest of a kind.
class PointCloud {
 public:
  explicit PointCloud(double cell_m = 0.1) : cell_(cell_m) {}

  void add(const SemanticPoint& point);
  /// All of another cloud, moved.
  void add(const PointCloud& other, const SE2& T_this_other);
  /// Index of the nearest point of that kind within the radius, or -1.
  [[nodiscard]] int nearest(const Eigen::Vector2d& p, PointKind kind, double radius) const;
  [[nodiscard]] const std::vector<SemanticPoint>& points() const { return points_; }
  [[nodiscard]] bool empty() const { return points_.empty(); }

 private:
  [[nodiscard]] std::int64_t keyOf(const Eigen::Vector2d& p, PointKind kind) const;
  double cell_;
  std::vector<SemanticPoint> points_;
  std::vector<int> counts_;
  std::unordered_map<std::int64_t, int> cells_;
};

/// The points of one labelled picture, in the levelled vehicle frame: painted lines, arrows and
/// other guide signs, speed bumps; one per cell, within range_m of the picture's middle.
PointCloud pointsOfLabels(const BevLabels& labels, double range_m, double cell_m);

struct PointIcpOptions {
  int max_iterations = 30;
  double start_radius_m = 1.0;
  double end_radius_m = 0.25;
  double trim = 0.8;
  double accept_rms_m = 0.12;
  double accept_share = 0.6;
  int min_points = 60;

  void visit(OptionVisitor& v) {
    v.field("max_iterations", max_iterations, "count", "Steps, at most.", 1, 1000);
    v.field("start_radius_m", start_radius_m, "m", "Points look this far at first.", 0.05, 20.0);
    v.field("end_radius_m", end_radius_m, "m", "And this far in the end.", 0.01, 20.0);
    v.field("trim", trim, "ratio", "Share of the pairs, the nearest ones, that a step uses.", 0.1,
            1.0);
    v.field("accept_rms_m", accept_rms_m, "m", "Pairs of a good fit are no farther apart.", 1e-3,
            5.0);
    v.field("accept_share", accept_share, "ratio", "Share of the points that a good fit pairs.",
            0.0, 1.0);
    v.field("min_points", min_points, "count", "Fewer pairs are no fit.", 3, 100000);
  }
};

struct PointIcpResult {
  bool accepted = false;
  SE2 T_target_source;
  double rms = 0.0;    ///< m, of the pairs within end_radius_m
  double share = 0.0;  ///< of the source's points that have one
  int pairs = 0;
  int iterations = 0;
};

/// Point-to-point ICP in the plane, class by class: nearest points of the same kind, trimmed, the
/// rigid motion in closed form, again until it stands still; the radius narrows on the way.
PointIcpResult registerPoints(const PointCloud& source, const PointCloud& target, const SE2& prior,
                              const PointIcpOptions& options);

}  // namespace parkade
