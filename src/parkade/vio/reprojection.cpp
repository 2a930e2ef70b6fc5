// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/reprojection.hpp"

namespace parkade {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix23d = Eigen::Matrix<double, 2, 3>;

SE3 cameraPlace(const VioCamera& camera, const WindowFrame& frame,
                const WindowObservation& observation) {
  const double later = camera.readout_time * observation.row_share;
  if (later == 0.0) return camera.T_imu_cam;
  Vector6d twist;
  twist << frame.state.R_odom_imu.inverse() * frame.state.v_odom, frame.gyro - frame.bias.gyro;
  return SE3::exp(later * twist) * camera.T_imu_cam;
}

bool reproject(const VioCamera& anchor_camera, const VioCamera& target_camera,
               const SE3& T_imu_target, const PoseMatrices& anchor, const PoseMatrices& target,
               const PoseMatrices& anchor_lin, const PoseMatrices& target_lin,
               const Vector3d& direction, double inverse_distance, Eigen::Vector2d& pixel,
               ReprojectionJacobians* jacobians, CameraJacobians* camera_jacobians) {
  const double rho = inverse_distance;
  const Matrix3d R_imu_anchor = anchor_camera.T_imu_cam.rotation().matrix();
  const Matrix3d R_target_imu = T_imu_target.rotation().matrix().transpose();
  const Vector3d& t_anchor = anchor_camera.T_imu_cam.translation();
  const Vector3d& t_target = T_imu_target.translation();

  // The point times its inverse distance, which stays finite for points at infinity.
  const Vector3d x_anchor = R_imu_anchor * direction + rho * t_anchor;
  const Vector3d y = anchor.R * x_anchor + rho * (anchor.p - target.p);
  const Vector3d x_target = target.R.transpose() * y;
  const Vector3d z = R_target_imu * (x_target - rho * t_target);
  if (jacobians == nullptr) return target_camera.camera.project(z, pixel);

  Matrix23d d_px_d_z;
  if (!target_camera.camera.project(z, pixel, &d_px_d_z)) return false;
  const Vector3d x_target_lin =
      target_lin.R.transpose() * (anchor_lin.R * x_anchor + rho * (anchor_lin.p - target_lin.p));
  const Matrix23d by_imu = d_px_d_z * R_target_imu;
  const Matrix23d by_odom = by_imu * target_lin.R.transpose();
  const Matrix23d by_anchor_imu = by_odom * anchor_lin.R;
  jacobians->d_px_d_anchor.leftCols<3>() = rho * by_odom;
  jacobians->d_px_d_anchor.rightCols<3>().noalias() = -by_anchor_imu * hat(x_anchor);
  jacobians->d_px_d_target.leftCols<3>() = -rho * by_odom;
  jacobians->d_px_d_target.rightCols<3>().noalias() = by_imu * hat(x_target_lin);
  jacobians->d_px_d_landmark.leftCols<2>().noalias() =
      (by_anchor_imu * R_imu_anchor) * tangentBasis(direction);
  jacobians->d_px_d_landmark.col(2).noalias() =
      by_anchor_imu * t_anchor + by_odom * (anchor_lin.p - target_lin.p) - by_imu * t_target;
  if (camera_jacobians != nullptr) {
    camera_jacobians->d_px_d_anchor_camera.leftCols<3>() = rho * by_anchor_imu;
    camera_jacobians->d_px_d_anchor_camera.rightCols<3>().noalias() =
        -(by_anchor_imu * R_imu_anchor) * hat(direction);
    camera_jacobians->d_px_d_target_camera.leftCols<3>() = -rho * by_imu;
    camera_jacobians->d_px_d_target_camera.rightCols<3>().noalias() = d_px_d_z * hat(z);
  }
  return true;
}

}  // namespace parkade
