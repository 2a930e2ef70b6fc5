// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Cuts what passes for a pillar's foot and lies behind it. Whoever drives past sees floor before
/// and beside a pillar and never what lies in the shadow of all views. But columns, square or
/// round, are the same seen from either side: a cell without a counterpart across the middle of the
/// pillar that it belongs to becomes unknown. Cells more than 1 m from every pillar among the
/// objects, and walls, are left alone. docs/math/grid.md.
void trimColumnFeet(const std::vector<MapObject>& objects, LayeredGrid& grid);

}  // namespace parkade
