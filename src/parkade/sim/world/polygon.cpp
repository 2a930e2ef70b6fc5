// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace parkade::sim {
namespace {

/// Whether an edge normal of a separates a from b.
bool separates(const Polygon& a, const Polygon& b, double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d edge = a[(i + 1) % a.size()] - a[i];
    const Eigen::Vector2d normal(edge.y(), -edge.x());
    const double length = normal.norm();
    if (length <= 0.0) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : b) {
      nearest = std::min(nearest, normal.dot(p - a[i]) / length);
    }
    if (nearest >= -tolerance) return true;
  }
  return false;
}

}  // namespace

Eigen::Vector2d Frame2::operator*(const Eigen::Vector2d& p) const {
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  return {origin.x() + c * p.x() - s * p.y(), origin.y() + s * p.x() + c * p.y()};
}

Eigen::Vector2d Frame2::inverse(const Eigen::Vector2d& p) const {
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const Eigen::Vector2d d = p - origin;
  return {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
}

double signedArea(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool contains(const Polygon& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

bool convexOverlap(const Polygon& a, const Polygon& b, double tolerance) {
  return !separates(a, b, tolerance) && !separates(b, a, tolerance);
}

Polygon rectangle(const Frame2& frame, double x0, double y0, double x1, double y1) {
  return {frame * Eigen::Vector2d(x0, y0), frame * Eigen::Vector2d(x1, y0),
          frame * Eigen::Vector2d(x1, y1), frame * Eigen::Vector2d(x0, y1)};
}

Polygon strip(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width, double extend) {
  const Eigen::Vector2d along = (b - a).normalized();
  const Eigen::Vector2d left(-along.y() * 0.5 * width, along.x() * 0.5 * width);
  const Eigen::Vector2d a2 = a - extend * along;
  const Eigen::Vector2d b2 = b + extend * along;
  return {a2 - left, b2 - left, b2 + left, a2 + left};
}

Polygon moved(const Frame2& frame, const Polygon& polygon) {
  Polygon out;
  out.reserve(polygon.size());
  for (const Eigen::Vector2d& p : polygon) out.push_back(frame * p);
  return out;
}

}  // namespace parkade::sim
