// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/mapping/slots/slot_likelihood.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// Two slots (or more) with no line to be seen between them are easily read as one along the aisle.
/// Where such a one is as long as whole slots of its row are wide, and the layers do not speak
/// for it (docs/math/slots.md, equation 6), these are appended to slots, with no observations of
/// their own and without an id. Returns the indices of the slots that they stand for, which stay.
std::vector<std::size_t> splitSlots(std::vector<MapSlot>& slots,
                                    const std::vector<Eigen::Vector2d>& pillars,
                                    const LayeredGrid& grid, const SlotLikelihood& likelihood,
                                    const RowCompletionOptions& options);

}  // namespace parkade::slot_rows
