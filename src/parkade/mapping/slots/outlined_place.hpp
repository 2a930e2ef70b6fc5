// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "parkade/mapping/slots/row_filling.hpp"

// Inside of the row completion: slots that are told by their own outline, without a row.

namespace parkade::slot_rows {

/// The same corners (counter-clockwise, an end or long side that may be the entrance first), from
/// there or from the other side, whichever has more known floor before it (2.5 m).
std::array<Eigen::Vector2d, 4> enteredFromFloor(const std::array<Eigen::Vector2d, 4>& corners,
                                                const LayeredGrid& grid);

/// A slot within such corners, entered so; seen when the last of `told` was.
Place outlinedPlace(const std::array<Eigen::Vector2d, 4>& corners, SlotShape shape,
                    const std::vector<MapSlot>& told, const LayeredGrid& grid, double sigma);

/// This slot alone; none where it is less likely than least.
std::optional<Filling> oneSlot(const MapSlot& slot, double log_odds, double least);

}  // namespace parkade::slot_rows
