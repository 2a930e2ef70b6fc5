// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "parkade/core/time.hpp"

namespace parkade {

/// Where the pixels of a bird's-eye picture lie on the ground, in the levelled vehicle frame (the
/// vehicle frame without its pitch and roll, origin on the ground). Row 0 lies ahead, column 0
/// left.
struct BevGeometry {
  int width_px = 384;
  int height_px = 384;
  double metres_per_px = 0.04;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< ground point at the picture's middle, m

  /// Ground point (x, y) of a pixel (u, v); integer pixels are pixel centres.
  [[nodiscard]] Eigen::Vector2d toGround(const Eigen::Vector2d& pixel) const {
    return {center.x() + (0.5 * (height_px - 1) - pixel.y()) * metres_per_px,
            center.y() + (0.5 * (width_px - 1) - pixel.x()) * metres_per_px};
  }
  /// Pixel (u, v) of a ground point (x, y).
  [[nodiscard]] Eigen::Vector2d toPixel(const Eigen::Vector2d& ground) const {
    return {0.5 * (width_px - 1) - (ground.y() - center.y()) / metres_per_px,
            0.5 * (height_px - 1) - (ground.x() - center.x()) / metres_per_px};
  }
};

/// How the car's body stands over the ground, relative to level: what IPM corrects for.
struct GroundAttitude {
  double pitch = 0.0;   ///< rad, nose down positive (rotation about y, to the left)
  double roll = 0.0;    ///< rad, leaning right positive (rotation about x, forward)
  double height = 0.0;  ///< m, of the vehicle frame's origin over the ground
};

/// How the car goes over the ground while a rolling shutter reads its rows.
struct GroundMotion {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s, levelled vehicle frame
  double yaw_rate = 0.0;                               ///< rad/s
};

/// All cameras of one instant on the ground plane, in one picture.
struct BevImage {
  TimeNs t_ns = 0;
  BevGeometry geometry;
  cv::Mat image;  ///< CV_8UC3 (BGR) or CV_8UC1, as the cameras gave
  cv::Mat valid;  ///< CV_8UC1: 255 where a camera sees the ground, 0 elsewhere and on the own car
};

}  // namespace parkade
