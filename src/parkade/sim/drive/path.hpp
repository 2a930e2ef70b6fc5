// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/core/result.hpp"

namespace parkade::sim {

/// Where the middle of the rear axle is on a planar path.
struct PathPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m, garage frame
  double heading = 0.0;    ///< rad, of the car's nose; continuous along the path (not wrapped)
  double curvature = 0.0;  ///< 1/m, change of heading per metre driven forwards; left > 0
  int direction = 1;       ///< +1 forwards, -1 in reverse
};

/// A stretch whose curvature blends from one value to another as a quintic step (C2), so that the
/// heading is C3 over the distance.
struct PathElement {
  double length = 0.0;
  double start_curvature = 0.0;
  double end_curvature = 0.0;
  int direction = 1;
};

/// A path that a car can follow without slip: position and heading are smooth functions of the
/// travelled distance s, which grows in reverse as well. The curvature is continuous; where the
/// direction changes it is zero.
class Path {
 public:
  Path() = default;
  Path(const Eigen::Vector2d& start, double heading, std::vector<PathElement> elements);

  [[nodiscard]] double length() const { return length_; }
  /// s is clamped into [0, length()].
  [[nodiscard]] PathPoint at(double s) const;
  /// Travelled distances at which the car must stand to change the direction, ascending.
  [[nodiscard]] const std::vector<double>& gearChanges() const { return gear_changes_; }
  [[nodiscard]] double maxCurvature() const;

 private:
  struct Node {
    double s = 0.0;
    Eigen::Vector2d position;
    double heading = 0.0;
    std::size_t element = 0;
  };
  [[nodiscard]] PathPoint advance(const Node& node, double s) const;

  std::vector<PathElement> elements_;
  std::vector<double> element_start_;
  std::vector<double> element_heading_;  // at the element's start
  std::vector<Node> nodes_;              // every few centimetres, and at every element's start
  std::vector<double> gear_changes_;
  double length_ = 0.0;
};

/// How the corners of a polyline are rounded.
struct CornerOptions {
  double radius = 7.0;      ///< m, wished for
  double min_radius = 5.5;  ///< m, accepted where space is short
  double blend = 4.0;       ///< m over which the curvature builds up, wished for
  double min_blend = 1.5;   ///< m, accepted where space is short
};

/// A polyline that is driven in one gear.
struct PathLeg {
  std::vector<Eigen::Vector2d> vertices;
  bool reverse = false;
  CornerOptions corners;
};

/// Rounds the corners of the legs into one path. Each leg starts where the one before ends, along
/// the same line. Fails where a corner does not fit between its neighbours.
Result<Path> buildPath(const std::vector<PathLeg>& legs);

}  // namespace parkade::sim
