// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_sides.hpp"

#include <algorithm>

namespace parkade::slot_rows {

SlotEvidence::Line sideAt(const LayeredGrid& grid, const Row& row, const Pattern& pattern,
                          double s) {
  constexpr double kDeepest = 4.0;  // m
  const Eigen::Vector2d from = row.at(s);
  return lookAlong(grid, from,
                   from + std::min(kDeepest, pattern.side.norm()) * pattern.side.normalized());
}

double settleSide(const LayeredGrid& grid, const Row& row, const Pattern& pattern, double s) {
  constexpr double kReach = 0.25;  // m
  double sum = 0.0;
  double paint = 0.0;
  for (double off = -kReach; off < kReach + 0.01; off += 0.05) {
    const double at = sideAt(grid, row, pattern, s + off).paint();
    sum += off * at;
    paint += at;
  }
  return paint > 0.0 ? s + sum / paint : s;
}

}  // namespace parkade::slot_rows
