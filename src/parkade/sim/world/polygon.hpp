// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace parkade::sim {

/// A simple polygon in the floor plane, counter-clockwise, metres.
using Polygon = std::vector<Eigen::Vector2d>;

/// A place in the floor plane with a direction: x along the heading, y to its left.
struct Frame2 {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double heading = 0.0;

  [[nodiscard]] Eigen::Vector2d operator*(const Eigen::Vector2d& p) const;
  [[nodiscard]] Eigen::Vector2d inverse(const Eigen::Vector2d& p) const;
};

/// Positive where counter-clockwise.
double signedArea(const Polygon& polygon);
bool contains(const Polygon& polygon, const Eigen::Vector2d& p);

/// Whether the insides of two convex polygons share more than a sliver (tolerance in metres).
bool convexOverlap(const Polygon& a, const Polygon& b, double tolerance = 1e-6);

/// Rectangle between two opposite corners of a frame's axes.
Polygon rectangle(const Frame2& frame, double x0, double y0, double x1, double y1);

/// The strip of a width around a segment, its ends extended by `extend` at each side.
Polygon strip(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width,
              double extend = 0.0);

/// All points moved by a frame.
Polygon moved(const Frame2& frame, const Polygon& polygon);

}  // namespace parkade::sim
