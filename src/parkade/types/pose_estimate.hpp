// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"

namespace parkade {

enum class Health { kInitialising, kTracking, kDegraded, kLost };

/// "initialising", "tracking", "degraded", "lost".
const char* toString(Health health);

/// Where the car is at one frame set, as a localiser emits it then (causally).
struct PoseEstimate {
  TimeNs t_ns = 0;
  /// Odom is fixed to the first vehicle pose and level as far as the start could tell (at rest:
  /// the accelerometer's turn-on bias over gravity, about a degree); it does not turn when the
  /// vertical becomes better known.
  SE3 T_odom_vehicle;
  /// The vertical in odom as known now: turn odom by it where z has to point up.
  Eigen::Vector3d up_odom = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d velocity_odom = Eigen::Vector3d::Zero();  ///< of the vehicle's origin, m/s
  Eigen::Vector3d bias_gyro = Eigen::Vector3d::Zero();      ///< imu frame, rad/s
  Eigen::Vector3d bias_accel = Eigen::Vector3d::Zero();     ///< imu frame, m/s^2
  /// Of (translation, rotation) of T_odom_vehicle (right perturbation), velocity, gyro bias, accel
  /// bias, in this order; relative to the first pose.
  Eigen::Matrix<double, 15, 15> covariance = Eigen::Matrix<double, 15, 15>::Zero();
  Health health = Health::kInitialising;
  std::string reason;  ///< why the health is not kTracking, in words; else empty
};

}  // namespace parkade
