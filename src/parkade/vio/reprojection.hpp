// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/vio/window.hpp"

namespace parkade {

/// A pose as matrices, ready for many products.
struct PoseMatrices {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  PoseMatrices() = default;
  explicit PoseMatrices(const NavState& state) : R(state.R_odom_imu.matrix()), p(state.p_odom) {}
  explicit PoseMatrices(const SE3& T) : R(T.rotation().matrix()), p(T.translation()) {}
};

/// Position and rotation of the imu frames and the landmark's three coordinates.
struct ReprojectionJacobians {
  Eigen::Matrix<double, 2, 6> d_px_d_anchor;
  Eigen::Matrix<double, 2, 6> d_px_d_target;
  Eigen::Matrix<double, 2, 3> d_px_d_landmark;
};

/// Position (imu axes) and rotation (right perturbation) of the two cameras on the car.
struct CameraJacobians {
  Eigen::Matrix<double, 2, 6> d_px_d_anchor_camera;
  Eigen::Matrix<double, 2, 6> d_px_d_target_camera;
};

/// Where a camera sat on the car when it read an observation's row, seen from the frame's instant
/// (T_imu_cam): a rolling shutter reads the rows one after the other, and the car goes on
/// meanwhile. docs/math/residuals.md, eq. (3c). The motion counts as known: it has no Jacobians.
SE3 cameraPlace(const VioCamera& camera, const WindowFrame& frame,
                const WindowObservation& observation);

/// Where a landmark, given by direction and inverse distance in its anchor camera, appears in a
/// target camera; docs/math/residuals.md, eq. (3). False where the camera cannot see it.
///
/// T_imu_target: where the target camera sat, as cameraPlace() tells. The Jacobians of the motion
/// are taken at the poses *_lin, those of the projection at the present point: a change of all
/// poses by one motion of the odom frame then leaves them without effect at any state
/// (first-estimate Jacobians; docs/math/marginalisation.md).
bool reproject(const VioCamera& anchor_camera, const VioCamera& target_camera,
               const SE3& T_imu_target, const PoseMatrices& anchor, const PoseMatrices& target,
               const PoseMatrices& anchor_lin, const PoseMatrices& target_lin,
               const Eigen::Vector3d& direction, double inverse_distance, Eigen::Vector2d& pixel,
               ReprojectionJacobians* jacobians = nullptr,
               CameraJacobians* camera_jacobians = nullptr);

}  // namespace parkade
