// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace parkade {

/// The labels of one camera's own picture, by where they are seen: a panorama from the camera's eye
/// in the levelled vehicle frame, whose columns are bearings and whose rows are slopes (height over
/// the eye, by horizontal distance). What stands upright is a column of it at any distance.
struct LevelView {
  static constexpr std::uint8_t kNotSeen = 255;  ///< beyond the picture, or on the own car

  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< m
  double bearing_begin = 0.0;                     ///< rad, from x to y, of column 0
  double bearing_step = 0.0;                      ///< rad
  double slope_begin = 0.0;                       ///< of row 0, the lowest
  double slope_step = 0.0;
  cv::Mat labels;  ///< CV_8UC1: SemanticClass (kUnknown: seen, of no class), or kNotSeen

  /// The label in the direction of a point; kNotSeen outside the panorama.
  [[nodiscard]] std::uint8_t at(const Eigen::Vector3d& p_level) const {
    const Eigen::Vector3d d = p_level - eye;
    const double distance = d.head<2>().norm();
    if (labels.empty() || !(distance > 0.0)) return kNotSeen;
    // Bearings from column 0 on, to one turn.
    double turn = std::remainder(std::atan2(d.y(), d.x()) - bearing_begin, 2.0 * M_PI);
    if (turn < -0.5 * bearing_step) turn += 2.0 * M_PI;
    const int column = static_cast<int>(std::lround(turn / bearing_step));
    const double row = std::round((d.z() / distance - slope_begin) / slope_step);
    if (column >= labels.cols || row < 0.0 || row >= labels.rows) return kNotSeen;
    return labels.at<std::uint8_t>(static_cast<int>(row), column);
  }
};

}  // namespace parkade
