// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/agent_slots.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
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

constexpr double kBefore = 0.8;  // m that a car sticks out of its slot

double depthOf(const SlotObservation& slot) {
  return (slot.corners[3] - slot.corners[0]).norm();
}

// Whether it lies between the sides, and not far before the entrance.
bool isWithin(const SlotObservation& slot, const Vector2d& place, double margin) {
  const double depth = depthOf(slot);
  return place.x() > margin && place.x() < 1.0 - margin && place.y() > -kBefore &&
         place.y() < depth;
}

// The slot in whose middle a point lies.
std::optional<std::size_t> slotOf(const Vector2d& p, const std::vector<SlotObservation>& slots) {
  constexpr double kMargin = 0.15;  // of the width: a car's flank may seem to lie beyond its slot
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

std::optional<double> findRowHeading(const std::vector<Vector2d>& floor,
                                     const std::vector<SlotObservation>& slots) {
  constexpr double kBeyond = 3.0;  // slots that a row goes on for
  constexpr double kMost = 0.7;    // of the points
  std::optional<double> heading;
  double least = kBeyond;
  for (const SlotObservation& slot : slots) {
    if (slot.shape == SlotShape::kParallel) continue;
    const double depth = depthOf(slot);
    double beyond = 0.0;  // mean, in widths
    int within = 0;
    for (const Vector2d& p : floor) {
      const Vector2d place = placeIn(slot, p);
      if (place.y() < -kBefore || place.y() > depth) continue;
      ++within;
      beyond += std::max(0.0, std::abs(place.x() - 0.5) - 0.5);
    }
    if (within < kMost * static_cast<double>(floor.size())) continue;
    beyond /= within;
    if (beyond >= least) continue;
    least = beyond;
    const Vector2d axis = slot.corners[3] - slot.corners[0];
    heading = std::atan2(axis.y(), axis.x());
  }
  return heading;
}

}  // namespace parkade
