// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_plausibility.hpp"

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

}  // namespace

bool isForDrivers(SemanticClass c) {
  return c == SemanticClass::kArrow || c == SemanticClass::kSpeedLimitPaint ||
         c == SemanticClass::kStopLine || c == SemanticClass::kCrossing ||
         c == SemanticClass::kSpeedBump;
}

bool drivenThrough(const Corners& corners, const std::vector<DrivenStep>& way) {
  const Corners inner = within(corners);
  for (const DrivenStep& step : way) {
    for (std::size_t k = 1; k < 4; ++k) {  // 0 is the entrance
      if (meet(step.from, step.to, inner[k], inner[(k + 1) % 4])) return true;
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

bool holdsPillar(const Corners& corners, const std::vector<MapObject>& objects,
                 std::int64_t observations) {
  const double width = (corners[1] - corners[0]).norm();
  const Vector2d u = (corners[1] - corners[0]) / width;
  const Vector2d side = corners[3] - corners[0];
  return std::any_of(objects.begin(), objects.end(), [&](const MapObject& object) {
    if (object.semantic_class != SemanticClass::kPillar) return false;
    if (2 * object.observations < observations) return false;
    constexpr double kAside = 0.25;  // of the width: beside them stand the rows' own pillars
    constexpr double kDeep = 0.8;    // of the depth: behind the slot, between two rows
    const Vector2d d = object.position.head<2>() - corners[0];
    const double deep = cross(u, d) / cross(u, side);
    const double aside = cross(d, side) / cross(u, side) / width;
    return deep > 0.0 && deep < kDeep && aside > kAside && aside < 1.0 - kAside;
  });
}

}  // namespace parkade
