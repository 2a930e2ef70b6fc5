// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

constexpr double kInside = 0.3;  // m: what stands deeper in a slot's width does not bound it

bool isWithin(const Row& row, double s) {
  return std::any_of(row.members.begin(), row.members.end(),
                     [&](const Member& m) { return s > m.begin + kInside && s < m.end - kInside; });
}

struct Margins {
  std::vector<double> before;
  std::vector<double> after;
};

// Beside the members of this shape that are next to a pillar. As much as a slot's front is no
// margin: a slot was missed there.
void gatherMargins(const Row& row, const Pattern& pattern, const std::vector<MapSlot>& slots,
                   const std::vector<Vector2d>& pillars, Margins& margins) {
  constexpr double kMost = 0.95;  // of the front
  const double most = kMost * pattern.front;
  for (const Vector2d& p : pillars) {
    if (!standsIn(row, pattern, p)) continue;
    const double s = alongRow(row, pattern, p);
    if (isWithin(row, s)) continue;
    for (const Member& m : row.members) {
      if (slots[m.slot].shape != pattern.shape) continue;
      if (m.begin - s > -kInside && m.begin - s < most) margins.before.push_back(m.begin - s);
      if (s - m.end > -kInside && s - m.end < most) margins.after.push_back(s - m.end);
    }
  }
}

// From the shortest on.
std::vector<Margin> countMargins(std::vector<double> lengths) {
  constexpr double kSame = 0.12;  // m
  std::sort(lengths.begin(), lengths.end());
  std::vector<Margin> margins;
  for (const double length : lengths) {
    const auto seen = std::count_if(lengths.begin(), lengths.end(),
                                    [&](double other) { return std::abs(other - length) < kSame; });
    margins.push_back({length, static_cast<int>(seen)});
  }
  return margins;
}

Pattern patternOf(const Row& row, SlotShape shape, const std::vector<MapSlot>& slots) {
  Pattern pattern;
  pattern.shape = shape;
  std::vector<double> fronts;
  std::vector<double> along;
  std::vector<double> across;
  const Vector2d n(-row.u.y(), row.u.x());
  for (const Member& m : row.members) {
    const MapSlot& slot = slots[m.slot];
    if (slot.shape != shape) continue;
    const Vector2d side =
        0.5 * (slot.corners[2] + slot.corners[3] - slot.corners[0] - slot.corners[1]);
    fronts.push_back(m.end - m.begin);
    along.push_back(side.dot(row.u));
    across.push_back(side.dot(n));
  }
  pattern.front = median(std::move(fronts));
  pattern.side = median(std::move(along)) * row.u + median(std::move(across)) * n;
  return pattern;
}

// Slots that stand square to the row, sized as in all the others.
Pattern patternOfOthers(const Row& row, SlotShape shape, const std::vector<Row>& rows,
                        const std::vector<MapSlot>& slots) {
  Pattern pattern;
  pattern.shape = shape;
  pattern.of_row = false;
  std::vector<double> fronts;
  std::vector<double> depths;
  for (const Row& other : rows) {
    for (const Member& m : other.members) {
      if (slots[m.slot].shape != shape) continue;
      fronts.push_back(m.end - m.begin);
      depths.push_back((slots[m.slot].corners[3] - slots[m.slot].corners[0]).norm());
    }
  }
  pattern.front = median(std::move(fronts));
  const MapSlot& any = slots[row.members.front().slot];
  const Vector2d n(-row.u.y(), row.u.x());
  const double side = n.dot(any.corners[3] - any.corners[0]) > 0.0 ? 1.0 : -1.0;
  pattern.side = side * median(std::move(depths)) * n;
  return pattern;
}

constexpr std::array<SlotShape, 3> kShapes = {SlotShape::kPerpendicular, SlotShape::kParallel,
                                              SlotShape::kSlanted};

int countOf(const Row& row, SlotShape shape, const std::vector<MapSlot>& slots) {
  return static_cast<int>(
      std::count_if(row.members.begin(), row.members.end(),
                    [&](const Member& m) { return slots[m.slot].shape == shape; }));
}

// Those of the row's own shapes, most members first, then those of others; no margins yet.
std::vector<Pattern> patternsOf(const Row& row, const std::vector<Row>& rows,
                                const std::vector<MapSlot>& slots) {
  constexpr double kWider = 0.6;  // m
  std::vector<Pattern> patterns;
  for (const SlotShape shape : kShapes) {
    if (countOf(row, shape, slots) > 0) patterns.push_back(patternOf(row, shape, slots));
  }
  std::stable_sort(patterns.begin(), patterns.end(), [&](const Pattern& a, const Pattern& b) {
    return countOf(row, a.shape, slots) > countOf(row, b.shape, slots);
  });
  // A row of which only wide slots were seen may hold usual ones all the same.
  const auto of_wide = std::find_if(patterns.begin(), patterns.end(), [](const Pattern& pattern) {
    return pattern.shape == SlotShape::kPerpendicular;
  });
  if (of_wide != patterns.end()) {
    const Pattern usual = patternOfOthers(row, SlotShape::kPerpendicular, rows, slots);
    of_wide->is_wide = of_wide->front > usual.front + kWider;
    if (of_wide->is_wide) patterns.push_back(usual);
  }
  for (const SlotShape shape : {SlotShape::kPerpendicular, SlotShape::kParallel}) {
    const bool elsewhere = std::any_of(rows.begin(), rows.end(), [&](const Row& other) {
      return countOf(other, shape, slots) > 0;
    });
    if (elsewhere && countOf(row, shape, slots) == 0) {
      patterns.push_back(patternOfOthers(row, shape, rows, slots));
    }
  }
  return patterns;
}

// A shape's own; those of all the others where it has none.
std::vector<Margin> marginsOf(SlotShape shape, const std::array<Margins, kShapes.size()>& margins,
                              std::vector<double> Margins::*side) {
  std::vector<double> own;
  std::vector<double> others;
  for (std::size_t k = 0; k < kShapes.size(); ++k) {
    const std::vector<double>& of_shape = margins[k].*side;
    std::vector<double>& to = kShapes[k] == shape ? own : others;
    to.insert(to.end(), of_shape.begin(), of_shape.end());
  }
  return countMargins(own.empty() ? std::move(others) : std::move(own));
}

}  // namespace

MapSlot unseenSlot(const Pattern& pattern, const Vector2d& left, const Vector2d& right,
                   const MapSlot& near, double sigma) {
  MapSlot slot;
  slot.corners = {left, right, right + pattern.side, left + pattern.side};
  slot.shape = pattern.shape;
  slot.last_seen_ns = near.last_seen_ns;
  slot.corner_sigma = std::max(sigma, near.corner_sigma);
  return slot;
}

double depthShare(const Row& row, const Pattern& pattern, const Vector2d& p) {
  // The same sign, whichever side the slots lie on.
  return cross(row.u, p - row.origin) / cross(row.u, pattern.side);
}

bool standsIn(const Row& row, const Pattern& pattern, const Vector2d& p) {
  constexpr double kAhead = 0.6;  // m
  const double share = depthShare(row, pattern, p);
  return share > -kAhead / std::abs(cross(row.u, pattern.side)) && share < 1.0;
}

double alongRow(const Row& row, const Pattern& pattern, const Vector2d& p) {
  return cross(p - row.origin, pattern.side) / cross(row.u, pattern.side);
}

std::vector<std::vector<Pattern>> findPatterns(const std::vector<Row>& rows,
                                               const std::vector<MapSlot>& slots,
                                               const std::vector<Vector2d>& pillars) {
  std::array<Margins, kShapes.size()> margins;
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < kShapes.size(); ++k) {
      if (countOf(row, kShapes[k], slots) == 0) continue;
      gatherMargins(row, patternOf(row, kShapes[k], slots), slots, pillars, margins[k]);
    }
  }
  std::vector<std::vector<Pattern>> of_rows;
  for (const Row& row : rows) {
    of_rows.push_back(patternsOf(row, rows, slots));
    for (Pattern& pattern : of_rows.back()) {
      pattern.before = marginsOf(pattern.shape, margins, &Margins::before);
      pattern.after = marginsOf(pattern.shape, margins, &Margins::after);
    }
  }
  return of_rows;
}

std::vector<Gap> findGaps(const Row& row, const Pattern& pattern,
                          const std::vector<Vector2d>& pillars, double reach) {
  struct Taken {
    double begin;
    double end;
    GapEnd by;
  };
  std::vector<Taken> taken;
  for (const Member& m : row.members) taken.push_back({m.begin, m.end, GapEnd::kSlot});
  const double first = row.members.front().begin;
  double last = first;
  for (const Member& m : row.members) last = std::max(last, m.end);
  for (const Vector2d& p : pillars) {
    if (!standsIn(row, pattern, p)) continue;
    const double s = alongRow(row, pattern, p);
    if (s < first - reach || s > last + reach || isWithin(row, s)) continue;
    taken.push_back({s, s, GapEnd::kPillar});
  }
  std::sort(taken.begin(), taken.end(),
            [](const Taken& a, const Taken& b) { return a.begin < b.begin; });
  std::vector<Gap> gaps;
  const Taken& front = taken.front();
  gaps.push_back({front.begin - reach, front.begin, GapEnd::kOpen, front.by});
  Taken before = front;
  for (const Taken& next : taken) {
    if (next.begin > before.end) gaps.push_back({before.end, next.begin, before.by, next.by});
    if (next.end > before.end) before = next;
  }
  gaps.push_back({before.end, before.end + reach, before.by, GapEnd::kOpen});
  return gaps;
}

}  // namespace parkade::slot_rows
