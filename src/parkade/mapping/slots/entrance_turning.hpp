// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"

// Inside of the row completion: slots that are told to be entered where nobody can.

namespace parkade::slot_rows {

/// A slot along the aisle that is closed all around is now and then told with its entrance at an
/// end, where the next slot of the row stands before it. Those are turned: entered by the long side
/// with more known floor before it. docs/math/slots.md. Returns the indices of those turned.
std::vector<std::size_t> turnBlockedSlots(std::vector<MapSlot>& told, const LayeredGrid& grid);

/// The last slot of a row that is entered from another aisle shows this one its long side, and is
/// told as one along it. Where it is as long as slots into rows may be deep and no other along an
/// aisle is, its far side was not in sight and another slot stands before one of its ends, it is
/// entered by the other end, and as wide as those slots. docs/math/slots.md. Returns the indices of
/// those turned.
std::vector<std::size_t> turnSidewaysSlots(std::vector<MapSlot>& told, const LayeredGrid& grid);

}  // namespace parkade::slot_rows
