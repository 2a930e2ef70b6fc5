// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/random.hpp"
#include "parkade/core/time.hpp"
#include "parkade/sim/drive/vehicle_motion.hpp"
#include "parkade/types/samples.hpp"

namespace parkade::sim {

/// What an ideal inertial unit at T_vehicle_imu measures at time t: the instantaneous angular rate
/// and specific force (+9.81 up at rest) in the imu frame, with the lever arm's accelerations.
ImuSample idealImu(const MotionState& state, const SE3& T_vehicle_imu, TimeNs t_ns);

/// Errors of an automotive MEMS part besides its noise densities, which ImuCalibration holds.
struct ImuErrorOptions {
  double gyro_turn_on_deg_s = 0.2;  ///< standard deviation of each axis' bias at the start, deg/s
  double accel_turn_on = 0.1;       ///< standard deviation, m/s^2 (about 10 mg)
  double gyro_step = 0.0;           ///< rad/s per count; 0: not quantised
  double accel_step = 0.0;          ///< m/s^2 per count; 0: not quantised
  bool noise = true;                ///< false: neither noise nor bias
};

/// Adds noise to ideal samples, one after the other: white noise of the set density N gives each
/// sample a standard deviation N * sqrt(rate), a bias starts at a turn-on value and walks by
/// K / sqrt(rate) per sample (Kalibr's and the Allan deviation's convention).
class NoisyImu {
 public:
  NoisyImu(const ImuCalibration& calibration, const ImuErrorOptions& options, const Random& random);

  /// The sample as the part reports it; advances the biases.
  ImuSample corrupt(const ImuSample& ideal);
  /// The biases contained in the latest sample.
  [[nodiscard]] const Eigen::Vector3d& gyroBias() const { return gyro_bias_; }
  [[nodiscard]] const Eigen::Vector3d& accelBias() const { return accel_bias_; }

 private:
  ImuCalibration calibration_;
  ImuErrorOptions options_;
  Random white_;
  Random walk_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
  bool started_ = false;
};

/// Errors of wheel-speed and steering sensors as they come over a car's bus.
struct WheelErrorOptions {
  double speed_step = 1.0 / 64.0;    ///< m/s per count
  double steering_step_deg = 0.1;    ///< deg of the road wheel per count
  double scale_sigma = 0.005;        ///< standard deviation of a wheel's rolling radius, share
  double dead_zone = 0.15;           ///< m/s below which the sensors report 0
  double steering_offset_deg = 0.3;  ///< standard deviation of the steering's zero
  bool noise = true;                 ///< false: exact values
};

/// Wheel speeds and steering as reported: constant scale errors, drawn once; dead zone; counts.
class NoisyWheels {
 public:
  NoisyWheels(const WheelErrorOptions& options, const Random& random);
  [[nodiscard]] WheelSample corrupt(const WheelState& state, TimeNs t_ns) const;

 private:
  WheelErrorOptions options_;
  double scale_left_ = 1.0;
  double scale_right_ = 1.0;
  double steering_offset_ = 0.0;
};

}  // namespace parkade::sim
