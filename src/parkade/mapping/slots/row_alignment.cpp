// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_alignment.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/slots/row_evidence.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"
#include "parkade/mapping/slots/slot_row.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

struct Line {
  Vector2d origin = Vector2d::Zero();
  Vector2d u = Vector2d::UnitX();  // unit
  [[nodiscard]] double off(const Vector2d& p) const { return cross(u, p - origin); }
};

constexpr double kOnLine = 0.1;    // m
constexpr double kAlike = 0.9903;  // cosine of 8 degrees

bool liesOn(const MapSlot& slot, const Line& line) {
  return std::abs(line.off(slot.corners[0])) < kOnLine &&
         std::abs(line.off(slot.corners[1])) < kOnLine;
}

// Those with sides along those of the i-th, whatever their entrances.
std::vector<const MapSlot*> neighboursOf(std::size_t i, const std::vector<MapSlot>& slots) {
  constexpr double kNear = 12.0;  // m
  std::vector<const MapSlot*> found;
  for (std::size_t j = 0; j < slots.size(); ++j) {
    if (j != i && (slots[j].entrance() - slots[i].entrance()).norm() < kNear &&
        inwardOf(slots[i]).dot(inwardOf(slots[j])) > kAlike) {
      found.push_back(&slots[j]);
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
      const Vector2d between = slots[j]->entrance() - slots[i]->entrance();
      if (between.norm() < kApart) continue;
      const Line line{slots[i]->entrance(), between.normalized()};
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

// As deep as given from its entrance on.
void setDepth(const Vector2d& inward, double depth, MapSlot& slot) {
  slot.corners[2] = slot.corners[1] + depth * inward;
  slot.corners[3] = slot.corners[0] + depth * inward;
}

bool align(MapSlot& slot, const std::vector<const MapSlot*>& neighbours) {
  const std::optional<Line> line = lineOf(neighbours);
  if (!line) return false;
  const Vector2d inward = inwardOf(slot);
  constexpr double kNoticeable = 0.15;  // m
  constexpr double kMost = 1.6;
  constexpr double kSteep = 0.5;
  const double slope = cross(line->u, inward);
  if (std::abs(slope) < kSteep) return false;
  const double left = -line->off(slot.corners[0]) / slope;
  const double right = -line->off(slot.corners[1]) / slope;
  const double farther = std::max(std::abs(left), std::abs(right));
  if (farther < kNoticeable || farther > kMost) return false;
  std::vector<double> depths;
  const MapSlot* nearest = nullptr;
  for (const MapSlot* other : neighbours) {
    if (!liesOn(*other, *line)) continue;
    depths.push_back((other->corners[3] - other->corners[0]).norm());
    const double distance = (other->entrance() - slot.entrance()).norm();
    if (nearest == nullptr || distance < (nearest->entrance() - slot.entrance()).norm())
      nearest = other;
  }
  // Parallel slots between others keep their shape: they are deep as they are.
  if ((nearest->shape == SlotShape::kParallel) != (slot.shape == SlotShape::kParallel))
    return false;
  slot.shape = nearest->shape;
  slot.corners[0] += left * inward;
  slot.corners[1] += right * inward;
  setDepth(inward, median(std::move(depths)), slot);
  return true;
}

constexpr double kAskew = 8.0 * M_PI / 180.0;

bool isMisread(const MapSlot& slot, double axis) {
  constexpr double kMore = 2.5;  // than its sides
  const double sides = std::abs(turnFromAxes(inwardOf(slot), axis));
  const double entrance = std::abs(turnFromAxes(slot.corners[1] - slot.corners[0], axis));
  return slot.shape != SlotShape::kParallel && sides < kAskew && entrance > kAskew &&
         entrance > kMore * sides;
}

// The corner of the entrance that lies farther in, by so much along the sides, comes out; left
// where ahead is negative.
MapSlot withEvenEntrance(const MapSlot& slot, double ahead) {
  const Vector2d inward = inwardOf(slot);
  const double depth = (slot.corners[3] - slot.corners[0]).norm();
  MapSlot even = slot;
  even.corners[ahead > 0.0 ? 1 : 0] -= std::abs(ahead) * inward;
  setDepth(inward, depth, even);
  return even;
}

// Its entrance square to its sides, through the corner that lies farther out.
MapSlot squared(const MapSlot& slot) {
  MapSlot square = withEvenEntrance(slot, (slot.corners[1] - slot.corners[0]).dot(inwardOf(slot)));
  square.shape = SlotShape::kPerpendicular;
  return square;
}

// A slot with its sides askew whose entrance runs neither along an aisle nor across one.
bool hasAskewEntrance(const MapSlot& slot, double axis) {
  return slot.shape != SlotShape::kParallel &&
         std::abs(turnFromAxes(inwardOf(slot), axis)) > kAskew &&
         std::abs(turnFromAxes(slot.corners[1] - slot.corners[0], axis)) > kAskew;
}

// Its entrance along u through the corner that lies farther out, its sides as they are.
MapSlot straightened(const MapSlot& slot, const Vector2d& u) {
  const Vector2d front = slot.corners[1] - slot.corners[0];
  MapSlot even = withEvenEntrance(slot, cross(u, front) / cross(u, inwardOf(slot)));
  even.shape = SlotShape::kSlanted;
  return even;
}

// Whether both are slanted alike (8 degrees) with their entrances on one line (0.35 m), however far
// along it: bays of one slanted slot each stand far apart.
bool areSlantedAlike(const MapSlot& a, const MapSlot& b) {
  constexpr double kOff = 0.35;  // m
  constexpr double kApart = 40.0;
  const Vector2d u = (a.corners[1] - a.corners[0]).normalized();
  const Vector2d between = b.entrance() - a.entrance();
  return b.shape == SlotShape::kSlanted &&
         u.dot((b.corners[1] - b.corners[0]).normalized()) > kAlike &&
         inwardOf(a).dot(inwardOf(b)) > kAlike && between.norm() < kApart &&
         std::abs(cross(u, between)) < kOff;
}

// Whether one of the others has its entrance on the slot's line, and none lies where the slot does.
bool isInAStraightRow(const MapSlot& slot, std::size_t index, const std::vector<MapSlot>& slots,
                      double axis) {
  constexpr double kOverlap = 0.2;
  bool is_in_row = false;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (i == index) continue;
    if (overlapShare(slots[i].corners, slot.corners) > kOverlap) return false;
    is_in_row = is_in_row || (!hasAskewEntrance(slots[i], axis) &&
                              (areInOneRow(slot, slots[i]) || areSlantedAlike(slot, slots[i])));
  }
  return is_in_row;
}

// With its entrance along one of the axes, that which it is nearer to first, if it stands in a row
// then.
std::optional<MapSlot> straightenedInRow(const std::vector<MapSlot>& slots, std::size_t index,
                                         double axis) {
  const Vector2d front = slots[index].corners[1] - slots[index].corners[0];
  const Vector2d nearer = axisAlong(front, axis);
  const Vector2d other(-nearer.y(), nearer.x());
  for (const Vector2d& u : {nearer, front.dot(other) > 0.0 ? other : Vector2d(-other)}) {
    const MapSlot straight = straightened(slots[index], u);
    if (isInAStraightRow(straight, index, slots, axis)) return straight;
  }
  return std::nullopt;
}

bool hasSides(const MapSlot& slot, const LayeredGrid& grid) {
  constexpr double kHalf = 0.5;
  const SlotEvidence evidence = gatherEvidence(grid, slot.corners);
  return std::min(evidence.left.contrast(), evidence.right.contrast()) > kHalf;
}

}  // namespace

SquaredSlots squareSlots(std::vector<MapSlot>& slots, const LayeredGrid& grid) {
  SquaredSlots result;
  const std::optional<double> axis = findAxis(slots);
  if (!axis) return result;
  const std::vector<MapSlot> given = slots;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (hasAskewEntrance(given[i], *axis)) {
      const std::optional<MapSlot> straight = straightenedInRow(given, i, *axis);
      if (!straight) continue;
      slots[i] = *straight;
      result.moved.push_back(i);
    }
    if (!isMisread(given[i], *axis)) continue;
    const MapSlot square = squared(given[i]);
    const auto isItsRow = [&](const MapSlot& other) {
      return !isMisread(other, *axis) && areInOneRow(square, other);
    };
    if (std::any_of(given.begin(), given.end(), isItsRow) || hasSides(square, grid)) {
      slots[i] = square;
      result.moved.push_back(i);
    } else {
      result.wrong.push_back(i);
    }
  }
  return result;
}

std::vector<std::size_t> alignRows(std::vector<MapSlot>& slots) {
  constexpr int kPasses = 3;  // those moved help their neighbours
  std::vector<bool> moved(slots.size(), false);
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<MapSlot> given = slots;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      if (align(slots[i], neighboursOf(i, given))) moved[i] = true;
    }
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (moved[i]) indices.push_back(i);
  }
  return indices;
}

}  // namespace parkade::slot_rows
