// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "parkade/mapping/layers/wall_points.hpp"
#include "parkade/mapping/layers/way_eyes.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Eigen::Vector3d;

// The first cell of a wall on a ray, if no pillar is before it.
std::optional<Vector2i> firstWall(const LayeredGrid& grid, const Vector2d& eye, double angle,
                                  double range) {
  const Vector2d step = grid.resolution() * Vector2d(std::cos(angle), std::sin(angle));
  const int steps = static_cast<int>(range / grid.resolution());
  Vector2d p = eye;
  for (int n = 0; n < steps; ++n, p += step) {
    const Vector2i cell = grid.cellOf(p);
    const SemanticClass c = grid.at(GridLayer::kZoneMarkers, cell).believed();
    if (c == SemanticClass::kWall) return cell;
    if (c == SemanticClass::kPillar) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Vector3d> wallFronts(const LayeredGrid& grid, const std::vector<SE2>& way,
                                 double range) {
  constexpr double kSpacing = 0.25;  // m between the places told
  std::vector<Vector3d> places;
  std::set<std::pair<int, int>> told;
  const int rays = static_cast<int>(M_PI * range / grid.resolution());
  forEachEye(way, [&](const Vector2d& eye) {
    for (int k = 0; k < rays; ++k) {
      const std::optional<Vector2i> cell = firstWall(grid, eye, 2.0 * M_PI * k / rays, range);
      if (!cell) continue;
      const Vector2d p = grid.centerOf(*cell);
      const Vector2i square = (p / kSpacing).array().floor().cast<int>();
      if (!told.emplace(square.x(), square.y()).second) continue;
      // Labels of a wall speak of all of its height.
      for (const double height : {1.0, 2.0}) places.emplace_back(p.x(), p.y(), height);
    }
  });
  return places;
}

}  // namespace parkade
