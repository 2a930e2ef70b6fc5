// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace parkade {

/// How a picture's ground point moves with an error of the levelling (rad; x: nose down, y: to the
/// left), seen from a camera camera_height (m) over the ground. from_camera: the point, as seen
/// from the place under the camera. Along the ray this is (d^2 + h^2) / h, across it h.
inline Eigen::Matrix2d groundTiltJacobian(const Eigen::Vector2d& from_camera,
                                          double camera_height) {
  return camera_height * Eigen::Matrix2d::Identity() +
         from_camera * from_camera.transpose() / camera_height;
}

}  // namespace parkade
