// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/vio/window.hpp"

namespace parkade {

// Residuals of single frames and pairs of frames, whitened (unit variance), with Jacobians by the
// frames' tangents taken at jacobianState(); see docs/math/residuals.md.

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9x15d = Eigen::Matrix<double, 9, 15>;
using Matrix3x15d = Eigen::Matrix<double, 3, 15>;
using Matrix15x2d = Eigen::Matrix<double, 15, 2>;

/// How well a resting car stays where it is.
struct StillSigma {
  double position = 5e-4;  ///< m
  double rotation = 1e-4;  ///< rad
  double velocity = 3e-3;  ///< m/s
};

/// IMU readings between two frames (eq. 1).
Vector15d imuResidual(const WindowFrame& begin, const WindowFrame& end,
                      const WindowGravity& gravity, Matrix15d* d_res_d_begin = nullptr,
                      Matrix15d* d_res_d_end = nullptr, Matrix15x2d* d_res_d_gravity = nullptr);

/// A car at rest: same pose as where it came to rest, no velocity (eq. 5).
Vector9d stillResidual(const WindowFrame& rest, const WindowFrame& now, const StillSigma& sigma,
                       Matrix9x15d* d_res_d_rest = nullptr, Matrix9x15d* d_res_d_now = nullptr);

/// Speed of the vehicle's origin along the vehicle's axes: wheels, no side slip, flat floor (eq.
/// 6).
Eigen::Vector3d bodyVelocityResidual(const WindowFrame& frame, const SE3& T_imu_vehicle,
                                     Matrix3x15d* d_res_d_frame = nullptr);

/// The first frame's pose and what is known of the rest (eq. 7).
Vector15d startResidual(const WindowFrame& frame, const StartPrior& prior,
                        Matrix15d* d_res_d_frame = nullptr);

/// What the calibration file says of a camera that is refined online (eq. 9).
CalibrationVector calibrationResidual(const VioCamera& camera, const CameraRefinement& refinement,
                                      CalibrationMatrix* d_res_d_camera = nullptr);

/// What the start knows of the vertical (eq. 8); zero where it knows nothing.
Eigen::Vector2d gravityResidual(const WindowGravity& gravity, const StartPrior& prior,
                                Eigen::Matrix2d* d_res_d_gravity = nullptr);

}  // namespace parkade
