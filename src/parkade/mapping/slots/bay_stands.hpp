// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/slots/slot_row.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// How slots lie beside columns, in the axes of their row: along the entrances from left to right
/// for who drives in, and into the slots.
struct Stand {
  SlotShape shape = SlotShape::kPerpendicular;
  bool is_right = true;  ///< the slot, of the column
  /// From the column to the entrance corner next to it.
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();
  Eigen::Vector2d side = Eigen::Vector2d::Zero();
  double front = 0.0;  ///< m

  [[nodiscard]] bool isLike(const Stand& other) const {
    constexpr double kCorner = 0.3;  // m
    constexpr double kFront = 0.15;
    constexpr double kSide = 0.5;
    return shape == other.shape && is_right == other.is_right &&
           (corner - other.corner).norm() < kCorner && std::abs(front - other.front) < kFront &&
           (side - other.side).norm() < kSide;
  }
};

/// Those of the rows known that were found three times at least (by their medians), most often
/// first.
std::vector<Stand> learnStands(const std::vector<Row>& rows, const std::vector<MapSlot>& slots,
                               const std::vector<Eigen::Vector2d>& pillars);

}  // namespace parkade::slot_rows
