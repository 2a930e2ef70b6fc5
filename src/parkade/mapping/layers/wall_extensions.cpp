// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/layers/wall_points.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr GridLayer kStructureLayer = GridLayer::kZoneMarkers;

// The side of a face that holds its wall: a unit vector across it.
Vector2d wallSide(const WallFace& face, const LayeredGrid& grid) {
  constexpr double kDeep = 0.3;  // m
  const Vector2d along = (face.to - face.from).normalized();
  const Vector2d left(-along.y(), along.x());
  const double length = (face.to - face.from).norm();
  int left_cells = 0;
  for (double s = 0.0; s < length; s += grid.resolution()) {
    for (double d = grid.resolution(); d < kDeep; d += grid.resolution()) {
      for (const double sign : {1.0, -1.0}) {
        const Vector2i cell = grid.cellOf(face.from + s * along + sign * d * left);
        if (grid.at(kStructureLayer, cell).believed() == SemanticClass::kWall) {
          left_cells += sign > 0.0 ? 1 : -1;
        }
      }
    }
  }
  return left_cells >= 0 ? left : Vector2d(-left);
}

// The floor from p on along away, as far as a wall or unknown ground; nothing where it is deeper
// than walls are mistaken.
std::optional<std::vector<Vector2i>> floorBehind(const Vector2d& p, const Vector2d& away,
                                                 const LayeredGrid& grid) {
  constexpr double kDeepest = 1.3;  // m
  constexpr double kUnknown = 0.1;  // m that end it
  const double step = 0.5 * grid.resolution();
  std::vector<Vector2i> floor;
  double unknown = 0.0;
  for (double d = 0.0; unknown <= kUnknown; d += step) {
    const Vector2i cell = grid.cellOf(p + d * away);
    const SemanticClass c = grid.at(kStructureLayer, cell).believed();
    if (c == SemanticClass::kWall) break;
    unknown = c == SemanticClass::kUnknown ? unknown + step : 0.0;
    if (unknown == 0.0 && d > kDeepest) return std::nullopt;
    if (c == SemanticClass::kFloor) floor.push_back(cell);
  }
  return floor;
}

}  // namespace

void forgetWallsInSlots(const std::vector<MapSlot>& slots, LayeredGrid& grid) {
  constexpr double kInset = 0.1;  // m
  std::vector<std::array<Vector2d, 4>> insides;
  for (const MapSlot& slot : slots) insides.push_back(inset(slot.corners, kInset));
  std::vector<Vector2i> lost;
  grid.forEachKnown(kStructureLayer, [&](const Vector2i& index, const GridCell& cell) {
    if (cell.believed() != SemanticClass::kWall) return;
    const Vector2d p = grid.centerOf(index);
    if (std::any_of(insides.begin(), insides.end(),
                    [&](const auto& inside) { return contains(inside, p); })) {
      lost.push_back(index);
    }
  });
  grid.forget(kStructureLayer, lost);
}

void forgetFloorBeyondWalls(const std::vector<WallFace>& faces, LayeredGrid& grid) {
  constexpr double kReach = 8.0;  // m
  const double step = 0.5 * grid.resolution();
  std::vector<Vector2i> lost;
  for (const WallFace& face : faces) {
    const Vector2d away = wallSide(face, grid);
    const Vector2d along = (face.to - face.from).normalized();
    const double length = (face.to - face.from).norm();
    for (const bool ahead : {false, true}) {
      const Vector2d end = ahead ? face.to : face.from;
      for (double s = -0.5 * length; s < kReach; s += step) {
        const auto floor = floorBehind(end + (ahead ? s : -s) * along, away, grid);
        if (floor) {
          lost.insert(lost.end(), floor->begin(), floor->end());
        } else if (s > 0.0) {
          break;
        }
      }
    }
  }
  grid.forget(kStructureLayer, lost);
}

}  // namespace parkade
