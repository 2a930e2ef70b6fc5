// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/odometry.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "parkade/core/units.hpp"

namespace parkade {
namespace {

// Covariance of (x, y, angle, z) of the levelled vehicle, from that of T_odom_vehicle.
Eigen::Matrix4d planarCovariance(const PoseEstimate& e) {
  const Eigen::Matrix3d R = e.T_odom_vehicle.rotation().matrix();
  // Right perturbations are turned to the levelled frame: its axes are the vehicle's without pitch
  // and roll.
  const Eigen::Matrix3d R_level =
      SO3::fromYawPitchRoll(-e.T_odom_vehicle.rotation().yaw(), 0.0, 0.0).matrix() * R;
  Eigen::Matrix<double, 4, 6> J = Eigen::Matrix<double, 4, 6>::Zero();
  J.block<2, 3>(0, 0) = R_level.topRows<2>();
  J.block<1, 3>(2, 3) = R_level.row(2);
  J.block<1, 3>(3, 0) = R_level.row(2);
  return J * e.covariance.topLeftCorner<6, 6>() * J.transpose();
}

}  // namespace

PlanarIncrement planarIncrement(const PoseEstimate& before, const PoseEstimate& after,
                                const OdometryNoiseOptions& options) {
  PlanarIncrement result;
  result.T_before_after =
      SE2::fromSE3(before.T_odom_vehicle).inverse() * SE2::fromSE3(after.T_odom_vehicle);
  result.dz = after.T_odom_vehicle.translation().z() - before.T_odom_vehicle.translation().z();
  const double distance = std::hypot(result.T_before_after.translation().norm(), result.dz);
  const double seconds = std::max(0.0, toSeconds(after.t_ns - before.t_ns));
  const bool weak = after.health == Health::kDegraded || after.health == Health::kLost;
  const double factor = weak ? options.degraded_factor * options.degraded_factor : 1.0;
  // A turn on the spot is no less drift than its arc at a car's turning radius.
  constexpr double kTurningRadius = 5.0;
  const double way = distance + kTurningRadius * std::abs(result.T_before_after.angle());
  const double place = options.translation * options.translation * way +
                       options.standing * options.standing * seconds;
  const double yaw =
      options.yaw_deg * options.yaw_deg * kDegree * kDegree * way +
      options.standing * options.standing * seconds / (kTurningRadius * kTurningRadius);
  const double height =
      options.height * options.height * way + options.standing * options.standing * seconds;
  const Eigen::Vector4d least = factor * Eigen::Vector4d(place, place, yaw, height);
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F.topLeftCorner<3, 3>() = result.T_before_after.inverse().adjoint();
  // Without pictures it tells what the inertial unit alone knows, and no more than that.
  const double share =
      after.health == Health::kLost ? std::max(1.0, options.told_share) : options.told_share;
  const Eigen::Matrix4d growth =
      share * (planarCovariance(after) - F * planarCovariance(before) * F.transpose());
  // Whitened by the floor, eigenvalues below one become one.
  const Eigen::Vector4d scale = least.cwiseMax(1e-12).cwiseSqrt();
  const Eigen::Vector4d unscale = scale.cwiseInverse();
  const Eigen::Matrix4d whitened = unscale.asDiagonal() * growth * unscale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(0.5 *
                                                             (whitened + whitened.transpose()));
  Eigen::Matrix4d bounded = Eigen::Matrix4d::Identity();
  if (eigen.info() == Eigen::Success && whitened.allFinite()) {
    bounded = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(1.0).asDiagonal() *
              eigen.eigenvectors().transpose();
  }
  result.covariance = scale.asDiagonal() * bounded * scale.asDiagonal();
  return result;
}

SE3 liftPose(const SE2& T_world_vehicle, double z, const SE3& T_odom_vehicle) {
  const Eigen::Vector3d angles = T_odom_vehicle.rotation().yawPitchRoll();
  const Eigen::Vector2d& p = T_world_vehicle.translation();
  return {SO3::fromYawPitchRoll(T_world_vehicle.angle(), angles[1], angles[2]), {p.x(), p.y(), z}};
}

}  // namespace parkade
