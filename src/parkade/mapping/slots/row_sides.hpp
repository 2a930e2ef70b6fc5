// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/slots/row_evidence.hpp"
#include "parkade/mapping/slots/row_pattern.hpp"
#include "parkade/mapping/slots/slot_row.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// What the map's layers hold of a line that goes in from the entrances of a row at s, along the
/// sides of its slots, 4 m deep at most: farther in, cars and the picture's edge hide most.
SlotEvidence::Line sideAt(const LayeredGrid& grid, const Row& row, const Pattern& pattern,
                          double s);

/// The middle of such a line near s: it looks the same for a hand's breadth to either side.
double settleSide(const LayeredGrid& grid, const Row& row, const Pattern& pattern, double s);

}  // namespace parkade::slot_rows
