// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "parkade/types/level_view.hpp"
#include "parkade/types/semantic_class.hpp"

// For tests only: panoramas drawn by hand.

namespace parkade::testing {

/// All around, all of no class.
inline LevelView emptyLevelView(const Eigen::Vector3d& eye = {0.0, 0.0, 0.9}) {
  LevelView view;
  view.eye = eye;
  view.bearing_begin = -M_PI;
  view.bearing_step = M_PI / 180.0;
  view.slope_begin = -0.51;
  view.slope_step = 0.03;
  view.labels = cv::Mat(45, 360, CV_8UC1, cv::Scalar(static_cast<int>(SemanticClass::kUnknown)));
  return view;
}

/// Something upright at a place, this wide to either side, from low to high (m over the floor).
inline void drawColumn(LevelView& view, const Eigen::Vector2d& foot, double half_width,
                       SemanticClass c, double low = -10.0, double high = 10.0) {
  const Eigen::Vector2d d = foot - view.eye.head<2>();
  for (int column = 0; column < view.labels.cols; ++column) {
    const double bearing = view.bearing_begin + column * view.bearing_step;
    const double off = std::remainder(bearing - std::atan2(d.y(), d.x()), 2.0 * M_PI);
    if (std::abs(off) > std::atan2(half_width, d.norm())) continue;
    for (int row = 0; row < view.labels.rows; ++row) {
      const double z = view.eye.z() + (view.slope_begin + row * view.slope_step) * d.norm();
      if (z < low || z > high) continue;
      view.labels.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(c);
    }
  }
}

}  // namespace parkade::testing
