// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/mapping/slots/slot_likelihood.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// Of the first slot of a row, the car that turns past the row's end sees one side and some of the
/// entrance, but hardly ever both entrance corners in one picture. Rows of a garage stand alike
/// between its columns: where the slots of the rows known lie beside a column is learned, and
/// beside every other column, in every direction that a row has, such a slot is looked for in the
/// map's layers. It is told where the side line next to the column stands out, ends at the
/// entrance, and the rest of the evidence makes it likely (docs/math/slots.md). Slots along the
/// aisle, of which a picture from across the lane shows little, are looked for in the same way: one
/// of their sides stands out and ends at the rear as well, and the other shows. `slots` are all
/// that are known; none of those returned overlaps one, or another. They have no observations.
std::vector<MapSlot> findBayEnds(const std::vector<MapSlot>& slots,
                                 const std::vector<Eigen::Vector2d>& pillars,
                                 const LayeredGrid& grid, const SlotLikelihood& likelihood,
                                 const RowCompletionOptions& options);

}  // namespace parkade::slot_rows
