// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Lays what the slots tell down in the layer of availability. A slot's probability of being free
/// was gathered over all looks at it, by where vehicles stand; cell by cell the layer holds what
/// pictures from above draw of them, a smear that covers half of the car and some of the next
/// slot. Inside every slot (0.3 m off its edges, as cars stand) that is told to be free or occupied
/// (MapSlot::isFree, isOccupied), the cells that were seen become floor or vehicle. Others stay.
/// docs/math/grid.md.
void layDownAvailability(const std::vector<MapSlot>& slots, LayeredGrid& grid);

}  // namespace parkade
