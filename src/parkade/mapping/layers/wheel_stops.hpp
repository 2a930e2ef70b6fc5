// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Cuts what pictures from above draw behind the wheel stops of slots: a stop is 0.15 m deep, seen
/// from the way driven; cells of the road markers' layer that hold it deeper in its slot become
/// unknown. way: the car's poses in the map, of any density, not empty. docs/math/grid.md.
void trimWheelStops(const std::vector<MapSlot>& slots, const std::vector<SE2>& way,
                    LayeredGrid& grid);

}  // namespace parkade
