// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/geometry/se3.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/vio/estimator.hpp"

namespace parkade {

/// Where cameras were when they took their pictures, in the vehicle's frame at the pictures' stamp
/// (T_vehicle_cam of each): the car goes on for as long as a camera's clock is off
/// (CameraCalibrationEstimate::time_offset). pose: at the stamp; gyro: the reading there, imu
/// frame, rad/s.
std::vector<SE3> camerasAtStamp(const std::vector<CameraCalibrationEstimate>& cameras,
                                const PoseEstimate& pose, const Eigen::Vector3d& gyro,
                                const SO3& R_vehicle_imu);

}  // namespace parkade
