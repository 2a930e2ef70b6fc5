// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slot_plausibility.hpp"

#include <algorithm>

#include "parkade/geometry/planar.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Corners = std::array<Vector2d, 4>;

Corners within(const Corners& corners) {
  constexpr double kShare = 0.2;
  const Vector2d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  Corners smaller;
  for (std::size_t k = 0; k < 4; ++k) smaller[k] = corners[k] + kShare * (middle - corners[k]);
  return smaller;
}

// A point on the line counts to its left, so that a way with a point there crosses once.
bool meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto apart = [](double s, double t) { return (s >= 0.0) != (t >= 0.0); };
  return apart(cross(b - a, c - a), cross(b - a, d - a)) &&
         apart(cross(d - c, a - c), cross(d - c, b - c));
}

bool isForDrivers(SemanticClass c) {
  return c == SemanticClass::kArrow || c == SemanticClass::kSpeedLimitPaint ||
         c == SemanticClass::kStopLine || c == SemanticClass::kCrossing ||
         c == SemanticClass::kSpeedBump;
}

}  // namespace

bool drivenThrough(const Corners& corners, const std::vector<Vector2d>& way) {
  const Corners inner = within(corners);
  for (std::size_t i = 1; i < way.size(); ++i) {
    for (std::size_t k = 1; k < 4; ++k) {  // 0 is the entrance
      if (meet(way[i - 1], way[i], inner[k], inner[(k + 1) % 4])) return true;
    }
  }
  return false;
}

bool holdsRoadMarking(const Corners& corners, const std::vector<MapObject>& objects) {
  const Corners inner = within(corners);
  return std::any_of(objects.begin(), objects.end(), [&](const MapObject& object) {
    return isForDrivers(object.semantic_class) && contains(inner, object.position.head<2>());
  });
}

}  // namespace parkade
