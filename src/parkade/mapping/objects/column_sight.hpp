// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/types/level_view.hpp"

namespace parkade {

/// What a camera's own picture shows where a pillar would stand.
enum class ColumnSight {
  kUnsure,   ///< nothing: it is hidden, cut, too near or too far, or labelled half and half
  kThere,    ///< a column of pillar
  kNotThere  ///< something else, or free space
};

/// Asks the labels for a pillar that stands on the floor at foot (levelled vehicle frame, m), from
/// knee to head height. Its place may lie off: the best of the columns within 0.3 m across the line
/// of sight counts. Vehicles and people only hide. Another pillar on the line of sight looks alike.
ColumnSight columnSight(const LevelView& view, const Eigen::Vector2d& foot);

/// Whether another place than `foot` lies on an eye's line of sight to that, before or behind it,
/// to within 0.6 m: what stands there looks as if it stood at foot.
bool standsInLine(const Eigen::Vector2d& other, const Eigen::Vector2d& foot,
                  const Eigen::Vector2d& eye);

}  // namespace parkade
