// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/imu_model.hpp"

#include <cmath>

#include "parkade/core/units.hpp"

namespace parkade::sim {
namespace {

Eigen::Vector3d normal3(Random& random, double sigma) {
  // One draw per axis in a fixed order: evaluation order of arguments is unspecified.
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = sigma * random.normal();
  return v;
}

double toCounts(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

void toCounts(Eigen::Vector3d& v, double step) {
  for (int i = 0; i < 3; ++i) v[i] = toCounts(v[i], step);
}

}  // namespace

ImuSample idealImu(const MotionState& state, const SE3& T_vehicle_imu, TimeNs t_ns) {
  const SO3 R_imu_vehicle = T_vehicle_imu.rotation().inverse();
  const Eigen::Vector3d& lever = T_vehicle_imu.translation();
  const Eigen::Vector3d& w = state.angular_velocity_body;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() * kGravity;
  const Eigen::Vector3d force_vehicle =
      state.T_world_vehicle.rotation().inverse() * (state.acceleration_world + up) +
      state.angular_acceleration_body.cross(lever) + w.cross(w.cross(lever));
  return {t_ns, R_imu_vehicle * w, R_imu_vehicle * force_vehicle};
}

NoisyImu::NoisyImu(const ImuCalibration& calibration, const ImuErrorOptions& options,
                   const Random& random)
    : calibration_(calibration),
      options_(options),
      white_(random.fork("imu_white")),
      walk_(random.fork("imu_walk")) {
  if (!options_.noise) return;
  Random turn_on = random.fork("imu_turn_on");
  gyro_bias_ = normal3(turn_on, options_.gyro_turn_on_deg_s * kDegree);
  accel_bias_ = normal3(turn_on, options_.accel_turn_on);
}

ImuSample NoisyImu::corrupt(const ImuSample& ideal) {
  ImuSample sample = ideal;
  if (options_.noise) {
    const double root_rate = std::sqrt(calibration_.rate_hz);
    if (started_) {
      gyro_bias_ += normal3(walk_, calibration_.gyroscope_random_walk / root_rate);
      accel_bias_ += normal3(walk_, calibration_.accelerometer_random_walk / root_rate);
    }
    started_ = true;
    sample.gyro += gyro_bias_ + normal3(white_, calibration_.gyroscope_noise_density * root_rate);
    sample.accel +=
        accel_bias_ + normal3(white_, calibration_.accelerometer_noise_density * root_rate);
    toCounts(sample.gyro, options_.gyro_step);
    toCounts(sample.accel, options_.accel_step);
  }
  return sample;
}

NoisyWheels::NoisyWheels(const WheelErrorOptions& options, const Random& random)
    : options_(options) {
  if (!options_.noise) return;
  Random draws = random.fork("wheel");
  scale_left_ = 1.0 + draws.normal(0.0, options_.scale_sigma);
  scale_right_ = 1.0 + draws.normal(0.0, options_.scale_sigma);
  steering_offset_ = draws.normal(0.0, options_.steering_offset_deg * kDegree);
}

WheelSample NoisyWheels::corrupt(const WheelState& state, TimeNs t_ns) const {
  if (!options_.noise) return {t_ns, state.rear_left, state.rear_right, state.steering};
  const auto speed = [this](double truth, double scale) {
    if (std::abs(truth) < options_.dead_zone) return 0.0;
    return toCounts(truth * scale, options_.speed_step);
  };
  return {t_ns, speed(state.rear_left, scale_left_), speed(state.rear_right, scale_right_),
          toCounts(state.steering + steering_offset_, options_.steering_step_deg * kDegree)};
}

}  // namespace parkade::sim
