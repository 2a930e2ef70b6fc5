// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// Entrances of a row lie in one line. Where a side line is worn off at its end, or nothing crosses
/// it there, a slot's entrance corners are easily told too far in or out, and the slot for a
/// slanted one: slots with a corner 0.15 to 1.6 m off the line that most entrances of the
/// neighbours with parallel sides lie on (12 m) are moved along their sides to it, and get the
/// neighbours' depth and shape. Returns the indices of those moved.
std::vector<std::size_t> alignRows(std::vector<MapSlot>& slots);

/// A slanted slot has its entrance along the aisle and its sides askew. One that is not parallel,
/// with its sides along the axes of the garage, which most of its square slots tell, and its
/// entrance askew is a square one with a corner misread, or none at all. It is made square where
/// its outer corner lies on the line of another slot's entrance, entered the same way (14 m), or
/// where both its sides are painted in the map for half of what is seen of them; else it is to go.
/// One with its entrance and its sides askew gets an entrance along the axis through its outer
/// corner, where another slot's entrance lies on that line and no slot in its way.
struct SquaredSlots {
  std::vector<std::size_t> moved;
  std::vector<std::size_t> wrong;  ///< indices; the slots stay as they are
};
SquaredSlots squareSlots(std::vector<MapSlot>& slots, const LayeredGrid& grid);

}  // namespace parkade::slot_rows
