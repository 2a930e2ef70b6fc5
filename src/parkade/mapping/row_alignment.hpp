// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "parkade/mapping/parking_map.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// Entrances of a row lie in one line. Where a side line is worn off at its end, or nothing crosses
/// it there, a slot's entrance corners are easily told too far in or out, and the slot for a
/// slanted one: slots with a corner 0.15 to 1.6 m off the line that most entrances of the
/// neighbours with parallel sides lie on (12 m) are moved along their sides to it, and get the
/// neighbours' depth and shape. Returns the indices of those moved.
std::vector<std::size_t> alignRows(std::vector<MapSlot>& slots);

}  // namespace parkade::slot_rows
