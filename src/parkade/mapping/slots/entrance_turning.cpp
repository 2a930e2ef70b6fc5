// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/entrance_turning.hpp"

#include <algorithm>
#include <array>

#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/slots/outlined_place.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

// Whether another slot lies so near before the entrance that no car gets in.
bool isBlocked(const MapSlot& slot, const std::vector<MapSlot>& told) {
  constexpr std::array<double, 6> kAhead = {0.8, 1.3, 1.8, 2.3, 2.8, 3.3};  // m
  constexpr std::array<double, 3> kAcross = {0.25, 0.5, 0.75};              // of the entrance
  const Vector2d out = -inwardOf(slot);
  const Vector2d along = slot.corners[1] - slot.corners[0];
  return std::any_of(told.begin(), told.end(), [&](const MapSlot& other) {
    if (other.id == slot.id) return false;
    for (const double ahead : kAhead) {
      for (const double across : kAcross) {
        const Vector2d p = slot.corners[0] + across * along + ahead * out;
        if (contains(other.corners, p)) return true;
      }
    }
    return false;
  });
}

// As long as slots along the aisle are.
bool mayLieAlong(const MapSlot& slot) {
  constexpr double kLeast = 5.0;  // m
  constexpr double kMost = 7.4;
  constexpr double kWidest = 2.8;
  const double length = (slot.corners[3] - slot.corners[0]).norm();
  const double width = (slot.corners[1] - slot.corners[0]).norm();
  return slot.shape == SlotShape::kPerpendicular && length > kLeast && length < kMost &&
         width < kWidest;
}

}  // namespace

std::vector<std::size_t> turnBlockedSlots(std::vector<MapSlot>& told, const LayeredGrid& grid) {
  std::vector<std::size_t> turned;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!mayLieAlong(told[i]) || !isBlocked(told[i], told)) continue;
    const auto& c = told[i].corners;
    MapSlot slot = told[i];
    slot.shape = SlotShape::kParallel;
    slot.corners = enteredFromFloor({c[1], c[2], c[3], c[0]}, grid);
    if (isBlocked(slot, told)) continue;
    told[i] = slot;
    turned.push_back(i);
  }
  return turned;
}

}  // namespace parkade::slot_rows
