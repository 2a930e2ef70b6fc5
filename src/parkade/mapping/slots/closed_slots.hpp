// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/mapping/slots/row_filling.hpp"

// Inside of the row completion.

namespace parkade::slot_rows {

/// Slots along the aisle that stand alone between lines on all four sides, where no picture shows
/// them whole: some rigs see nothing of the ground beside the car, and such slots are longer than
/// what lies before it. Looked for along the axes of the garage (findAxis) in the layer of parking
/// lines; the long side with more floor before it is the entrance. docs/math/slots.md.
std::vector<Filling> findClosedSlots(const std::vector<MapSlot>& told, const LayeredGrid& grid,
                                     const SlotLikelihood& likelihood,
                                     const RowCompletionOptions& options);

}  // namespace parkade::slot_rows
