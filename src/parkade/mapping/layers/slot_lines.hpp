// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Completes the lines of slots in the layer of parking lines. Networks call far, faint and worn
/// paint floor, so lines of the told map end where the pictures did not show them any more. Slots
/// of a garage are painted alike: at a distance from the entrance where lines show on many slots,
/// those that show elsewhere on the same edge are line as well; entrances and rears also where
/// those of their row, of slots as wide, show lines. Only cells that were seen are changed. slots:
/// those told. Few slots (fewer than six edges of a kind) teach nothing. docs/math/grid.md.
void completeSlotLines(const std::vector<MapSlot>& slots, LayeredGrid& grid);

}  // namespace parkade
