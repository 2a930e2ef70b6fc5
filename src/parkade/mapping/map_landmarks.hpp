// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/submap.hpp"

namespace parkade {

/// What a saved map holds for a later drive to be registered to, in the map's frame: points on the
/// middles of its painted lines (slot, lane and stop lines of its layers, to about a centimetre),
/// its slots' entrance corners, and its point landmarks with their texts.
/// docs/math/registration.md.
Submap landmarksOf(const ParkingMap& map);

}  // namespace parkade
