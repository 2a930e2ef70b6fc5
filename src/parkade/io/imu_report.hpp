// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/geometry/so3.hpp"
#include "parkade/io/stream_statistics.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

struct ImuReport {
  StreamStatistics stream;
  Eigen::Vector3d gyro_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_std = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_std = Eigen::Vector3d::Zero();
  /// The quietest second (least spread of the accelerometer).
  TimeNs quiet_start_ns = 0;
  Eigen::Vector3d quiet_gyro = Eigen::Vector3d::Zero();           ///< mean, imu frame, rad/s
  Eigen::Vector3d quiet_accel_vehicle = Eigen::Vector3d::Zero();  ///< mean, vehicle frame, m/s^2
  double quiet_accel_std = 0.0;                                   ///< m/s^2
  double gravity = 0.0;                                           ///< norm of that mean, m/s^2
};

/// Means, spreads and the quietest second of samples in the order of time; leaves the report as it
/// is where there are none.
void describeSamples(const std::vector<ImuSample>& samples, const SO3& R_vehicle_imu,
                     ImuReport& report);

}  // namespace parkade
