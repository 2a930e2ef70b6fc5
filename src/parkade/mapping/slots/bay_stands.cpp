// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/bay_stands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "parkade/core/median.hpp"
#include "parkade/mapping/slots/row_pattern.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

void gatherStands(const Row& row, const Pattern& pattern, const std::vector<MapSlot>& slots,
                  const std::vector<Vector2d>& pillars, std::vector<Stand>& stands) {
  constexpr double kAhead = 0.8;  // m: columns in front of the entrances
  constexpr double kBehind = 1.0;
  constexpr double kInside = 0.3;
  constexpr double kMost = 2.0;  // beside a slot
  const Vector2d n(-row.u.y(), row.u.x());
  const auto inRow = [&](const Vector2d& v) { return Vector2d(v.dot(row.u), v.dot(n)); };
  Stand stand;
  stand.shape = pattern.shape;
  stand.side = inRow(pattern.side);
  stand.front = pattern.front;
  for (const Vector2d& p : pillars) {
    const Vector2d at = inRow(p - row.origin);
    if (at.y() < -kAhead || at.y() > stand.side.y() + kBehind) continue;
    const double along = alongRow(row, pattern, p);
    for (const Member& m : row.members) {
      if (slots[m.slot].shape != pattern.shape) continue;
      for (const bool is_right : {true, false}) {
        const double between = is_right ? m.begin - along : along - m.end;
        if (between < -kInside || between > std::min(kMost, 0.95 * pattern.front)) continue;
        stand.is_right = is_right;
        stand.corner = Vector2d(is_right ? m.begin : m.end, 0.0) - at;
        stands.push_back(stand);
      }
    }
  }
}

// What was found again and again, most often first.
std::vector<Stand> commonOf(std::vector<Stand> stands) {
  constexpr std::ptrdiff_t kLeast = 3;
  std::vector<Stand> common;
  while (!stands.empty()) {
    const auto alike = [&](const Stand& stand) {
      return std::count_if(stands.begin(), stands.end(),
                           [&](const Stand& other) { return stand.isLike(other); });
    };
    const Stand most =
        *std::max_element(stands.begin(), stands.end(),
                          [&](const Stand& a, const Stand& b) { return alike(a) < alike(b); });
    if (alike(most) < kLeast) break;
    std::array<std::vector<double>, 5> values;
    for (const Stand& other : stands) {
      if (!most.isLike(other)) continue;
      values[0].push_back(other.corner.x());
      values[1].push_back(other.corner.y());
      values[2].push_back(other.side.x());
      values[3].push_back(other.side.y());
      values[4].push_back(other.front);
    }
    Stand middle = most;
    middle.corner = {median(values[0]), median(values[1])};
    middle.side = {median(values[2]), median(values[3])};
    middle.front = median(values[4]);
    common.push_back(middle);
    std::erase_if(stands, [&](const Stand& other) { return most.isLike(other); });
  }
  return common;
}

}  // namespace

std::vector<Stand> learnStands(const std::vector<Row>& rows, const std::vector<MapSlot>& slots,
                               const std::vector<Vector2d>& pillars) {
  const std::vector<std::vector<Pattern>> patterns = findPatterns(rows, slots, pillars);
  std::vector<Stand> stands;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const Pattern& pattern : patterns[i]) {
      if (pattern.of_row) gatherStands(rows[i], pattern, slots, pillars, stands);
    }
  }
  return commonOf(std::move(stands));
}

}  // namespace parkade::slot_rows
