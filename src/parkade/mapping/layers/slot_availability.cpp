// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/slot_availability.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "parkade/geometry/planar.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Corners = std::array<Vector2d, 4>;

void fill(const Corners& corners, SemanticClass semantic_class, float log_odds, LayeredGrid& grid) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& corner : corners) box.extend(corner);
  const Vector2i first = grid.cellOf(box.min());
  const Vector2i last = grid.cellOf(box.max());
  for (int x = first.x(); x <= last.x(); ++x) {
    for (int y = first.y(); y <= last.y(); ++y) {
      const Vector2i cell(x, y);
      if (!grid.at(GridLayer::kAvailability, cell).known()) continue;
      if (!contains(corners, grid.centerOf(cell))) continue;
      grid.set(GridLayer::kAvailability, cell, semantic_class, log_odds);
    }
  }
}

}  // namespace

void layDownAvailability(const std::vector<MapSlot>& slots, LayeredGrid& grid) {
  constexpr double kInset = 0.3;  // m
  for (const MapSlot& slot : slots) {
    if (!slot.isFree() && !slot.isOccupied()) continue;
    const double sure = std::max(slot.probability_free, 1.0 - slot.probability_free);
    const auto log_odds = static_cast<float>(std::log(sure / std::max(1e-3, 1.0 - sure)));
    fill(inset(slot.corners, kInset),
         slot.isOccupied() ? SemanticClass::kVehicle : SemanticClass::kFloor, log_odds, grid);
  }
}

}  // namespace parkade
