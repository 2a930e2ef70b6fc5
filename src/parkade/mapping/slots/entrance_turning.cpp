// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/entrance_turning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/slots/outlined_place.hpp"
#include "parkade/mapping/slots/row_evidence.hpp"
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

double frontOf(const MapSlot& slot) {
  return (slot.corners[1] - slot.corners[0]).norm();
}

// As long as slots along the aisle are.
bool mayLieAlong(const MapSlot& slot) {
  constexpr double kLeast = 5.0;  // m
  constexpr double kMost = 7.4;
  constexpr double kWidest = 2.8;
  const double length = (slot.corners[3] - slot.corners[0]).norm();
  return slot.shape == SlotShape::kPerpendicular && length > kLeast && length < kMost &&
         frontOf(slot) < kWidest;
}

// Of slots into rows, most of them.
std::optional<double> frontIntoRows(const std::vector<MapSlot>& told) {
  constexpr std::size_t kLeast = 5;
  std::vector<double> fronts;
  for (const MapSlot& slot : told) {
    if (slot.shape == SlotShape::kPerpendicular) fronts.push_back(frontOf(slot));
  }
  if (fronts.size() < kLeast) return std::nullopt;
  return median(std::move(fronts));
}

// As long as slots into rows are deep, unlike all others along an aisle, and seen from the front
// alone.
bool mayBeSideways(std::size_t i, const std::vector<MapSlot>& told, const LayeredGrid& grid) {
  constexpr double kShallow = 4.5;  // m
  constexpr double kDeep = 5.8;
  constexpr double kOther = 0.4;   // m
  constexpr int kOthers = 2;       // at least, to tell by
  constexpr double kUnseen = 1.0;  // m of the far side
  const double front = frontOf(told[i]);
  if (told[i].shape != SlotShape::kParallel || front < kShallow || front > kDeep) return false;
  int others = 0;
  for (std::size_t k = 0; k < told.size(); ++k) {
    if (k == i || told[k].shape != SlotShape::kParallel) continue;
    if (std::abs(frontOf(told[k]) - front) < kOther) return false;
    ++others;
  }
  return others >= kOthers && gatherEvidence(grid, told[i].corners).rear.seen_m < kUnseen;
}

// So wide, the front a side, entered by its right end.
MapSlot enteredFromRight(const MapSlot& slot, double width) {
  const Vector2d& a = slot.corners[0];
  const Vector2d& b = slot.corners[1];
  const Vector2d across = width * inwardOf(slot);
  MapSlot turned = slot;
  turned.shape = SlotShape::kPerpendicular;
  turned.corners = {b, b + across, a + across, a};
  return turned;
}

// The floor before its entrance is known.
bool hasWayIn(const MapSlot& slot, const LayeredGrid& grid) {
  constexpr double kAhead = 2.0;  // m
  constexpr double kSeen = 1.0;
  const Vector2d from = slot.entrance();
  return lookAlong(grid, from, from - kAhead * inwardOf(slot)).seen_m > kSeen;
}

}  // namespace

std::vector<std::size_t> turnSidewaysSlots(std::vector<MapSlot>& told, const LayeredGrid& grid) {
  std::vector<std::size_t> turned;
  const std::optional<double> width = frontIntoRows(told);
  if (!width) return turned;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!mayBeSideways(i, told, grid)) continue;
    const MapSlot by_right = enteredFromRight(told[i], *width);
    MapSlot by_left = by_right;
    std::rotate(by_left.corners.begin(), by_left.corners.begin() + 2, by_left.corners.end());
    const bool is_right_blocked = isBlocked(by_right, told);
    if (is_right_blocked == isBlocked(by_left, told)) continue;
    const MapSlot& slot = is_right_blocked ? by_left : by_right;
    if (!hasWayIn(slot, grid)) continue;
    told[i] = slot;
    turned.push_back(i);
  }
  return turned;
}

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
