// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/column_sight.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/geometry/planar.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {
namespace {

// Beyond, a pillar is a few label pixels wide; nearer, its place tells its bearing too badly.
constexpr double kNearest = 1.0;    // m
constexpr double kFarthest = 10.0;  // m

}  // namespace

ColumnSight columnSight(const LevelView& view, const Eigen::Vector2d& foot) {
  const Eigen::Vector2d d = foot - view.eye.head<2>();
  const double distance = d.norm();
  if (distance < kNearest || distance > kFarthest) return ColumnSight::kUnsure;
  constexpr int kColumns = 2;  // to either side
  constexpr double kAcross = 0.15;
  constexpr int kHeights = 9;
  constexpr double kLowest = 0.4;
  constexpr double kHeightStep = 0.2;
  constexpr int kEnough = 4;  // heights that are seen
  const Eigen::Vector2d side = Eigen::Vector2d(-d.y(), d.x()) / distance;
  double best = -1.0;
  for (int column = -kColumns; column <= kColumns; ++column) {
    Eigen::Vector3d p;
    p << foot + column * kAcross * side, 0.0;
    int own = 0;
    int other = 0;
    for (int k = 0; k < kHeights; ++k) {
      p.z() = kLowest + k * kHeightStep;
      const std::uint8_t value = view.at(p);
      if (value == LevelView::kNotSeen) continue;
      const auto label = static_cast<SemanticClass>(value);
      if (label == SemanticClass::kPillar || label == SemanticClass::kZoneMarker) {
        ++own;
      } else if (label != SemanticClass::kVehicle && label != SemanticClass::kPedestrian) {
        ++other;
      }
    }
    if (own + other >= kEnough) best = std::max(best, static_cast<double>(own) / (own + other));
  }
  constexpr double kMost = 0.7;
  constexpr double kLittle = 0.3;
  if (best >= kMost) return ColumnSight::kThere;
  return best >= 0.0 && best <= kLittle ? ColumnSight::kNotThere : ColumnSight::kUnsure;
}

bool standsInLine(const Eigen::Vector2d& other, const Eigen::Vector2d& foot,
                  const Eigen::Vector2d& eye) {
  constexpr double kDepth = 0.5;   // m
  constexpr double kAcross = 0.6;  // m, of the nearer one
  const Eigen::Vector2d d = foot - eye;
  const Eigen::Vector2d e = other - eye;
  if (d.dot(e) <= 0.0 || std::abs(e.norm() - d.norm()) < kDepth) return false;
  return std::abs(cross(d, e)) < kAcross * std::max(d.norm(), e.norm());
}

}  // namespace parkade
