// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/imu/standstill.hpp"

#include <algorithm>
#include <cmath>

namespace parkade {
namespace {

constexpr double kStandardErrors = 4.0;

double limitOfMean(double density, double random_walk, double span_s, double age_s) {
  return kStandardErrors * std::hypot(density * std::sqrt(2.0 / std::max(span_s, 1e-3)),
                                      random_walk * std::sqrt(std::max(age_s, 0.0)));
}

}  // namespace

StillnessCheck checkStillness(std::span<const ImuReading> readings, const ImuNoise& noise,
                              double tolerance, double gyro_floor, double accel_floor) {
  StillnessCheck check;
  if (readings.size() < 5) return check;
  const double count = static_cast<double>(readings.size());
  for (const ImuReading& reading : readings) {
    check.mean_gyro += reading.gyro / count;
    check.mean_accel += reading.accel / count;
  }
  Eigen::Array3d gyro_variance = Eigen::Array3d::Zero();
  Eigen::Array3d accel_variance = Eigen::Array3d::Zero();
  for (const ImuReading& reading : readings) {
    gyro_variance += (reading.gyro - check.mean_gyro).array().square() / (count - 1.0);
    accel_variance += (reading.accel - check.mean_accel).array().square() / (count - 1.0);
  }
  check.gyro_spread = std::sqrt(gyro_variance.maxCoeff());
  check.accel_spread = std::sqrt(accel_variance.maxCoeff());
  const double span = toSeconds(readings.back().t_ns - readings.front().t_ns);
  const double root_rate = std::sqrt((count - 1.0) / span);
  check.quiet =
      check.gyro_spread < gyro_floor + tolerance * noise.gyroscope_noise_density * root_rate &&
      check.accel_spread < accel_floor + tolerance * noise.accelerometer_noise_density * root_rate;
  return check;
}

bool meansAreOfRest(const StillnessCheck& check, const RestReadings& rest, const ImuNoise& noise,
                    double span_s, double age_s) {
  const double gyro_limit =
      rest.gyro_doubt +
      limitOfMean(noise.gyroscope_noise_density, noise.gyroscope_random_walk, span_s, age_s);
  const double accel_limit =
      rest.accel_doubt + limitOfMean(noise.accelerometer_noise_density,
                                     noise.accelerometer_random_walk, span_s, age_s);
  return (check.mean_gyro - rest.gyro).cwiseAbs().maxCoeff() < gyro_limit &&
         (check.mean_accel - rest.accel).cwiseAbs().maxCoeff() < accel_limit;
}

}  // namespace parkade
