// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "parkade/camera/camera.hpp"
#include "parkade/geometry/so3.hpp"

namespace parkade {

/// The picture of a level camera that looks at a marker: columns and heights over the depth.
class LevelCamera {
 public:
  LevelCamera(const Camera& camera, const SO3& R_level_cam, double azimuth)
      : camera_(camera), R_level_cam_(R_level_cam) {
    axes_.row(0) << std::sin(azimuth), -std::cos(azimuth), 0.0;  // right
    axes_.row(1) << 0.0, 0.0, 1.0;                               // up
    axes_.row(2) << std::cos(azimuth), std::sin(azimuth), 0.0;   // ahead
  }

  // False where the pixel's ray does not go ahead.
  bool look(const Eigen::Vector2d& pixel, Eigen::Vector2d& at) const {
    Eigen::Vector3d ray;
    if (!camera_.unproject(pixel, ray)) return false;
    const Eigen::Vector3d p = axes_ * (R_level_cam_ * ray);
    if (p.z() < 0.1) return false;
    at = p.head<2>() / p.z();
    return true;
  }
  // A point (right, up, depth), of any length, to the camera's picture.
  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& pixel) const {
    return camera_.project(R_level_cam_.inverse() * (axes_.transpose() * p), pixel);
  }
  [[nodiscard]] Eigen::Vector3d levelRay(double x, double v) const {
    return (axes_.transpose() * Eigen::Vector3d(x, v, 1.0)).normalized();
  }

 private:
  const Camera& camera_;
  SO3 R_level_cam_;
  Eigen::Matrix3d axes_;
};

}  // namespace parkade
