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

/// Takes free space back from the borders of what was seen: floor of the structure layer within
/// 0.25 m of unknown ground becomes unknown. Far borders err by as much (0.1 degrees of pitch move
/// a point at 8 m by 0.11 m), and reach into walls. Unknown specks up to two cells wide count for
/// nothing. docs/math/grid.md.
void retreatFromUnseen(LayeredGrid& grid);

}  // namespace parkade
