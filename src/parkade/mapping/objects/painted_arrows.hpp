// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Arrows that no picture showed whole, for they are worn or something hid a part, and that the map
/// as a whole does: a garage's arrows are painted alike. The looks of the arrows told are searched
/// for where the layer of road markers holds paint of arrows; those found are told with no
/// observations, those found and those told drawn whole in the cells that the layer knows.
/// docs/math/grid.md, eq. (8).
void completeArrows(ParkingMap& map);

}  // namespace parkade
