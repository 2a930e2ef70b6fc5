// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "parkade/mapping/layered_grid.hpp"

// Inside of the row completion: what the map's layers hold of a place that may be a slot.

namespace parkade::slot_rows {

/// Shares of the cells that were seen, 0 to 1.
struct SlotEvidence {
  struct Line {
    double painted = 0.0;  ///< along the line, a little to either side where that is more
    double beside = 0.0;   ///< along lines a third of a metre beside it
    double seen_m = 0.0;
    [[nodiscard]] double contrast() const { return painted - beside; }
    /// Metres of paint that stand out.
    [[nodiscard]] double paint() const { return std::max(0.0, contrast()) * seen_m; }
  };
  Line entrance;
  Line left;
  Line right;
  Line rear;
  double divider = 0.0;       ///< of a line that goes in from the entrance between the sides
  double lane_ahead = 0.0;    ///< of the entrance's length: lane line on it
  double lines_inside = 0.0;  ///< of what is seen of the inside
  double lanes_inside = 0.0;
  double markers_inside = 0.0;  ///< for who drives: arrows, stop lines, crossings, bumps, limits
  double structure_inside = 0.0;
  double vehicle = 0.0;
  double vehicle_amid = 0.0;  ///< of the middle half alone: any car in the slot covers that
  double seen = 0.0;          ///< of the inside
  static constexpr double kLeastSeen = 0.15;  ///< of the inside, to tell what is in it
  double number_m2 = 0.0;                     ///< painted number inside, not a share
  double stop_m2 = 0.0;                       ///< wheel stop inside, not a share
  double number_aside = 0.0;  ///< how far from the middle between the sides, of the width
};

/// corners: entrance left and right, rear right and left.
SlotEvidence gatherEvidence(const LayeredGrid& grid, const std::array<Eigen::Vector2d, 4>& corners);

/// Of the line between two places.
SlotEvidence::Line lookAlong(const LayeredGrid& grid, const Eigen::Vector2d& from,
                             const Eigen::Vector2d& to);

}  // namespace parkade::slot_rows
