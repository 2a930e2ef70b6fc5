// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/column_feet.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr double kReach = 1.0;  // m from a pillar's position to what may be its foot

bool isPillarCell(const LayeredGrid& grid, const Vector2i& cell) {
  return grid.at(GridLayer::kZoneMarkers, cell).believed() == SemanticClass::kPillar;
}

// Cells of structure that no other pillar is nearer to.
std::vector<Vector2i> cellsOf(std::size_t pillar, const std::vector<Vector2d>& pillars,
                              const LayeredGrid& grid) {
  std::vector<Vector2i> cells;
  const Vector2d& p = pillars[pillar];
  const Vector2i middle = grid.cellOf(p);
  const int reach = static_cast<int>(std::ceil(kReach / grid.resolution()));
  for (int dx = -reach; dx <= reach; ++dx) {
    for (int dy = -reach; dy <= reach; ++dy) {
      const Vector2i cell = middle + Vector2i(dx, dy);
      const Vector2d at = grid.centerOf(cell);
      const double distance = (at - p).norm();
      if (distance > kReach || !isPillarCell(grid, cell)) continue;
      const bool is_other = std::any_of(pillars.begin(), pillars.end(), [&](const Vector2d& other) {
        return (at - other).norm() < distance;
      });
      if (!is_other) cells.push_back(cell);
    }
  }
  return cells;
}

// Whether a cell within one of the point across the middle is a pillar's as well.
bool hasCounterpart(const LayeredGrid& grid, const Vector2i& cell, const Vector2d& middle) {
  const Vector2i across = grid.cellOf(2.0 * middle - grid.centerOf(cell));
  return anyWithinACell(across, [&](const Vector2i& near) { return isPillarCell(grid, near); });
}

}  // namespace

void trimColumnFeet(const std::vector<MapObject>& objects, LayeredGrid& grid) {
  const std::vector<Vector2d> pillars = positionsOf(SemanticClass::kPillar, objects);
  std::vector<Vector2i> behind;
  for (std::size_t i = 0; i < pillars.size(); ++i) {
    for (const Vector2i& cell : cellsOf(i, pillars, grid)) {
      if (!hasCounterpart(grid, cell, pillars[i])) behind.push_back(cell);
    }
  }
  for (const Vector2i& cell : behind) grid.touch(GridLayer::kZoneMarkers, cell) = GridCell();
}

}  // namespace parkade
