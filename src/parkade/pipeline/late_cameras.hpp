// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/vio/estimator.hpp"

namespace parkade {

/// Where cameras were when they took their pictures, in the vehicle's frame at the pictures' stamp.
struct CamerasAtStamp {
  std::vector<SE3> T_vehicle_cam;     ///< of each; of the middle row with a rolling shutter
  std::vector<double> readout_time;   ///< of each, s
  Vector6d twist = Vector6d::Zero();  ///< of the vehicle in its own frame there, m/s and rad/s

  /// Over the ground; the few degrees between the vehicle's axes and the level ones are neglected.
  [[nodiscard]] GroundMotion motion() const { return {twist.head<2>(), twist(5)}; }
};

/// Where the cameras were: the car goes on for as long as a camera's clock is off
/// (CameraCalibrationEstimate::time_offset). pose: at the stamp; gyro: the reading there, imu
/// frame, rad/s.
CamerasAtStamp camerasAtStamp(const std::vector<CameraCalibrationEstimate>& cameras,
                              const PoseEstimate& pose, const Eigen::Vector3d& gyro,
                              const SO3& R_vehicle_imu);

/// Where a camera with a rolling shutter was when it read a row, px, in the vehicle's frame at the
/// stamp. T_vehicle_cam: at its middle row; twist: as CamerasAtStamp's.
SE3 cameraAtRow(const RigCamera& camera, const SE3& T_vehicle_cam, double row,
                const Vector6d& twist);

/// The row, px, at which a camera, as the rig places it, sees what stands `ahead` metres before it
/// at `height` over the vehicle's origin; the first or last row where it lies above or below the
/// picture.
double rowOf(const RigCamera& camera, double ahead, double height);

}  // namespace parkade
