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

/// Forgets what the layer of structure holds of pillars more than 1 m off any pillar of the map:
/// corners of cars and smears that single pictures took for one. Those cells become unknown.
void forgetStrayPillars(const std::vector<MapObject>& objects, LayeredGrid& grid);

/// Gives feet to pillars that the cameras' own pictures show and the bird's-eye pictures hardly do:
/// columns of a garage are alike, so where a pillar among the objects has less than 0.6 of the
/// usual foot's area around it (the median of those seen, three at least), a disc of that area is
/// pillar. Only where half of it is known: what was never in sight is not told. After
/// trimColumnFeet(). docs/math/grid.md.
void completeColumnFeet(const std::vector<MapObject>& objects, LayeredGrid& grid);

}  // namespace parkade
