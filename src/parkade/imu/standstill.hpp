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

/// What readings say while nothing moves, as a mean.
struct RestReadings {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< rad/s
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< m/s^2
  double gyro_doubt = 0.0;                          ///< rad/s, by which they may be wrong
  double accel_doubt = 0.0;                         ///< m/s^2
};

/// Whether the means of a stretch of `span_s` are those of rest, known from as long a stretch
/// `age_s` before: no further off than four standard errors by both stretches' white noise and the
/// biases' random walk, plus the doubts. A car that speeds up evenly is quiet, but not this.
bool meansAreOfRest(const StillnessCheck& check, const RestReadings& rest, const ImuNoise& noise,
                    double span_s, double age_s);

}  // namespace parkade
