// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/agent_slots.hpp"

#include <Eigen/LU>
#include <optional>

namespace parkade {
namespace {

using Eigen::Vector2d;

// A place in a slot's own terms: across from its left side (0) to its right one (1), and metres in.
Vector2d placeIn(const SlotObservation& slot, const Vector2d& p) {
  Eigen::Matrix2d axes;
  axes.col(0) = slot.corners[1] - slot.corners[0];
  axes.col(1) = (slot.corners[3] - slot.corners[0]).normalized();
  return axes.inverse() * (p - slot.corners[0]);
}

// Whether it lies between the sides, and not far before the entrance.
bool isWithin(const SlotObservation& slot, const Vector2d& place, double margin) {
  constexpr double kBefore = 0.8;  // m that a car sticks out
  const double depth = (slot.corners[3] - slot.corners[0]).norm();
  return place.x() > margin && place.x() < 1.0 - margin && place.y() > -kBefore &&
         place.y() < depth;
}

// The slot in whose middle a point lies.
std::optional<std::size_t> slotOf(const Vector2d& p, const std::vector<SlotObservation>& slots) {
  constexpr double kMargin = 0.25;  // of the width: a car's flank may seem to lie beyond its slot
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (isWithin(slots[i], placeIn(slots[i], p), kMargin)) return i;
  }
  return std::nullopt;
}

}  // namespace

std::size_t findSlotChange(const std::vector<Vector2d>& swept,
                           const std::vector<SlotObservation>& slots) {
  constexpr int kLeast = 3;  // points in the middle of each
  std::optional<std::size_t> before;
  std::optional<std::size_t> behind;
  std::size_t last = 0;  // point in the slot before
  int in_before = 0;
  int in_behind = 0;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const std::optional<std::size_t> slot = slotOf(swept[i], slots);
    if (!slot) continue;
    if (!before || (in_before < kLeast && slot != before)) {
      before = slot;
      in_before = 0;
    }
    if (slot == before) {
      if (in_behind > 0) in_behind = 0;
      ++in_before;
      last = i;
      continue;
    }
    if (slot != behind) {
      behind = slot;
      in_behind = 0;
    }
    if (++in_behind < kLeast) continue;
    for (std::size_t k = last + 1; k <= i; ++k) {
      if (!isWithin(slots[*before], placeIn(slots[*before], swept[k]), 0.0)) return k;
    }
    return i;
  }
  return 0;
}

}  // namespace parkade
