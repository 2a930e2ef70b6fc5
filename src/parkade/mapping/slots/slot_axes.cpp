// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_axes.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/geometry/planar.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

constexpr double kOnAxis = 4.0 * M_PI / 180.0;

// By how much the sides of slots near an angle are turned from it on average, and their looks.
struct Turn {
  double looks = 0.0;
  double mean = 0.0;
};

Turn turnNear(const std::vector<MapSlot>& slots, double angle, double reach) {
  Turn turn;
  for (const MapSlot& slot : slots) {
    const double off = turnFromAxes(inwardOf(slot), angle);
    if (slot.shape == SlotShape::kSlanted || std::abs(off) > reach) continue;
    turn.looks += static_cast<double>(slot.observations);
    turn.mean += static_cast<double>(slot.observations) * off;
  }
  turn.mean /= std::max(1.0, turn.looks);
  return turn;
}

constexpr double kSides = 1.5 * M_PI / 180.0;

bool isTurned(const MapSlot& slot, double axis) {
  constexpr double kEntrance = 2.5 * M_PI / 180.0;
  constexpr double kMost = 8.0 * M_PI / 180.0;
  if (slot.shape == SlotShape::kSlanted) return false;
  const double sides = std::abs(turnFromAxes(inwardOf(slot), axis));
  const double entrance = std::abs(turnFromAxes(slot.corners[1] - slot.corners[0], axis));
  return sides < kMost && entrance < kMost && (sides > kSides || entrance > kEntrance);
}

// Whether a row of its own is turned as the slot is: its sides too.
bool isOneOfManyTurned(std::size_t index, const std::vector<MapSlot>& slots, double axis) {
  constexpr double kNear = 14.0;  // m
  constexpr double kAlike = 1.0 * M_PI / 180.0;
  constexpr int kMany = 3;
  const MapSlot& slot = slots[index];
  const double sides = turnFromAxes(inwardOf(slot), axis);
  if (std::abs(sides) < kSides) return false;
  int alike = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (i == index || !isTurned(slots[i], axis)) continue;
    alike += (slots[i].entrance() - slot.entrance()).norm() < kNear &&
                     std::abs(turnFromAxes(inwardOf(slots[i]), axis) - sides) < kAlike
                 ? 1
                 : 0;
  }
  return alike >= kMany;
}

MapSlot turned(const MapSlot& slot, double axis) {
  const Vector2d front = slot.corners[1] - slot.corners[0];
  const Vector2d inward = axisAlong(inwardOf(slot), axis);
  const Vector2d along = axisAlong(front, axis);
  const Vector2d half = 0.5 * front.dot(along) * along;
  const double depth = (slot.corners[3] - slot.corners[0]).norm();
  MapSlot result = slot;
  result.corners[0] = slot.entrance() - half;
  result.corners[1] = slot.entrance() + half;
  result.corners[2] = result.corners[1] + depth * inward;
  result.corners[3] = result.corners[0] + depth * inward;
  return result;
}

}  // namespace

double turnFromAxes(const Vector2d& v, double axis) {
  return wrapQuarter(std::atan2(v.y(), v.x()) - axis);
}

Vector2d axisAlong(const Vector2d& v, double axis) {
  const double angle = std::atan2(v.y(), v.x()) - turnFromAxes(v, axis);
  return {std::cos(angle), std::sin(angle)};
}

std::optional<double> findAxis(const std::vector<MapSlot>& slots) {
  constexpr double kMost = 0.6;
  constexpr double kLeast = 100.0;  // looks
  constexpr double kClose = 1.5 * M_PI / 180.0;
  double all = 0.0;
  Turn best;
  double axis = 0.0;
  for (const MapSlot& slot : slots) {
    if (slot.shape == SlotShape::kSlanted) continue;
    all += static_cast<double>(slot.observations);
    const Vector2d inward = inwardOf(slot);
    const double angle = std::atan2(inward.y(), inward.x());
    const Turn turn = turnNear(slots, angle, kOnAxis);
    if (turn.looks <= best.looks) continue;
    best = turn;
    axis = angle + turn.mean;
  }
  if (best.looks < kLeast || best.looks < kMost * all) return std::nullopt;
  return axis + turnNear(slots, axis, kClose).mean;
}

std::vector<std::size_t> turnToAxes(std::vector<MapSlot>& slots) {
  std::vector<std::size_t> indices;
  const std::optional<double> axis = findAxis(slots);
  if (!axis) return indices;
  const std::vector<MapSlot> given = slots;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!isTurned(given[i], *axis) || isOneOfManyTurned(i, given, *axis)) continue;
    slots[i] = turned(given[i], *axis);
    indices.push_back(i);
  }
  return indices;
}

}  // namespace parkade::slot_rows
