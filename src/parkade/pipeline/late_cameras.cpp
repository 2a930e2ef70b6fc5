// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/late_cameras.hpp"

namespace parkade {

std::vector<SE3> camerasAtStamp(const std::vector<CameraCalibrationEstimate>& cameras,
                                const PoseEstimate& pose, const Eigen::Vector3d& gyro,
                                const SO3& R_vehicle_imu) {
  Vector6d twist;
  twist << pose.T_odom_vehicle.rotation().inverse() * pose.velocity_odom,
      R_vehicle_imu * Eigen::Vector3d(gyro - pose.bias_gyro);
  std::vector<SE3> places;
  for (const CameraCalibrationEstimate& camera : cameras) {
    places.push_back(SE3::exp(camera.time_offset * twist) * camera.T_vehicle_cam);
  }
  return places;
}

}  // namespace parkade
