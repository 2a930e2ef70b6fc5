// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/late_cameras.hpp"

#include <algorithm>

namespace parkade {

CamerasAtStamp camerasAtStamp(const std::vector<CameraCalibrationEstimate>& cameras,
                              const PoseEstimate& pose, const Eigen::Vector3d& gyro,
                              const SO3& R_vehicle_imu) {
  CamerasAtStamp there;
  there.twist << pose.T_odom_vehicle.rotation().inverse() * pose.velocity_odom,
      R_vehicle_imu * Eigen::Vector3d(gyro - pose.bias_gyro);
  for (const CameraCalibrationEstimate& camera : cameras) {
    there.T_vehicle_cam.push_back(SE3::exp(camera.time_offset * there.twist) *
                                  camera.T_vehicle_cam);
    there.readout_time.push_back(camera.readout_time);
  }
  return there;
}

SE3 cameraAtRow(const RigCamera& camera, const SE3& T_vehicle_cam, double row,
                const Vector6d& twist) {
  if (camera.readout_time <= 0.0) return T_vehicle_cam;
  return SE3::exp(camera.rowTime(row) * twist) * T_vehicle_cam;
}

double rowOf(const RigCamera& camera, double ahead, double height) {
  const Eigen::Vector3d axis = camera.T_vehicle_cam.rotation() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d along = axis.head<2>().normalized();
  const Eigen::Vector3d& eye = camera.T_vehicle_cam.translation();
  const Eigen::Vector3d point(eye.x() + ahead * along.x(), eye.y() + ahead * along.y(), height);
  const double last = camera.camera.height() - 1.0;
  Eigen::Vector2d pixel;
  if (camera.camera.project(camera.T_vehicle_cam.inverse() * point, pixel)) {
    return std::clamp(pixel.y(), 0.0, last);
  }
  // Out of what the camera sees: above it or below.
  return height > eye.z() + ahead * axis.z() ? 0.0 : last;
}

}  // namespace parkade
