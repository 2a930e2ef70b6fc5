// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/mapping/slots/row_filling.hpp"
#include "parkade/mapping/slots/slot_likelihood.hpp"

// Inside of the row completion: wide slots with a sign that stand in no row.

namespace parkade::slot_rows {

/// For each painted sign (findPaintedSigns) in none of the slots told, one slot with the sign in
/// its middle and its sides along the garage's axes, where enough of its outline is painted to tell
/// which way it lies; entered from where more of the floor is known. None where the garage has no
/// axes. docs/math/slots.md, "Signs without a row".
std::vector<Filling> findLoneSignSlots(const std::vector<Eigen::Vector2d>& signs,
                                       const std::vector<MapSlot>& told, const LayeredGrid& grid,
                                       const SlotLikelihood& likelihood,
                                       const RowCompletionOptions& options);

}  // namespace parkade::slot_rows
