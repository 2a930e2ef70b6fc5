// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "parkade/mapping/parking_map.hpp"

// Inside of the row completion: rows of slots that are not slanted run along two square directions.

namespace parkade::slot_rows {

/// Along a slot's sides, from the entrance in; unit.
inline Eigen::Vector2d inwardOf(const MapSlot& slot) {
  return (slot.corners[3] - slot.corners[0]).normalized();
}

/// The axes of the garage, rad modulo 90 degrees: along most of the slots that are not slanted,
/// weighed by how often they were seen. None where they were seen less than 100 times, or less than
/// 60 % of the looks agree.
std::optional<double> findAxis(const std::vector<MapSlot>& slots);

/// rad, signed: how far a direction is turned from the nearest of the four axes.
double turnFromAxes(const Eigen::Vector2d& v, double axis);

/// The one of the four axes next to a direction; unit.
Eigen::Vector2d axisAlong(const Eigen::Vector2d& v, double axis);

/// Slots that are not slanted have their sides and entrances along the axes. Those with sides off
/// by 1.5 to 8 degrees, or entrances by 2.5 to 8, are turned about the middle of their entrance, if
/// no three others nearby (14 m) are turned as they are, their sides too: worn lines tell
/// directions badly, and a row that follows such a slot leads astray. Returns the indices of those
/// turned.
std::vector<std::size_t> turnToAxes(std::vector<MapSlot>& slots);

}  // namespace parkade::slot_rows
