// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Points along one painted line, in order.
struct MeasuredLine {
  std::vector<LinePoint> points;
  std::vector<double> sigmas;  ///< m, across, of each point's own noise: without the attitude
  double width = 0.0;          ///< m
};

struct SegmentOptions {
  double min_length_m = 0.3;
  double max_deviation_m = 0.06;  ///< of a straight piece's points
  double max_gap_m = 0.8;         ///< collinear pieces are joined over it
  double camera_height_m = 1.0;
  Eigen::Vector2d viewpoint = Eigen::Vector2d::Zero();
};

/// Straight pieces of lines: split where they bend, fitted with a Huber loss, joined over gaps and
/// where several lines lie on each other. attitude_sigma: rad.
std::vector<LineSegment> fitSegments(const std::vector<MeasuredLine>& lines, double attitude_sigma,
                                     const SegmentOptions& options);

}  // namespace parkade
