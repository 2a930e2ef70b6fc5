// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace parkade {

/// The cross product's component out of the plane: positive where b lies to the left of a.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// How far p lies off the line from a to b, which are apart, with its ends.
inline double distanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                                const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double s = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - s * along).norm();
}

/// Into [-45, 45] degrees: what two directions differ by where quarter turns do not count.
inline double wrapQuarter(double angle) {
  return angle - std::round(angle / M_PI_2) * M_PI_2;
}

/// Whether p lies in a convex quadrilateral of either orientation.
inline bool contains(const std::array<Eigen::Vector2d, 4>& quad, const Eigen::Vector2d& p) {
  int positive = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (cross(quad[(i + 1) % 4] - quad[i], p - quad[i]) > 0.0) ++positive;
  }
  return positive == 0 || positive == 4;
}

/// A quadrilateral with its edges moved inwards by a margin, m; corners slide along the edges.
inline std::array<Eigen::Vector2d, 4> inset(const std::array<Eigen::Vector2d, 4>& quad,
                                            double margin) {
  std::array<Eigen::Vector2d, 4> inner;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d ahead = (quad[(k + 1) % 4] - quad[k]).normalized();
    const Eigen::Vector2d behind = (quad[(k + 3) % 4] - quad[k]).normalized();
    inner[k] = quad[k] + margin / std::abs(cross(ahead, behind)) * (ahead + behind);
  }
  return inner;
}

}  // namespace parkade
