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

// Inside of the row completion: wide slots, as for wheelchairs, by the sign painted in them.

namespace parkade::slot_rows {

/// Middles of signs painted on the floor: what the layers hold as painted number, as large as no
/// number is (0.85 m^2). World frame. None where the grid is too wide for a picture of it.
std::vector<Eigen::Vector2d> findPaintedSigns(const LayeredGrid& grid);

/// m, between the entrance corners of slots that are wider than usual ones by far; of a garage
/// without any as the norm has it.
double wideFrontOf(const std::vector<MapSlot>& told);

/// For each sign in the depth of a row, not in a slot told, one wide slot with the sign in its
/// middle: as wide as the sides' paint has it, where none shows as the garage's others.
/// docs/math/slots.md.
std::vector<Filling> findReservedSlots(const std::vector<Eigen::Vector2d>& signs,
                                       const std::vector<MapSlot>& told,
                                       const std::vector<Eigen::Vector2d>& pillars,
                                       const LayeredGrid& grid, const SlotLikelihood& likelihood,
                                       const RowCompletionOptions& options);

}  // namespace parkade::slot_rows
