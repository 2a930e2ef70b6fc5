// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/mapping/slots/row_filling.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// Slots that their own lines show, where the gaps of a row say nothing: behind its last slot, in a
/// bay of wide ones, beside a wall. In the axes of every row (along the entrances, in along the
/// sides) plain lines that go in are looked for; two of them as far apart as slots are wide, with
/// an entrance line, a vehicle, a number or a wheel stop between, bound one. What is looked at:
/// the map's layers up to reach_m beyond the row's ends.
std::vector<Filling> findLinedSlots(const std::vector<MapSlot>& told,
                                    const std::vector<Eigen::Vector2d>& pillars,
                                    const LayeredGrid& grid, const SlotLikelihood& likelihood,
                                    const RowCompletionOptions& options);

}  // namespace parkade::slot_rows
