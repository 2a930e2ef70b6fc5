// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/layered_grid.hpp"

namespace parkade {

/// Takes back what the structure layer says of ground that nobody can have seen: floor and walls
/// that lie, from everywhere on the car's way within `range` m, behind a wall or a pillar of the
/// map. A bare wall that is taken for floor draws free space behind itself. Pillars stay. way: the
/// car's poses in the map, of any density. docs/math/grid.md.
void forgetUnseenGround(const std::vector<SE2>& way, double range, LayeredGrid& grid);

}  // namespace parkade
