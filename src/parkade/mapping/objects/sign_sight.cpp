// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/sign_sight.hpp"

namespace parkade {

ColumnSight signSight(const LevelView& view, const Eigen::Vector3d& p, SemanticClass sign) {
  // Nearer, its place tells its direction too badly; far away a sign is a few label pixels high,
  // that are seen more often than not, and beyond a pixel or two.
  constexpr double kNearest = 1.5;         // m
  constexpr double kFarthest = 12.0;       // m
  constexpr double kFarthestMissed = 9.0;  // m
  const Eigen::Vector2d d = (p - view.eye).head<2>();
  const double distance = d.norm();
  if (distance < kNearest || distance > kFarthest) return ColumnSight::kUnsure;
  constexpr int kColumns = 2;  // to either side
  constexpr double kAcross = 0.12;
  constexpr int kRows = 1;  // up and down
  constexpr double kUp = 0.12;
  constexpr int kEnough = 2;  // of 15 places
  const Eigen::Vector2d side = Eigen::Vector2d(-d.y(), d.x()) / distance;
  int own = 0;
  int other = 0;
  int all = 0;
  for (int column = -kColumns; column <= kColumns; ++column) {
    for (int row = -kRows; row <= kRows; ++row, ++all) {
      Eigen::Vector3d at = p;
      at.head<2>() += column * kAcross * side;
      at.z() += row * kUp;
      const std::uint8_t value = view.at(at);
      if (value == static_cast<std::uint8_t>(sign)) {
        ++own;
      } else if (value == static_cast<std::uint8_t>(SemanticClass::kUnknown)) {
        ++other;
      }
    }
  }
  if (own >= kEnough) return ColumnSight::kThere;
  return other == all && distance <= kFarthestMissed ? ColumnSight::kNotThere
                                                     : ColumnSight::kUnsure;
}

}  // namespace parkade
