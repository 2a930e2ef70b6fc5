// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "parkade/core/random.hpp"

namespace parkade::sim {

/// How a driver keeps to the lane.
struct LaneOptions {
  double offset = 0.9;             ///< m right of the centre in two-way aisles
  double right_turn_offset = 0.2;  ///< m; drivers swing out before a tight right turn
  double corner_zone = 9.0;        ///< m before and after a corner kept for turning
  double shift_length = 9.0;       ///< m over which the car changes its offset
  double wander = 0.1;             ///< m, standard deviation of the place in the lane
  double wander_spacing = 14.0;    ///< m
};

/// One straight aisle stretch of a way.
struct LaneSegment {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double width = 6.0;  ///< m
  bool one_way = false;
};

/// The polyline that the rear axle follows before its corners are rounded. Consecutive segments
/// join; those in one line become one. Where given, the offsets (m right of the centre) hold at the
/// way's start and end.
std::vector<Eigen::Vector2d> laneVertices(std::vector<LaneSegment> segments,
                                          const LaneOptions& options, Random& random,
                                          std::optional<double> start_offset = std::nullopt,
                                          std::optional<double> end_offset = std::nullopt);

}  // namespace parkade::sim
