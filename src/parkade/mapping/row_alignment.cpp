// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/row_alignment.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

struct Line {
  Vector2d origin = Vector2d::Zero();
  Vector2d u = Vector2d::UnitX();  // unit
  [[nodiscard]] double off(const Vector2d& p) const { return cross(u, p - origin); }
};

constexpr double kOnLine = 0.1;  // m

Vector2d middleOf(const MapSlot& slot) {
  return 0.5 * (slot.corners[0] + slot.corners[1]);
}

bool liesOn(const MapSlot& slot, const Line& line) {
  return std::abs(line.off(slot.corners[0])) < kOnLine &&
         std::abs(line.off(slot.corners[1])) < kOnLine;
}

std::vector<const MapSlot*> neighboursOf(const MapSlot& slot, const std::vector<MapSlot>& slots) {
  constexpr double kNear = 12.0;        // m
  constexpr double kAside = 1.5;        // m
  constexpr double kParallel = 0.9903;  // cosine of 8 degrees
  const Vector2d u = (slot.corners[1] - slot.corners[0]).normalized();
  std::vector<const MapSlot*> found;
  for (const MapSlot& other : slots) {
    const Vector2d between = middleOf(other) - middleOf(slot);
    const Vector2d v = (other.corners[1] - other.corners[0]).normalized();
    if (&other != &slot && other.shape == slot.shape && u.dot(v) > kParallel &&
        between.norm() < kNear && std::abs(cross(u, between)) < kAside) {
      found.push_back(&other);
    }
  }
  return found;
}

// The line through two entrances that most others lie on, if most do.
std::optional<Line> lineOf(const std::vector<const MapSlot*>& slots) {
  constexpr double kApart = 2.0;  // m
  constexpr int kLeast = 4;
  constexpr double kMost = 0.6;  // of them
  std::optional<Line> best;
  int most = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (std::size_t j = i + 1; j < slots.size(); ++j) {
      const Vector2d between = middleOf(*slots[j]) - middleOf(*slots[i]);
      if (between.norm() < kApart) continue;
      const Line line{middleOf(*slots[i]), between.normalized()};
      const auto on = std::count_if(slots.begin(), slots.end(),
                                    [&](const MapSlot* slot) { return liesOn(*slot, line); });
      if (on <= most) continue;
      most = static_cast<int>(on);
      best = line;
    }
  }
  if (most < kLeast || most < kMost * static_cast<double>(slots.size())) return std::nullopt;
  return best;
}

bool align(MapSlot& slot, const std::vector<MapSlot>& slots) {
  const std::vector<const MapSlot*> neighbours = neighboursOf(slot, slots);
  const std::optional<Line> line = lineOf(neighbours);
  if (!line) return false;
  const Vector2d inward = (slot.corners[3] - slot.corners[0]).normalized();
  constexpr double kNoticeable = 0.15;  // m
  constexpr double kMost = 1.3;
  constexpr double kSteep = 0.5;
  const double slope = cross(line->u, inward);
  if (std::abs(slope) < kSteep) return false;
  const double left = -line->off(slot.corners[0]) / slope;
  const double right = -line->off(slot.corners[1]) / slope;
  const double farther = std::max(std::abs(left), std::abs(right));
  if (farther < kNoticeable || farther > kMost) return false;
  std::vector<double> depths;
  for (const MapSlot* other : neighbours) {
    if (liesOn(*other, *line)) depths.push_back((other->corners[3] - other->corners[0]).norm());
  }
  const double depth = median(std::move(depths));
  slot.corners[0] += left * inward;
  slot.corners[1] += right * inward;
  slot.corners[2] = slot.corners[1] + depth * inward;
  slot.corners[3] = slot.corners[0] + depth * inward;
  return true;
}

}  // namespace

std::vector<std::size_t> alignRows(std::vector<MapSlot>& slots) {
  const std::vector<MapSlot> given = slots;
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    MapSlot slot = given[i];
    // Its neighbours as they were: none moves on another's account.
    std::vector<MapSlot> others = given;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (!align(slot, others)) continue;
    slots[i] = slot;
    moved.push_back(i);
  }
  return moved;
}

}  // namespace parkade::slot_rows
