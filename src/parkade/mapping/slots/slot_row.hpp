// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "parkade/mapping/parking_map.hpp"

// Inside of the row completion: slots whose entrances lie in one line.

namespace parkade::slot_rows {

/// A slot in its row: where its entrance begins and ends along it.
struct Member {
  std::size_t slot = 0;  ///< index among the slots
  double begin = 0.0;    ///< m, its left corner
  double end = 0.0;      ///< m, its right corner
};

/// Slots with their entrances in one line, entered the same way. World frame.
struct Row {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< on the line of the entrances
  Eigen::Vector2d u = Eigen::Vector2d::UnitX();      ///< unit, left to right for who drives in
  std::vector<Member> members;                       ///< ordered by begin

  [[nodiscard]] Eigen::Vector2d at(double s) const { return origin + s * u; }
};

/// Whether both are entered the same way (6 degrees), over one line (0.35 m), 14 m apart at most.
bool areInOneRow(const MapSlot& a, const MapSlot& b);

/// Whether a line from `from` to `to` lies on one of the slot's four (0.4 m at its middle, 15
/// degrees), as a line of a slot lies on the entrance of the next row.
bool liesOnLineOf(const MapSlot& slot, const Eigen::Vector2d& from, const Eigen::Vector2d& to);

std::vector<Row> findRows(const std::vector<MapSlot>& slots);

}  // namespace parkade::slot_rows
