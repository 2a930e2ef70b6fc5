// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/column_feet.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "parkade/core/median.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr double kReach = 1.0;  // m from a pillar's position to what may be its foot

bool isPillarCell(const LayeredGrid& grid, const Vector2i& cell) {
  return grid.at(GridLayer::kZoneMarkers, cell).believed() == SemanticClass::kPillar;
}

std::vector<Vector2i> cellsWithin(const LayeredGrid& grid, const Vector2d& p, double radius) {
  std::vector<Vector2i> cells;
  const Vector2i middle = grid.cellOf(p);
  const int reach = static_cast<int>(std::ceil(radius / grid.resolution()));
  for (int dx = -reach; dx <= reach; ++dx) {
    for (int dy = -reach; dy <= reach; ++dy) {
      const Vector2i cell = middle + Vector2i(dx, dy);
      if ((grid.centerOf(cell) - p).norm() <= radius) cells.push_back(cell);
    }
  }
  return cells;
}

// Cells of structure that no other pillar is nearer to.
std::vector<Vector2i> cellsOf(std::size_t pillar, const std::vector<Vector2d>& pillars,
                              const LayeredGrid& grid) {
  std::vector<Vector2i> cells;
  const Vector2d& p = pillars[pillar];
  for (const Vector2i& cell : cellsWithin(grid, p, kReach)) {
    if (!isPillarCell(grid, cell)) continue;
    const Vector2d at = grid.centerOf(cell);
    const bool is_other = std::any_of(pillars.begin(), pillars.end(), [&](const Vector2d& other) {
      return (at - other).norm() < (at - p).norm();
    });
    if (!is_other) cells.push_back(cell);
  }
  return cells;
}

// Whether a cell within one of the point across the middle is a pillar's as well.
bool hasCounterpart(const LayeredGrid& grid, const Vector2i& cell, const Vector2d& middle) {
  const Vector2i across = grid.cellOf(2.0 * middle - grid.centerOf(cell));
  return anyWithinACell(across, [&](const Vector2i& near) { return isPillarCell(grid, near); });
}

// A disc of pillar, but where walls stand, if at least half of it is known.
void stampFoot(const Vector2d& middle, double radius, LayeredGrid& grid) {
  constexpr float kLogOdds = 1.0F;  // against what was seen there
  const std::vector<Vector2i> foot = cellsWithin(grid, middle, radius);
  const auto known = std::count_if(foot.begin(), foot.end(), [&](const Vector2i& cell) {
    return grid.at(GridLayer::kZoneMarkers, cell).known();
  });
  if (2 * known < static_cast<std::ptrdiff_t>(foot.size())) return;
  for (const Vector2i& cell : foot) {
    if (isStructure(grid.at(GridLayer::kZoneMarkers, cell).believed())) continue;
    grid.set(GridLayer::kZoneMarkers, cell, SemanticClass::kPillar, kLogOdds);
  }
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
  grid.forget(GridLayer::kZoneMarkers, behind);
}

void forgetStrayPillars(const std::vector<MapObject>& objects, LayeredGrid& grid) {
  const std::vector<Vector2d> pillars = positionsOf(SemanticClass::kPillar, objects);
  std::vector<Vector2i> strays;
  grid.forEachKnown(GridLayer::kZoneMarkers, [&](const Vector2i& index, const GridCell& cell) {
    if (cell.semantic_class != SemanticClass::kPillar) return;
    const Vector2d p = grid.centerOf(index);
    if (std::none_of(pillars.begin(), pillars.end(),
                     [&](const Vector2d& pillar) { return (p - pillar).norm() <= kReach; })) {
      strays.push_back(index);
    }
  });
  grid.forget(GridLayer::kZoneMarkers, strays);
}

void completeColumnFeet(const std::vector<MapObject>& objects, LayeredGrid& grid) {
  constexpr std::size_t kFewest = 3;  // feet to learn from
  constexpr double kLeast = 0.04;     // m^2, of a foot that was seen
  constexpr double kMost = 1.0;
  constexpr double kLittle = 0.6;  // of the usual foot's area
  const std::vector<Vector2d> pillars = positionsOf(SemanticClass::kPillar, objects);
  const double cell = grid.resolution() * grid.resolution();
  std::vector<double> areas;
  std::vector<double> seen;
  for (std::size_t i = 0; i < pillars.size(); ++i) {
    areas.push_back(cell * static_cast<double>(cellsOf(i, pillars, grid).size()));
    if (areas.back() > kLeast && areas.back() < kMost) seen.push_back(areas.back());
  }
  if (seen.size() < kFewest) return;
  const double usual = median(std::move(seen));
  for (std::size_t i = 0; i < pillars.size(); ++i) {
    if (areas[i] < kLittle * usual) stampFoot(pillars[i], std::sqrt(usual / M_PI), grid);
  }
}

}  // namespace parkade
