// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/wheel_stops.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include "parkade/core/median.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr double kStopDepth = 0.15;  // m

double distanceTo(const std::vector<SE2>& way, const Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const SE2& pose : way) least = std::min(least, (pose.translation() - p).norm());
  return least;
}

struct StopCell {
  Vector2i cell;
  double behind = 0.0;  // m, along the slot, away from the way
};

// The cells of wheel stops in a slot, in columns along it.
std::map<int, std::vector<StopCell>> columnsOf(const MapSlot& slot, const std::vector<SE2>& way,
                                               const LayeredGrid& grid) {
  const Vector2d front = slot.entrance();
  const Vector2d rear = 0.5 * (slot.corners[2] + slot.corners[3]);
  const bool from_rear = distanceTo(way, rear) < distanceTo(way, front);
  const Vector2d from = from_rear ? rear : front;
  const Vector2d axis = (from_rear ? front - rear : rear - front).normalized();
  const Vector2d across(-axis.y(), axis.x());
  const double half = 0.5 * std::abs((slot.corners[1] - slot.corners[0]).dot(across));
  constexpr double kBeyond = 0.3;  // m, that a smear may reach out of the slot
  const double end = (rear - front).norm() + kBeyond;
  Eigen::AlignedBox2d box;
  for (const double along : {-kBeyond, end}) {
    for (const double side : {-half, half}) box.extend(from + along * axis + side * across);
  }
  const Vector2i first = grid.cellOf(box.min());
  const Vector2i last = grid.cellOf(box.max());
  std::map<int, std::vector<StopCell>> columns;
  for (int x = first.x(); x <= last.x(); ++x) {
    for (int y = first.y(); y <= last.y(); ++y) {
      const Vector2i cell(x, y);
      const Vector2d p = grid.centerOf(cell) - from;
      const double along = p.dot(axis);
      const double side = p.dot(across);
      if (std::abs(side) > half || along < -kBeyond || along > end) continue;
      if (grid.at(GridLayer::kRoadMarkers, cell).believed() != SemanticClass::kWheelStop) continue;
      columns[static_cast<int>(std::floor(side / grid.resolution()))].push_back({cell, along});
    }
  }
  return columns;
}

}  // namespace

void trimWheelStops(const std::vector<MapSlot>& slots, const std::vector<SE2>& way,
                    LayeredGrid& grid) {
  constexpr std::size_t kFewest = 4;  // columns that tell where a stop's near edge is
  for (const MapSlot& slot : slots) {
    if (slot.shape == SlotShape::kParallel) continue;
    const auto columns = columnsOf(slot, way, grid);
    if (columns.size() < kFewest) continue;
    std::vector<double> edges;
    for (const auto& [column, cells] : columns) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const StopCell& c : cells) nearest = std::min(nearest, c.behind);
      edges.push_back(nearest);
    }
    const double edge = median(std::move(edges));
    std::vector<Vector2i> behind;
    for (const auto& [column, cells] : columns) {
      for (const StopCell& c : cells) {
        if (c.behind > edge + kStopDepth) behind.push_back(c.cell);
      }
    }
    grid.forget(GridLayer::kRoadMarkers, behind);
  }
}

}  // namespace parkade
