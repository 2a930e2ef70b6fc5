// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/core/time.hpp"
#include "parkade/geometry/so3.hpp"

namespace parkade {

/// One reading in the imu frame: angular rate, rad/s, and specific force, m/s^2.
struct ImuReading {
  TimeNs t_ns = 0;
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();
};

/// Continuous-time noise densities (Kalibr's names and units).
struct ImuNoise {
  double gyroscope_noise_density = 2.44e-4;      ///< rad/s/sqrt(Hz)
  double gyroscope_random_walk = 2.0e-5;         ///< rad/s^2/sqrt(Hz)
  double accelerometer_noise_density = 1.86e-3;  ///< m/s^2/sqrt(Hz)
  double accelerometer_random_walk = 2.0e-4;     ///< m/s^3/sqrt(Hz)
  double gap_gyro = 0.5;   ///< rad/s: what may happen unseen in a gap between readings, 1 sigma
  double gap_accel = 2.0;  ///< m/s^2: the same of the specific force
};

struct ImuBias {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< rad/s
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< m/s^2
};

/// The inertial unit in a frame whose z axis points up.
struct NavState {
  SO3 R_odom_imu;
  Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();  ///< of the imu, m
  Eigen::Vector3d v_odom = Eigen::Vector3d::Zero();  ///< of the imu, m/s
};

}  // namespace parkade
