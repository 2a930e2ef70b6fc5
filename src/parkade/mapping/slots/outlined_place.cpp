// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/outlined_place.hpp"

#include <algorithm>

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

// Share of the ground before a side, away from the middle, that is known floor.
double floorBefore(const LayeredGrid& grid, const Vector2d& left, const Vector2d& right,
                   const Vector2d& middle) {
  constexpr int kSteps = 10;
  constexpr double kReach = 2.5;  // m
  const Vector2d out = (0.5 * (left + right) - middle).normalized();
  int floor = 0;
  for (int i = 1; i < kSteps; ++i) {
    for (int k = 1; k <= kSteps; ++k) {
      const Vector2d p = left + (right - left) * i / kSteps + out * kReach * k / kSteps;
      const GridCell cell = grid.at(GridLayer::kParkingLines, grid.cellOf(p));
      floor += cell.known() && cell.semantic_class == SemanticClass::kFloor ? 1 : 0;
    }
  }
  return static_cast<double>(floor) / ((kSteps - 1) * kSteps);
}

}  // namespace

std::array<Vector2d, 4> enteredFromFloor(const std::array<Vector2d, 4>& corners,
                                         const LayeredGrid& grid) {
  const auto& c = corners;
  const Vector2d middle = 0.5 * (c[0] + c[2]);
  if (floorBefore(grid, c[2], c[3], middle) > floorBefore(grid, c[0], c[1], middle)) {
    return {c[2], c[3], c[0], c[1]};
  }
  return c;
}

Place outlinedPlace(const std::array<Vector2d, 4>& corners, SlotShape shape,
                    const std::vector<MapSlot>& told, const LayeredGrid& grid, double sigma) {
  Place place;
  place.slot.corners = enteredFromFloor(corners, grid);
  place.slot.shape = shape;
  place.slot.corner_sigma = sigma;
  for (const MapSlot& other : told) {
    place.slot.last_seen_ns = std::max(place.slot.last_seen_ns, other.last_seen_ns);
  }
  place.evidence = gatherEvidence(grid, place.slot.corners);
  setFree(place.evidence, place.slot);
  return place;
}

std::optional<Filling> oneSlot(const MapSlot& slot, double log_odds, double least) {
  if (log_odds < least) return std::nullopt;
  return Filling{{slot}, log_odds, log_odds};
}

}  // namespace parkade::slot_rows
