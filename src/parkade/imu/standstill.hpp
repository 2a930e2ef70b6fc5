// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "parkade/imu/imu_types.hpp"

namespace parkade {

/// What readings of a short stretch say about rest.
struct StillnessCheck {
  bool quiet = false;  ///< spread no larger than the sensor's own noise allows
  Eigen::Vector3d mean_gyro = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_accel = Eigen::Vector3d::Zero();
  double gyro_spread = 0.0;   ///< rad/s, standard deviation, the worst axis
  double accel_spread = 0.0;  ///< m/s^2
};

/// Whether the IMU could be at rest. A car that rolls evenly on a smooth floor is quiet too: quiet
/// is necessary for rest, not sufficient. The limits are `tolerance` times the spread that white
/// noise gives at the readings' rate, plus the floors.
StillnessCheck checkStillness(std::span<const ImuReading> readings, const ImuNoise& noise,
                              double tolerance, double gyro_floor, double accel_floor);

}  // namespace parkade
