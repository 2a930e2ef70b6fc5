// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Crossings that no picture showed whole, as those that the car drives over, and that the map as a
/// whole does: their stripes are as wide and as far from one another all over. Those of three
/// stripes and more are told with no observations where both ends are in sight, and their stripes
/// are drawn whole in the cells that the layer of road markers knows. docs/math/grid.md.
void completeCrossings(ParkingMap& map);

}  // namespace parkade
