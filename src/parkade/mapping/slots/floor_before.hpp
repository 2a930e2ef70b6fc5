// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/mapping/layered_grid.hpp"

// Inside of the row completion: which end of a slot that is closed all around is its entrance.

namespace parkade::slot_rows {

/// Share of the ground before a side (2.5 m), away from the middle, that is known floor.
double floorBefore(const LayeredGrid& grid, const Eigen::Vector2d& left,
                   const Eigen::Vector2d& right, const Eigen::Vector2d& middle);

}  // namespace parkade::slot_rows
