// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Parked cars whose smears hang together stand in slots of their own. Where an edge on the floor,
/// its points in the order in which a viewer sweeps over them (level frame, m), passes from the
/// middle of one slot, or of the way into it, to that of another: the index of the first point
/// beyond the first slot's side. 0 where it does not.
std::size_t findSlotChange(const std::vector<Eigen::Vector2d>& swept,
                           const std::vector<SlotObservation>& slots);

/// Cars that stand in a row of slots, told or beyond those that are, lie along them: the direction
/// (rad) of the nearest slot whose row most of the points (m, of an edge on the floor) lie in.
/// Nothing where they lie in none, or in one of slots along the way.
std::optional<double> findRowHeading(const std::vector<Eigen::Vector2d>& floor,
                                     const std::vector<SlotObservation>& slots);

}  // namespace parkade
