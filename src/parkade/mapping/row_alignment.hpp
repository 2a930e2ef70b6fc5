// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "parkade/mapping/parking_map.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// Entrances of a row lie in one line. Where a side line is worn off at its end, or nothing crosses
/// it there, a slot's entrance is easily told too far in or out: slots whose entrance lies off the
/// line of most of their neighbours (12 m, the same shape and direction) by 0.15 to 1.3 m are
/// moved along their sides to it, and as deep as those. Returns the indices of those moved.
std::vector<std::size_t> alignRows(std::vector<MapSlot>& slots);

}  // namespace parkade::slot_rows
